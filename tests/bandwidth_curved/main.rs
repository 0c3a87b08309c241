//! Expectations at finite bandwidth on any surface, against what shares no code with the cells: the tables, the plane mirror's
//! polar coordinates, closed forms averaged over a disc, small bandwidths, units, and the error bounds themselves.

mod charts;
mod scattered;

use std::f64::consts::PI;
use std::fs;
use std::path::PathBuf;

use nephroid::entry;
use nephroid::evaluate::evaluate;
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::frame::FrameExpectation;
use nephroid_analytic::bandwidth::{
    Convention, Expectation, Kernel, Moments, PlanarSetting, Technique,
};
use nephroid_analytic::camera::Film;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;

fn load(name: &str) -> Entry {
    entry::load(name).expect("a catalogue entry")
}

fn expectation(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> EntryExpectation {
    let estimator = Estimator {
        technique,
        kernel,
        convention: Convention::Exact,
        bandwidths,
    };
    EntryExpectation::new(entry, estimator, 1.0).expect("an expectation")
}

/// Of the class L S D.
fn at(e: &EntryExpectation, x: [f64; 2], tolerance: f64) -> Moments {
    let position = e.classes().iter().position(|c| c.light.len() == 1);
    e.at(x[0], x[1], tolerance)[position.expect("LSDE")]
}

fn truth(entry: &Entry, [x, y]: [f64; 2]) -> f64 {
    let light = FloorTruth::new(entry).expect("a floor").at(x, y);
    let caustic = light.iter().find(|t| t.class == PathClass::LSDE);
    caustic.map_or(0.0, |t| t.irradiance.value)
}

fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}

/// What the issue of finite bandwidth asks of the tables: means to 1e-9, second moments to 1e-6 (they have ten digits).
#[test]
fn the_tables_of_curved_mirrors_interface_and_flatland() {
    for (name, count) in [
        ("concave-sphere", 490),
        ("convex-sphere", 350),
        ("flat-interface", 20),
        ("flatland", 20),
    ] {
        let file = format!("golden/reference/bandwidth-{name}.json");
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(file);
        let text = fs::read_to_string(path).expect("the table");
        let report = evaluate(name, &text).expect("a good file");
        let mut compared = 0;
        for placed in report.rows() {
            let Some(expected) = placed.row.expected else {
                continue;
            };
            compared += 1;
            let off = relative(placed.row.value, expected);
            let second = placed.row.key.ends_with("second_moment");
            let allowed = if second { 1e-6 } else { 1e-9 };
            assert!(off <= allowed, "{name} {placed:?}");
        }
        assert!(compared >= count, "{name}: {compared} values");
    }
}

/// The plane mirror in its own polar coordinates, and on the cells: light and mirror's edges, all techniques and kernels.
#[test]
fn the_plane_mirror_by_two_parametrisations() {
    let scene = load("mirror-wall");
    let setting = PlanarSetting::of_entry(&scene)
        .expect("valid")
        .expect("a mirror");
    let mut compared = 0;
    for technique in Technique::ALL {
        for &kernel in technique.kernels() {
            for b in [0.4, 0.05, 1e-4] {
                let cells = expectation(&scene, technique, kernel, &[b]);
                let polar = Expectation::new(setting.clone(), technique, kernel, &[b])
                    .expect("an expectation");
                for x in [[0.3, 0.12], [0.65, -0.7], [-0.9, 0.9]] {
                    let (a, p) = (at(&cells, x, 1e-10), polar.at([x[0], x[1], 0.0], 1e-12));
                    let pairs = [(a.mean, p.mean), (a.second_moment, p.second_moment)];
                    for (a, p) in pairs {
                        if p.value == 0.0
                            || technique == Technique::Linked && a.error > 1e-8 * a.value
                        {
                            continue;
                        }
                        compared += 1;
                        let allowed = 1e-10 * p.value + p.error + 1e-16 / b * p.value;
                        assert!(
                            (a.value - p.value).abs() <= allowed,
                            "{technique} {kernel} {b} {x:?}: {a:?} {p:?}"
                        );
                    }
                }
            }
        }
    }
    assert!(compared > 150, "{compared} compared");
}

/// Merging is the closed form averaged over the kernel: polar rules of 40 points each about a point with no edge near it.
#[test]
fn merging_is_the_closed_form_averaged() {
    let rule = nephroid_analytic::pixel::rule::Rule::gauss(40);
    for (name, x, r) in [
        ("ball", [1.1, 0.9], 0.3),
        ("pillar", [-0.812, -0.978], 0.15),
        ("underwater", [0.2, 0.1], 0.3),
        ("conic-wall", [0.3, 0.1], 0.05),
    ] {
        let scene = load(name);
        if truth(&scene, x) == 0.0 {
            panic!("{name} is dark at {x:?}");
        }
        let (mut mean, azimuths) = (0.0, 64);
        for k in 0..azimuths {
            let w = 2.0 * PI * f64::from(k) / f64::from(azimuths);
            for (t, weight) in rule.iter() {
                let d = [r * t * libm::cos(w), r * t * libm::sin(w)];
                let e = truth(&scene, [x[0] + d[0], x[1] + d[1]]);
                // 2πρ dρ/(πr²) = 2 t dt.
                mean += 2.0 * t * weight * e / f64::from(azimuths);
            }
        }
        let e = expectation(&scene, Technique::Merge, Kernel::Disc, &[r]);
        let got = at(&e, x, 1e-11).mean;
        assert!(relative(got.value, mean) < 1e-10, "{name}: {got:?} {mean}");
    }
}

/// At regular points the bias goes like α²: from 1e-3 to 1e-6 there is nothing but the closed form, to what α² leaves.
#[test]
fn small_bandwidths_give_the_closed_form() {
    for (name, x) in [
        ("dome", [-1.5, -0.6]),
        ("ball", [0.53, 0.184]),
        ("cup", [0.96, 0.136]),
        ("pillar", [-0.812, -0.978]),
        ("underwater", [0.3, 0.2]),
        ("ripple-pool", [0.68, 0.96]),
        ("ellipsoid", [0.1, 0.05]),
        ("hyperboloid", [0.4, 0.3]),
        ("cup-rim", [0.2, 0.3]),
        ("conic-wall", [0.3, 0.1]),
    ] {
        let scene = load(name);
        let e0 = truth(&scene, x);
        for technique in Technique::ALL {
            let kernel = technique.default_kernel();
            let off = |b: f64| {
                let e = expectation(&scene, technique, kernel, &[b]);
                at(&e, x, 1e-10).mean.value - e0
            };
            if e0 == 0.0 {
                assert_eq!(off(1e-5), 0.0, "{name} {technique}");
                continue;
            }
            let (wide, narrow, least) = (off(2e-3) / e0, off(1e-3) / e0, off(1e-6) / e0);
            assert!(least.abs() < 1e-8, "{name} {technique}: {least:e}");
            // Order 2, where the bias is far above rounding; linked rays that leave the floor add a part of their own.
            if narrow.abs() > 1e-8 && technique != Technique::Linked {
                let order = libm::log2(wide / narrow);
                assert!((order - 2.0).abs() < 0.1, "{name} {technique}: {order}");
            }
        }
    }
}

/// The bounds cover what a much finer run finds, and finer tolerances are met.
#[test]
fn error_bounds_cover_the_difference_to_finer_runs() {
    let points = [[-1.2, -0.41], [-0.7, -0.3]];
    for (name, technique, b) in [
        ("dome", Technique::Camera, 0.2),
        ("dome", Technique::Merge, 0.15),
        ("dome", Technique::Linked, 0.2),
        ("cup", Technique::Light, 0.1),
        ("ripple-pool", Technique::Merge, 0.1),
    ] {
        let scene = load(name);
        for kernel in [technique.default_kernel(), Kernel::Epanechnikov] {
            let e = expectation(&scene, technique, kernel, &[b]);
            for x in points {
                let fine = at(&e, x, 1e-11);
                for tolerance in [1e-3, 1e-5, 1e-7] {
                    let m = at(&e, x, tolerance);
                    for (m, f) in [(m.mean, fine.mean), (m.second_moment, fine.second_moment)] {
                        assert!(
                            (m.value - f.value).abs() <= m.error + f.error,
                            "{name} {technique} {kernel} {x:?} {tolerance:e}: {m:?} {f:?}"
                        );
                        assert!(m.error <= 1.01 * tolerance * m.value, "{m:?}");
                    }
                }
            }
        }
    }
}

/// A schedule is the mean of its bandwidths.
#[test]
fn a_schedule_is_one_quadrature() {
    let scene = load("dome");
    let bandwidths = [0.3, 0.2, 0.11, 0.05];
    let x = [-1.2, -0.41];
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Epanechnikov),
        (Technique::Linked, Kernel::Cone),
    ] {
        let all = at(
            &expectation(&scene, technique, kernel, &bandwidths),
            x,
            1e-10,
        );
        let each = bandwidths.map(|b| at(&expectation(&scene, technique, kernel, &[b]), x, 1e-10));
        let mean = each.iter().map(|m| m.mean.value).sum::<f64>() / 4.0;
        let second = each.iter().map(|m| m.second_moment.value).sum::<f64>() / 4.0;
        assert!(relative(all.mean.value, mean) < 1e-9, "{technique}");
        assert!(
            relative(all.second_moment.value, second) < 1e-9,
            "{technique}"
        );
    }
}

/// Film regions and pixels against a midpoint sum of the expectations at the floor points of 32 × 32 film points.
#[test]
fn regions_and_pixels_are_means_of_points() {
    for (name, technique, allowed) in [
        ("pillar", Technique::Camera, 2e-3),
        ("dome", Technique::Merge, 2e-2),
    ] {
        let mut scene = load(name);
        (scene.camera.width, scene.camera.height) = (8, 8);
        let estimator = Estimator {
            technique,
            kernel: technique.default_kernel(),
            convention: Convention::Exact,
            bandwidths: &[0.25],
        };
        let frame = FrameExpectation::new(&scene, estimator, 1.0).expect("a frame");
        let e = EntryExpectation::new(&scene, estimator, 1.0).expect("an expectation");
        let film = Film::new(&scene.camera);
        let floor = scene.kind.floor().expect("a floor");
        let (n, mut sum) = (32, 0.0);
        for k in 0..n * n {
            let at = |k: i32| 8.0 * (f64::from(k) + 0.5) / f64::from(n);
            let d = film.direction(at(k % n), at(k / n));
            let t = film.position.z / -d.z;
            let x = [film.position.x + d.x * t, film.position.y + d.y * t];
            let on = (0..2).all(|k| f64::abs(x[k] - floor.center[k]) <= floor.half_width[k]);
            if on {
                let m = self::at(&e, x, 1e-4);
                sum += floor.albedo / PI * m.mean.value / f64::from(n * n);
            }
        }
        let region = frame.region(0, 0..8, 0..8, 1e-3, [0.0; 2]);
        let mean = region.mean.value / 64.0;
        assert!(relative(mean, sum) < allowed, "{name}: {mean} {sum}");
        let typical = [mean, region.second_moment.value / 64.0];
        let pixels = frame.pixels(0, 0..8, 0..8, 1e-2, typical);
        let total: f64 = pixels.iter().map(|m| m.mean.value).sum();
        let bound: f64 = pixels.iter().map(|m| m.mean.error).sum();
        let off = (total - region.mean.value).abs();
        assert!(
            off <= bound + region.mean.error,
            "{name}: {total} {region:?}"
        );
        assert!(off <= 3e-3 * total, "{name}: {total} {region:?}");
    }
}

/// The plane mirror by the tiles of curved pictures against polygons that are cut along its edges and integrated in polar coordinates.
#[test]
fn pictures_of_a_plane_mirror_by_two_routes() {
    let mut scene = load("mirror-wall");
    (scene.camera.width, scene.camera.height) = (16, 16);
    for technique in [Technique::Camera] {
        let (kernel, bandwidths) = (technique.default_kernel(), [0.2]);
        let estimator = Estimator {
            technique,
            kernel,
            convention: Convention::Exact,
            bandwidths: &bandwidths,
        };
        let frame = FrameExpectation::new(&scene, estimator, 1.0).expect("a frame");
        let film = FilmExpectation::new(&scene, technique, kernel, &bandwidths).expect("a film");
        assert_eq!(frame.classes(), film.classes());
        let unlimited = [[f64::INFINITY; 2]; 2];
        let rough = film.region(0..16, 0..16, &unlimited, 1e-3);
        let targets = [0, 1].map(|c| [2e-5 * rough[c].mean.value, f64::INFINITY]);
        let polygons = film.region(0..16, 0..16, &targets, 1e-5);
        for (class, exact) in polygons.iter().enumerate() {
            let found = frame.region(class, 0..16, 0..16, 5e-4, [0.0, f64::INFINITY]);
            let off = (found.mean.value - exact.mean.value).abs();
            assert!(
                off <= found.mean.error + exact.mean.error && off <= 1e-3 * exact.mean.value,
                "{technique} {class}: {found:?} {exact:?}"
            );
        }
    }
}

/// Twice the scene is a quarter of the irradiance at the same angles, and at twice the radius.
#[test]
fn units() {
    for (name, x) in [("dome", [-1.2, -0.41]), ("pool", [0.1, 0.05])] {
        let scene = load(name);
        let (scaled, _) = nephroid::variation::Variation::Scaled(2.0)
            .of(name)
            .expect("a good scene")
            .expect("a larger scene");
        for (technique, b) in [
            (Technique::Camera, 0.2),
            (Technique::Light, 0.2),
            (Technique::Merge, 0.2),
        ] {
            let kernel = technique.default_kernel();
            let larger = if technique.bandwidth_is_angle() {
                b
            } else {
                2.0 * b
            };
            let one = at(&expectation(&scene, technique, kernel, &[b]), x, 1e-10);
            let two = expectation(&scaled, technique, kernel, &[larger]);
            let two = at(&two, [2.0 * x[0], 2.0 * x[1]], 1e-10);
            assert!(
                relative(4.0 * two.mean.value, one.mean.value) < 1e-9,
                "{name} {technique}"
            );
            let ratio = 16.0 * two.second_moment.value / one.second_moment.value;
            assert!((ratio - 1.0).abs() < 1e-9, "{name} {technique}: {ratio}");
        }
    }
}
