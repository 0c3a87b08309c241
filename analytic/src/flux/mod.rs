//! Exact pixels by conservation of flux, for any light that ends on the floor z = 0 seen directly.
//!
//! Light of one path class is a two-parameter family of rays (`theory/scenes.md`, 0.1): a ray carries flux and lands
//! somewhere. A pixel's radiance is the flux of the rays that land in it, times the film's area per floor area. In the
//! parameters that is the integral of a smooth function even where the irradiance has a fold, a cusp or a focus; what is
//! left to be exact about is the region of integration.

pub(crate) mod border;
mod cells;
pub(crate) mod chart;
pub mod direct;
mod folded;
mod keep;
mod lens;
pub(crate) mod poly;
mod regular;

use core::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use crate::camera::Bounded;
use crate::flux::cells::{Piece, Shape};
use crate::flux::folded::Slices;
use crate::flux::lens::Lens;
use crate::flux::regular::Edges;
use crate::scene::{Camera, Floor};

/// Number of margins of a ray.
pub const MARGINS: usize = 8;

/// Where a ray of a bundle lands, and what it carries there.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Floor point (x, y) [m].
    pub floor: [f64; 2],
    /// Flux that lands per unit of parameter area [W per unit of u0 u1], ≥ 0 (negative only in a bundle that stands for a
    /// shadow which is subtracted), specular weights included; smooth.
    pub flux: f64,
    /// The ray exists where every margin is ≥ 0; each is a smooth function of the parameters that changes sign where its
    /// condition does. Unused ones are 1. Where one is negative the others may be anything or NaN as well.
    pub margins: [f64; MARGINS],
}

/// Light of one path class as a two-parameter family of rays.
pub trait Bundle: Debug + Send + Sync {
    /// Rectangle of the parameters, [[low, high]; 2].
    fn domain(&self) -> [[f64; 2]; 2];
    /// The ray of a parameter pair inside the domain. Where a margin is negative the floor point and the flux may be
    /// anything finite or NaN.
    fn ray(&self, u: [f64; 2]) -> Ray;
    /// Product of the reflectances and transmittances on the way of a ray that exists; `None` where it is not known apart
    /// from the flux.
    fn weight(&self, _u: [f64; 2]) -> Option<f64> {
        None
    }
}

/// The image: one layer per path class, each the sum of several bundles (also shadows with negative flux).
#[derive(Clone, Debug)]
pub struct FluxImage {
    lens: Lens,
    layers: Arc<[Layer]>,
    edges: Edges,
    slices: Slices,
}

/// One path class.
struct Layer {
    pieces: Vec<Piece>,
    /// Pieces that each row touches.
    rows: Vec<Vec<u32>>,
    /// Mean radiance of the pixels that are reached.
    typical: f64,
}

impl FluxImage {
    /// Prepares the image of a validated camera and floor.
    pub fn new(camera: &Camera, floor: &Floor, layers: Vec<Vec<Arc<dyn Bundle>>>) -> Self {
        let lens = Lens::new(camera);
        let layers = layers
            .iter()
            .map(|bundles| Layer::new(&lens, floor, bundles))
            .collect();
        FluxImage {
            lens,
            layers,
            edges: Edges::default(),
            slices: Slices::default(),
        }
    }

    /// Row `j`, `[class][column]`: the mean radiance over the pixel [W m⁻² sr⁻¹] with its error estimate, to a relative
    /// tolerance; pixels that an edge cuts are exact relative to the typical radiance of the layer.
    ///
    /// **Accuracy**: the error is an estimate, not a proof: the difference of the last two orders of every edge and slice
    /// integral, what the interpolants leave out, rounding, and all that a piece can carry which was left out.
    pub fn row(&self, j: u32, tolerance: f64, row: &mut [Vec<Bounded>]) {
        for (layer, out) in self.layers.iter().zip(row) {
            out.fill(Bounded::default());
            let pieces = layer.rows.get(j as usize).into_iter().flatten();
            for piece in pieces.filter_map(|&k| layer.pieces.get(k as usize)) {
                self.piece(piece, i64::from(j), tolerance, layer.typical, out);
            }
        }
    }

    /// Adds what a piece gives to row `j`.
    fn piece(&self, piece: &Piece, j: i64, tolerance: f64, typical: f64, out: &mut [Bounded]) {
        let width = i64::from(self.lens.width);
        let columns = [piece.columns[0].max(0), piece.columns[1].min(width - 1)];
        let Some(cell) = &piece.cell else {
            // All of it is in one pixel, or can be anywhere in the range.
            for i in columns[0]..=columns[1] {
                if let Some(out) = out.get_mut(i as usize) {
                    out.value += piece.total;
                    out.error += piece.error;
                }
            }
            return;
        };
        let step = folded::WINDOW as i64;
        let mut first = columns[0];
        while first <= columns[1] {
            let window = [first, columns[1].min(first + step - 1)];
            let mut sums = [Bounded::default(); folded::WINDOW];
            let done = cell.shape == Shape::Regular
                && regular::row(
                    cell,
                    &self.lens,
                    &self.edges,
                    j,
                    window,
                    (tolerance, typical),
                    &mut sums,
                )
                .is_some();
            if !done {
                // A pixel can have many folded cells.
                let tolerance = (tolerance, 0.02 * tolerance * typical);
                folded::row(
                    cell,
                    &self.lens,
                    &self.slices,
                    j,
                    window,
                    tolerance,
                    &mut sums,
                );
            }
            for (i, sum) in (window[0]..=window[1]).zip(&sums) {
                if let Some(out) = out.get_mut(i as usize) {
                    out.value += sum.value;
                    out.error += sum.error + piece.error * f64::from(u8::from(sum.value != 0.0));
                }
            }
            first += step;
        }
    }
}

impl Debug for Layer {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Layer")
            .field("pieces", &self.pieces.len())
            .field("typical", &self.typical)
            .finish_non_exhaustive()
    }
}

impl Layer {
    fn new(lens: &Lens, floor: &Floor, bundles: &[Arc<dyn Bundle>]) -> Self {
        let mut pieces = Vec::new();
        for bundle in bundles {
            pieces.extend(cells::cut(bundle.as_ref(), lens, floor));
        }
        let mut rows = vec![Vec::new(); lens.height as usize];
        let mut reached = vec![false; lens.width as usize * lens.height as usize];
        let mut total = 0.0;
        for (k, piece) in pieces.iter().enumerate() {
            total += f64::abs(piece.total);
            for j in piece.rows[0].max(0)..=piece.rows[1].min(i64::from(lens.height) - 1) {
                rows[j as usize].push(k as u32);
                for i in piece.columns[0].max(0)..=piece.columns[1].min(i64::from(lens.width) - 1) {
                    reached[j as usize * lens.width as usize + i as usize] = true;
                }
            }
        }
        let count = reached.iter().filter(|r| **r).count();
        Layer {
            pieces,
            rows,
            typical: total / count.max(1) as f64,
        }
    }
}
