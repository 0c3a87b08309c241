//! What is exactly known of running means under a schedule: their expectations, variances and how normal they are.

use nephroid_analytic::bandwidth::{Bounded, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::InvalidParameter;

use super::converge::Request;
use super::expected::{Expected, expected};
use super::region::View;
use crate::integrators::Schedule;

/// A mean over all replicates is taken as normal if it consists of at least so many contributions: its skewness is then below 0.023,
/// and a tail of 1e-7 wrong by less than a factor of two.
const FEWEST_CONTRIBUTIONS: f64 = 2000.0;

/// The bandwidths of the iterations.
pub(super) fn bandwidths(schedule: &Schedule, iterations: u32) -> Vec<f64> {
    (0..iterations).map(|i| schedule.bandwidth(i)).collect()
}

/// What is exactly known of the running means.
pub(super) struct Law {
    /// Per iteration; empty for a class without bias.
    pub(super) iterations: Vec<Expected>,
    /// At n = 1, 2, 4, ….
    pub(super) means: Vec<Bounded>,
    /// `None` if there is no exact second moment.
    pub(super) variances: Option<Vec<f64>>,
    /// Relative standard errors of the variances of so many replicates.
    pub(super) variance_errors: Option<Vec<f64>>,
    /// Contributions of which the mean over all replicates consists, in effect.
    pub(super) contributions: Option<Vec<f64>>,
}

impl Law {
    /// Whether the mean over all replicates at the k-th n is normal enough for a t test.
    pub(super) fn is_normal(&self, k: usize) -> bool {
        let is_enough = |c: &Vec<f64>| c[k] >= FEWEST_CONTRIBUTIONS;
        self.contributions.as_ref().is_none_or(is_enough)
    }

    pub(super) fn new(
        request: &Request,
        class: PathClass,
        technique: Option<Technique>,
        view: &View,
        sharp: Bounded,
        paths: u64,
    ) -> Result<Self, InvalidParameter> {
        let ns = || {
            (0..request.iterations)
                .map(|i| i + 1)
                .filter(|n| n.is_power_of_two())
        };
        let Some(technique) = technique else {
            return Ok(Law {
                iterations: Vec::new(),
                means: ns().map(|_| sharp).collect(),
                variances: None,
                variance_errors: None,
                contributions: None,
            });
        };
        let schedule = request.predicted_schedule.unwrap_or(request.schedule);
        let schedule = bandwidths(schedule, request.iterations);
        let kernel = request.asked.kernel_of(technique);
        let mut iterations = expected(view, class, technique, kernel, &schedule)?;
        if technique == Technique::Symmetric {
            // Known for one side alone.
            iterations.iter_mut().for_each(|e| e.hit = None);
        }
        let (mut means, mut variances, mut errors) = (Vec::new(), Vec::new(), Vec::new());
        let mut contributions = Vec::new();
        let (mut sum, mut squares, mut fourths) = (Bounded::default(), 0.0, 0.0);
        for (n, e) in (1_u32..).zip(&iterations) {
            let variance = e.variance() / paths as f64;
            sum.value += e.mean.value;
            sum.error += e.mean.error;
            squares += variance;
            // The fourth cumulant of rare equal samples is their variance squared over their number.
            fourths += variance * variance / (e.effective_hit() * paths as f64);
            if n.is_power_of_two() {
                let n = f64::from(n);
                means.push(Bounded {
                    value: sum.value / n,
                    error: sum.error / n,
                });
                variances.push(squares / (n * n));
                let kurtosis = fourths / (squares * squares);
                errors.push(f64::sqrt(
                    (2.0 + kurtosis) / f64::from(request.asked.replicates),
                ));
                contributions.push(f64::from(request.asked.replicates) / kurtosis);
            }
        }
        let is_known = match technique {
            Technique::Merge => view.is_close_up,
            // It depends on how the two sides share a path.
            Technique::Symmetric => false,
            _ => true,
        };
        Ok(Law {
            iterations,
            means,
            variances: is_known.then_some(variances),
            variance_errors: Some(errors),
            contributions: Some(contributions),
        })
    }
}
