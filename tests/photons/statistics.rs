//! Progressive photon mapping with statistics of each pixel: what is exact about it.

use libm::tgamma;
use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::pixel_statistics::PixelProgressive;
use nephroid::integrators::{Learner, Settings};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::{REPLICATES, Replicates, close_up};

const POINT: [f64; 2] = [0.3, 0.12];
const RADIUS: f64 = 0.5;
const PATHS: u64 = 1 << 12;

fn scene() -> Entry {
    close_up(&entry::load("mirror-wall").unwrap(), POINT, 1.0, 1)
}

/// The mean over radii of the exact expectation of merging, as a radiance.
fn expected(scene: &Entry, radii: &[f64]) -> f64 {
    let estimator = Estimator {
        technique: Technique::Merge,
        kernel: Kernel::Disc,
        convention: Convention::Exact,
        bandwidths: radii,
    };
    let e = EntryExpectation::new(scene, estimator, 1.0).unwrap();
    let albedo = scene.kind.floor().unwrap().albedo;
    albedo / core::f64::consts::PI * e.at(POINT[0], POINT[1], 1e-6)[0].mean.value
}

/// The estimates after n passes, and r²/r₁² averaged over replicates.
fn estimates(scene: &Entry, a: f64, passes: u32) -> (Replicates, f64) {
    let settings = Settings::default();
    let prepared = PixelProgressive::with_reduction(scene, &settings, a).unwrap();
    let (mut found, mut ratio) = (vec![], 0.0);
    for seed in 0..REPLICATES {
        let mut run = prepared.run();
        let mut film = Film::new(1, 1, scene.kind.classes());
        for pass in 0..passes {
            run.iterate(7000 + seed, pass, PATHS, RADIUS, &mut film);
        }
        let layer = film.layer_of(PathClass::LSDE).unwrap();
        found.push(film.layers[layer][0] / film.paths as f64);
        let r = run.pixels()[0].radius / RADIUS;
        ratio += r * r / REPLICATES as f64;
    }
    (Replicates(found), ratio)
}

/// With a = 1 nothing is reduced: energy and expectation are those of photon mapping at the first radius.
#[test]
fn without_reduction_it_is_photon_mapping() {
    let scene = scene();
    let (found, ratio) = estimates(&scene, 1.0, 8);
    assert_eq!(ratio, 1.0);
    found.check(
        "pixel statistics, a = 1",
        expected(&scene, &[RADIUS]),
        0.0,
        0.1,
    );
}

/// r²ₙ = r₁² Γ(n + a)/(Γ(a) n!) where photons are uniform; here they nearly are, and a pass meets a hundred times its camera paths. The
/// estimate is then the mean over passes of merging at those radii, up to what the rescaling of τ costs: 1 % is allowed for it.
#[test]
fn radii_shrink_by_the_recursion_and_the_error_with_them() {
    let scene = scene();
    let a = 2.0 / 3.0;
    let r2 = |n: f64| tgamma(n + a) / (tgamma(a) * tgamma(n + 1.0));
    for passes in [1_u32, 8, 64] {
        let (found, ratio) = estimates(&scene, a, passes);
        let expected_ratio = r2(f64::from(passes));
        assert!(
            (ratio / expected_ratio - 1.0).abs() < 0.05,
            "{passes}: r² {ratio}, {expected_ratio}"
        );
        let radii: Vec<f64> = (0..passes)
            .map(|n| RADIUS * r2(f64::from(n)).sqrt())
            .collect();
        let mean = expected(&scene, &radii);
        let what = format!("pixel statistics after {passes}");
        found.check(&what, mean, 0.01 * mean, 0.2);
    }
}
