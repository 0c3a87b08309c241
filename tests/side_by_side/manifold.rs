//! Specular manifold sampling against closed forms, point by point, on every kind of surface; its variance where it is known.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid::integrators::{Settings, Sight, Technique, Treatment, by_name};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::{Entry, Kind};

use super::{Measured, REPLICATES, STANDARD_ERRORS, at_point, measure};

/// Floor points that the camera sees directly, far from folds compared with the patch that a point is, with the light of
/// one interaction that they get [W/m²].
fn points(entry: &Entry, wanted: usize) -> Vec<([f64; 2], usize, f64)> {
    let truth = FloorTruth::new(entry).unwrap();
    let sight = Sight::new(entry).unwrap();
    let classes = entry.kind.classes();
    let (width, height) = (
        f64::from(entry.camera.width),
        f64::from(entry.camera.height),
    );
    let mut found = Vec::new();
    // A golden-ratio walk over the film.
    for k in 1..400 {
        let part = |step: f64| (f64::from(k) * step).fract();
        let (u, v) = (part(0.754_877_666_246_693), part(0.569_840_290_998_053));
        let Some((point, false)) = sight.floor_point(u * width, v * height) else {
            continue;
        };
        let [x, y] = point;
        let single = |c: &PathClass| c.is_caustic() && c.light.len() == 1 && c.eye.is_empty();
        let Some(layer) = classes.iter().position(single) else {
            break;
        };
        let at = truth.at(x, y);
        let index = at.iter().position(|c| c.class == classes[layer]).unwrap();
        let near = truth
            .singularity(x, y, index)
            .is_some_and(|s| s.distance < 0.03);
        let irradiance = at[index].irradiance.value;
        if irradiance > 0.0 && irradiance.is_finite() && !near {
            found.push((point, layer, irradiance));
        }
        if found.len() == wanted {
            break;
        }
    }
    found
}

/// Every scene with a caustic by one interaction that is seen directly: at least one point each, three where there are as
/// many, of 32 × 1000 paths. Where a point has one solution that every walk finds there is no variance at all, and the figure
/// is exact but for the patch. About 40 figures. A bias of 1 to 5 % is caught, of 1e-4 where there is one solution: an
/// index on the wrong side, a curvature of the wrong sign, a solution beyond the border of the surface, a probability that
/// depends on the solution.
#[test]
fn manifold_sampling_has_the_closed_form_on_every_surface() {
    // A patch is 1e-3 degrees wide: 5e-5 m from 3 m, over which nothing here changes by more, folds being far.
    const PATCH: f64 = 3e-4;
    let (mut scenes, mut exact) = (0, 0);
    for name in [
        "mirror-wall",
        "cup",
        "corner",
        "cup-rim",
        "deep-cup",
        "pillar",
        "conic-wall",
        "glass-pillar",
        "underwater",
        "ripple-pool",
        "dome",
        "ball",
        "dish",
        "ellipsoid",
        "hyperboloid",
        "lens",
        "glass-ball",
    ] {
        let full = entry::load(name).unwrap();
        let sms = by_name("sms", &Settings::default()).unwrap();
        let found = points(&full, 3);
        assert!(!found.is_empty(), "{name}");
        scenes += 1;
        for (point, layer, irradiance) in found {
            let plan = sms.plan(&full);
            let treatment = plan[layer].treatment;
            assert_eq!(treatment, Treatment::Exact(Technique::ManifoldSampling));
            let entry = at_point(&full, point);
            let truth = irradiance * FloorTruth::new(&full).unwrap().albedo() / PI;
            let prepared = sms.prepare(&entry);
            let Measured { mean, error, .. } =
                measure(prepared.as_ref(), &entry, 0.0, REPLICATES, 1000);
            let (mean, error) = (mean[layer], error[layer]);
            assert!(error < 0.03 * truth, "{name} {point:?}: {error} of {truth}");
            // What is left is how the patch varies, over the root of the number of paths.
            exact += usize::from(error < 1e-5 * truth);
            assert!(
                (mean - truth).abs() < STANDARD_ERRORS * error + PATCH * truth,
                "{name} {point:?}: {mean} ± {error}, {truth}"
            );
        }
    }
    assert!(scenes == 17 && exact >= 3, "{exact} without variance");
}

/// At a point with two solutions of irradiance E₁, E₂ and probabilities p₁, p₂ a sample has the second moment
/// Σ E² (2 - p)/p. Only that the variance is finite and what replicates say of it agrees between runs is asserted where
/// probabilities are unknown; where one plane mirror is found by every walk it is zero.
#[test]
fn one_solution_that_every_walk_finds_has_no_variance() {
    let full = entry::load("underwater").unwrap();
    let sms = by_name("sms", &Settings::default()).unwrap();
    for (point, layer, _) in points(&full, 3) {
        let entry = at_point(&full, point);
        let prepared = sms.prepare(&entry);
        let measured = measure(prepared.as_ref(), &entry, 0.0, 8, 500);
        assert!(measured.error[layer] < 1e-6 * measured.mean[layer]);
    }
}

/// No clamp: all lengths times k divide the radiance of a lamp's light by k², to rounding, path by path.
#[test]
fn scaling_the_scene_scales_every_sample() {
    let full = entry::load("dome").unwrap();
    let Kind::ConcaveSphere(scene) = &full.kind else {
        panic!("a dome");
    };
    let k = 1024.0;
    let mut large = full.clone();
    let mut scaled = scene.clone();
    scaled.light.position = scaled.light.position.map(|v| v * k);
    scaled.floor.center = scaled.floor.center.map(|v| v * k);
    scaled.floor.half_width = scaled.floor.half_width.map(|v| v * k);
    scaled.cap.center = scaled.cap.center.map(|v| v * k);
    scaled.cap.radius *= k;
    large.kind = Kind::ConcaveSphere(scaled);
    large.camera.position = large.camera.position.map(|v| v * k);
    large.camera.look_at = large.camera.look_at.map(|v| v * k);
    let film = |entry: &Entry| {
        let sms = by_name("sms", &Settings::default()).unwrap();
        let mut film = nephroid::film::Film::new(128, 128, entry.kind.classes());
        sms.prepare(entry).iterate(7, 0, 20_000, 0.0, &mut film);
        film
    };
    let (small, large) = (film(&full), film(&large));
    // A power of two changes no digit.
    for (a, b) in small.layers.iter().zip(&large.layers) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b * k * k).abs() <= 1e-12 * a, "{a} {b}");
        }
    }
}
