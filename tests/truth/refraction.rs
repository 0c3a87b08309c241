//! Entries with refraction: the closed form against rays of the renderer's own geometry, which shares no code with it.

use crate::gauss;

use glam::DVec3;
use nephroid::entry;
use nephroid::geometry::chains::Chains;
use nephroid::geometry::compiled::{Visitor, visit};
use nephroid::geometry::emission::Emitter;
use nephroid::geometry::light::Light;
use nephroid::geometry::scene::{Overrides, Scene};
use nephroid::geometry::specular::Specular;
use nephroid::truth;
use nephroid_analytic::camera::Film;
use nephroid_analytic::entries::{FloorTruth, State};
use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::scene::{Entry, Kind};

/// Where a photon of the unit square of emission lands by a chain, and its weight.
fn land<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    chain: usize,
    u: f64,
    v: f64,
) -> Option<[f64; 3]> {
    let targets = scene.surface.targets(chain, &scene.floor.hull());
    let (origin, direction) = scene.light.narrow(&targets, 10.0).ray(u, v);
    let leg = scene.surface.follow(chain, origin, direction);
    let t = -leg.origin.z / leg.direction.z;
    let at: DVec3 = leg.origin + leg.direction * t;
    (leg.weight > 0.0 && leg.direction.z < 0.0).then_some([at.x, at.y, leg.weight])
}

/// Irradiance at the landing point by this one photon's surroundings: flux per unit square over the Jacobian, by
/// differences of fourth order.
struct OneRoot<'a> {
    entry: &'a Entry,
    chain: usize,
    /// Photons along either axis of emission, and the step of the differences there.
    grid: u32,
    step: f64,
}

impl Visitor for OneRoot<'_> {
    /// Number of compared points and the largest relative difference.
    type Output = (usize, f64);

    fn furnace(self, _: nephroid::geometry::furnace::Furnace) -> Self::Output {
        unreachable!("nothing refracts in a furnace")
    }

    fn scene<L: Light, S: Specular>(self, _: Scene<L, S>) -> Self::Output {
        panic!("a kind with chains is expected")
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output {
        let truth = FloorTruth::new(self.entry).unwrap();
        let targets = scene.surface.targets(self.chain, &scene.floor.hull());
        let flux = scene.light.narrow(&targets, 10.0).flux();
        let (mut compared, mut worst) = (0, 0.0_f64);
        for k in 0..self.grid * self.grid {
            let at = |n: u32| (f64::from(n) + 0.5) / f64::from(self.grid);
            let (u, v, h) = (at(k % self.grid), at(k / self.grid), self.step);
            let stencil = |du: f64, dv: f64| land(&scene, self.chain, u + du * h, v + dv * h);
            // Next to a rim the map is no longer smooth on the scale of the differences.
            let inside = [(150.0, 0.0), (-150.0, 0.0), (0.0, 150.0), (0.0, -150.0)]
                .iter()
                .all(|&(du, dv)| stencil(du, dv).is_some());
            if !inside {
                continue;
            }
            let difference = |along: &dyn Fn(f64) -> Option<[f64; 3]>| -> Option<[f64; 2]> {
                let (a, b, c, d) = (along(1.0)?, along(-1.0)?, along(2.0)?, along(-2.0)?);
                Some([0, 1].map(|i| (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h)))
            };
            let (Some([x, y, weight]), Some(by_u), Some(by_v)) = (
                stencil(0.0, 0.0),
                difference(&|s| stencil(s, 0.0)),
                difference(&|s| stencil(0.0, s)),
            ) else {
                continue;
            };
            if !truth.is_on_floor(x, y) {
                continue;
            }
            let determinant = by_u[0] * by_v[1] - by_u[1] * by_v[0];
            let expected = flux * weight / determinant.abs();
            let found = truth.at(x, y)[self.chain];
            let near = truth
                .singularity(x, y, self.chain)
                .is_some_and(|s| s.distance < 0.03);
            let found = found.irradiance;
            if found.roots != 1 || near {
                continue;
            }
            worst = worst.max((found.value / expected - 1.0).abs());
            compared += 1;
        }
        (compared, worst)
    }
}

/// Differences of fourth order with a step of 1e-4 leave less than 1e-8 where the map is as smooth as here; of a ball's
/// rim, which reflects to the floor, a narrow ring is left.
#[test]
fn where_there_is_one_root_it_is_what_its_ray_says() {
    for (name, chain, grid, step, at_least) in [
        ("underwater", 0, 30, 1e-4, 200),
        ("slab", 0, 30, 1e-4, 200),
        ("slab", 1, 30, 1e-4, 200),
        ("glass-ball", 0, 20, 1e-4, 150),
        ("glass-ball", 1, 60, 1e-5, 30),
        ("glass-ball", 2, 40, 1e-5, 100),
        ("glass-ball", 3, 40, 1e-5, 20),
        ("ripple-pool", 0, 15, 1e-4, 50),
        ("lens", 0, 30, 1e-4, 300),
    ] {
        let entry = entry::load(name).unwrap();
        let one = OneRoot {
            entry: &entry,
            chain,
            grid,
            step,
        };
        let (compared, worst) = visit(&entry, Overrides::default(), one);
        assert!(compared >= at_least, "{name} {chain}: {compared}");
        assert!(worst <= 1e-7, "{name} {chain}: {worst:e}");
    }
}

/// Away from singularities, ridges and edges a pixel is the mean of the closed form over it: Gauss's rule with 6 × 6 points.
#[test]
fn smooth_pixels_are_means_of_point_values() {
    let nodes = gauss::rule(6);
    for (name, size, every, at_least) in [
        ("underwater", 20, 1, 200),
        ("glass-ball", 20, 1, 200),
        ("ripple-pool", 60, 31, 12),
        ("lens", 20, 1, 60),
    ] {
        let mut scene = entry::load(name).unwrap();
        (scene.camera.width, scene.camera.height) = (size, size);
        let image = truth::image(&scene, 1e-9);
        let truth = FloorTruth::new(&scene).unwrap();
        let film = Film::new(&scene.camera);
        let floor_point = |u: f64, v: f64| {
            let d = film.direction(u, v);
            let q = film.position + d * (-film.position.z / d.z);
            [q.x, q.y]
        };
        let mut compared = 0;
        for p in (0..size * size).step_by(every) {
            let (i, j) = (f64::from(p % size), f64::from(p / size));
            let [x, y] = floor_point(i + 0.5, j + 0.5);
            let far = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(a, b)| {
                let [cx, cy] = floor_point(i + a, j + b);
                libm::hypot(cx - x, cy - y)
            });
            let extent = far.into_iter().fold(0.0, f64::max);
            let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5)];
            let on_floor = corners.iter().all(|&(a, b)| {
                let [x, y] = floor_point(i + 2.0 * a - 0.5, j + 2.0 * b - 0.5);
                truth.is_on_floor(x, y)
            });
            let middle = truth.at(x, y);
            let smooth = |class: usize| {
                let here = middle[class].irradiance;
                let away = truth
                    .singularity(x, y, class)
                    .is_none_or(|s| s.distance > 4.0 * extent);
                away && corners.iter().all(|&(a, b)| {
                    let [x, y] = floor_point(i + 1.4 * a - 0.2, j + 1.4 * b - 0.2);
                    let there = truth.at(x, y)[class].irradiance;
                    // A ridge that almost folds is too sharp for the rule.
                    let flat = (there.value - here.value).abs() <= 0.2 * here.value;
                    here.roots == there.roots && flat
                })
            };
            if !on_floor {
                continue;
            }
            for class in (0..middle.len()).filter(|&class| smooth(class)) {
                let mut mean = 0.0;
                for &(u, wu) in nodes {
                    for &(v, wv) in nodes {
                        let [x, y] = floor_point(i + u, j + v);
                        mean += wu * wv * truth.at(x, y)[class].irradiance.value;
                    }
                }
                mean *= truth.albedo() / core::f64::consts::PI;
                let found = image.layers[class][p as usize];
                assert!(
                    (found - mean).abs() <= 2e-6 * mean.abs() + image.errors[class][p as usize],
                    "{name} {} ({i}, {j}): {found} {mean}",
                    image.classes[class]
                );
                compared += 1;
            }
        }
        assert!(compared >= at_least, "{name}: {compared}");
    }
}

/// With one internal reflection no ray of a ball of an accepted index comes down.
#[test]
fn no_light_comes_down_after_one_internal_reflection() {
    for index in [1.15, 1.2, 1.36, 1.7, 2.0, 2.5] {
        let ball = GlassSphere {
            index,
            radius: 0.8,
            irradiance: 1.3,
            receiver_z: 1.2,
            max_incidence: core::f64::consts::FRAC_PI_2,
        };
        for k in 0..=2000 {
            let incidence = core::f64::consts::FRAC_PI_2 * f64::from(k) / 2000.0;
            assert!(
                ball.landing_of(incidence, 3).cosine < 0.0,
                "{index} {incidence}"
            );
        }
    }
}

/// All light of the aperture comes to the floor, and in the focus to one point of it: the configuration is degenerate.
#[test]
fn a_lens_with_its_focus_on_the_floor_is_reported_as_stigmatic() {
    let text = include_str!("../../scenes/lens.toml");
    let mut scene = entry::load("lens").unwrap();
    // The whole floor, from straight above, in one pixel.
    let whole = |scene: &mut Entry| {
        scene.camera = nephroid_analytic::scene::Camera {
            position: [0.0, 0.0, 0.2],
            look_at: [0.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            field_of_view_degrees: 150.0,
            width: 1,
            height: 1,
        };
        let image = truth::image(scene, 1e-9);
        image.layers[0][0]
    };
    let Kind::StigmaticRefractors(s) = &mut scene.kind else {
        panic!("the lens is a lens");
    };
    s.lens.center = [0.03, 0.02];
    let [near, focus] = [0.2, 0.0].map(|defocus| {
        let Kind::StigmaticRefractors(s) = &mut scene.kind else {
            panic!("the lens is a lens");
        };
        s.lens.defocus = defocus;
        whole(&mut scene)
    });
    // Seen along the axis all floor counts alike: the mean is the flux, wherever it lands in the frame.
    assert!((near - focus).abs() <= 1e-8 * near, "{near} {focus}");
    let Kind::StigmaticRefractors(s) = &scene.kind else {
        panic!("the lens is a lens");
    };
    let (n, rim) = (s.lens.index, s.lens.rim_z() * s.lens.aperture());
    let frame = 0.4 * libm::tan(75.0_f64.to_radians());
    let passed = near * frame * frame / s.floor.albedo / (s.light.irradiance * rim * rim);
    // All that falls on the aperture, but for what is reflected: least of all in the middle.
    let most = 4.0 * n / ((n + 1.0) * (n + 1.0));
    assert!(passed < most && passed > 0.9 * most, "{passed} {most}");
    let truth = FloorTruth::new(&scene).unwrap();
    let at = truth.at(0.03, 0.02)[0];
    assert_eq!(truth.state(0.03, 0.02, 0, &at), State::Degenerate);
    let singularity = truth.singularity(0.03, 0.02, 0).unwrap();
    assert_eq!(
        (singularity.kind, singularity.distance),
        (SingularityKind::PointFocus, 0.0)
    );
    let beside = truth.at(0.2, 0.1)[0];
    assert_eq!((beside.irradiance.value, beside.irradiance.roots), (0.0, 0));
    assert!(entry::from_toml("mine.toml", text).is_ok());
}

/// What leaves the range in which closed form and closure hold is refused by name.
#[test]
fn ranges_of_the_refracting_kinds_are_checked() {
    for (name, from, to, parts) in [
        (
            "underwater",
            "[-1.5, -2.1, 1.35]",
            "[-1.5, -2.1, 1.65]",
            ["camera.position", "1.6"],
        ),
        (
            "underwater",
            "[0.0, -0.25, 0.0]",
            "[0.0, -0.25, 1.3]",
            ["camera.look_at", "horizon"],
        ),
        (
            "underwater",
            "[0.35, 0.25, 2.1]",
            "[0.35, 0.25, 1.5]",
            ["light.position", "1.6"],
        ),
        (
            "glass-ball",
            "index = 1.36",
            "index = 1.1",
            ["glass.index", "1.15"],
        ),
        (
            "glass-ball",
            "radius = 0.8",
            "radius = 1.3",
            ["glass.center", "greater than 1.3"],
        ),
        (
            "glass-ball",
            "[0.1, 0.15, 1.2]",
            "[0.1, 0.15, 0.9]",
            ["camera.look_at", "glass ball"],
        ),
        (
            "ripple-pool",
            "amplitude = 0.016",
            "amplitude = 0.06",
            ["waves", "0.577"],
        ),
        (
            "ripple-pool",
            "surface_z = 1.85",
            "surface_z = 0.01",
            ["water.surface_z", "trough"],
        ),
        (
            "ripple-pool",
            "-1.75, 1.6]",
            "-1.75, 1.84]",
            ["camera.position", "z less than"],
        ),
        (
            "lens",
            "half_angle_degrees = 42.0",
            "half_angle_degrees = 49.0",
            ["lens.half_angle_degrees", "at most 48"],
        ),
        (
            "lens",
            "defocus = 0.63",
            "defocus = -0.8",
            ["lens.defocus", "rim"],
        ),
        ("lens", "index = 1.52", "index = nan", ["lens.index", "NaN"]),
    ] {
        let text = std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap();
        let changed = text.replacen(from, to, 1);
        assert_ne!(text, changed, "{name}: {from} must occur");
        let error = entry::from_toml("mine.toml", &changed).expect_err("out of range");
        let help = miette::Diagnostic::help(&error).map(|h| h.to_string());
        let complaint = format!("{error} | {}", help.unwrap_or_default());
        for part in parts {
            assert!(
                complaint.contains(part),
                "`{part}` is missing in: {complaint}"
            );
        }
    }
}
