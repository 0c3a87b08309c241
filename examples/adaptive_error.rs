//! Mean squared errors of progressive photon mapping against the least that is possible.
//!
//! At floor points of three scenes, off the caustics: `appm` against the exact best single radius for its number of photons
//! (`nephroid bandwidth` finds it from exact expectations), and `ppm` with a = 2/3 against its own prediction, the exact bias and variance summed over its
//! radii. A pixel of 2 mm stands for the point. The errors are those of so many replicates: their relative standard error is √(2/m).
//!
//! `cargo run --profile test --example adaptive_error [REPLICATES]`

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::appm::{Appm, photon_flux};
use nephroid::integrators::{Learner as _, Settings, by_name};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::optimum::{Study, fixed};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Camera, Entry, Kind};
use rayon::prelude::*;

/// Scene, point, height of the camera over it [m], first radius [m].
const POINTS: [(&str, [f64; 2], f64, f64); 5] = [
    ("mirror-wall", [0.3, 0.12], 1.0, 0.9),
    ("mirror-wall", [-0.2, -0.3], 1.0, 0.9),
    ("cup", [0.96, 0.136], 0.3, 0.25),
    ("cup", [0.3, 0.1], 0.3, 0.3),
    ("dome", [-1.2, -0.41], 0.3, 0.3),
];
/// Passes of `appm`, and iterations of `ppm` with as many photons each as a map has.
const PASSES: u32 = 192;

fn close_up(entry: &Entry, [x, y]: [f64; 2], height: f64) -> Entry {
    let mut entry = entry.clone();
    entry.camera = Camera {
        position: [x, y, height],
        look_at: [x, y, 0.0],
        up: [0.0, 1.0, 0.0],
        field_of_view_degrees: (2.0 * libm::atan(1e-3 / height)).to_degrees(),
        width: 1,
        height: 1,
    };
    entry
}

/// Cross-section of the beam that photons of parallel light are drawn from; of no meaning for a point light.
fn beam_area(entry: &Entry) -> f64 {
    match (&entry.kind, photon_flux(entry)) {
        (Kind::CylinderCup(cup), Some(flux)) => flux / cup.light.irradiance,
        _ => 1.0,
    }
}

fn mean_squared_error(estimates: &[f64], truth: f64) -> f64 {
    estimates
        .iter()
        .map(|e| (e - truth) * (e - truth))
        .sum::<f64>()
        / estimates.len() as f64
}

fn main() {
    let replicates: u64 = std::env::args()
        .nth(1)
        .and_then(|a| a.parse().ok())
        .unwrap_or(64);
    println!(
        "{replicates} replicates: errors of a figure {:.0} %",
        100.0 * (2.0 / replicates as f64).sqrt()
    );
    for (name, x, height, first) in POINTS {
        let Ok(whole) = entry::load(name) else {
            continue;
        };
        let area = beam_area(&whole);
        let scene = close_up(&whole, x, height);
        let study = Study::new(
            &scene,
            Technique::Merge,
            Kernel::Disc,
            Convention::Exact,
            area,
        );
        let Some((study, place)) = study.ok().and_then(|s| {
            let place = s.classes().iter().position(|c| *c == PathClass::LSDE)?;
            Some((s, place))
        }) else {
            println!("{name}: no expectation of merging");
            continue;
        };
        let Some(curve) = study.curve(place, x) else {
            println!("{name} {x:?}: on a caustic");
            continue;
        };
        let albedo = scene.kind.floor().map_or(0.0, |f| f.albedo);
        let per_radiance = core::f64::consts::PI / albedo;
        let truth = nephroid_analytic::entries::FloorTruth::new(&scene)
            .map(|t| t.at(x[0], x[1]))
            .and_then(|t| t.iter().find(|t| t.class == PathClass::LSDE).copied())
            .map_or(f64::NAN, |t| t.irradiance.value);
        let layer = scene
            .kind
            .classes()
            .iter()
            .position(|c| *c == PathClass::LSDE);
        let layer = layer.unwrap_or(0);
        let film = || Film::new(1, 1, scene.kind.classes());
        let value = |film: &Film| per_radiance * film.layers[layer][0] / film.paths as f64;

        // Adaptive.
        let Some(per_map) = Appm::new(Settings::default())
            .run(&scene)
            .map(|run| run.photons_per_map(first))
        else {
            continue;
        };
        let photons = per_map * u64::from(PASSES);
        let runs: Vec<(f64, f64)> = (0..replicates)
            .into_par_iter()
            .filter_map(|seed| {
                let mut run = Appm::new(Settings::default()).run(&scene)?;
                let mut film = film();
                for pass in 0..PASSES {
                    run.iterate(100 + seed, pass, per_map, first, &mut film);
                }
                Some((value(&film), run.radius(0, first)))
            })
            .collect();
        let estimates: Vec<f64> = runs.iter().map(|r| r.0).collect();
        let radius = runs.iter().map(|r| r.1).sum::<f64>() / runs.len() as f64;
        let Some(best) = fixed(&[&curve], photons as f64) else {
            continue;
        };
        let adaptive = mean_squared_error(&estimates, truth) / (best.rmse * best.rmse);

        // Progressive, from the radius whose progressive average has the least error.
        let Ok(ppm) = by_name("ppm", &Settings::default()) else {
            continue;
        };
        let start = 1.3 * best.bandwidth;
        let schedule = ppm.schedule(start);
        let radii: Vec<f64> = (0..PASSES).map(|i| schedule.bandwidth(i)).collect();
        let estimator = Estimator {
            technique: Technique::Merge,
            kernel: Kernel::Disc,
            convention: Convention::Exact,
            bandwidths: &radii,
        };
        let Ok(exact) = EntryExpectation::new(&scene, estimator, area) else {
            continue;
        };
        let m = exact.at(x[0], x[1], 1e-6)[place];
        let bias = m.mean.value - truth;
        // The mean of the radii's second moments; squared means differ little from the square of their mean.
        let variance = (m.second_moment.value - m.mean.value * m.mean.value) / photons as f64;
        let predicted = bias * bias + variance;
        let prepared = ppm.prepare(&scene);
        let estimates: Vec<f64> = (0..replicates)
            .into_par_iter()
            .map(|seed| {
                let mut film = film();
                for (i, &r) in (0..).zip(&radii) {
                    prepared.iterate(500 + seed, i, per_map, r, &mut film);
                }
                value(&film)
            })
            .collect();
        let progressive = mean_squared_error(&estimates, truth);
        println!(
            "{name} {x:?}: {photons} photons, best radius {:.4} m, relative rmse {:.4}; appm {adaptive:.2} times the least MSE (last radius {radius:.4}); ppm: rmse {:.4}, predicted {:.4} (bias {:+.4})",
            best.bandwidth,
            best.rmse / truth,
            progressive.sqrt() / truth,
            predicted.sqrt() / truth,
            bias / truth
        );
    }
}
