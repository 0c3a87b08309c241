//! Mean radiance of each path class over the whole image, against quadrature that shares no code with integrator or
//! truth: the image of the light in the mirror, a midpoint rule over the film, and for regularized classes a midpoint
//! rule over the mirror or the disc inside it.
//!
//! An integrator's mean of m = 32 replicates must be within z = 6.2 standard errors plus the quadrature's own error of
//! the expectation; with Student's t on 31 degrees of freedom a false alarm has probability 7e-7 per figure, and seeds
//! are fixed. Each assertion prints the relative bias that it would catch.

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Kernel, Settings, by_name};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{DiffuseScene, Entry, Kind, PlanarMirrorScene};

type V = [f64; 3];

/// The z above.
const STANDARD_ERRORS: f64 = 6.2;

fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn scaled(a: V, k: f64) -> V {
    [a[0] * k, a[1] * k, a[2] * k]
}

fn plus(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn cubed(a: f64) -> f64 {
    a * a * a
}

fn unit(a: V) -> V {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

/// A scene with at most a vertical mirror facing -y, in the plainest terms.
struct Plain {
    light: V,
    intensity: f64,
    albedo: f64,
    half: [f64; 2],
    /// y of the mirror's plane, half width, z from, z to, reflectance.
    mirror: Option<(f64, f64, f64, f64, f64)>,
    entry: Entry,
}

impl Plain {
    fn load(name: &str) -> Self {
        let entry = entry::load(name).unwrap();
        let (light, floor, mirror) = match &entry.kind {
            Kind::Diffuse(DiffuseScene { light, floor }) => (light, floor, None),
            Kind::PlanarMirror(PlanarMirrorScene {
                light,
                floor,
                mirror,
            }) => {
                assert_eq!(
                    (mirror.normal, mirror.edge),
                    ([0.0, -1.0, 0.0], [1.0, 0.0, 0.0])
                );
                let (z, h) = (mirror.center[2], mirror.half_height);
                assert_eq!(mirror.center[0], 0.0);
                let plain = (
                    mirror.center[1],
                    mirror.half_width,
                    z - h,
                    z + h,
                    mirror.reflectance,
                );
                (light, floor, Some(plain))
            }
            _ => panic!("not a kind for this test"),
        };
        assert_eq!(floor.center, [0.0, 0.0]);
        Plain {
            light: light.position,
            intensity: light.intensity,
            albedo: floor.albedo,
            half: floor.half_width,
            mirror,
            entry: entry.clone(),
        }
    }

    /// Where the segment a → b crosses the mirror.
    fn crossing(&self, a: V, b: V) -> Option<V> {
        let (y, half, low, high, _) = self.mirror?;
        let t = (y - a[1]) / (b[1] - a[1]);
        let p = plus(a, scaled(sub(b, a), t));
        ((0.0..=1.0).contains(&t) && p[0].abs() <= half && (low..=high).contains(&p[2]))
            .then_some(p)
    }

    fn image(&self, p: V) -> V {
        let y = self.mirror.unwrap().0;
        [p[0], 2.0 * y - p[1], p[2]]
    }

    fn direct(&self, x: V) -> f64 {
        let d = sub(self.light, x);
        let free = self.crossing(x, self.light).is_none();
        if free {
            self.intensity * d[2] / cubed(dot(d, d)).sqrt()
        } else {
            0.0
        }
    }

    fn caustic(&self, x: V) -> f64 {
        let Some((y, .., reflectance)) = self.mirror else {
            return 0.0;
        };
        let image = self.image(self.light);
        let d = sub(image, x);
        let lit = x[1] < y && self.crossing(x, image).is_some();
        if lit {
            reflectance * self.intensity * d[2] / cubed(dot(d, d)).sqrt()
        } else {
            0.0
        }
    }

    /// The expectation of technique `camera` with the kernel φ, integrated over the mirror.
    fn camera_side(&self, x: V, n: usize, phi: &dyn Fn(f64) -> f64) -> f64 {
        let (y, half, low, high, reflectance) = self.mirror.unwrap();
        if x[1] >= y {
            return 0.0;
        }
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..n {
                let sx = half * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
                let sz = low + (high - low) * (j as f64 + 0.5) / n as f64;
                let s = [sx, y, sz];
                let (to_x, to_y) = (sub(x, s), sub(self.light, s));
                let (r1, r2) = (dot(to_x, to_x).sqrt(), dot(to_y, to_y).sqrt());
                let exact = [-to_x[0], to_x[1], -to_x[2]];
                let cos_g = dot(exact, to_y) / (r1 * r2);
                let (cos_x, cos_1) = (-to_x[2] / r1, -to_x[1] / r1);
                // cos_x = (s - x)·z/r1, and the mirror faces -y.
                sum += phi(cos_g) * cos_x.abs() * cos_1 / (r1 * r1 * r2 * r2);
            }
        }
        let area = 2.0 * half * (high - low) / (n * n) as f64;
        reflectance * self.intensity * sum * area
    }

    /// The caustic convolved with a disc of radius r.
    fn merged(&self, x: V, r: f64, n: usize) -> f64 {
        let mut sum = 0.0;
        for i in 0..n {
            for j in 0..2 * n {
                // Equal areas.
                let d = r * ((i as f64 + 0.5) / n as f64).sqrt();
                let (s, c) = libm::sincos(core::f64::consts::PI * (j as f64 + 0.5) / n as f64);
                let p = [x[0] + d * c, x[1] + d * s, 0.0];
                let on_floor = p[0].abs() <= self.half[0] && p[1].abs() <= self.half[1];
                sum += if on_floor { self.caustic(p) } else { 0.0 };
            }
        }
        sum / (2 * n * n) as f64
    }

    /// Means over the film of radiance seen directly and in the mirror, for an irradiance.
    fn film_means(&self, n: usize, irradiance: &dyn Fn(V) -> f64) -> [f64; 2] {
        let camera = &self.entry.camera;
        let forward = unit(sub(camera.look_at, camera.position));
        let right = unit(cross(forward, camera.up));
        let up = cross(right, forward);
        let half = libm::tan(0.5 * camera.field_of_view_degrees.to_radians());
        assert_eq!(camera.width, camera.height);
        let on_floor = |o: V, d: V| {
            let x = plus(o, scaled(d, -o[2] / d[2]));
            let inside = d[2] < 0.0 && x[0].abs() <= self.half[0] && x[1].abs() <= self.half[1];
            inside.then_some([x[0], x[1], 0.0])
        };
        let mut means = [0.0; 2];
        for i in 0..n {
            for j in 0..n {
                let a = half * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
                let b = half * (2.0 * (j as f64 + 0.5) / n as f64 - 1.0);
                let d = plus(forward, plus(scaled(right, a), scaled(up, b)));
                if let Some(x) = on_floor(camera.position, d) {
                    let hidden = self.crossing(camera.position, x).is_some();
                    means[0] += if hidden { 0.0 } else { irradiance(x) };
                }
            }
        }
        // What is seen in the mirror: over the mirror, so that its border is no error of the quadrature.
        if let Some((y, wide, low, high, reflectance)) = self.mirror {
            for i in 0..n {
                for j in 0..n {
                    let sx = wide * (2.0 * (i as f64 + 0.5) / n as f64 - 1.0);
                    let sz = low + (high - low) * (j as f64 + 0.5) / n as f64;
                    let d = sub([sx, y, sz], camera.position);
                    let depth = dot(d, forward);
                    let (a, b) = (dot(d, right) / depth, dot(d, up) / depth);
                    assert!(
                        a.abs() <= half && b.abs() <= half,
                        "the mirror is cut by the frame"
                    );
                    // Film area per mirror area at depth 1: the foreshortened area over D², and 1/cos³ of the axis.
                    let density =
                        d[1] / cubed(depth) * 2.0 * wide * (high - low) / (4.0 * half * half);
                    if let Some(x) = on_floor([sx, y, sz], [d[0], -d[1], d[2]]) {
                        means[1] += reflectance * irradiance(x) * density;
                    }
                }
            }
        }
        means.map(|m| m * self.albedo / core::f64::consts::PI / (n * n) as f64)
    }
}

/// Mean over replicates and its standard error, per class.
fn replicate_means(
    name: &str,
    settings: &Settings,
    entry: &Entry,
    paths: u64,
    bandwidth: f64,
) -> Vec<(PathClass, f64, f64)> {
    let prepared = by_name(name, settings).unwrap().prepare(entry);
    let classes = entry.kind.classes();
    let replicates = 32;
    let rows: Vec<Vec<f64>> = (0..replicates)
        .map(|k| {
            let mut film = Film::new(entry.camera.width, entry.camera.height, classes);
            prepared.iterate(2026 + k, 0, paths, bandwidth, &mut film);
            film.class_means()
        })
        .collect();
    let m = rows.len() as f64;
    (0..classes.len())
        .map(|c| {
            let mean = rows.iter().map(|r| r[c]).sum::<f64>() / m;
            let variance = rows
                .iter()
                .map(|r| (r[c] - mean) * (r[c] - mean))
                .sum::<f64>()
                / (m - 1.0);
            (classes[c], mean, (variance / m).sqrt())
        })
        .collect()
}

/// Two quadratures of different fineness: the value, and their difference as its error.
fn refined(coarse: [f64; 2], fine: [f64; 2]) -> [(f64, f64); 2] {
    [0, 1].map(|k| (fine[k], (fine[k] - coarse[k]).abs()))
}

fn check(
    what: &str,
    found: &[(PathClass, f64, f64)],
    expected: [(f64, f64); 2],
    classes: [PathClass; 2],
    weakest: f64,
) {
    for (class, (value, error)) in classes.into_iter().zip(expected) {
        let Some(&(_, mean, se)) = found.iter().find(|f| f.0 == class) else {
            continue;
        };
        let allowed = STANDARD_ERRORS * se + error;
        println!(
            "{what} {class}: {mean:.6e} expected {value:.6e}, catches a bias of {:.2} %",
            100.0 * (allowed + STANDARD_ERRORS * se) / value
        );
        assert!(value > 0.0 && se > 0.0, "{what} {class}: nothing there");
        assert!(
            (mean - value).abs() <= allowed,
            "{what} {class}: {mean:e}, expected {value:e} ± {allowed:e}"
        );
        assert!(
            allowed <= weakest * value,
            "{what} {class}: too weak, {allowed:e} of {value:e}"
        );
    }
}

const DIRECT: [PathClass; 2] = [PathClass::LDE, PathClass::LDSE];
const CAUSTIC: [PathClass; 2] = [PathClass::LSDE, PathClass::LSDSE];

#[test]
fn unregularized_classes_have_the_right_mean() {
    for scene in ["floor", "mirror-wall"] {
        let plain = Plain::load(scene);
        let direct = refined(
            plain.film_means(500, &|x| plain.direct(x)),
            plain.film_means(1000, &|x| plain.direct(x)),
        );
        let caustic = refined(
            plain.film_means(500, &|x| plain.caustic(x)),
            plain.film_means(1000, &|x| plain.caustic(x)),
        );
        let settings = Settings::default();
        for name in ["pt", "pt-reg"] {
            let found = replicate_means(name, &settings, &plain.entry, 100_000, 0.2);
            check(&format!("{scene} {name}"), &found, direct, DIRECT, 0.015);
        }
        let mut found = replicate_means("lt", &settings, &plain.entry, 2_000_000, 0.0);
        // What the mirror shows is not sampled: nothing may be there.
        for class in [DIRECT[1], CAUSTIC[1]] {
            assert!(found.iter().all(|f| f.0 != class || f.1 == 0.0));
            found.retain(|f| f.0 != class);
        }
        check(&format!("{scene} lt"), &found, direct, DIRECT, 0.015);
        check(&format!("{scene} lt"), &found, caustic, CAUSTIC, 0.015);
    }
}

#[test]
fn the_regularized_classes_have_the_mean_of_technique_camera() {
    let plain = Plain::load("mirror-wall");
    let alpha: f64 = 0.2;
    let kappa = 4.0 / (alpha * alpha);
    let vmf_norm = kappa / (core::f64::consts::TAU * (1.0 - libm::exp(-2.0 * kappa)));
    let vmf = |cos_g: f64| vmf_norm * libm::exp(kappa * (cos_g - 1.0));
    let cone_norm = 1.0 / (core::f64::consts::TAU * (1.0 - libm::cos(alpha)));
    let cone = |cos_g: f64| {
        if cos_g > libm::cos(alpha) {
            cone_norm
        } else {
            0.0
        }
    };
    type Case<'a> = (Kernel, &'a dyn Fn(f64) -> f64, [usize; 2]);
    let cases: [Case; 2] = [
        (Kernel::VonMisesFisher, &vmf, [16, 24]),
        (Kernel::Cone, &cone, [36, 52]),
    ];
    for (kernel, phi, mirror) in cases {
        let means =
            |film: usize, n: usize| plain.film_means(film, &|x| plain.camera_side(x, n, phi));
        let expected = refined(means(70, mirror[0]), means(100, mirror[1]));
        let settings = Settings {
            kernel: Some(kernel),
            fault: None,
            ..Settings::default()
        };
        let found = replicate_means("pt-reg", &settings, &plain.entry, 2_000_000, alpha);
        check(&format!("pt-reg {kernel}"), &found, expected, CAUSTIC, 0.05);
    }
}

#[test]
fn merging_has_the_mean_of_the_convolved_caustic() {
    let plain = Plain::load("mirror-wall");
    let r = 0.2;
    let means = |film: usize, n: usize| plain.film_means(film, &|x| plain.merged(x, r, n));
    let expected = refined(means(70, 10), means(100, 14));
    for (name, kernel) in [("pm", None), ("ppm", Some(Kernel::Disc))] {
        let settings = Settings {
            kernel,
            fault: None,
            ..Settings::default()
        };
        let found = replicate_means(name, &settings, &plain.entry, 200_000, r);
        check(name, &found, expected, CAUSTIC, 0.04);
    }
}
