//! Films at finite bandwidth, of any kind with an expectation at points: pixels, regions and whole images.
//!
//! Through a film point the eye sees a floor point x, directly or by a specular surface (weight W), and
//!
//! ```text
//! mean of a region    = ∫ W ρ/π E_α(x(u, v)) du dv                over what sees the floor, per area of the region
//! second moment       = ∫ (W ρ/π)² m₂(x(u, v)) du dv              one camera sample uniform in it, one estimator sample
//! ```
//!
//! The mollified E is continuous, and smooth but for kinks where an edge of the kernel touches one of the surface, so a picture is
//! covered with tiles of which each is a polynomial ([`super::tile`]), and those are quartered that are worst.

use core::f64::consts::PI;
use core::ops::Range;

use super::chart::link::Receiver;
use super::entry::{EntryExpectation, Estimator};
use super::eye::Eye;
use super::light::{Class, unknown};
use super::quadrature::Pair;
use super::tile::{Sampled, Tile, refine, total};
use super::{Kernel, Moments, Technique};
use crate::class::PathClass;
use crate::scene::{Entry, InvalidParameter};

/// Tiles along each axis of a region to begin with: a lit patch that has none of their samples, four along an axis each, is missed, and
/// nothing tells.
const GRID: u32 = 8;
/// Tiles sampled at most for one region.
const MOST: usize = 20_000;
/// Part of the tolerance that the samples of a tile are known to.
const SAMPLES: f64 = 0.1;
/// Second moments are wanted for the sizes of samples: to so many times the tolerance.
const SLACK: f64 = 10.0;

/// One class as it is seen.
#[derive(Clone, Debug)]
struct Layer {
    class: PathClass,
    /// Position of the class as it ends on the floor.
    position: usize,
    eye: Eye,
}

/// The expectation of the image of an entry by a regularized estimator.
#[derive(Clone, Debug)]
pub struct FrameExpectation {
    expectation: EntryExpectation,
    size: (u32, u32),
    /// ρ/π.
    brightness: f64,
    layers: Vec<Layer>,
}

impl FrameExpectation {
    /// Prepares an estimator for an entry; see [`EntryExpectation::new`].
    ///
    /// # Errors
    /// What [`EntryExpectation::new`] finds; a kind of which the eye sees the floor in a way that is not known here.
    pub fn new(
        entry: &Entry,
        estimator: Estimator<'_>,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        let expectation = EntryExpectation::new(entry, estimator, beam_area)?;
        let technique = estimator.technique;
        let floor = entry.kind.floor();
        let floor = floor.ok_or_else(|| unknown(&entry.kind, technique))?;
        let ends = expectation.classes();
        let mut layers = Vec::new();
        for &class in entry.kind.classes() {
            let same = |c: &PathClass| c.light == class.light && c.diffuse == class.diffuse;
            let Some(position) = ends.iter().position(same) else {
                continue;
            };
            layers.push(Layer {
                class,
                position,
                eye: Eye::new(entry, floor, class, technique)?,
            });
        }
        Ok(FrameExpectation {
            expectation,
            size: (entry.camera.width, entry.camera.height),
            brightness: floor.albedo / PI,
            layers,
        })
    }

    /// The regularized classes, in the order of the entry's.
    pub fn classes(&self) -> Vec<PathClass> {
        self.layers.iter().map(|l| l.class).collect()
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The light of a class.
    pub(super) fn light(&self, class: usize) -> &Class {
        self.expectation.light(self.layers[class].position)
    }

    pub(super) fn receiver(&self) -> Receiver {
        self.expectation.receiver()
    }

    pub(super) fn estimator(&self) -> (Technique, Kernel, &[f64]) {
        self.expectation.estimator()
    }

    pub(super) fn technique(&self) -> Technique {
        self.estimator().0
    }

    /// ρ/π.
    pub(super) fn brightness(&self) -> f64 {
        self.brightness
    }

    pub(super) fn eye(&self, class: usize) -> &Eye {
        &self.layers[class].eye
    }

    /// Mean and second moment of the radiance [W m⁻² sr⁻¹] of a class on a tile, each sample to `tolerance × max(|value|, floor)`;
    /// an infinite floor asks for nothing.
    pub fn sample(&self, class: usize, tile: Tile, tolerance: f64, floor: [f64; 2]) -> Sampled {
        let eye = &self.layers[class].eye;
        let sees = |u: f64, v: f64| eye.sees(u, v);
        Sampled::new(tile, sees, |u, v| {
            self.radiance(class, u, v, tolerance, floor)
        })
    }

    /// Moments of the radiance [W m⁻² sr⁻¹] of a class summed over the pixels of a rectangle, to `tolerance × max(|value|, floor)` where
    /// `floor` are such sums, or nothing; second moments to ten times that.
    ///
    /// **Accuracy**: as stated in the error bounds, which are estimates.
    pub fn region(
        &self,
        class: usize,
        columns: Range<u32>,
        rows: Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
    ) -> Moments {
        total(&self.cover(class, columns, rows, tolerance, floor))
    }

    /// Moments of the radiance [W m⁻² sr⁻¹] of a class for each pixel of a rectangle, row by row, to a `tolerance` of all of
    /// them together, and of `floor` per pixel; what each is known to is in its bound.
    ///
    /// **Accuracy**: as stated in the error bounds, which are estimates.
    pub fn pixels(
        &self,
        class: usize,
        columns: Range<u32>,
        rows: Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
    ) -> Vec<Moments> {
        let (width, left, top) = (columns.len(), columns.start, rows.start);
        let mut out = vec![Moments::default(); width * rows.len()];
        let count = out.len() as f64;
        for s in self.cover(class, columns, rows, tolerance, floor.map(|f| f * count)) {
            let parts = s.pixels.len() as f64;
            for (k, value) in s.pixels.iter().enumerate() {
                let (i, j) = (k as u32 % s.count[0], k as u32 / s.count[0]);
                let at = (s.first[1] + j - top) as usize * width + (s.first[0] + i - left) as usize;
                if let Some(m) = out.get_mut(at) {
                    m.mean.value += value[0];
                    m.mean.error += s.uneven[0] / parts;
                    m.second_moment.value += value[1];
                    m.second_moment.error += s.uneven[1] / parts;
                }
            }
        }
        out
    }

    fn cover(
        &self,
        class: usize,
        columns: Range<u32>,
        rows: Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
    ) -> Vec<Sampled> {
        let low = [f64::from(columns.start), f64::from(rows.start)];
        let high = [f64::from(columns.end), f64::from(rows.end)];
        let area = (high[0] - low[0]) * (high[1] - low[1]);
        if !(area > 0.0) {
            return Vec::new();
        }
        // A point may be as wrong as all of them on average.
        let typical = floor.map(|f| f / area);
        let goal = |sum: [f64; 2]| {
            let slack = [1.0, SLACK];
            [0, 1].map(|k| slack[k] * tolerance * f64::max(sum[k], floor[k]))
        };
        refine(grid(low, high), MOST, goal, |tiles| {
            let one = |t: &Tile| self.sample(class, *t, SAMPLES * tolerance, typical);
            tiles.iter().map(one).collect()
        })
    }

    /// Mean and second moment of the radiance that a film point shows, or would show beyond an edge.
    fn radiance(&self, class: usize, u: f64, v: f64, tolerance: f64, floor: [f64; 2]) -> Pair {
        let layer = &self.layers[class];
        let (x, weight) = layer.eye.look(u, v);
        let scale = weight * self.brightness;
        let scales = [scale, scale * scale];
        if !(x[0].is_finite() && x[1].is_finite() && scale > 0.0) {
            return Pair {
                value: [f64::NAN; 2],
                error: [0.0; 2],
            };
        }
        let floor = [0, 1].map(|k| floor[k] / scales[k]);
        let m = self
            .expectation
            .of_class(layer.position, x, tolerance, floor);
        let m = [m.mean, m.second_moment];
        Pair {
            value: [0, 1].map(|k| scales[k] * m[k].value),
            error: [0, 1].map(|k| scales[k] * m[k].error),
        }
    }
}

/// The first tiles of a region, cut between pixels where there are enough.
fn grid(low: [f64; 2], high: [f64; 2]) -> Vec<Tile> {
    let cut = |k: usize, i: u32| {
        let size = high[k] - low[k];
        let at = low[k] + size * f64::from(i) / f64::from(GRID);
        if size >= f64::from(GRID) {
            libm::floor(at)
        } else {
            at
        }
    };
    let tile = |n: u32| {
        let at = [n % GRID, n / GRID];
        Tile {
            low: [cut(0, at[0]), cut(1, at[1])],
            high: [cut(0, at[0] + 1), cut(1, at[1] + 1)],
        }
    };
    (0..GRID * GRID).map(tile).collect()
}
