//! The order of the bias in the bandwidth: measured on replicates, and as the exact expectation has it.

use nephroid_analytic::bandwidth::{Bounded, Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::InvalidParameter;

use super::allocation::shares;
use super::classes::{Asked, Bandwidths, Skipped, Subject};
use super::expected::{Expected, aimed, expected, sharp};
use super::outcome::{State, Test, state};
use super::power_law::{Design, Exponent, scale};
use super::region::View;
use super::runs::{AtBandwidths, at_bandwidths};
use super::variance::{VarianceTest, variance_test};
use crate::judge::distributions::{student_quantile, student_survival};
use crate::judge::evidence::moments;
use crate::verify::replicates::Seeds;

/// Of all tests of a study together: the probability that a correct integrator is called different.
pub const LEVEL: f64 = 1e-6;
/// Intervals that are printed hold with this probability.
pub const CONFIDENCE: f64 = 0.95;
/// An exponent is decided if its interval is not wider than this on either side, on average.
pub const HALF_WIDTH: f64 = 0.15;
/// The mean over all replicates is taken as normal from so many contributions on: its skewness is then below 0.023, and a tail of 1e-7
/// wrong by less than a factor of two.
pub const FEWEST_CONTRIBUTIONS: u64 = 2000;
/// Replicates unless asked otherwise.
pub const REPLICATES: u32 = 64;

/// What to measure.
pub struct Request<'a> {
    /// What every study is asked.
    pub asked: Asked<'a>,
    /// Angles [rad] or radii [m], at least two.
    pub bandwidths: &'a [f64],
    /// Paths of one class in all; `None` for what takes some seconds.
    pub paths: Option<u64>,
    /// See [`HALF_WIDTH`].
    pub half_width: f64,
}

/// One bandwidth.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// The bandwidth.
    pub bandwidth: f64,
    /// Paths in all replicates.
    pub paths: u64,
    /// Mean over the replicates [W m⁻² sr⁻¹], and its standard error.
    pub mean: f64,
    /// See `mean`.
    pub standard_error: f64,
    /// Half of the interval of the mean and of the bias.
    pub half_interval: f64,
    /// What the mean should be.
    pub expected: Bounded,
    /// The mean minus the sharp truth.
    pub bias: f64,
    /// What the bias should be.
    pub predicted_bias: f64,
    /// The squared bias without what noise adds to it: it may be negative.
    pub squared_bias: f64,
    /// Whether there are enough contributions for the mean to be normal: otherwise it is shown, and not used.
    pub is_used: bool,
    /// The variance of a replicate against the exact one.
    pub variance: Option<VarianceTest>,
    /// 1/(V·T): V the relative variance of the mean, T the seconds of all threads that it took.
    pub efficiency: f64,
}

/// A class and what came of it.
#[derive(Clone, Debug)]
pub struct Study {
    /// The class.
    pub class: PathClass,
    /// The technique of the prediction.
    pub technique: Technique,
    /// Its kernel.
    pub kernel: Kernel,
    /// Where.
    pub view: View,
    /// The radiance at bandwidth zero.
    pub sharp: Bounded,
    /// In the order of the bandwidths.
    pub points: Vec<Point>,
    /// A finer prediction for a picture: (bandwidth, bias).
    pub curve: Vec<(f64, f64)>,
    /// The order of the bias.
    pub exponent: Exponent,
    /// That of the exact expectation at the same bandwidths with the same weights.
    pub predicted: f64,
    /// Measured bias over predicted bias, and half of its interval.
    pub scale: [f64; 2],
    /// The smallest deviation of the order that would have been found with probability 0.9.
    pub detectable: f64,
    /// The tests.
    pub tests: Vec<Test>,
    /// What follows.
    pub state: State,
    /// Paths that would make the interval narrow enough.
    pub paths_needed: Option<f64>,
    /// Paths of all replicates.
    pub paths: u64,
    /// Seconds of all threads.
    pub seconds: f64,
}

/// Paths that take about as long with each technique: some seconds of two cores.
const fn default_paths(technique: Technique) -> u64 {
    match technique {
        Technique::Merge => 40_000_000,
        _ => 200_000_000,
    }
}

/// Studies each class that is regularized.
///
/// # Errors
/// A region, a kernel, a technique or a bandwidth that does not fit; a kind without exact expectations.
pub fn study(request: &Request) -> Result<(Vec<Study>, Vec<Skipped>), InvalidParameter> {
    let bandwidths = Bandwidths {
        named: request.bandwidths,
        extremes: request.bandwidths,
    };
    let without_bias = Some("sampled without bias: there is no order to measure");
    request.asked.each(&bandwidths, without_bias, |subject| {
        match subject.technique {
            Some(technique) => of_class(request, technique, subject),
            None => Ok(None),
        }
    })
}

/// Exact values of a region at the bandwidths.
struct Truth {
    sharp: Bounded,
    expected: Vec<Expected>,
}

impl Truth {
    fn bias(&self) -> Vec<f64> {
        self.expected
            .iter()
            .map(|e| e.mean.value - self.sharp.value)
            .collect()
    }

    fn errors(&self) -> Vec<f64> {
        self.expected
            .iter()
            .map(|e| e.mean.error + self.sharp.error)
            .collect()
    }
}

fn of_class(
    request: &Request,
    technique: Technique,
    Subject {
        layer, class, view, ..
    }: Subject,
) -> Result<Option<Study>, InvalidParameter> {
    let asked = &request.asked;
    let kernel = asked.kernel_of(technique);
    let Some(sharp) = sharp(&view, class)? else {
        return Ok(None);
    };
    let prepared = asked.integrator.prepare(&view.entry);
    let truth = Truth {
        sharp,
        expected: aimed(
            expected(&view, class, technique, kernel, request.bandwidths)?,
            prepared.as_ref(),
            request.bandwidths,
        ),
    };
    if truth.expected.iter().all(|e| e.mean.value <= 0.0) {
        return Ok(None);
    }
    let replicates = asked.replicates;
    let total = request.paths.unwrap_or(default_paths(technique));
    let deviations = truth.expected.iter().map(|e| e.variance().max(0.0).sqrt());
    let noise: Vec<f64> = deviations
        .zip(truth.bias())
        .map(|(s, b)| s / b.abs())
        .collect();
    let paths: Vec<u64> = shares(request.bandwidths, &noise)
        .iter()
        .map(|s| ((total as f64 * s / f64::from(replicates)) as u64).max(1))
        .collect();
    let seeds = Seeds::new(asked.seed, &asked.entry.name, asked.integrator.name());
    let rows = at_bandwidths(
        prepared.as_ref(),
        &view,
        layer,
        request.bandwidths,
        &paths,
        seeds,
        replicates,
    );
    let low = request
        .bandwidths
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let high = request.bandwidths.iter().copied().fold(0.0, f64::max);
    let curve_at: Vec<f64> = (0..=12)
        .map(|k| low * libm::pow(high / low, f64::from(k) / 12.0))
        .map(|b| b.clamp(low, high))
        .collect();
    let curve = if view.is_close_up {
        let exact = expected(&view, class, technique, kernel, &curve_at)?;
        let bias = exact.iter().map(|e| e.mean.value - sharp.value);
        curve_at.iter().copied().zip(bias).collect()
    } else {
        let mut points: Vec<_> = request
            .bandwidths
            .iter()
            .copied()
            .zip(truth.bias())
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let mut study = judge(
        request, class, technique, kernel, view, &truth, &paths, &rows,
    );
    study.curve = curve;
    Ok(Some(study))
}

/// Judges replicates.
fn judge(
    request: &Request,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    view: View,
    truth: &Truth,
    paths: &[u64],
    rows: &[AtBandwidths],
) -> Study {
    let count = rows.len() as f64;
    let t = student_quantile(0.5 * (1.0 - CONFIDENCE), count - 1.0);
    let (predicted_bias, errors) = (truth.bias(), truth.errors());
    let points: Vec<Point> = (0..paths.len())
        .map(|i| {
            let values: Vec<f64> = rows.iter().map(|r| r.means[i]).collect();
            let (mean, variance) = moments(&values);
            let standard_error = f64::sqrt(variance / count);
            let bias = mean - truth.sharp.value;
            let exact = &truth.expected[i];
            // Samples that are all alike have the kurtosis of their number; others more, which the sample shows.
            // A photon map serves all pixels of a region at once: its photons are counted by what they do to the spread.
            let is_exact = technique != Technique::Merge || view.is_close_up;
            let kurtosis = if is_exact {
                1.0 / (exact.effective_hit() * paths[i] as f64)
            } else {
                variance / (mean * mean)
            };
            let is_used = kurtosis * FEWEST_CONTRIBUTIONS as f64 <= count;
            let is_known = is_used && is_exact;
            let seconds: f64 = rows.iter().map(|r| r.seconds[i]).sum();
            Point {
                bandwidth: request.bandwidths[i],
                paths: paths[i] * rows.len() as u64,
                mean,
                standard_error,
                half_interval: t * standard_error,
                expected: exact.mean,
                bias,
                predicted_bias: predicted_bias[i],
                squared_bias: bias * bias - variance / count,
                is_used,
                variance: is_known
                    .then(|| variance_test(&values, exact.variance() / paths[i] as f64, kurtosis)),
                efficiency: mean * mean / (standard_error * standard_error * seconds),
            }
        })
        .collect();
    let weights: Vec<f64> = truth
        .expected
        .iter()
        .zip(paths.iter().zip(&points))
        .map(|(e, (&n, p))| {
            if p.is_used {
                n as f64 * count / e.variance().max(f64::MIN_POSITIVE)
            } else {
                0.0
            }
        })
        .collect();
    let is_fitted = points.iter().filter(|p| p.is_used).count() >= 2;
    let design = Design::new(request.bandwidths, &weights);
    let biases: Vec<Vec<f64>> = rows
        .iter()
        .map(|r| r.means.iter().map(|m| m - truth.sharp.value).collect())
        .collect();
    let exponent = if is_fitted {
        design.fit(&biases, 1.0 - CONFIDENCE)
    } else {
        Exponent::UNKNOWN
    };
    let predicted = if is_fitted {
        design.exponent_of(&predicted_bias)
    } else {
        f64::NAN
    };
    let (factor, factor_error) = scale(&weights, &predicted_bias, &biases);

    let mut tests = Vec::new();
    for p in points.iter().filter(|p| p.is_used) {
        let distance = (p.mean - p.expected.value).abs() - p.expected.error;
        let at = p.bandwidth;
        tests.push(Test {
            what: format!("mean at {at} is the exact expectation"),
            p: if distance <= 0.0 {
                1.0
            } else {
                2.0 * student_survival(distance / p.standard_error, count - 1.0)
            },
        });
        if let Some(v) = &p.variance {
            tests.push(Test {
                what: format!("variance at {at} is that of the exact second moment"),
                p: v.p,
            });
        }
    }
    if is_fitted {
        tests.push(Test {
            what: "order of the bias is that of the exact expectation".to_owned(),
            p: design.p_value(&predicted_bias, &errors, &biases),
        });
        // What the truth is not known to, relative to the bias.
        let known_to = errors
            .iter()
            .zip(&predicted_bias)
            .map(|(e, b)| e / b.abs())
            .fold(0.0, f64::max);
        tests.push(Test {
            what: "size of the bias is that of the exact expectation".to_owned(),
            p: {
                let distance = (factor - 1.0).abs() - known_to;
                if distance <= 0.0 {
                    1.0
                } else {
                    2.0 * student_survival(distance / factor_error, count - 1.0)
                }
            },
        });
    }
    let half_width = exponent.half_width();
    let is_resolved = half_width <= request.half_width;
    let share = request.asked.level / tests.len().max(1) as f64;
    let quantiles = student_quantile(0.5 * share, count - 1.0) + student_quantile(0.1, count - 1.0);
    // Of the design, not of the data: with the exact bias for c.
    let a = design.contrast(predicted);
    let used = a.iter().zip(&weights).filter(|(_, w)| **w > 0.0);
    let noise = used.map(|(a, w)| a * a / w).sum::<f64>();
    let ideal_error = noise.sqrt() / design.sensitivity(predicted, &predicted_bias);
    let total: u64 = points.iter().map(|p| p.paths).sum();
    let wanted = request.half_width / t;
    Study {
        class,
        technique,
        kernel,
        view,
        sharp: truth.sharp,
        curve: Vec::new(),
        exponent,
        predicted,
        scale: [factor, t * factor_error],
        detectable: quantiles * ideal_error,
        state: state(&tests, request.asked.level, is_resolved && is_fitted),
        tests,
        paths_needed: (!is_resolved)
            .then(|| total as f64 * (ideal_error / wanted) * (ideal_error / wanted) * 1.2),
        paths: total,
        points,
        seconds: rows.iter().flat_map(|r| &r.seconds).sum(),
    }
}
