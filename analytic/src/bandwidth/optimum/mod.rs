//! Which bandwidth: of least error for a number of paths, for one run or for a schedule, at a point or over several; and the smallest
//! that misses nothing.
//!
//! Everything is computed from exact expectations and second moments, not from their law at small bandwidth, which only tells where to begin
//! and what holds below the smallest bandwidth that is worth an integral.

mod best;
mod curve;
mod extrapolated;
mod hits;
mod sums;

pub use best::{Best, fixed, of_schedule, progressive};
pub use curve::{Curve, Error};
pub use extrapolated::extrapolated;

use super::entry::{EntryExpectation, Estimator};
use super::law::{Law, Place, SmallBandwidth};
use super::{Bounded, Convention, Kernel, Moments, Technique};
use crate::class::PathClass;
use crate::entries::FloorTruth;
use crate::scene::{Entry, InvalidParameter};

/// An estimator on an entry, of which bandwidths are wanted.
#[derive(Clone, Debug)]
pub struct Study {
    entry: Entry,
    technique: Technique,
    kernel: Kernel,
    convention: Convention,
    beam_area: f64,
    laws: SmallBandwidth,
    truth: Option<FloorTruth>,
    /// Largest bandwidth that is considered.
    largest: f64,
}

/// Relative tolerance of the expectations.
const TOLERANCE: f64 = 1e-7;
/// Below this bandwidth, in radians or metres, or a tenth of the law's reach, the law is used.
const NARROW: f64 = 2e-3;

impl Study {
    /// Arguments as in [`EntryExpectation::new`]; bandwidths up to 1 rad, or up to twice the floor's half width.
    ///
    /// # Errors
    /// As there.
    pub fn new(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        convention: Convention,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        let laws = SmallBandwidth::new(entry, technique, kernel, convention, beam_area)?;
        let width = entry
            .kind
            .floor()
            .map_or(1.0, |f| f.half_width[0].max(f.half_width[1]));
        Ok(Study {
            entry: entry.clone(),
            technique,
            kernel,
            convention,
            beam_area,
            laws,
            truth: FloorTruth::new(entry),
            largest: if technique.bandwidth_is_angle() {
                1.0
            } else {
                2.0 * width
            },
        })
    }

    /// The classes.
    pub fn classes(&self) -> Vec<PathClass> {
        self.laws.classes()
    }

    /// The laws of all classes at a floor point.
    pub fn laws(&self, x: f64, y: f64) -> Vec<Option<Law>> {
        self.laws.at(x, y)
    }

    /// Exact moments of the class at a position of [`Self::classes`].
    ///
    /// # Errors
    /// A bandwidth out of range.
    pub fn moments(
        &self,
        class: usize,
        [x, y]: [f64; 2],
        bandwidth: f64,
        tolerance: f64,
    ) -> Result<Moments, InvalidParameter> {
        let estimator = Estimator {
            technique: self.technique,
            kernel: self.kernel,
            convention: self.convention,
            bandwidths: &[bandwidth],
        };
        let e = EntryExpectation::new(&self.entry, estimator, self.beam_area)?;
        Ok(e.at(x, y, tolerance)
            .get(class)
            .copied()
            .unwrap_or_default())
    }

    /// Bias and variance against the bandwidth; `None` where the truth is not finite (on a caustic), jumps (on an edge), or where there
    /// is no law.
    pub fn curve(&self, class: usize, x: [f64; 2]) -> Option<Curve> {
        let law = self.laws.at(x[0], x[1]).get(class).copied().flatten()?;
        self.curve_of(law, class, x)
    }

    /// The same, with a law that is known.
    pub fn curve_of(&self, law: Law, class: usize, x: [f64; 2]) -> Option<Curve> {
        let truth = self
            .truth
            .as_ref()?
            .at(x[0], x[1])
            .iter()
            .find(|t| t.class == law.class && t.is_finite())?
            .irradiance
            .value;
        let low = match law.place {
            Place::Smooth => NARROW.min(0.1 * law.reach),
            // Below its reach there is nothing.
            Place::Dark => 0.999 * law.reach.min(self.largest),
            _ => return None,
        };
        let low = low.max(super::SMALLEST_BANDWIDTH);
        Some(Curve::new(
            truth,
            law,
            [low, self.largest.max(1.001 * low)],
            |alpha| {
                let m = self.moments(class, x, alpha.min(self.largest), TOLERANCE);
                m.map_or([f64::NAN; 2], |m| [m.mean.value, m.second_moment.value])
            },
        ))
    }

    /// Probability that one sample is not zero; `None` for a kernel without an end and for light whose weights are not known.
    pub fn hit_probability(&self, class: usize, x: [f64; 2], bandwidth: f64) -> Option<Bounded> {
        let family = &self.laws.family;
        super::check(self.technique, self.kernel, &[bandwidth]).ok()?;
        hits::probability(family, family.classes.get(class)?, x, bandwidth, 1e-9)
    }

    /// The smallest bandwidth at which N paths miss with probability ε at most; `None` where the largest is not enough.
    pub fn preview(&self, class: usize, x: [f64; 2], paths: f64, epsilon: f64) -> Option<f64> {
        hits::preview(self.largest, paths, epsilon, |b| {
            Some(self.hit_probability(class, x, b)?.value)
        })
    }
}
