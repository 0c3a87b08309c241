//! `appm`: given the radius that a pass has, its expectation is that of merging at that radius.
//!
//! The radius of pass k depends on earlier photons, those of the pass do not: X_k - E[X | r_k] are differences of a martingale, whose sum has
//! mean zero whatever the radii are. E[X | r] is the exact expectation at the floor point that the close-up shows. A radius chosen with a look at the
//! pass's own photons breaks it.

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Appm, Fault, Learner, Settings};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::{REPLICATES, Replicates, STANDARD_ERRORS, close_up};

const PASSES: u32 = 24;

/// Per replicate the sum over passes of X_k and of E[X | r_k], and all radii.
fn sums(
    scene: &Entry,
    x: [f64; 2],
    first: f64,
    fault: Option<Fault>,
) -> (Replicates, f64, Vec<f64>) {
    let exact = |r: f64| {
        let estimator = Estimator {
            technique: Technique::Merge,
            kernel: Kernel::Disc,
            convention: Convention::Exact,
            bandwidths: &[r],
        };
        let e = EntryExpectation::new(scene, estimator, 1.0).unwrap();
        let place = e.classes().iter().position(|c| *c == PathClass::LSDE);
        e.at(x[0], x[1], 1e-6)[place.unwrap()].mean.value
    };
    let floor = scene.kind.floor().unwrap();
    let brightness = floor.albedo / core::f64::consts::PI;
    let settings = Settings {
        fault,
        ..Settings::default()
    };
    let (mut differences, mut total, mut radii) = (vec![], 0.0, vec![]);
    for seed in 0..REPLICATES {
        let mut run = Appm::new(settings).run(scene).unwrap();
        let paths = run.photons_per_map(first);
        let mut film = Film::new(1, 1, scene.kind.classes());
        let layer = film.layer_of(PathClass::LSDE).unwrap();
        let mut difference = 0.0;
        for pass in 0..PASSES {
            let sound = run.radius(0, first);
            film.clear();
            run.iterate(9000 + seed, pass, paths, first, &mut film);
            let expected = brightness * exact(sound);
            difference += film.layers[layer][0] / paths as f64 - expected;
            total += expected / REPLICATES as f64;
            radii.push(sound);
        }
        differences.push(difference);
    }
    (Replicates(differences), total, radii)
}

#[test]
fn a_pass_has_the_expectation_of_its_radius() {
    for (name, x, height, first) in [
        ("mirror-wall", [0.3, 0.12], 1.0, 1.0),
        ("dome", [-1.2, -0.41], 0.3, 0.3),
    ] {
        let scene = close_up(&entry::load(name).unwrap(), x, height, 1);
        let (found, total, radii) = sums(&scene, x, first, None);
        let se = found.standard_error();
        println!(
            "{name}: {:+.2} se; catches a bias of {:.1} %; radii {:.3} to {:.3}",
            found.t(0.0),
            200.0 * STANDARD_ERRORS * se / total,
            radii.iter().fold(f64::INFINITY, |a, &b| a.min(b)),
            radii.iter().fold(0.0, |a: f64, &b| a.max(b)),
        );
        assert!(found.t(0.0).abs() < STANDARD_ERRORS);
        assert!(STANDARD_ERRORS * se < 0.2 * total, "too weak");
        // The radii are a choice: they differ from replicate to replicate, and shrink.
        let last = |k: usize| radii[(k + 1) * PASSES as usize - 1];
        assert!((1..REPLICATES as usize).all(|k| last(k) != last(0)));
        assert!((0..REPLICATES as usize).all(|k| last(k) < first));
    }
}
