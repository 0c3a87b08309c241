//! Energy: the integral of each caustic over its receiver is the flux that was sent there.
//!
//! The left side is a quadrature of the irradiance over the floor; the right side counts the light where it leaves, and
//! knows nothing of Jacobians. 1e-9 where no fold is cut, 1e-6 across folds.

use std::f64::consts::PI;

use libm::{asin, atan, cos, sin, tan};
use nephroid_analytic::kinds::diffuse::{Sphere, direct};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::planar_mirror::{PlanarMirror, Rectangle};
use nephroid_analytic::quadrature::{gauss_legendre, integrate, integrate_between_folds};
use nephroid_analytic::vector::{Vec3, vec3};

fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let difference = (found / expected - 1.0).abs();
    println!("{what}: {found} of {expected}, relative difference {difference:.1e}");
    assert!(
        difference <= tolerance,
        "{what}: {found} of {expected}, {difference:e}"
    );
}

/// ∫ E dA of a radially symmetric irradiance over the whole plane, with r = scale tan(t)
fn over_plane(e: impl Fn(f64) -> f64, scale: f64, split: f64) -> f64 {
    let f = |t: f64| {
        let r = scale * tan(t);
        let c = cos(t);
        2.0 * PI * e(r) * r * scale / (c * c)
    };
    let kink = atan(split / scale);
    let end = 0.5 * PI - 1e-13;
    integrate_between_folds(f, 0.0, kink, 1e-12).value
        + integrate_between_folds(f, kink, end, 1e-12).value
}

#[test]
fn floor_and_sphere() {
    let light = vec3(0.0, 0.0, 1.3);
    let e = |r: f64| direct(light, 5.2, vec3(r, 0.0, 0.0)).value;
    assert_close("floor", over_plane(e, 1.3, 1.3), 2.0 * PI * 5.2, 1e-9);
    let sphere = Sphere {
        radius: 1.7,
        offset: 0.6,
        intensity: 2.5,
        albedo: 0.6,
    };
    let flux = integrate(|c| sphere.direct(c).value, -1.0, 1.0, 1e-13).value * 2.0 * PI * 1.7 * 1.7;
    assert_close("sphere", flux, 4.0 * PI * 2.5, 1e-12);
    // What the walls absorb in the end is what the light sends: (1 - ρ) E_mean 4π a² = 4π I.
    let all = (sphere.indirect().value * 4.0 * PI * 1.7 * 1.7 + flux) * (1.0 - 0.6);
    assert_close("sphere, all bounces", all, 4.0 * PI * 2.5, 1e-12);
}

fn water(light_z: f64, receiver_z: f64) -> FlatInterface<f64> {
    FlatInterface {
        surface_z: 1.1,
        index: 1.333,
        light: vec3(0.0, 0.0, light_z),
        intensity: 6.5,
        receiver_z,
    }
}

/// Flux through, or off, the surface by a light in a medium of index n1: 2π I ∫ (T or F) sin θ dθ, Fresnel in angles.
fn fresnel_flux(intensity: f64, n1: f64, n2: f64, through: bool) -> f64 {
    let weight = |i: f64| {
        let s = n1 / n2 * sin(i);
        if s >= 1.0 {
            return if through { 0.0 } else { 1.0 };
        }
        let t = asin(s);
        let f = if i < 1e-7 {
            ((n1 - n2) / (n1 + n2)) * ((n1 - n2) / (n1 + n2))
        } else {
            let (rs, rp) = (sin(i - t) / sin(i + t), tan(i - t) / tan(i + t));
            0.5 * (rs * rs + rp * rp)
        };
        if through { 1.0 - f } else { f }
    };
    let critical = if n1 > n2 { asin(n2 / n1) } else { 0.25 * PI };
    let f = |i: f64| 2.0 * PI * intensity * weight(i) * sin(i);
    integrate_between_folds(f, 0.0, critical, 1e-13).value
        + integrate_between_folds(f, critical, 0.5 * PI, 1e-13).value
}

#[test]
fn interface_in_all_directions() {
    for (name, light_z, receiver_z) in [
        ("air to water", 1.9, 0.0),
        ("water to water", 0.7, 0.0),
        ("water to air", 0.7, 1.6),
        ("air to air", 1.9, 1.6),
    ] {
        let w = water(light_z, receiver_z);
        let (n1, n2) = if light_z > 1.1 {
            (1.0, 1.333)
        } else {
            (1.333, 1.0)
        };
        let expected = fresnel_flux(6.5, n1, n2, w.is_refracted());
        let kink = w.distance_to_kink(0.0, 0.0).unwrap_or(1.0);
        let found = over_plane(|r| w.caustic(r, 0.0).value, 1.0, kink);
        assert_close(name, found, expected, 1e-9);
    }
}

/// Solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
fn triangle(a: Vec3<f64>, b: Vec3<f64>, c: Vec3<f64>) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let top = a.dot(b.cross(c)).abs();
    let bottom = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * libm::atan2(top, bottom)
}

#[test]
fn rectangle_mirrors() {
    for (normal, point) in [
        (vec3(0.0, -1.0, 0.0), vec3(0.0, 1.0, 0.625)),
        (vec3(-0.8, 0.1, -0.6), vec3(1.2, 0.2, 1.0)),
    ] {
        let normal = normal.normalized();
        let edge = vec3(normal.y, -normal.x, 0.0).normalized();
        let (other, w, h) = (normal.cross(edge), 0.75, 0.3);
        let light = vec3(0.25, 0.0, 2.0);
        let mirror = PlanarMirror::new(
            light,
            1.7,
            0.9,
            point,
            normal,
            Some(Rectangle {
                edge,
                other,
                half_width: w,
                half_height: h,
            }),
        );
        let corner = |s: f64, t: f64| point + edge * (s * w) + other * (t * h);
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let [a, b, c, d] = corners.map(|c| c - light);
        let expected = 0.9 * 1.7 * (triangle(a, b, c) + triangle(a, c, d));
        // The quadrilateral that the reflected cone cuts out of the floor, from reflected rays.
        let foot = corners.map(|c| {
            let ray = c - light;
            let ray = ray - normal * (2.0 * ray.dot(normal));
            assert!(ray.z < 0.0);
            c + ray * (c.z / -ray.z)
        });
        let rule = gauss_legendre(48);
        let mut found = 0.0;
        for &(s, ws) in &rule {
            for &(t, wt) in &rule {
                let (s, t) = (0.5 + 0.5 * s, 0.5 + 0.5 * t);
                let low = foot[0] * (1.0 - s) + foot[1] * s;
                let high = foot[3] * (1.0 - s) + foot[2] * s;
                let along = (foot[1] - foot[0]) * (1.0 - t) + (foot[2] - foot[3]) * t;
                let area = along.cross(high - low).length();
                let x = low * (1.0 - t) + high * t;
                found += 0.25 * ws * wt * area * mirror.caustic(vec3(x.x, x.y, 0.0)).value;
            }
        }
        assert_close("rectangle", found, expected, 1e-9);
    }
}
