//! Chains of plane mirrors: one vertex mollified (d = 2) for 1 to 4 reflections, every vertex (d = 4) for two.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid::integrators::probes::{self, Technique as Probe};
use nephroid::integrators::{Integrator as _, Kernel, Mollified, PtReg, Settings};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::every_vertex::two_reflections;
use nephroid_analytic::bandwidth::{Convention, Kernel as TruthKernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind, PlanarChainsScene};

use super::{REPLICATES, STANDARD_ERRORS, at_point, measure};

const POINTS: [[f64; 2]; 2] = [[2.5, 0.75], [2.2, 0.4]];

fn corner() -> (Entry, PlanarChainsScene) {
    let entry = entry::load("corner").unwrap();
    let Kind::PlanarChains(scene) = entry.kind.clone() else {
        panic!("a wedge");
    };
    (entry, scene)
}

fn one_vertex(entry: &Entry, [x, y]: [f64; 2], alpha: f64) -> Vec<(PathClass, Moments)> {
    let estimator = Estimator {
        technique: Technique::Camera,
        kernel: TruthKernel::Cone,
        bandwidths: &[alpha],
        convention: Convention::Exact,
    };
    let expectation = EntryExpectation::new(entry, estimator, 1.0).unwrap();
    let moments = expectation.at(x, y, 1e-6);
    expectation.classes().into_iter().zip(moments).collect()
}

/// Two kernels, two points, angles from 0.3 to 0.6: means to 0.5 to 3 %, so that a bias of 6 to 20 % is caught at the
/// least, and 4 % at 0.6; second moments from 512 replicates to a fifth. Six figures, at 7e-7 and 1e-6.
#[test]
fn every_vertex_of_a_chain_of_two_has_its_exact_moments() {
    let (full, scene) = corner();
    let layer = full
        .kind
        .classes()
        .iter()
        .position(|c| c.light.len() == 2)
        .unwrap();
    for (point, kernel, truth_kernel, alpha, paths) in [
        (POINTS[0], Kernel::Cone, TruthKernel::Cone, 0.6, 4000),
        (POINTS[1], Kernel::Cone, TruthKernel::Cone, 0.45, 6000),
        (
            POINTS[0],
            Kernel::Epanechnikov,
            TruthKernel::Epanechnikov,
            0.6,
            6000,
        ),
        (POINTS[0], Kernel::Cone, TruthKernel::Cone, 0.3, 20_000),
    ] {
        let integrator = PtReg::new(Settings {
            kernel: Some(kernel),
            mollified: Mollified::Every,
            ..Settings::default()
        });
        let entry = at_point(&full, point);
        let prepared = integrator.prepare(&entry);
        let exact = two_reflections(&scene, point, truth_kernel, alpha).unwrap();
        let scale = scene.floor.albedo / PI;
        let truth = scale * exact.mean.value;
        assert!(exact.mean.error < 2e-3 * exact.mean.value, "{exact:?}");
        let replicates = 512;
        let measured = measure(prepared.as_ref(), &entry, alpha, replicates, paths);
        let (mean, error) = (measured.mean[layer], measured.error[layer]);
        let square = measured.second_moment[layer] / (scale * scale * exact.second_moment.value);
        println!(
            "{point:?} {kernel} {alpha}: {:+.2} % ± {:.2} %, second moment {square:.3}, bound {:.1e}",
            100.0 * (mean / truth - 1.0),
            100.0 * error / truth,
            exact.mean.error / exact.mean.value
        );
        assert!(error < 0.035 * truth);
        assert!((mean - truth).abs() < STANDARD_ERRORS * error + 2e-3 * truth);
        // The spread of 512 replicates: 6 % at least, more by what is left of the skewness of a replicate.
        assert!((square - 1.0).abs() < 0.5, "{square}");
    }
}

/// The margin of 1 % at 0.3, by 1.6e8 paths: minutes. `cargo test --test side_by_side -- --ignored`.
#[test]
#[ignore = "minutes"]
fn every_vertex_of_a_chain_of_two_is_equivalent_at_one_per_cent() {
    let (full, scene) = corner();
    let layer = full
        .kind
        .classes()
        .iter()
        .position(|c| c.light.len() == 2)
        .unwrap();
    for (alpha, paths) in [(0.3, 2_500_000), (0.45, 1_000_000), (0.6, 400_000)] {
        let integrator = PtReg::new(Settings {
            mollified: Mollified::Every,
            ..Settings::default()
        });
        let entry = at_point(&full, POINTS[0]);
        let prepared = integrator.prepare(&entry);
        let exact = two_reflections(&scene, POINTS[0], TruthKernel::Cone, alpha).unwrap();
        let truth = scene.floor.albedo / PI * exact.mean.value;
        let measured = measure(prepared.as_ref(), &entry, alpha, 2 * REPLICATES, paths);
        let (mean, error) = (measured.mean[layer], measured.error[layer]);
        println!(
            "{alpha}: {:+.3} % ± {:.3} %",
            100.0 * (mean / truth - 1.0),
            100.0 * error / truth
        );
        // Two one-sided tests inside 1 %, each at 1e-3 (t on 63 degrees of freedom).
        assert!((mean - truth).abs() + 3.2 * error < 0.01 * truth);
    }
}

/// One vertex mollified, aimed, for every number of reflections: two one-sided tests inside 1 % at 1e-3 each, and no bias at
/// 7e-7 (normal: a million samples).
#[test]
fn one_vertex_of_chains_of_one_to_four_is_equivalent_at_one_per_cent() {
    let (full, _) = corner();
    let alpha = 0.3;
    let estimator = probes::Estimator::new(&full, Probe::Camera, Kernel::Cone, None).unwrap();
    let aim = estimator.aim(alpha, POINTS[0]).unwrap();
    let sums = estimator
        .run_aimed(11, 0, 2_000_000, alpha, POINTS[0], &aim)
        .unwrap();
    let exact = one_vertex(&full, POINTS[0], alpha);
    let mut reflections = Vec::new();
    for (class, sums) in estimator.classes().iter().zip(&sums) {
        let (_, moments) = exact.iter().find(|(c, _)| c == class).unwrap();
        let (mean, error) = (sums.mean(), sums.standard_error());
        let apart = (mean - moments.mean.value).abs();
        println!(
            "{class}: {:+.3} % ± {:.3} %",
            100.0 * (mean / moments.mean.value - 1.0),
            100.0 * error / mean
        );
        assert!(apart < 5.0 * error + moments.mean.error, "{class}");
        assert!(apart + 3.1 * error < 0.01 * moments.mean.value, "{class}");
        reflections.push(class.light.len());
    }
    assert_eq!(reflections, [1, 2, 3, 4]);
}

/// Exponents of the exact second moments in α: -2 with one vertex mollified, whatever the number of reflections, -4 with
/// both of two; and the same limit of the means.
#[test]
fn variance_grows_as_the_bandwidth_to_the_minus_d() {
    let (full, scene) = corner();
    let both = |alpha| two_reflections(&scene, POINTS[0], TruthKernel::Cone, alpha).unwrap();
    let (wide, narrow) = (both(0.04), both(0.02));
    let slope = |a: f64, b: f64| libm::log2(a / b);
    let exponent = slope(wide.second_moment.value, narrow.second_moment.value);
    println!("both: {exponent:.4}");
    assert!((exponent + 4.0).abs() < 0.02, "{exponent}");
    let (one_wide, one_narrow) = (
        one_vertex(&full, POINTS[0], 0.04),
        one_vertex(&full, POINTS[0], 0.02),
    );
    for ((class, a), (_, b)) in one_wide.iter().zip(&one_narrow) {
        let exponent = slope(a.second_moment.value, b.second_moment.value);
        println!("{class}: {exponent:.4}");
        assert!((exponent + 2.0).abs() < 0.02, "{class} {exponent}");
        if class.light.len() == 2 {
            // The bias is of second order, with a larger coefficient where there are two kernels.
            let (both, one) = (narrow.mean.value, b.mean.value);
            assert!((both / one - 1.0).abs() < 3e-3, "{both} {one}");
        }
    }
    // On the way to there: what tests can measure.
    let at = [0.6, 0.42, 0.3].map(|alpha| both(alpha).second_moment.value);
    println!(
        "0.6 to 0.42: {:.3}, 0.42 to 0.3: {:.3}",
        libm::log(at[0] / at[1]) / libm::log(0.6 / 0.42),
        libm::log(at[1] / at[2]) / libm::log(0.42 / 0.3)
    );
}

#[test]
fn what_is_not_taken_is_refused() {
    let (_, mut scene) = corner();
    let refused = |scene: &PlanarChainsScene, kernel, alpha| {
        two_reflections(scene, POINTS[0], kernel, alpha)
            .unwrap_err()
            .key
    };
    assert_eq!(refused(&scene, TruthKernel::VonMisesFisher, 0.3), "kernel");
    assert_eq!(refused(&scene, TruthKernel::Cone, 0.8), "bandwidth");
    assert_eq!(refused(&scene, TruthKernel::Cone, f64::NAN), "bandwidth");
    // Outside the wedge it is dark.
    let dark = two_reflections(&scene, [1.0, 2.0], TruthKernel::Cone, 0.3).unwrap();
    assert_eq!(dark.mean.value, 0.0);
    scene.wedge.divisor = 2;
    assert_eq!(refused(&scene, TruthKernel::Cone, 0.3), "wedge.divisor");
}
