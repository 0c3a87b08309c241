//! Films of `pt-reg`, `pm` and `ppm` where light takes chains: the probe's mean in a pixel, and regular classes untouched.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::probes::{Estimator, Technique};
use nephroid::integrators::{Kernel, Settings, Treatment, all, by_name};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind};

fn film(entry: &Entry, name: &str, seed: u64, paths: u64, bandwidth: f64) -> Film {
    let integrator = by_name(name, &Settings::default()).unwrap();
    let (width, height) = (entry.camera.width, entry.camera.height);
    let mut film = Film::new(width, height, entry.kind.classes());
    integrator
        .prepare(entry)
        .iterate(seed, 0, paths, bandwidth, &mut film);
    film
}

/// A pixel that sees a millimetre of the floor has ρ/π times the probe's irradiance, class by class. 6.2 standard errors of 32
/// replicates (7e-7 a figure) and twice the probe's own: it would catch 8 %, such as a light that is counted in
/// another class, or a chain's reflectance forgotten.
#[test]
fn a_pixel_has_the_mean_of_the_probe() {
    let cases = [
        ("dome", [-0.9, -0.44], 0.3),
        ("glass-column", [-0.6, 1.3], 0.3),
        ("corner", [3.3, 0.95], 0.25),
        ("slab", [0.1, 0.3], 0.3),
    ];
    for (scene, point, bandwidth) in cases {
        let mut entry = entry::load(scene).unwrap();
        let floor = entry.kind.floor().unwrap().clone();
        (entry.camera.width, entry.camera.height) = (1, 1);
        let position = entry.camera.position;
        entry.camera.look_at = [point[0], point[1], 0.0];
        if libm::hypot(position[0] - point[0], position[1] - point[1]) < 0.1 {
            entry.camera.up = [0.0, 1.0, 0.0];
        }
        entry.camera.field_of_view_degrees = 0.1;
        for (name, technique, kernel, paths) in [
            ("pt-reg", Technique::Camera, Kernel::Cone, 40_000),
            ("pm", Technique::Merge, Kernel::Disc, 20_000),
        ] {
            let catalogue = entry::load(scene).unwrap();
            let probe = Estimator::new(&catalogue, technique, kernel, None).unwrap();
            let aim = probe.aim(bandwidth, point).unwrap();
            let sums = probe
                .run_aimed(1, 0, 200_000, bandwidth, point, &aim)
                .unwrap();
            let means: Vec<Vec<f64>> = (0..32)
                .map(|seed| film(&entry, name, seed, paths, bandwidth).class_means())
                .collect();
            for (&class, sums) in probe.classes().iter().zip(&sums) {
                let layer = entry.kind.classes().iter().position(|&c| c == class);
                let of = |m: &Vec<f64>| m[layer.unwrap()] * PI / floor.albedo;
                let n = means.len() as f64;
                let mean = means.iter().map(of).sum::<f64>() / n;
                let square = |m: &Vec<f64>| (of(m) - mean) * (of(m) - mean);
                let error = (means.iter().map(square).sum::<f64>() / (n * (n - 1.0))).sqrt();
                let (expected, own) = (sums.mean(), sums.standard_error());
                println!(
                    "{scene} {name} {class}: {:.4} ± {:.4} ± {:.4}",
                    mean / expected,
                    error / expected,
                    own / expected
                );
                // A class that does not reach the point has no light in either.
                let bound = 6.2 * error + 6.0 * own;
                assert!((mean - expected).abs() <= bound, "{scene} {name} {class}");
                if expected > 0.0 && error < 0.01 * expected {
                    assert!(bound < 0.08 * expected, "{scene} {name} {class}: {bound}");
                }
            }
        }
    }
}

/// Direct light has the same bits whatever is regularized beside it, and at any bandwidth.
#[test]
fn direct_light_is_never_regularized() {
    for scene in [
        "dome",
        "ball",
        "pillar",
        "corner",
        "glass-column",
        "glass-ball",
    ] {
        let entry = entry::load(scene).unwrap();
        let layer = |name: &str, bandwidth: f64| {
            let film = film(&entry, name, 9, 20_000, bandwidth);
            let at = film.layer_of(PathClass::LDE).unwrap();
            (film.layers[at].clone(), film.nonzero[at])
        };
        let reference = layer("pt", 0.0);
        assert!(reference.1 > 1000);
        for name in ["pt-reg", "pm", "ppm"] {
            for bandwidth in [1e-6, 0.3] {
                assert!(layer(name, bandwidth) == reference, "{scene} {name}");
            }
        }
    }
}

/// Every caustic of every kind is planned as regularized, at a vertex that is named, and has light where it is planned.
#[test]
fn plans_cover_all_kinds() {
    let mut kinds = 0;
    for name in entry::names() {
        let entry = entry::load(name).unwrap();
        let has_floor = !matches!(entry.kind, Kind::Furnace(_));
        kinds += 1;
        if !has_floor {
            let refuses = |name: &str| {
                let integrator = by_name(name, &Settings::default()).unwrap();
                integrator.supports(&entry).is_err()
            };
            assert!(["pt-reg", "pm", "ppm"].into_iter().all(refuses));
            continue;
        }
        for integrator in all() {
            let plan = integrator.plan(&entry);
            assert_eq!(plan.len(), entry.kind.classes().len());
            if !matches!(integrator.name(), "pt-reg" | "pm" | "ppm") {
                continue;
            }
            assert!(integrator.supports(&entry).is_ok(), "{name}");
            for class in &plan {
                let regularized = matches!(class.treatment, Treatment::Regularized(_));
                assert_eq!(regularized, class.class.is_caustic(), "{name}");
                let text = &class.reason;
                assert!(
                    !regularized
                        || text.contains("specular vertex next to the light")
                        || text.contains("merged"),
                    "{text}"
                );
            }
        }
    }
    assert!(kinds > 20);
}
