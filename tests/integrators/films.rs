//! What films hold: the planned classes, closed values, nothing that is not finite, and the factor of a deliberate fault.

use core::f64::consts::PI;

use nephroid::entry;
use nephroid::integrators::{
    Fault, Kernel, NAMES, Schedule, Settings, Technique, Treatment, all, by_name,
};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{CylinderCupScene, DiffuseScene, Entry, Kind};

use crate::iteration::one_iteration;

const SCENES: [&str; 4] = ["floor", "mirror-wall", "cup", "pool"];

fn load(scene: &str, width: u32, height: u32) -> Entry {
    let mut entry = entry::load(scene).unwrap();
    (entry.camera.width, entry.camera.height) = (width, height);
    entry
}

#[test]
fn films_carry_what_the_plan_says() {
    for scene in SCENES {
        let entry = load(scene, 64, 64);
        for integrator in all() {
            let plan = integrator.plan(&entry);
            let planned: Vec<_> = plan.iter().map(|c| c.class).collect();
            assert_eq!(planned, entry.kind.classes());
            let film = one_iteration(integrator.as_ref(), &entry, 300_000, 0.3);
            for (k, class) in plan.iter().enumerate() {
                let what = format!("{scene} {} {}", integrator.name(), class.class);
                let sampled = class.treatment != Treatment::NotSampled;
                assert_eq!(film.nonzero[k] > 0, sampled, "{what}");
                assert_eq!(film.layers[k].iter().any(|&v| v != 0.0), sampled, "{what}");
                let regularized = matches!(class.treatment, Treatment::Regularized(_));
                // What is connected and merged is merged wherever there is a floor.
                let expected = match integrator.name() {
                    "lt" | "sms" => false,
                    "vcm" => sampled,
                    // Light tracing samples what the floor shows directly.
                    "bdpt" | "bdpt-reg" => {
                        sampled && class.class.is_caustic() && !class.class.eye.is_empty()
                    }
                    _ => sampled && class.class.is_caustic(),
                };
                assert_eq!(regularized, expected);
                assert!(!class.reason.is_empty());
            }
        }
    }
    assert_eq!(all().len(), NAMES.len());
}

/// Cameras that look up, along the floor, straight down, from close by, into the mirror, with one pixel or one row.
#[test]
fn odd_cameras_give_finite_films() {
    type Odd = ([f64; 3], [f64; 3], [f64; 3], f64, u32, u32);
    let odd: [Odd; 7] = [
        (
            [0.0, -1.0, 3.0],
            [0.0, -1.0, 9.0],
            [0.0, 1.0, 0.0],
            60.0,
            5,
            5,
        ),
        (
            [0.0, -1.0, 3.0],
            [0.0, -1.0, 0.0],
            [0.0, 1.0, 0.0],
            150.0,
            9,
            4,
        ),
        (
            [0.0, -2.0, 1.3],
            [0.0, 5.0, 1.3],
            [0.0, 0.0, 1.0],
            90.0,
            1,
            64,
        ),
        (
            [0.1, 0.5, 2.5],
            [0.1, 1.0, 0.6],
            [1.0, 0.0, 0.0],
            100.0,
            64,
            1,
        ),
        (
            [-1.7, -1.0, 2.2],
            [0.6, 0.0, 0.3],
            [0.0, 0.0, -1.0],
            0.1,
            1,
            1,
        ),
        (
            [0.25, 0.0, 2.0],
            [0.25, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            45.0,
            8,
            8,
        ),
        (
            [0.0, -3.0, 1e-6],
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            45.0,
            8,
            8,
        ),
    ];
    let mut contributions = 0;
    for scene in SCENES {
        for (position, look_at, up, fov, width, height) in odd {
            let mut entry = load(scene, width, height);
            entry.camera.position = position;
            entry.camera.look_at = look_at;
            entry.camera.up = up;
            entry.camera.field_of_view_degrees = fov;
            // An integrator must be sound even where the closed forms are not: validation is not asked here.
            for integrator in all() {
                for bandwidth in [0.3, 1e-9] {
                    let film = one_iteration(integrator.as_ref(), &entry, 3000, bandwidth);
                    let sound = |v: &f64| v.is_finite() && *v >= 0.0;
                    assert!(
                        film.layers.iter().flatten().all(sound),
                        "{scene} {}",
                        integrator.name()
                    );
                    assert_eq!(film.paths, 3000);
                    contributions += film.nonzero.iter().sum::<u64>();
                }
            }
        }
    }
    assert!(contributions > 100_000);
}

#[test]
fn bandwidths_out_of_range_leave_the_regularized_classes_empty() {
    let entry = load("mirror-wall", 32, 32);
    for integrator in all() {
        let plan = integrator.plan(&entry);
        for bandwidth in [0.0, -0.5, f64::NAN, f64::INFINITY] {
            let film = one_iteration(integrator.as_ref(), &entry, 20_000, bandwidth);
            for (k, class) in plan.iter().enumerate() {
                // A connection does without a radius.
                let connected = Treatment::Regularized(Technique::ConnectionAndMerging);
                let exact = matches!(class.treatment, Treatment::Exact(_));
                let empty = !(exact || class.treatment == connected);
                assert_eq!(
                    film.nonzero[k] == 0,
                    empty,
                    "{} {}",
                    integrator.name(),
                    bandwidth
                );
            }
            assert!(film.layers.iter().flatten().all(|v| v.is_finite()));
        }
    }
}

/// One pixel that sees a patch of 0.2 mm around a point: direct light against ρ I h/(π d³). Noise here is only whether
/// the value varies over the patch, so 1e-3 relative is 100 times the variation and would catch any wrong factor.
#[test]
fn a_pixel_of_direct_light_has_the_closed_value() {
    let mut entry = load("floor", 1, 1);
    entry.camera.look_at = [0.4, 0.9, 0.0];
    entry.camera.field_of_view_degrees = 0.1;
    let Kind::Diffuse(DiffuseScene { light, floor }) = &entry.kind else {
        panic!("floor is diffuse");
    };
    let d: Vec<f64> = (0..3)
        .map(|i| light.position[i] - entry.camera.look_at[i])
        .collect();
    let square: f64 = d.iter().map(|c| c * c).sum();
    let closed = floor.albedo / PI * light.intensity * d[2] / (square * square.sqrt());
    for name in ["pt", "pt-reg", "pm", "ppm"] {
        let integrator = by_name(name, &Settings::default()).unwrap();
        let mean = one_iteration(integrator.as_ref(), &entry, 2000, 0.2).class_means()[0];
        assert!(
            (mean / closed - 1.0).abs() < 1e-3,
            "{name}: {mean} {closed}"
        );
    }
}

/// The light's direct term in a pixel through light tracing: the number of hits is binomial, so the standard error is
/// known; z = 6 has a false-alarm probability of 2e-9. It would catch a bias of 2.5 %.
#[test]
fn light_tracing_fills_a_pixel_with_the_closed_value() {
    let mut entry = load("floor", 1, 1);
    entry.camera.look_at = [0.4, 0.9, 0.0];
    entry.camera.field_of_view_degrees = 2.0;
    let reference = by_name("pt", &Settings::default()).unwrap();
    let expected = one_iteration(reference.as_ref(), &entry, 100_000, 0.0).class_means()[0];
    let integrator = by_name("lt", &Settings::default()).unwrap();
    let film = one_iteration(integrator.as_ref(), &entry, 20_000_000, 0.0);
    let mean = film.class_means()[0];
    let error = mean / (film.nonzero[0] as f64).sqrt();
    assert!(6.0 * error < 0.025 * mean, "too weak: {}", film.nonzero[0]);
    assert!(
        (mean - expected).abs() < 6.0 * error,
        "{mean} {expected} {error}"
    );
}

/// Techniques that share neither measure nor side agree where no closed form is at hand: merging, regularized
/// connection and, for what the floor shows directly, light tracing. At r = α = 0.06 the biases are below 2.5 % (3·10⁸
/// paths at 0.08, 0.04 and 0.02) and the standard error of a connected class is 1.5 % (2500 contributions and more): the
/// margin of 10 % is 5 of them beyond the bias, a false alarm of 6e-7 per figure. A forgotten n², π or cosine is 20 %
/// and more.
#[test]
fn independent_techniques_agree_on_the_cup_and_in_the_pool() {
    // Scenes of this test alone: the biases were measured on them.
    let scenes = [
        include_str!("../scenes/cup.toml"),
        include_str!("../scenes/pool.toml"),
    ];
    for text in scenes {
        let mut entry = entry::from_toml("scenes", text).unwrap();
        (entry.camera.width, entry.camera.height) = (16, 16);
        let scene = entry.name.as_str();
        let means = |name: &str, paths: u64| {
            let integrator = by_name(name, &Settings::default()).unwrap();
            one_iteration(integrator.as_ref(), &entry, paths, 0.06).class_means()
        };
        let merged = means("pm", 500_000);
        let connected = means("pt-reg", 20_000_000);
        let traced = means("lt", 500_000);
        for (k, &class) in entry.kind.classes().iter().enumerate() {
            let close = |a: f64, b: f64| (a / b - 1.0).abs() < 0.1;
            println!(
                "{scene} {class}: {} {} {}",
                merged[k], connected[k], traced[k]
            );
            assert!(close(merged[k], connected[k]), "{scene} {class}");
            if class.eye.is_empty() {
                assert!(close(merged[k], traced[k]), "{scene} {class}");
            }
        }
    }
}

/// A fault changes the means by its own factor, on the same random numbers, and only where it applies.
#[test]
fn faults_do_what_they_say() {
    let entry = load("cup", 16, 16);
    let Kind::CylinderCup(CylinderCupScene { light, wall, .. }) = &entry.kind else {
        panic!("cup is a cylinder cup");
    };
    let bandwidth = 0.5_f64;
    let means = |name: &str, fault: Option<Fault>| {
        let integrator = by_name(
            name,
            &Settings {
                kernel: None,
                fault,
                ..Settings::default()
            },
        )
        .unwrap();
        one_iteration(integrator.as_ref(), &entry, 50_000, bandwidth).class_means()
    };
    let classes = entry.kind.classes();
    // Manifold sampling has faults of its own.
    for name in NAMES.into_iter().filter(|n| *n != "sms") {
        let plan = by_name(name, &Settings::default()).unwrap().plan(&entry);
        let healthy = means(name, None);
        let check = |fault: Fault, factor: &dyn Fn(PathClass) -> f64| {
            let faulty = means(name, Some(fault));
            for (k, &class) in classes.iter().enumerate() {
                if plan[k].treatment == Treatment::NotSampled {
                    assert_eq!(faulty[k], 0.0);
                    continue;
                }
                let ratio = faulty[k] / healthy[k];
                assert!(
                    (ratio - factor(class)).abs() < 1e-9,
                    "{name} {class} {fault:?}: {ratio}"
                );
            }
        };
        let regularized = |class: PathClass| {
            let of_class = plan.iter().find(|c| c.class == class);
            of_class.is_some_and(|c| matches!(c.treatment, Treatment::Regularized(_)))
        };
        check(Fault::IntensityForgotten, &|_| 1.0 / light.irradiance);
        check(Fault::ReflectanceForgotten, &|class| {
            let mirrors = class.light.len() + class.eye.len();
            (0..mirrors).fold(1.0, |product, _| product / wall.reflectance)
        });
        // Radii of their own, and shares of merges.
        if !matches!(name, "appm" | "vcm") {
            check(Fault::RadiusForRadiusSquared, &|class| {
                if regularized(class) { bandwidth } else { 1.0 }
            });
        }
        check(Fault::KernelNormalizedByPiAlphaSquared, &|class| {
            let ratio = 2.0 * (1.0 - libm::cos(bandwidth)) / (bandwidth * bandwidth);
            if regularized(class) && name.ends_with("-reg") {
                ratio
            } else {
                1.0
            }
        });
        for lost in classes {
            check(Fault::ClassDropped(*lost), &|class| {
                if class == *lost { 0.0 } else { 1.0 }
            });
        }
        // Direct light and photons of a directional light arrive at one angle; sampled directions do not.
        let sine = libm::sin(light.elevation_degrees.to_radians());
        let faulty = means(name, Some(Fault::CosineTwice));
        for (k, class) in plan.iter().enumerate() {
            let ratio = faulty[k] / healthy[k];
            match class.treatment {
                Treatment::NotSampled => {}
                Treatment::Regularized(technique) if technique.is_angular() => {
                    assert!(ratio > 0.05 && ratio < 0.9)
                }
                _ => assert!(
                    (ratio - sine).abs() < 1e-9,
                    "{name} {}: {ratio}",
                    class.class
                ),
            }
        }
    }
}

#[test]
fn names_and_kernels_are_checked() {
    let with = |name: &str, kernel| {
        by_name(
            name,
            &Settings {
                kernel: Some(kernel),
                fault: None,
                ..Settings::default()
            },
        )
    };
    assert!(by_name("mlt", &Settings::default()).is_err());
    for kernel in [
        Kernel::Cone,
        Kernel::Epanechnikov,
        Kernel::VonMisesFisher,
        Kernel::Disc,
    ] {
        assert_eq!(with("pt-reg", kernel).is_ok(), kernel.is_angular());
        assert_eq!(with("bdpt-reg", kernel).is_ok(), kernel.is_angular());
        assert_eq!(with("pm", kernel).is_ok(), kernel.is_planar());
        assert_eq!(with("ppm", kernel).is_ok(), kernel.is_planar());
        assert!(with("pt", kernel).is_ok() && with("lt", kernel).is_ok());
    }
    let ppm = by_name("ppm", &Settings::default()).unwrap().schedule(0.2);
    assert!(matches!(ppm, Schedule::Progressive { first, .. } if first == 0.2));
    assert!(ppm.bandwidth(100) < 0.1);
    assert_eq!(
        by_name("pm", &Settings::default()).unwrap().schedule(0.2),
        Schedule::Fixed(0.2)
    );
}
