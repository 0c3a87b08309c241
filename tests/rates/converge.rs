//! Slopes along schedules, right and wrong.

use libm::{log, pow};
use nephroid::integrators::{Integrator, Schedule};
use nephroid::rates::classes::Asked;
use nephroid::rates::converge;
use nephroid::rates::outcome::State;
use nephroid::rates::power_law::Design;
use nephroid::rates::variance::slope_contrast;
use nephroid_analytic::class::PathClass;

use super::{Change, Changed, LEVEL, integrator, mirror_wall};

pub fn converge_studies(
    integrator: &dyn Integrator,
    schedule: &Schedule,
    predicted: Option<&Schedule>,
    [iterations, paths, replicates]: [u32; 3],
    class: PathClass,
) -> converge::Study {
    let entry = mirror_wall();
    let request = converge::Request {
        asked: Asked {
            entry: &entry,
            integrator,
            kernel: None,
            technique: None,
            class: Some(class),
            region: None,
            replicates,
            seed: 12,
            level: LEVEL,
        },
        schedule,
        predicted_schedule: predicted,
        iterations,
        paths_per_iteration: Some(u64::from(paths)),
        half_widths: [0.08, 3.0],
    };
    let (mut studies, skipped) = converge::study(&request).unwrap();
    assert!(skipped.is_empty() && studies.len() == 1, "{skipped:?}");
    studies.remove(0)
}

fn power_schedule(first: f64, lambda: f64, iterations: u32) -> Schedule {
    let at = |i: u32| first * pow(f64::from(i), -lambda);
    Schedule::List((1..=iterations).map(at).collect())
}

#[test]
fn variance_and_bias_slopes_along_a_schedule() {
    let sizes = [64, 1024, 160];
    let schedule = Schedule::Progressive {
        first: 0.4,
        reduction: 2.0 / 3.0,
    };
    let run = |integrator: &dyn Integrator| {
        converge_studies(integrator, &schedule, None, sizes, PathClass::LSDE)
    };
    let healthy = run(integrator("pt-reg").as_ref());
    let (slope, predicted) = healthy.variance.unwrap();
    println!(
        "variance {slope:?}, predicted {predicted}, bias {:?}",
        healthy.bias
    );
    assert_eq!(
        healthy.state,
        State::Consistent,
        "{:?} {:?}",
        healthy.tests,
        healthy.remarks
    );
    // `theory/consistency.md` section 5 has the sums for V ~ α⁻², bias ~ α²; the exact ones differ by relative orders of α². The
    // asymptotic −2/3 and −1/3 would be off by more.
    let a = 2.0 / 3.0;
    let ratio = |n: f64, p: f64, q: f64| libm::exp(libm::lgamma(n + p) - libm::lgamma(n + q));
    let n: Vec<f64> = (0..7).map(|k| f64::from(1 << k)).collect();
    let law: Vec<f64> = n
        .iter()
        .map(|&n| (ratio(n, 2.0, a) - 1.0 / libm::tgamma(a)) / (n * n))
        .collect();
    let contrast = slope_contrast(&n);
    let of_law: f64 = contrast.iter().zip(&law).map(|(c, v)| c * log(*v)).sum();
    assert!((predicted - of_law).abs() < 0.02, "{predicted} {of_law}");
    assert!((of_law + 2.0 / 3.0).abs() > 0.05);
    let weights: Vec<f64> = law.iter().map(|v| 1.0 / v).collect();
    let bias: Vec<f64> = n
        .iter()
        .map(|&n| (ratio(n, 1.0 + a, 1.0) / libm::tgamma(1.0 + a) - 1.0) / (n * a))
        .collect();
    let of_law = Design::new(&n, &weights).exponent_of(&bias);
    let predicted = healthy.bias.unwrap().1;
    assert!(
        (predicted / of_law - 1.0).abs() < 0.08,
        "{predicted} {of_law}"
    );
    // r in place of r² in the recursion: consistent as well, with other rates.
    let halved = Changed(integrator("pt-reg"), Change::HalfTheExponent(0.4));
    assert_eq!(run(&halved).state, State::Different);
    // The same random numbers in every iteration: every mean is right, and the variance stays.
    let repeated = Changed(integrator("pt-reg"), Change::SameNumbers);
    assert_eq!(run(&repeated).state, State::Different);
}

#[test]
fn an_estimator_without_bias_has_slope_minus_one() {
    let schedule = Schedule::Fixed(0.2);
    let sizes = [32, 2048, 128];
    for (name, class) in [("lt", PathClass::LSDE), ("pt", PathClass::LDE)] {
        let study = converge_studies(integrator(name).as_ref(), &schedule, None, sizes, class);
        let (slope, predicted) = study.variance.unwrap();
        assert_eq!(predicted, -1.0);
        assert!(
            slope.p_value(-1.0) > LEVEL && slope.half_width() < 0.15,
            "{slope:?}"
        );
        assert!(study.state != State::Different && study.bias.is_none());
    }
}

/// Merging at a point: the variance of a photon map is that of its photons. λ = 0.6 > 1/2: the variance grows, most replicates
/// see nothing any more, and the numbers of photons are those of the exact probabilities.
#[test]
fn a_schedule_beyond_the_window_starves() {
    let sizes = [128, 256, 128];
    let schedule = power_schedule(0.3, 0.6, 128);
    let healthy = converge_studies(
        integrator("ppm").as_ref(),
        &schedule,
        None,
        sizes,
        PathClass::LSDE,
    );
    assert!(healthy.state != State::Different, "{:?}", healthy.tests);
    let (first, last) = (healthy.points[0], healthy.points[7]);
    // The prediction itself: n^0.2/2.2 by facts.md, up to the finite sum.
    let growth = last.predicted_variance.unwrap() / first.predicted_variance.unwrap();
    assert!(growth > 1.0, "{growth}");
    let events = last.events.unwrap();
    println!("growth {growth:.3}, {events:?}, median {}", last.median);
    assert!(events.expected_empty > 0.3 * 128.0 && last.median < 0.9);
    // A bandwidth with a floor: every expectation stays within its error, the counts do not.
    let floored = Changed(integrator("ppm"), Change::NeverBelow(0.06));
    let study = converge_studies(&floored, &schedule, None, sizes, PathClass::LSDE);
    assert_eq!(study.state, State::Different);
    let count_tests = study.tests.iter().filter(|t| t.what.contains("not zero"));
    assert!(count_tests.clone().any(|t| t.p < 1e-9), "{:?}", study.tests);
}
