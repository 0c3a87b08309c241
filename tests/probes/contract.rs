//! What a probe promises: bits, aims, and errors that name what is allowed.

use nephroid::entry;
use nephroid::integrators::Kernel;
use nephroid::integrators::probes::{Distance, Estimator, Sums, Technique};
use rayon::prelude::*;

fn probe(scene: &str, technique: Technique) -> Estimator {
    let entry = entry::load(scene).unwrap();
    let kernel = match technique {
        Technique::Merge => Kernel::Disc,
        _ => Kernel::Cone,
    };
    Estimator::new(&entry, technique, kernel, None).unwrap()
}

#[test]
fn a_run_is_a_function_of_seed_iteration_and_paths() {
    for technique in Technique::ALL {
        let probe = probe("glass-column", technique);
        let run =
            |seed: u64, iteration: u32| probe.run(seed, iteration, 5000, 0.5, [-0.6, 1.3]).unwrap();
        let reference = run(1, 0);
        assert!(reference.iter().any(|s| s.nonzero > 0));
        assert!(reference.iter().all(|s| s.paths == 5000));
        let again: Vec<_> = (0..8_u32).into_par_iter().map(|_| run(1, 0)).collect();
        assert!(again.iter().all(|r| *r == reference));
        assert!(run(2, 0) != reference && run(1, 1) != reference);
    }
}

/// An aim keeps the mean and multiplies the second moment by its share: both within 6 standard errors of either run (false
/// alarm 2e-9 a figure, 16 figures), which would catch 4 % of either. Where contributions are rare, the aim makes them common.
#[test]
fn an_aim_keeps_means_and_scales_second_moments() {
    for (scene, point) in [("dome", [-0.9, -0.44]), ("cup", [0.29, 0.044])] {
        for technique in Technique::ALL {
            let probe = probe(scene, technique);
            let bandwidth = 0.15;
            let aim = probe.aim(bandwidth, point).unwrap();
            let share = aim.share(0);
            let moments = |run: &dyn Fn(u32) -> Sums| {
                let runs: Vec<Sums> = (0..16).map(run).collect();
                let n = runs.len() as f64;
                [Sums::mean, Sums::second_moment].map(|of| {
                    let mean = runs.iter().map(of).sum::<f64>() / n;
                    let off = |r: &Sums| (of(r) - mean) * (of(r) - mean);
                    let error = (runs.iter().map(off).sum::<f64>() / (n * (n - 1.0))).sqrt();
                    (mean, error)
                })
            };
            let free = moments(&|k| probe.run(3, k, 100_000, bandwidth, point).unwrap()[0]);
            let aimed = moments(&|k| {
                probe
                    .run_aimed(4, k, 30_000, bandwidth, point, &aim)
                    .unwrap()[0]
            });
            for (k, scale) in [(0, 1.0), (1, share)] {
                let (a, b) = (free[k], aimed[k]);
                let (a, b) = ((a.0 * scale, a.1 * scale), b);
                let error = libm::hypot(a.1, b.1);
                let what = format!("{scene} {} {k}: {a:?} {b:?}", technique.name());
                // Student's t on 15 degrees of freedom: 9 in place of 6.
                assert!((a.0 - b.0).abs() < 9.0 * error, "{what}");
                assert!(9.0 * error < 0.1 * a.0, "too weak: {what}");
            }
            let sums = probe.run_aimed(4, 0, 20_000, 0.01, point, &probe.aim(0.01, point).unwrap());
            assert!(
                sums.unwrap()[0].nonzero > 5000,
                "{scene} {}",
                technique.name()
            );
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let refused = |scene: &str, technique, kernel, distance, key: &str| {
        let entry = entry::load(scene).unwrap();
        match Estimator::new(&entry, technique, kernel, distance) {
            Ok(_) => panic!("{scene} {key}"),
            Err(e) => assert!(e.to_string().contains(key), "{e}"),
        }
    };
    let (camera, merge) = (Technique::Camera, Technique::Merge);
    refused("floor", camera, Kernel::Cone, None, "kind");
    refused("furnace", camera, Kernel::Cone, None, "kind");
    refused("dome", camera, Kernel::Disc, None, "kernel");
    refused("dome", merge, Kernel::VonMisesFisher, None, "kernel");
    refused(
        "dome",
        merge,
        Kernel::Disc,
        Some(Distance::Exact),
        "distance",
    );
    refused(
        "cup",
        camera,
        Kernel::Cone,
        Some(Distance::Light),
        "distance",
    );
    let dome = probe("dome", camera);
    for bad in [0.0, -0.1, 4.0, f64::NAN, f64::INFINITY] {
        let error = dome.run(1, 0, 10, bad, [0.0, 0.0]).unwrap_err();
        assert!(error.to_string().contains("bandwidth"));
    }
    let entry = entry::load("dome").unwrap();
    let soft = Estimator::new(&entry, camera, Kernel::VonMisesFisher, None).unwrap();
    assert!(soft.run(1, 0, 10, 0.1, [0.0, 0.0]).is_ok());
    assert!(soft.aim(0.1, [0.0, 0.0]).is_err());
    let class = "LSSDE".parse().unwrap();
    assert!(Estimator::of_class(&entry, camera, Kernel::Cone, None, class).is_err());
    // Light that a wide kernel sends to a point from all over an unbounded surface.
    let ripples = probe("ripple-pool", Technique::Light);
    assert!(ripples.run(1, 0, 10, 0.1, [0.1, 0.2]).is_ok());
    assert!(ripples.run(1, 0, 10, 1.5, [0.1, 0.2]).is_err());
}

#[test]
fn beside_the_floor_there_is_no_light() {
    for technique in Technique::ALL {
        let dome = probe("dome", technique);
        for point in [[9.0, 0.0], [f64::NAN, 0.0], [0.0, f64::INFINITY]] {
            let sums = dome.run(1, 0, 1000, 0.3, point).unwrap();
            assert_eq!((sums[0].sum, sums[0].paths), (0.0, 1000));
        }
    }
}
