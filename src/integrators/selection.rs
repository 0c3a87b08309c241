//! Which bandwidth a pass has: a part that any integrator takes.
//!
//! The choice looks at passes that are over, never at the one it is for: a pass has the expectation of its bandwidth. Three ways:
//!
//! - *fixed*: the one that is given, or a schedule.
//! - *preview*: the smallest at which all N paths of a pixel miss with probability ε at most. A path hits with probability p b^d at a
//!   small bandwidth b, d the dimension of the mollified interaction, p from the hits of the passes so far:
//!   (1 - p b^d)^N = ε.
//! - *optimum*: the estimated bias B b² and variance V b^(-d) per path balance: of a run of n paths b^(d + 4) = d V/(4 B² n)
//!   [Kaplanyan & Dachsbacher 2013; theory of schedules]. B is the slope of the passes' means over b², which needs passes at two
//!   bandwidths or more: the first ones alternate. Squared means are taken tile by tile of the image, and what noise adds to the square
//!   of a slope is taken off again.

use libm::{expm1, log, pow};

use super::Prepared;
use super::learning::Run;
use crate::film::Film;

/// How a bandwidth is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Selection {
    /// The one that is given.
    Fixed,
    /// The smallest at which a pixel is black with probability `miss` at most.
    Preview {
        /// ε.
        miss: f64,
    },
    /// Of least estimated error.
    Optimum,
}

/// Passes that only look, at the given bandwidth and at [`NARROWER`] times it in turns.
pub const PILOTS: u32 = 8;
/// See [`PILOTS`].
pub const NARROWER: f64 = 0.5;
/// Tiles along a side of the image.
const TILES: usize = 4;

/// The bandwidth at which n paths all miss with probability `miss`, from the part `rate` of paths that hit at the bandwidth `at`; `None`
/// if nothing was hit.
pub fn preview_bandwidth(rate: f64, at: f64, paths: f64, miss: f64, dimension: f64) -> Option<f64> {
    // 1 - ε^(1/N) without cancellation.
    let needed = -expm1(log(miss) / paths);
    (rate > 0.0).then(|| at * pow(needed / rate, 1.0 / dimension))
}

/// The bandwidth of least error of n paths with the squared bias `bias_squared` b⁴ and the variance `variance` b^(-d)/n; `None` without
/// either.
pub fn best_bandwidth(bias_squared: f64, variance: f64, paths: f64, dimension: f64) -> Option<f64> {
    let ratio = dimension * variance / (4.0 * bias_squared * paths);
    (bias_squared > 0.0 && ratio > 0.0).then(|| pow(ratio, 1.0 / (dimension + 4.0)))
}

/// A pass that is over.
#[derive(Clone, Debug)]
struct Pass {
    bandwidth: f64,
    /// Means of the tiles.
    tiles: Vec<f64>,
    hits: u64,
    paths: u64,
}

/// Chooses bandwidths for a run.
#[derive(Clone, Debug)]
pub struct Selector {
    selection: Selection,
    given: f64,
    dimension: f64,
    /// Paths of the whole run, and pixels.
    budget: f64,
    pixels: f64,
    /// Layers of the classes that are regularized.
    layers: Vec<usize>,
    passes: Vec<Pass>,
}

impl Selector {
    /// For a run of `budget` paths over an image of so many pixels, of which the layers are regularized with `dimension` the dimension of
    /// the mollified interaction (2 on a surface in space).
    pub fn new(
        selection: Selection,
        given: f64,
        dimension: f64,
        budget: u64,
        pixels: usize,
        layers: Vec<usize>,
    ) -> Self {
        Selector {
            selection,
            given,
            dimension,
            budget: budget as f64,
            pixels: pixels as f64,
            layers,
            passes: Vec::new(),
        }
    }

    /// The bandwidth of the next pass: never more than the one that is given.
    pub fn bandwidth(&self) -> f64 {
        let pilots = self.passes.len() < PILOTS as usize;
        let chosen = match self.selection {
            Selection::Fixed => None,
            Selection::Preview { miss } => {
                let hits: f64 = self.passes.iter().map(|p| p.hits as f64).sum();
                let weights = self
                    .passes
                    .iter()
                    .map(|p| p.paths as f64 * pow(p.bandwidth / self.given, self.dimension));
                let rate = hits / weights.sum::<f64>();
                let paths = self.budget / self.pixels;
                preview_bandwidth(rate, self.given, paths, miss, self.dimension)
            }
            Selection::Optimum if pilots => {
                let odd = self.passes.len() % 2 == 1;
                odd.then_some(NARROWER * self.given)
            }
            Selection::Optimum => {
                let (bias, variance) = self.coefficients();
                best_bandwidth(bias, variance, self.budget, self.dimension)
            }
        };
        chosen.filter(|b| *b < self.given).unwrap_or(self.given)
    }

    /// Learns from a pass: a film that has it and nothing else.
    pub fn observe(&mut self, bandwidth: f64, film: &Film) {
        let (width, height) = (film.width as usize, film.height as usize);
        let mut tiles = vec![0.0; TILES * TILES];
        for &layer in &self.layers {
            for (p, &value) in film.layers[layer].iter().enumerate() {
                let (row, column) = (p / width * TILES / height, p % width * TILES / width);
                tiles[row * TILES + column] += value;
            }
        }
        let scale = (TILES * TILES) as f64 / (self.pixels * film.paths as f64);
        tiles.iter_mut().for_each(|t| *t *= scale);
        self.passes.push(Pass {
            bandwidth,
            tiles,
            hits: self.layers.iter().map(|&l| film.nonzero[l]).sum(),
            paths: film.paths,
        });
    }

    /// Sums over tiles of B² and V, by weighted least squares of the passes' means over b²: weights b^d, as the variance is V b^(-d).
    fn coefficients(&self) -> (f64, f64) {
        let weight = |p: &Pass| p.paths as f64 * pow(p.bandwidth, self.dimension);
        let total: f64 = self.passes.iter().map(weight).sum();
        let x = |p: &Pass| p.bandwidth * p.bandwidth;
        let center = self.passes.iter().map(|p| weight(p) * x(p)).sum::<f64>() / total;
        let spread: f64 = self
            .passes
            .iter()
            .map(|p| weight(p) * (x(p) - center) * (x(p) - center))
            .sum();
        let freedom = self.passes.len() as f64 - 2.0;
        let (mut bias, mut variance) = (0.0, 0.0);
        for tile in 0..TILES * TILES {
            let y = |p: &Pass| p.tiles[tile];
            let mean = self.passes.iter().map(|p| weight(p) * y(p)).sum::<f64>() / total;
            let product = |p: &Pass| weight(p) * (x(p) - center) * y(p);
            let slope = self.passes.iter().map(product).sum::<f64>() / spread;
            let rest = |p: &Pass| {
                let off = y(p) - mean - slope * (x(p) - center);
                weight(p) * off * off
            };
            let v = self.passes.iter().map(rest).sum::<f64>() / freedom;
            bias += slope * slope - v / spread;
            variance += v;
        }
        // A bias that noise hides is at most about what the noise is.
        let noise = variance / spread;
        (if bias > noise { bias } else { noise }, variance)
    }
}

/// Draws a run whose bandwidths a selector chooses, in iterations of `per_iteration` paths one after the other. Returns the bandwidths.
pub fn accumulate_selected(
    prepared: &dyn Prepared,
    selector: &mut Selector,
    seed: u64,
    paths: u64,
    per_iteration: u64,
    film: &mut Film,
) -> Vec<f64> {
    let mut run = Run::of(prepared);
    let mut pass = Film::new(film.width, film.height, film.classes);
    let per_iteration = per_iteration.max(1);
    let mut bandwidths = Vec::new();
    for iteration in 0..paths.div_ceil(per_iteration) {
        let bandwidth = selector.bandwidth();
        let left = paths - iteration * per_iteration;
        pass.clear();
        run.iterate(
            seed,
            iteration as u32,
            left.min(per_iteration),
            bandwidth,
            &mut pass,
        );
        selector.observe(bandwidth, &pass);
        film.add(&pass);
        bandwidths.push(bandwidth);
    }
    bandwidths
}
