//! Regions, and variances against exact second moments.

use nephroid::integrators::Integrator;
use nephroid::rates::expected::{expected, sharp};
use nephroid::rates::region::{View, interior};
use nephroid::rates::runs::at_bandwidths;
use nephroid::rates::variance::variance_test;
use nephroid::verify::replicates::Seeds;
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;

use super::{BANDWIDTHS, Change, Changed, LEVEL, integrator, mirror_wall};

/// The variance of replicate means is (m₂ − mean²)/paths. 4096 replicates: a variance wrong by 15 % is found with probability 0.9 (χ² with
/// the kurtosis of the number of contributions); a healthy one is rejected with probability below 1e-6 each.
#[test]
fn second_moments_of_regularized_path_tracing() {
    let mut entry = mirror_wall();
    (entry.camera.width, entry.camera.height) = (16, 16);
    let bandwidth = 0.3;
    let (technique, kernel) = (Technique::Camera, Kernel::Cone);
    let whole = View::whole(&entry, "");
    let part = View::pixels(&entry, [4, 6, 12, 12]).unwrap();
    let close = interior(
        &entry,
        PathClass::LSDE,
        technique,
        kernel,
        &[0.1, bandwidth],
    );
    let close = close.unwrap().unwrap();
    for view in [whole, part, close] {
        let exact = expected(&view, PathClass::LSDE, technique, kernel, &[bandwidth]).unwrap()[0];
        let paths = 512;
        let layer = entry
            .kind
            .classes()
            .iter()
            .position(|&c| c == PathClass::LSDE)
            .unwrap();
        let values = |integrator: &dyn Integrator| -> Vec<f64> {
            let prepared = integrator.prepare(&view.entry);
            let seeds = Seeds::new(21, "mirror-wall", "pt-reg");
            at_bandwidths(
                prepared.as_ref(),
                &view,
                layer,
                &[bandwidth],
                &[paths],
                seeds,
                4096,
            )
            .iter()
            .map(|r| r.means[0])
            .collect()
        };
        let variance = exact.variance() / paths as f64;
        let kurtosis = 1.0 / (exact.effective_hit() * paths as f64);
        let healthy = variance_test(&values(integrator("pt-reg").as_ref()), variance, kurtosis);
        println!("{}: {healthy:?}", view.name);
        assert!(healthy.p > LEVEL, "{}: {healthy:?}", view.name);
        assert!(exact.second_moment.error < 1e-2 * variance * paths as f64);
        let half = Changed(integrator("pt-reg"), Change::HalfThePaths);
        let twice = variance_test(&values(&half), variance, kurtosis);
        assert!(twice.p < LEVEL, "{}: {twice:?}", view.name);
    }
}

/// Interior regions: the sharp truth of the pixels is the closed form at points, every bandwidth's expectation has the sign of the
/// largest one's, and merging keeps off the circle of radius √(8/3) about (0.25, 2), where its α² coefficient is zero.
#[test]
fn regions_are_interior_and_their_bias_has_one_sign() {
    let entry = mirror_wall();
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        for class in [PathClass::LSDE, PathClass::LSDSE] {
            let view = interior(&entry, class, technique, kernel, &BANDWIDTHS)
                .unwrap()
                .unwrap();
            let truth = sharp(&view, class).unwrap().unwrap();
            let biases: Vec<f64> = expected(&view, class, technique, kernel, &BANDWIDTHS)
                .unwrap()
                .iter()
                .map(|e| e.mean.value - truth.value)
                .collect();
            assert!(biases.iter().all(|b| b * biases[0] > 0.0), "{biases:?}");
            let film =
                FilmExpectation::new(&view.entry, technique, kernel, &[BANDWIDTHS[0]]).unwrap();
            for (u, v) in [(0.1, 0.1), (7.9, 0.1), (4.0, 4.0), (0.1, 7.9), (7.9, 7.9)] {
                let point = film.at(class, u, v, 1e-6).unwrap();
                assert!(point.is_interior, "{}", view.name);
                assert!((point.sharp / truth.value - 1.0).abs() < 0.2);
                // ∇²E/E = −6/D² + 15 h²/D⁴, and the bias is r²/8 times it, to r⁴.
                let [x, y, _] = point.floor;
                let h2 = (x - 0.25) * (x - 0.25) + (y - 2.0) * (y - 2.0);
                let d2 = h2 + 4.0;
                let laplacian = 15.0 * h2 / (d2 * d2) - 6.0 / d2;
                let relative = point.moments.mean.value / point.sharp - 1.0;
                if technique == Technique::Merge {
                    let predicted = 0.02 * laplacian;
                    assert!(
                        (relative / predicted - 1.0).abs() < 0.15,
                        "{relative} {predicted}"
                    );
                    assert!((h2 - 8.0 / 3.0).abs() > 0.3, "{h2}");
                }
            }
        }
    }
}
