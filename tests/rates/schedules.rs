//! Six schedules run, and behave as they are classified: path tracing, regularized, in a close-up of what `mirror-wall` reflects.
//!
//! 128 iterations of 512 paths, 64 replicates (128 where few paths contribute). Running means, their variances, and the numbers of
//! contributions at n = 1, 2, 4, … are held to the exact finite sums by the study's own tests, which share a level of 1e-6 for a
//! schedule (6e-6 in all).
//! What they would catch is printed and bounded: half an interval of the bias, and the standard error of a variance.

use nephroid::integrators::Schedule;
use nephroid::rates::converge::{Point, Study};
use nephroid::rates::outcome::State;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::schedule::{Classification, Expression, Number, Request, Weights, classify};

use super::converge::converge_studies;
use super::integrator;

const ITERATIONS: u32 = 128;
const PATHS: u32 = 512;
const REPLICATES: u32 = 64;

/// Where the running mean stands at the last n, and at n = 8.
struct Course {
    study: Study,
    early: Point,
    late: Point,
}

impl Course {
    /// Measured variance at the last n over that of one iteration.
    fn growth(&self) -> f64 {
        self.late.variance / self.study.points[0].variance
    }

    fn exact_growth(&self) -> f64 {
        let exact = |p: &Point| p.predicted_variance.unwrap();
        exact(&self.late) / exact(&self.study.points[0])
    }

    /// Exact mean squared error.
    fn error(p: &Point) -> f64 {
        p.predicted_bias * p.predicted_bias + p.predicted_variance.unwrap()
    }

    /// Measured mean squared error.
    fn measured_error(p: &Point) -> f64 {
        p.squared_bias + p.variance
    }
}

/// Runs a schedule after it has been classified, and holds it to its sums.
fn course(text: &str, expected: Classification, replicates: u32) -> Course {
    let expression: Expression = text.parse().unwrap();
    let request = Request {
        dimension: Number::integer(2),
        bias_order: Number::integer(2),
        weights: Weights::Uniform,
        discarded: 0.0,
        chain_rate: None,
    };
    let report = classify(&expression, &request).unwrap();
    assert_eq!(report.classification, expected, "{text}");
    let schedule: Schedule = text.parse().unwrap();
    let sizes = [ITERATIONS, PATHS, replicates];
    let pt_reg = integrator("pt-reg");
    let study = converge_studies(pt_reg.as_ref(), &schedule, None, sizes, PathClass::LSDE);
    let (early, late) = (study.points[3], study.points[7]);
    let course = Course { study, early, late };
    println!(
        "{text}: variance × {:.3} (exact {:.3}, ± {:.3}), bias {:.4} (exact {:.4}, ± {:.4}), median {:.4}, p {:?}",
        course.growth(),
        course.exact_growth(),
        late.variance_error.unwrap_or(f64::NAN),
        late.bias / course.study.sharp.value,
        late.predicted_bias / course.study.sharp.value,
        late.half_interval / course.study.sharp.value,
        late.median,
        course.study.tests.iter().map(|t| t.p).reduce(f64::min),
    );
    for p in &course.study.points {
        println!(
            "  n {:>3} α {:.4} variance {:.3e} (exact {:.3e}) events {:?}",
            p.iterations,
            p.bandwidth.unwrap(),
            p.variance,
            p.predicted_variance.unwrap(),
            p.events
                .map(|e| (e.count, e.expected, e.empty, e.expected_empty))
        );
    }
    assert!(
        course.study.state != State::Different,
        "{text}: {:?}",
        course.study.tests
    );
    course
}

#[test]
fn consistent_schedules_run_down_in_bias_and_variance() {
    for text in ["0.4*n^(-1/4)", "0.4*n^(-1/6)", "ppm(0.4, 2/3)"] {
        let c = course(text, Classification::Consistent, REPLICATES);
        assert!(c.growth() < 0.2 && c.exact_growth() < 0.2, "{text}");
        assert!(
            c.late.predicted_bias.abs() < 0.7 * c.early.predicted_bias.abs(),
            "{text}"
        );
        assert!(
            Course::error(&c.late) < 0.3 * Course::error(&c.early)
                && Course::measured_error(&c.late) < 0.5 * Course::measured_error(&c.early),
            "{text}"
        );
    }
}

/// The plateau of the boundary λ = 1/d: half the variance of one iteration (`theory/consistency.md` section 3), here with
/// (1/n²) Σ k = (n + 1)/(2n) up to relative orders of α².
#[test]
fn on_the_boundary_the_variance_stays() {
    let c = course("0.4*n^(-1/2)", Classification::VariancePersists, REPLICATES);
    let n = f64::from(ITERATIONS);
    assert!(f64::abs(c.exact_growth() / ((n + 1.0) / (2.0 * n)) - 1.0) < 0.15);
    let off = f64::abs(c.growth() / c.exact_growth() - 1.0);
    let error = c.late.variance_error.unwrap();
    assert!(error < 0.35 && off < 6.0 * error, "{off} {error}");
}

/// Faster than that, contributions run out: nearly all replicates are below the mean that all of them have in the limit, while the
/// variance, carried by the few that are far above, grows.
#[test]
fn too_fast_a_schedule_starves() {
    let c = course(
        "0.4*n^(-3/4)",
        Classification::VariancePersists,
        2 * REPLICATES,
    );
    assert!(c.exact_growth() > 3.0, "{}", c.exact_growth());
    let last = c.late.events.unwrap();
    let first = c.study.points[0].events.unwrap();
    // Per iteration: the last n stands for 64 of them.
    let rate = |count: f64, iterations: f64| count / iterations;
    let starved = rate(last.count as f64, 64.0) / rate(first.count as f64, 1.0);
    assert!(starved < 0.01, "{starved}");
    // None at all has a probability of exp(−14).
    assert!(last.expected_empty > 10.0 && last.empty > 0, "{last:?}");
    assert!(c.late.median < 0.97, "{}", c.late.median);
}

/// A bandwidth with a floor: everything becomes precise, around the wrong value.
#[test]
fn too_slow_a_schedule_keeps_its_bias() {
    let c = course(
        "max(0.25, 0.4*n^(-1/6))",
        Classification::BiasPersists,
        REPLICATES,
    );
    assert!(c.growth() < 0.05);
    // Beyond doubt not the truth, and it hardly moves any more.
    assert!(f64::abs(c.late.bias) > 3.0 * c.late.half_interval);
    let before = c.study.points[6].predicted_bias;
    assert!(f64::abs(c.late.predicted_bias / before) > 0.9);
    assert!(f64::abs(c.late.predicted_bias) > 0.25 * f64::abs(c.study.points[0].predicted_bias));
}
