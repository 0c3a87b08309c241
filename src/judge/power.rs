//! How many replicates decide, and what could have been seen.
//!
//! Under a bias b the t statistic is, for the 32 or more replicates that are asked for, a central t shifted by b/s. So
//! a test that rejects beyond t_c has power P(T > t_c - b/s), and a power of 1 - β needs b ≥ (t_c + t_β) s.

use nephroid_analytic::camera::Bounded;

use super::distributions::{student_quantile, student_survival};
use super::evidence::{FEWEST_REPLICATES, Sample};
use super::hypotheses::Levels;

/// Power of equivalence for an unbiased integrator that a run is planned for. Far above 0.9, because a suite is
/// undecided if one of its checks is.
pub const PLANNED_EQUIVALENCE: f64 = 0.9999;
/// Power of difference, for a bias of the margin, that a run is planned for.
pub const PLANNED_DIFFERENCE: f64 = 0.99;
/// The power that the minimum detectable bias refers to.
pub const DETECTION_POWER: f64 = 0.9;

/// The part of a margin that is left for the estimator when the truth is known to ± error: absolute, for a bias of zero
/// and for a bias of the margin alike.
pub fn usable_margin(truth: Bounded, margin: f64) -> f64 {
    margin * truth.value - truth.error * (2.0 + margin)
}

/// Number of standard errors that the margin must hold for the planned powers.
fn standard_errors_needed(levels: Levels, dof: f64) -> f64 {
    let difference = student_quantile(0.5 * levels.different, dof)
        + student_quantile(1.0 - PLANNED_DIFFERENCE, dof);
    // Both one-sided tests must reject, and fail on opposite sides.
    let equivalence = student_quantile(levels.equivalent, dof)
        + student_quantile(0.5 * (1.0 - PLANNED_EQUIVALENCE), dof);
    difference.max(equivalence)
}

/// Fewest replicates with which a check of the given variance per replicate is decided at the planned powers. `None` if
/// the truth is not known well enough for the margin, or the variance is not a number.
pub fn replicates_needed(
    variance: f64,
    truth: Bounded,
    margin: f64,
    levels: Levels,
) -> Option<u64> {
    let usable = usable_margin(truth, margin);
    if !(usable > 0.0) || !(variance.is_finite()) {
        return None;
    }
    let needed = |dof: f64| {
        let errors = standard_errors_needed(levels, dof) / usable;
        libm::ceil(errors * errors * variance)
    };
    // The quantiles fall with the replicates: iterate from below until nothing changes.
    let mut replicates = FEWEST_REPLICATES as f64;
    for _ in 0..50 {
        let next = needed(replicates - 1.0).max(FEWEST_REPLICATES as f64);
        if next <= replicates {
            break;
        }
        // Half-way in logarithm damps the overshoot of few degrees of freedom.
        replicates = next.min(libm::ceil(libm::sqrt(next * replicates)) + 1.0);
    }
    Some(replicates as u64)
}

/// What a sample could have decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// The smaller of two: the power of "different" for a bias of the margin, and of "equivalent" for no bias.
    pub power: f64,
    /// The relative bias that is called different with power 0.9.
    pub minimum_detectable_bias: f64,
}

/// Power of the tests on a sample.
pub fn of_sample(sample: &Sample, truth: Bounded, margin: f64, levels: Levels) -> Power {
    let (error, dof) = (sample.standard_error(), sample.dof());
    let usable = usable_margin(truth, margin) / error;
    let critical = student_quantile(0.5 * levels.different, dof);
    let difference = student_survival(critical - usable, dof);
    let one_side = student_survival(usable - student_quantile(levels.equivalent, dof), dof);
    let detectable = (critical + student_quantile(1.0 - DETECTION_POWER, dof)) * error;
    Power {
        power: difference.min((1.0 - 2.0 * one_side).max(0.0)),
        minimum_detectable_bias: (detectable + truth.error) / truth.value,
    }
}
