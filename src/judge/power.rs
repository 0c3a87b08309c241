//! How many replicates decide, and what could have been seen.
//!
//! Under a bias of δ standard errors the statistic is a non-central t. With ν degrees of freedom and the critical value t
//! [Johnson & Welch 1940, after Jennett & Welch]
//!
//! > P(T > t) ≈ Φ((δ - t (1 - 1/(4ν))) / √(1 + t²/(2ν))),
//!
//! to within 0.01 for the 32 or more replicates that are asked for.

use nephroid_analytic::camera::Bounded;

use super::distributions::normal_survival;
use super::evidence::Sample;
use super::hypotheses::Levels;
use super::tails::Tail;

/// Power of equivalence for an unbiased integrator at the planned look. A check that misses it gets twice the sample at
/// the next look.
pub const PLANNED_EQUIVALENCE: f64 = 0.9;
/// Power of difference, for a bias of the margin, at the planned look.
pub const PLANNED_DIFFERENCE: f64 = 0.9;
/// Fewest replicates that a run is planned for: with fewer, their skewness is known too badly for the levels of a suite.
pub const FEWEST_PLANNED: u64 = 256;
/// The power that the minimum detectable bias refers to.
pub const DETECTION_POWER: f64 = 0.9;

/// The part of a margin that is left for the estimator when the truth is known to ± error: absolute, for a bias of zero
/// and for a bias of the margin alike.
pub fn usable_margin(truth: Bounded, margin: f64) -> f64 {
    margin * truth.value - truth.error * (2.0 + margin)
}

/// z with P(Z > z) = (1 - [`PLANNED_EQUIVALENCE`]) / 2: both one-sided tests must reject, and fail on opposite sides.
const Z_EQUIVALENCE: f64 = 1.644_853_627;
/// z with P(Z > z) = 1 - [`DETECTION_POWER`], and that of [`PLANNED_DIFFERENCE`].
const Z_DETECTION: f64 = 1.281_551_566;

/// Centre and scale of the approximation in the module's head. A critical value that is never reached stays infinite.
fn centre_and_scale(critical: f64, dof: f64) -> (f64, f64) {
    if critical.is_infinite() {
        return (critical, 1.0);
    }
    let centre = critical * (1.0 - 0.25 / dof);
    (centre, libm::sqrt(1.0 + 0.5 * critical * critical / dof))
}

/// Power of a one-sided test under a bias of so many standard errors.
fn one_sided_power(bias: f64, critical: f64, dof: f64) -> f64 {
    let (centre, scale) = centre_and_scale(critical, dof);
    normal_survival((centre - bias) / scale)
}

/// The bias, in standard errors, at which the power is that of the quantile.
fn bias_for(quantile: f64, critical: f64, dof: f64) -> f64 {
    let (centre, scale) = centre_and_scale(critical, dof);
    centre + quantile * scale
}

/// Number of standard errors that the margin must hold for the planned powers.
fn standard_errors_needed(levels: Levels, replicates: f64) -> f64 {
    // Replicates that are no more skewed than what the tails allow for.
    let tail = Tail::new(replicates as usize, 0.0, false);
    let difference = tail.critical(0.5 * levels.different);
    let equivalence = tail.one_sided().critical(levels.equivalent);
    let dof = tail.dof();
    bias_for(Z_DETECTION, difference, dof).max(bias_for(Z_EQUIVALENCE, equivalence, dof))
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
    // What is needed falls, slowly, with the replicates that there are: so the fixed point is between any number and what
    // that number asks for, and the bracket shrinks fast.
    let asked = |n: f64| {
        let errors = standard_errors_needed(levels, n) / usable;
        libm::ceil(errors * errors * variance).max(FEWEST_PLANNED as f64)
    };
    let mut high = asked(FEWEST_PLANNED as f64);
    let mut low = asked(high);
    for _ in 0..8 {
        if high - low <= 1.0 {
            break;
        }
        high = high.min(asked(low));
        low = low.max(asked(high));
    }
    while high > low {
        let middle = libm::floor(0.5 * (low + high));
        if asked(middle) <= middle {
            high = middle;
        } else {
            low = middle + 1.0;
        }
    }
    (high <= 1e18).then_some(high as u64)
}

/// What a sample could have decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power {
    /// The smaller of two: the power of "different" for a bias of the margin, and of "equivalent" for no bias. A verdict
    /// tells that of the whole run: of going on to the last look that its budget allows.
    pub power: f64,
    /// The relative bias that is called different with power 0.9.
    pub minimum_detectable_bias: f64,
}

/// Power of the tests on a sample.
pub fn of_sample(sample: &Sample, truth: Bounded, margin: f64, levels: Levels) -> Power {
    let error = sample.standard_error();
    let usable = usable_margin(truth, margin) / error;
    let tails = [sample.tail(true), sample.tail(false)];
    let dof = tails[0].dof();
    let worse = |f: &dyn Fn(Tail) -> f64| f(tails[0]).max(f(tails[1]));
    let different = worse(&|t| t.critical(0.5 * levels.different));
    let equivalent = worse(&|t| t.one_sided().critical(levels.equivalent));
    let difference = one_sided_power(usable, different, dof);
    let equivalence = one_sided_power(usable, equivalent, dof);
    let detectable = bias_for(Z_DETECTION, different, dof) * error;
    Power {
        power: difference.min((2.0 * equivalence - 1.0).max(0.0)),
        minimum_detectable_bias: (detectable + truth.error) / truth.value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quantiles_are_those_of_the_powers() {
        for (z, p) in [
            (Z_DETECTION, 1.0 - PLANNED_DIFFERENCE),
            (Z_EQUIVALENCE, 0.5 * (1.0 - PLANNED_EQUIVALENCE)),
            (Z_DETECTION, 1.0 - DETECTION_POWER),
        ] {
            assert!((normal_survival(z) / p - 1.0).abs() < 1e-8);
        }
    }

    /// What is planned is what is found, and one replicate less would not do.
    #[test]
    fn the_plan_is_the_smallest_that_has_the_power() {
        let levels = Levels::shared(1e-6, 1e-3, 20);
        let truth = Bounded {
            value: 2.0,
            error: 1e-4,
        };
        for deviation in [0.05, 0.2, 1.0] {
            let n = replicates_needed(deviation * deviation, truth, 0.02, levels).unwrap();
            let enough = |n: f64| {
                standard_errors_needed(levels, n) * deviation / libm::sqrt(n)
                    <= usable_margin(truth, 0.02)
            };
            assert!(enough(n as f64), "{deviation}: {n}");
            assert!(
                n == FEWEST_PLANNED || !enough(n as f64 - 1.0),
                "{deviation}: {n}"
            );
        }
        assert_eq!(replicates_needed(1.0, truth, 1e-5, levels), None);
        assert_eq!(replicates_needed(f64::NAN, truth, 0.02, levels), None);
    }
}
