//! Where integrators put their contributions: one layer per path class, in a fixed order.

use nephroid_analytic::class::PathClass;

/// Sums of contributions, one layer per path class.
///
/// A contribution to a pixel is scaled so that `sum / paths` is an estimate of the pixel's mean radiance
/// [W m⁻² sr⁻¹], whatever the technique: a camera path that picks one of P pixels with equal probability adds P times its
/// radiance to that pixel; a light path adds the whole of what it brings to the pixel it hits.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The classes of the layers.
    pub classes: &'static [PathClass],
    /// `layers[class][row * width + column]`: sums of contributions.
    pub layers: Vec<Vec<f64>>,
    /// Contributions that are not zero, per class.
    pub nonzero: Vec<u64>,
    /// Paths drawn, misses included.
    pub paths: u64,
    /// Layers that nobody will read: an integrator may leave them empty, and does so where that saves work.
    unread: Layers,
}

/// A set of a film's layers, by their positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layers(u64);

impl Layers {
    /// Most layers of a film.
    const MOST: usize = u64::BITS as usize;

    /// Whether a layer is among them.
    pub fn contain(self, layer: usize) -> bool {
        layer < Layers::MOST && self.0 >> layer & 1 == 1
    }
}

impl FromIterator<usize> for Layers {
    fn from_iter<T: IntoIterator<Item = usize>>(layers: T) -> Self {
        let layers = layers.into_iter().filter(|&l| l < Layers::MOST);
        Layers(layers.fold(0, |set, layer| set | 1 << layer))
    }
}

impl Film {
    /// An empty film.
    pub fn new(width: u32, height: u32, classes: &'static [PathClass]) -> Self {
        let pixels = width as usize * height as usize;
        Film {
            width,
            height,
            classes,
            layers: vec![vec![0.0; pixels]; classes.len()],
            nonzero: vec![0; classes.len()],
            paths: 0,
            unread: Layers::default(),
        }
    }

    /// The same film, of which some layers need not be filled.
    pub fn without(self, unread: Layers) -> Self {
        Film { unread, ..self }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Sets everything back to zero, keeping the memory.
    pub fn clear(&mut self) {
        self.layers.iter_mut().for_each(|l| l.fill(0.0));
        self.nonzero.fill(0);
        self.paths = 0;
    }

    /// Adds another film of the same shape. The order of additions decides the last bits: keep it fixed.
    pub fn add(&mut self, other: &Film) {
        for (layer, o) in self.layers.iter_mut().zip(&other.layers) {
            for (a, b) in layer.iter_mut().zip(o) {
                *a += b;
            }
        }
        for (a, b) in self.nonzero.iter_mut().zip(&other.nonzero) {
            *a += b;
        }
        self.paths += other.paths;
    }

    /// The index of a class's layer; `None` where there is none, or nobody will read it.
    pub fn layer_of(&self, class: PathClass) -> Option<usize> {
        let layer = self.position_of(class)?;
        (!self.unread.contain(layer)).then_some(layer)
    }

    /// The index of a class's layer, whether it is read or not: for methods in which one class decides about another.
    pub fn position_of(&self, class: PathClass) -> Option<usize> {
        self.classes.iter().position(|&c| c == class)
    }

    /// Whether any of these classes has a layer that is read.
    pub fn reads(&self, classes: &[PathClass]) -> bool {
        classes.iter().any(|&c| self.layer_of(c).is_some())
    }

    /// Mean radiance of each class over the whole image [W m⁻² sr⁻¹].
    pub fn class_means(&self) -> Vec<f64> {
        let scale = 1.0 / (self.paths as f64 * self.pixels() as f64);
        self.layers
            .iter()
            .map(|l| compensated_sum(l) * scale)
            .collect()
    }
}

/// Sum in index order with Neumaier's compensation.
pub fn compensated_sum(values: &[f64]) -> f64 {
    let (mut sum, mut rest) = (0.0, 0.0);
    for &v in values {
        let t: f64 = sum + v;
        rest += if f64::abs(sum) >= f64::abs(v) {
            (sum - t) + v
        } else {
            (v - t) + sum
        };
        sum = t;
    }
    sum + rest
}
