//! The two questions that are asked of a sample, and how the probability of a wrong answer is shared.
//!
//! With mean m, standard error s, R replicates and a truth T known to ± e (all t with R - 1 degrees of freedom):
//!
//! - *Different*: null hypothesis E m = T' for some T' in [T - e, T + e]. p = 2 P(T > (|m - T| - e) / s).
//! - *Equivalent* [Schuirmann 1987], two one-sided tests: null hypothesis |E m - T'| ≥ μ T' for margin μ, for some T' in the
//!   same interval. p is the larger of P(T > (m - (T + e)(1 - μ)) / s) and P(T > ((T - e)(1 + μ) - m) / s).
//!
//! Both are worst cases over where the truth can be, so the error probabilities hold whatever it is. P is the tail of
//! [`super::tails`], which allows for replicates that are skewed; [`super::evidence`] says how many contributions they need.

use nephroid_analytic::camera::Bounded;

use super::distributions::student_survival;
use super::evidence::{FEWEST_REPLICATES, Sample};

/// Probability that a suite of verdicts on correct integrators contains any false "different", by default.
pub const LEVEL: f64 = 1e-6;
/// Probability that a suite contains any false "equivalent".
pub const EQUIVALENCE_LEVEL: f64 = 1e-3;

/// The error probabilities of one check: its share of those of the whole suite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Of a false "different".
    pub different: f64,
    /// Of a false "equivalent".
    pub equivalent: f64,
}

impl Levels {
    /// Shares the error probabilities of a suite equally (Bonferroni: valid under any dependence) among its checks.
    pub fn shared(different: f64, equivalent: f64, checks: u64) -> Self {
        let checks = checks.max(1) as f64;
        Levels {
            different: different / checks,
            equivalent: equivalent / checks,
        }
    }
}

/// p-value of "different", two-sided. 1 inside the truth's bounds.
pub fn difference_p(sample: &Sample, truth: Bounded) -> f64 {
    let off = sample.mean - truth.value;
    let distance = off.abs() - truth.error;
    if distance <= 0.0 {
        return 1.0;
    }
    let p = sample
        .tail(off > 0.0)
        .survival(distance / sample.standard_error());
    (2.0 * p).min(1.0)
}

/// p-value of "equivalent" for a margin relative to the truth.
pub fn equivalence_p(sample: &Sample, truth: Bounded, margin: f64) -> f64 {
    let error = sample.standard_error();
    // The mean is above the lower end of the margin, and below the upper one.
    let above = sample.mean - (truth.value + truth.error) * (1.0 - margin);
    let below = (truth.value - truth.error) * (1.0 + margin) - sample.mean;
    let p = |distance: f64, upper: bool| sample.tail(upper).survival(distance / error);
    p(above, true).max(p(below, false))
}

/// p-value of "replicates are not independent of their predecessors", two-sided, from their correlation: √n times it is
/// about normal. Products have heavier tails than what is multiplied; a quarter of the degrees of freedom allows for
/// that.
pub fn dependence_p(correlation: f64, replicates: usize) -> f64 {
    if replicates < 4 * FEWEST_REPLICATES || !correlation.is_finite() {
        return 1.0;
    }
    let n = replicates as f64;
    (2.0 * student_survival(correlation.abs() * libm::sqrt(n), 0.25 * n)).min(1.0)
}
