//! The minimal path tracer of examples/minimal_regularized_pt.rs against the oracle.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::{Entry, Kind};

use super::minimal_regularized_pt::{ALBEDO, INTENSITY, LIGHT, REFLECTANCE, Random, V, radiance};
use super::{REPLICATES, STANDARD_ERRORS};

/// Radiance that the floor point should leave with: direct light exactly, the caustic as technique `camera` has it at the
/// bandwidth.
fn expected(entry: &Entry, [x, y]: [f64; 2], alpha: f64) -> f64 {
    let direct = FloorTruth::new(entry).unwrap().at(x, y);
    let direct = direct.iter().find(|c| c.class == PathClass::LDE).unwrap();
    let estimator = Estimator {
        technique: Technique::Camera,
        kernel: Kernel::Cone,
        bandwidths: &[alpha],
        convention: Convention::Exact,
    };
    let caustic = EntryExpectation::new(entry, estimator, 1.0)
        .unwrap()
        .at(x, y, 1e-8);
    ALBEDO / PI * (direct.irradiance.value + caustic[0].mean.value)
}

#[test]
fn the_scene_of_the_minimal_path_tracer_is_the_catalogue_s() {
    let entry = entry::load("mirror-wall").unwrap();
    let Kind::PlanarMirror(scene) = &entry.kind else {
        panic!("a mirror");
    };
    assert_eq!(scene.light.position, [LIGHT.0, LIGHT.1, LIGHT.2]);
    assert_eq!(scene.light.intensity, INTENSITY);
    assert_eq!(scene.floor.albedo, ALBEDO);
    assert_eq!(scene.mirror.reflectance, REFLECTANCE);
    assert_eq!(scene.mirror.center, [0.0, 1.0, 0.625]);
    assert_eq!(
        (scene.mirror.half_width, scene.mirror.half_height),
        (0.75, 0.5)
    );
}

/// Floor points seen directly, and one of them in the mirror, at two bandwidths: means of 32 × 40 000 paths have errors of about 0.2 %, so
/// that a bias of 2 % in the sum (10 % in the caustic's part, which is a fifth) is caught: a cosine too many at the mirror,
/// a kernel normalised by π tan² α or with the whole angle for the half, and the light's image in the mirror, which would
/// add infinitely much. Four figures, each a false alarm with probability 7e-7.
#[test]
fn the_minimal_path_tracer_has_the_expectation_of_the_oracle() {
    let entry = entry::load("mirror-wall").unwrap();
    let mut caustic = 0.0;
    for (point, through_mirror, alpha) in [
        ([0.1, -0.4], false, 0.3),
        ([0.1, -0.4], true, 0.3),
        ([-0.6, 0.2], false, 0.3),
        ([0.1, -0.4], false, 0.15),
    ] {
        let [x, y] = point;
        let at = V(x, y, 0.0);
        // The image of the floor point is beyond the mirror.
        let (eye, aim) = if through_mirror {
            (V(x, 0.2, 0.8), V(x, 2.0 - y, 0.0))
        } else {
            (V(x, y, 1.0), at)
        };
        let truth = expected(&entry, point, alpha);
        let direct = FloorTruth::new(&entry).unwrap().at(x, y)[0]
            .irradiance
            .value;
        caustic += 1.0 - ALBEDO / PI * direct / truth;
        let means: Vec<f64> = (0..REPLICATES)
            .map(|replicate| {
                let mut random = Random(0x1234_5678_9abc_def1 + 0x1_0001 * replicate);
                let n = 40_000;
                let sum: f64 = (0..n)
                    .map(|_| radiance(eye, aim - eye, alpha, &mut random))
                    .sum();
                sum / f64::from(n)
            })
            .collect();
        let n = REPLICATES as f64;
        let mean = means.iter().sum::<f64>() / n;
        let spread: f64 = means.iter().map(|m| (m - mean) * (m - mean)).sum();
        let error = (spread / (n - 1.0) / n).sqrt();
        assert!(error < 0.005 * truth, "{error} of {truth}");
        assert!(
            (mean - truth).abs() < STANDARD_ERRORS * error,
            "{point:?} {alpha}: {mean} ± {error}, {truth}"
        );
    }
    assert!(caustic > 0.4, "the caustic is {caustic} of four");
}
