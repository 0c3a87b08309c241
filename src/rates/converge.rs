//! How variance and bias of a running mean fall with the number n of iterations under a schedule.
//!
//! With aᵢ the bandwidth of iteration i, Nn paths and independent iterations, exactly
//!
//! ```text
//! variance of the mean = n⁻² Σ V(aᵢ)/N,   bias of the mean = n⁻¹ Σ (E(aᵢ) − E(0))
//! ```
//!
//! V and E come from the exact second moments and expectations, so the predicted slopes hold at small n as well
//! (`theory/consistency.md`, section 1). An estimator without bias has slope −1 and no bias. Running means at n = 1, 2, 4, … share their
//! samples; both fits allow for that (see `power_law` and `variance`).

use nephroid_analytic::bandwidth::{Bounded, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::InvalidParameter;

use super::bias::CONFIDENCE;
use super::classes::{Asked, Bandwidths, Skipped, Subject};
pub use super::events::Events;
use super::events::{count_tests, events};
use super::expected::sharp;
use super::law::{Law, bandwidths};
use super::outcome::{State, Test, state};
use super::power_law::{Design, Exponent};
use super::region::View;
use super::runs::{Along, along};
use super::variance::{Slope, slope_contrast, variance_slope};
use crate::integrators::Schedule;
use crate::judge::distributions::{student_quantile, student_survival};
use crate::judge::evidence::moments;
use crate::verify::replicates::Seeds;

/// The variance's slope is decided if its interval is not wider than this on either side.
pub const VARIANCE_HALF_WIDTH: f64 = 0.05;
/// The same for the slope of the squared bias.
pub const BIAS_HALF_WIDTH: f64 = 0.15;
/// Iterations unless asked otherwise.
pub const ITERATIONS: u32 = 256;
/// Replicates unless asked otherwise: a variance to 6 %.
pub const REPLICATES: u32 = 512;
/// A variance enters the fit if its relative standard error, kurtosis included, is at most this.
const ROUGHEST_VARIANCE: f64 = 0.3;
/// A bias enters the fit if it is known to this part of itself.
const KNOWN_BIAS: f64 = 0.05;

/// What to measure.
pub struct Request<'a> {
    /// What every study is asked.
    pub asked: Asked<'a>,
    /// The bandwidths that the integrator is given, iteration by iteration.
    pub schedule: &'a Schedule,
    /// The bandwidths of the prediction, if not those.
    pub predicted_schedule: Option<&'a Schedule>,
    /// Iterations: a power of two.
    pub iterations: u32,
    /// Paths of each; `None` for what takes some seconds.
    pub paths_per_iteration: Option<u64>,
    /// See [`VARIANCE_HALF_WIDTH`] and [`BIAS_HALF_WIDTH`].
    pub half_widths: [f64; 2],
}

/// The running mean of n iterations.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// n.
    pub iterations: u32,
    /// The bandwidth of iteration n.
    pub bandwidth: Option<f64>,
    /// Mean over the replicates [W m⁻² sr⁻¹].
    pub mean: f64,
    /// What it should be.
    pub expected: Bounded,
    /// Variance over the replicates, and the relative standard error that it should have.
    pub variance: f64,
    /// See `variance`.
    pub variance_error: Option<f64>,
    /// Whether the mean over the replicates has enough contributions to be normal: otherwise only their number is tested.
    pub is_normal: bool,
    /// What it should be, up to the constant of a law where there is no exact second moment.
    pub predicted_variance: Option<f64>,
    /// The mean minus the sharp truth, and half of its interval.
    pub bias: f64,
    /// See `bias`.
    pub half_interval: f64,
    /// What the bias should be.
    pub predicted_bias: f64,
    /// The squared bias without what noise adds to it.
    pub squared_bias: f64,
    /// Since the n before: events and what their number should be.
    pub events: Option<Events>,
    /// The median of the running means over the sharp truth.
    pub median: f64,
}

/// A class and what came of it.
#[derive(Clone, Debug)]
pub struct Study {
    /// The class.
    pub class: PathClass,
    /// The technique of the prediction; `None` for a class sampled without bias.
    pub technique: Option<Technique>,
    /// Where.
    pub view: View,
    /// The radiance at bandwidth zero.
    pub sharp: Bounded,
    /// Paths of an iteration.
    pub paths_per_iteration: u64,
    /// At n = 1, 2, 4, ….
    pub points: Vec<Point>,
    /// Of the variance in n, with the prediction.
    pub variance: Option<(Slope, f64)>,
    /// The exponent of the bias in n (half of that of the squared bias), with the prediction.
    pub bias: Option<(Exponent, f64)>,
    /// The tests.
    pub tests: Vec<Test>,
    /// What follows.
    pub state: State,
    /// What is too wide, or cannot be predicted.
    pub remarks: Vec<String>,
    /// Paths of all replicates.
    pub paths: u64,
    /// 1/(V·T) of the last running mean.
    pub efficiency: f64,
    /// Seconds of all threads.
    pub seconds: f64,
}

/// Paths of an iteration that take about as long with each technique.
const fn default_paths(technique: Option<Technique>) -> u64 {
    match technique {
        Some(Technique::Merge) | None => 512,
        Some(_) => 1024,
    }
}

/// Studies each class that the integrator samples.
///
/// # Errors
/// A region, a kernel, a technique or a bandwidth that does not fit; a kind without exact expectations.
pub fn study(request: &Request) -> Result<(Vec<Study>, Vec<Skipped>), InvalidParameter> {
    let iterations = u64::from(request.iterations);
    let is_positive = |v: f64| v > 0.0 && v.is_finite();
    if let Some((n, found)) = request.schedule.first_unfit(iterations, is_positive) {
        return Err(InvalidParameter {
            key: "bandwidth".to_owned(),
            found: format!("{found} at n = {n}"),
            allowed: "greater than 0 at every n".to_owned(),
        });
    }
    let schedule = bandwidths(request.schedule, request.iterations);
    let low = schedule.iter().copied().fold(f64::INFINITY, f64::min);
    let high = schedule.iter().copied().fold(0.0, f64::max);
    let ends = if low < high {
        vec![low, high]
    } else {
        vec![high]
    };
    let bandwidths = Bandwidths {
        named: &ends,
        extremes: &ends,
    };
    request
        .asked
        .each(&bandwidths, None, |subject| of_class(request, subject))
}

fn of_class(
    request: &Request,
    Subject {
        layer,
        class,
        technique,
        view,
    }: Subject,
) -> Result<Option<Study>, InvalidParameter> {
    let asked = &request.asked;
    let Some(sharp) = sharp(&view, class)? else {
        return Ok(None);
    };
    let paths = request
        .paths_per_iteration
        .unwrap_or(default_paths(technique));
    let law = Law::new(request, class, technique, &view, sharp, paths)?;
    if law.means.iter().all(|m| m.value <= 0.0) {
        return Ok(None);
    }
    let schedule = bandwidths(request.schedule, request.iterations);
    let seeds = Seeds::new(asked.seed, &asked.entry.name, asked.integrator.name());
    let rows = along(
        asked.integrator.prepare(&view.entry).as_ref(),
        &view,
        layer,
        &schedule,
        paths,
        seeds,
        asked.replicates,
    );
    let merges = technique == Some(Technique::Merge);
    let events = events(&law, &rows, paths, merges);
    let points = points(
        request,
        technique.is_some().then_some(&schedule),
        sharp,
        &law,
        &rows,
        &events,
    );
    let mut tests = Vec::new();
    let mut remarks = Vec::new();
    let mut is_resolved = true;

    // The variance.
    let usable: Vec<usize> = (0..points.len())
        .filter(|&i| {
            points[i]
                .variance_error
                .is_none_or(|e| e <= ROUGHEST_VARIANCE)
        })
        .filter(|&i| points[i].variance > 0.0)
        .collect();
    let n: Vec<f64> = points.iter().map(|p| f64::from(p.iterations)).collect();
    let select = |values: &[f64]| usable.iter().map(|&i| values[i]).collect::<Vec<f64>>();
    let mut variance = None;
    if technique.is_some() && law.variances.is_none() {
        remarks.push(
            if technique == Some(Technique::Symmetric) {
                "the variance depends on how the two sides share a path: not predicted"
            } else {
                "the variance of merging is predicted for regions that are small against the radius only"
            }
            .to_owned(),
        );
    } else if usable.len() >= 3 {
        let at = select(&n);
        let rows: Vec<Vec<f64>> = rows.iter().map(|r| select(&r.means)).collect();
        let slope = variance_slope(&at, &rows, 1.0 - CONFIDENCE);
        let predicted = match &law.variances {
            Some(v) => {
                let v = select(v);
                let terms = slope_contrast(&at).into_iter().zip(v);
                terms.map(|(a, v)| a * libm::log(v)).sum()
            }
            None => -1.0,
        };
        tests.push(Test {
            what: "slope of the variance is the predicted one".to_owned(),
            p: slope.p_value(predicted),
        });
        if !(slope.half_width() <= request.half_widths[0]) {
            is_resolved = false;
            remarks.push(format!(
                "the slope of the variance is known to ± {:.3} only: more replicates",
                slope.half_width()
            ));
        }
        variance = Some((slope, predicted));
    } else {
        is_resolved = false;
        remarks.push("too few contributions for the variance: more paths in an iteration, or more replicates".to_owned());
    }
    let left_out = points.len() - usable.len();
    if left_out > 0 && variance.is_some() {
        remarks.push(format!(
            "{left_out} of the variances rest on too few contributions and are left out"
        ));
    }

    // The bias.
    let mut bias = None;
    if technique.is_some() {
        let (exponent, predicted, p) = bias_exponent(&n, sharp, &law, &rows, paths);
        tests.extend(p.map(|p| Test {
            what: "slope of the bias is that of the exact expectations".to_owned(),
            p,
        }));
        if !(2.0 * exponent.half_width() <= request.half_widths[1]) {
            is_resolved = false;
            remarks.push("the slope of the squared bias is not known well enough: more paths in an iteration".to_owned());
        }
        bias = Some((exponent, predicted));
    }

    // Every mean, and the counts.
    let dof = f64::from(asked.replicates) - 1.0;
    for p in &points {
        let distance = (p.mean - p.expected.value).abs() - p.expected.error;
        let error = f64::sqrt(p.variance / f64::from(asked.replicates));
        // A mean of rare spikes is not normal enough for a t test; their number is tested instead.
        if p.is_normal {
            tests.push(Test {
                what: format!(
                    "mean of {} iterations is the exact expectation",
                    p.iterations
                ),
                p: if distance <= 0.0 {
                    1.0
                } else {
                    2.0 * student_survival(distance / error, dof)
                },
            });
        }
    }
    tests.extend(count_tests(request, &points, paths, merges));
    let last = points.last().map_or((0.0, 0.0), |p| (p.mean, p.variance));
    let seconds: f64 = rows.iter().map(|r| r.seconds).sum();
    Ok(Some(Study {
        class,
        technique,
        view,
        sharp,
        paths_per_iteration: paths,
        variance,
        bias,
        state: state(&tests, asked.level, is_resolved),
        tests,
        remarks,
        paths: paths * u64::from(request.iterations) * u64::from(asked.replicates),
        efficiency: last.0 * last.0 / (last.1 * seconds / f64::from(asked.replicates)),
        seconds,
        points,
    }))
}

/// The exponent of the bias in n, the predicted one, and the p-value of their difference.
fn bias_exponent(
    n: &[f64],
    sharp: Bounded,
    law: &Law,
    rows: &[Along],
    paths: u64,
) -> (Exponent, f64, Option<f64>) {
    let exact: Vec<f64> = law.means.iter().map(|m| m.value - sharp.value).collect();
    let errors: Vec<f64> = law.means.iter().map(|m| m.error + sharp.error).collect();
    let variances: Vec<f64> = match &law.variances {
        Some(v) => v.clone(),
        None => n.iter().map(|n| 1.0 / (n * paths as f64)).collect(),
    };
    let weights: Vec<f64> = variances
        .iter()
        .zip(exact.iter().zip(&errors))
        .enumerate()
        .map(|(k, (v, (b, e)))| {
            if *e <= KNOWN_BIAS * b.abs() && law.is_normal(k) {
                1.0 / v
            } else {
                0.0
            }
        })
        .collect();
    let design = Design::new(n, &weights);
    if weights.iter().filter(|w| **w > 0.0).count() < 2 {
        return (Exponent::UNKNOWN, f64::NAN, None);
    }
    let biases: Vec<Vec<f64>> = rows
        .iter()
        .map(|r| r.means.iter().map(|m| m - sharp.value).collect())
        .collect();
    let exponent = design.fit(&biases, 1.0 - CONFIDENCE);
    let p = design.p_value(&exact, &errors, &biases);
    (exponent, design.exponent_of(&exact), Some(p))
}

fn points(
    request: &Request,
    schedule: Option<&Vec<f64>>,
    sharp: Bounded,
    law: &Law,
    rows: &[Along],
    events: &Option<Vec<Events>>,
) -> Vec<Point> {
    let count = rows.len() as f64;
    let t = student_quantile(0.5 * (1.0 - CONFIDENCE), count - 1.0);
    (0..law.means.len())
        .map(|k| {
            let n = 1_u32 << k;
            let mut values: Vec<f64> = rows.iter().map(|r| r.means[k]).collect();
            let (mean, variance) = moments(&values);
            values.sort_by(f64::total_cmp);
            let bias = mean - sharp.value;
            Point {
                iterations: n,
                bandwidth: schedule.map(|s| s[n as usize - 1]),
                mean,
                expected: law.means[k],
                variance,
                variance_error: law.variance_errors.as_ref().map(|e| e[k]),
                is_normal: law.is_normal(k),
                predicted_variance: law.variances.as_ref().map(|v| v[k]),
                bias,
                half_interval: t * f64::sqrt(variance / count),
                predicted_bias: law.means[k].value - sharp.value,
                squared_bias: bias * bias - variance / count,
                events: events.as_ref().map(|e| e[k]),
                median: values[values.len() / 2] / sharp.value,
            }
        })
        .take_while(|p| p.iterations <= request.iterations)
        .collect()
}
