//! The furnace: the wall's closed form against flux, pixels against ray casting, and the remainder of the series.

use crate::gauss;

use std::f64::consts::PI;

use nephroid::{entry, truth};
use nephroid_analytic::entries::{FloorTruth, WallTruth};
use nephroid_analytic::scene::{Entry, FurnaceScene, Kind};
use nephroid_analytic::vector::{Vec3, vec3};

fn furnace() -> (Entry, FurnaceScene) {
    let entry = entry::load("furnace").unwrap();
    let Kind::Furnace(scene) = entry.kind.clone() else {
        panic!("the furnace is a furnace");
    };
    (entry, scene)
}

/// The direct light adds up to 4π I over the wall, wherever the light is.
#[test]
fn the_wall_takes_all_the_light() {
    let (mut entry, scene) = furnace();
    for shift in [0.0, 0.4, 0.9, 1.3] {
        let [x, y, z] = scene.wall.center;
        let Kind::Furnace(s) = &mut entry.kind else {
            panic!("the furnace is a furnace");
        };
        s.light.position = [x + 0.6 * shift, y, z - 0.8 * shift];
        let wall = WallTruth::new(&entry).unwrap();
        // Archimedes: area is uniform in the height along any axis; about the light's own the trapezoid rule is exact in
        // the angle, and there is nothing to sum. About another axis neither holds.
        let (n, m) = (4000, 160);
        let mut sum = 0.0;
        for i in 0..n {
            let h = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
            let r = libm::sqrt(1.0 - h * h);
            for k in 0..m {
                let phi = 2.0 * PI * f64::from(k) / f64::from(m);
                let direction = vec3(r * libm::cos(phi), r * libm::sin(phi), h);
                sum += wall.at(direction)[0].irradiance.value;
            }
        }
        let area = 4.0 * PI * scene.wall.radius * scene.wall.radius;
        let flux = sum * area / f64::from(n * m);
        let off = flux / (4.0 * PI * scene.light.intensity) - 1.0;
        assert!(off.abs() < 2e-5, "{shift}: {off:e}");
    }
}

/// Without absorption in between, what bounce k takes is ρ times what bounce k - 1 took; all bounces add up to ρ/(1 - ρ).
#[test]
fn classes_and_remainder_add_up_to_the_series() {
    let (entry, scene) = furnace();
    let wall = WallTruth::new(&entry).unwrap();
    let at = wall.at(vec3(0.3, -0.5, 0.2));
    let names: Vec<_> = at.iter().map(|t| t.class.to_string()).collect();
    assert_eq!(names, ["LDE", "LDDE", "LDDDE", "LDDDDE"]);
    let (a, rho) = (scene.wall.radius, scene.wall.albedo);
    let bounced: f64 = at[1..].iter().map(|t| t.irradiance.value).sum();
    let all = rho / (1.0 - rho) * scene.light.intensity / (a * a);
    let off = (bounced + scene.remainder()) / all - 1.0;
    assert!(off.abs() < 1e-14, "{off:e}");
    assert!(FloorTruth::new(&entry).is_none());
}

/// A light at the centre makes every pixel of every class the same, ρ^k I/(π a²), exactly.
#[test]
fn a_light_at_the_centre_leaves_no_contrast() {
    let (mut entry, scene) = furnace();
    let Kind::Furnace(s) = &mut entry.kind else {
        panic!("the furnace is a furnace");
    };
    s.light.position = scene.wall.center;
    (entry.camera.width, entry.camera.height) = (17, 9);
    let image = truth::image(&entry, 1e-6);
    let (a, rho) = (scene.wall.radius, scene.wall.albedo);
    let mut expected = scene.light.intensity / (PI * a * a);
    for layer in &image.layers {
        expected *= rho;
        assert!(
            layer
                .iter()
                .all(|v| (v / expected - 1.0).abs() < 1e-15 * 4.0)
        );
    }
}

/// Direct light of pixels against cast rays: the wall point by bisection along the ray, I cos θ/d² there, 4 × 4 Gauss points.
#[test]
fn direct_pixels_are_the_means_of_cast_rays() {
    let (entry, scene) = furnace();
    let image = truth::image(&entry, 1e-10);
    let film = nephroid_analytic::camera::Film::new(&entry.camera);
    let (centre, light) = (
        Vec3::from_f64(scene.wall.center),
        Vec3::from_f64(scene.light.position),
    );
    let radiance = |u: f64, v: f64| {
        let d = film.direction(u, v).normalized();
        let (mut low, mut high) = (0.0, 4.0 * scene.wall.radius);
        for _ in 0..80 {
            let t = 0.5 * (low + high);
            if (film.position + d * t - centre).length() < scene.wall.radius {
                low = t;
            } else {
                high = t;
            }
        }
        let x = film.position + d * low;
        let inwards = (centre - x).normalized();
        let to_light = light - x;
        let squared = to_light.length_squared();
        let irradiance = scene.light.intensity * inwards.dot(to_light.normalized()) / squared;
        scene.wall.albedo / PI * irradiance
    };
    let gauss = gauss::rule(4);
    for (i, j) in [(0, 0), (127, 3), (64, 64), (31, 101), (127, 127)] {
        let mut mean = 0.0;
        for &(s, ws) in gauss {
            for &(t, wt) in gauss {
                mean += ws * wt * radiance(f64::from(i) + s, f64::from(j) + t);
            }
        }
        let found = image.layers[0][(j * 128 + i) as usize];
        let off = found / mean - 1.0;
        assert!(off.abs() < 1e-12, "({i}, {j}): {off:e}");
    }
}
