//! Paraboloid, conic mirrors and stigmatic refractors against traced light.

use nephroid_analytic::kinds::conic_mirrors::{Ellipsoid, Hyperboloid};
use nephroid_analytic::kinds::paraboloid::{Light, Paraboloid};
use nephroid_analytic::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use nephroid_analytic::vector::Vec3;

use crate::tracing::{
    Random, V, add, determinant, dot, frame, meet, mirror, normal, refract, to_plane, unit,
};

/// Traces light that meets the surface near `at` on to the plane, and compares landing point and flux density with the
/// answer. `launch` gives the ray for two parameters around the one through `at`, `strength` its flux per parameter area.
fn compare(
    name: &str,
    target: [f64; 2],
    answer: f64,
    strength: f64,
    launch: impl Fn(f64, f64) -> (V, V),
    surface: impl Fn(V) -> f64,
    span: (f64, f64),
    bend: impl Fn(V, V) -> (V, f64),
    plane: f64,
) {
    let trace = |u: f64, v: f64| {
        let (from, d) = launch(u, v);
        let hit = meet(&surface, from, d, span.0, span.1)?;
        let mut n = normal(&surface, hit);
        if dot(n, d) > 0.0 {
            n = n.map(|c| -c);
        }
        let (out, weight) = bend(d, n);
        to_plane(hit, out, plane).map(|p| (p, weight))
    };
    let (landed, weight) = trace(0.0, 0.0).expect("the ray lands");
    let off = libm::hypot(landed[0] - target[0], landed[1] - target[1]);
    assert!(off < 1e-9, "{name}: lands {off:e} off");
    let area = determinant(|u, v| trace(u, v).map(|(p, _)| p), 2e-4).expect("a map");
    let traced = strength * weight / area;
    let difference = (traced / answer - 1.0).abs();
    assert!(
        difference < 1e-6,
        "{name}: traced {traced:e}, answer {answer:e}, {difference:e}"
    );
}

/// Directions around the one from `light` to `at`: flux per parameter area is the intensity, to second order.
fn from_point(light: V, at: Vec3<f64>) -> impl Fn(f64, f64) -> (V, V) {
    let axis = unit(add(at.to_f64(), light, -1.0));
    let (e, f) = frame(axis);
    move |u, v| (light, unit(add(add(axis, e, u), f, v)))
}

/// Parallel rays along -z through points around `at`.
fn from_above(at: Vec3<f64>, height: f64) -> impl Fn(f64, f64) -> (V, V) {
    move |u, v| ([at.x + u, at.y + v, height], [0.0, 0.0, -1.0])
}

#[test]
fn paraboloid() {
    let mut r = Random(1);
    let mut lit = 0;
    for _ in 0..60 {
        let f = r.between(0.4, 2.0);
        let to_focus = r.between(0.0, 1.0) < 0.5;
        let strength = r.between(0.5, 3.0);
        let dish = Paraboloid {
            focal_length: f,
            reflectance: r.between(0.3, 0.95),
            light: if to_focus {
                Light::Beam(strength)
            } else {
                Light::Focus(strength)
            },
            receiver_z: r.between(0.2, 1.8) * f,
            inner_radius: 0.0,
            outer_radius: 4.0,
        };
        let target = [r.between(-0.5, 0.5) * f, r.between(-0.5, 0.5) * f];
        let Some(root) = dish.reflection(target[0], target[1]) else {
            continue;
        };
        lit += 1;
        let surface = |p: V| p[2] - (p[0] * p[0] + p[1] * p[1]) / (4.0 * f);
        let bend = |d: V, n: V| (mirror(d, n), dish.reflectance);
        let (at, c) = (root.specular_point, dish.receiver_z);
        let e = root.irradiance;
        if to_focus {
            let launch = from_above(at, 5.0);
            compare(
                "beam",
                target,
                e,
                strength,
                launch,
                surface,
                (0.0, 6.0),
                bend,
                c,
            );
        } else {
            let launch = from_point([0.0, 0.0, f], at);
            compare(
                "focus",
                target,
                e,
                strength,
                launch,
                surface,
                (0.0, 9.0),
                bend,
                c,
            );
        }
    }
    assert!(lit > 30, "{lit}");
}

#[test]
fn silver_ends_where_it_should() {
    let dish = Paraboloid {
        focal_length: 1.0,
        reflectance: 0.9,
        light: Light::Beam(2.0),
        receiver_z: 1.2,
        inner_radius: 1.0,
        outer_radius: 1.6,
    };
    // Theory block H: lit from 4/15 to 8/9.
    for (x, lit) in [(0.2666, 0), (0.2667, 1), (0.8888, 1), (0.8889, 0)] {
        assert_eq!(dish.caustic(x, 0.0).roots, lit, "{x}");
    }
    // On the edge rounding decides: the bound says so.
    let edge = dish.caustic(0.0, 8.0 / 9.0);
    assert!(edge.error > 0.5, "{edge:?}");
    let focus = Paraboloid {
        receiver_z: 1.0,
        ..dish
    };
    assert!(focus.caustic(0.0, 0.0).value == f64::INFINITY);
    assert_eq!(focus.caustic(0.3, 0.0).roots, 0);
    // A receiver below the focus is lit before the light crosses; above the mirror only.
    let low = Paraboloid {
        receiver_z: 0.5,
        ..dish
    };
    let root = low.reflection(0.6, 0.0).expect("lit");
    assert!(root.specular_point.x > 0.0);
    let under = Paraboloid {
        receiver_z: -0.1,
        ..dish
    };
    assert!(under.reflection(0.6, 0.0).is_none());
}

#[test]
fn ellipsoid() {
    let mut r = Random(2);
    for _ in 0..60 {
        let (a, e) = (r.between(0.5, 2.0), r.between(0.05, 0.8));
        let mirrored = Ellipsoid {
            semi_axis: a,
            eccentricity: e,
            defocus: r.between(-0.3, 0.5) * a,
            intensity: r.between(0.5, 3.0),
            reflectance: r.between(0.3, 0.95),
        };
        let g = mirrored.defocus.abs();
        let target = [r.between(-1.5, 1.5) * g, r.between(-1.5, 1.5) * g];
        let root = mirrored.reflection(target[0], target[1]).expect("a root");
        if root.leg <= 0.0 || root.specular_point.z > a * e {
            continue;
        }
        let b2 = a * a * (1.0 - e * e);
        let surface = |p: V| 1.0 - (p[0] * p[0] + p[1] * p[1]) / b2 - p[2] * p[2] / (a * a);
        compare(
            "ellipsoid",
            target,
            root.irradiance,
            mirrored.intensity,
            from_point([0.0, 0.0, -a * e], root.specular_point),
            surface,
            (0.0, 2.5 * a),
            |d, n| (mirror(d, n), mirrored.reflectance),
            mirrored.receiver_z(),
        );
        // Direct light by distance and cosine.
        let direct = mirrored.direct(target[0], target[1]);
        let h = 2.0 * a * e + mirrored.defocus;
        let d = libm::hypot(libm::hypot(target[0], target[1]), h);
        let expected = if h > 0.0 {
            mirrored.intensity * h / (d * d * d)
        } else {
            0.0
        };
        assert!((direct.value - expected).abs() <= 1e-13 * (1.0 + expected));
    }
}

#[test]
fn hyperboloid() {
    let mut r = Random(3);
    for _ in 0..60 {
        let (a, e) = (r.between(0.3, 1.0), r.between(1.1, 3.0));
        let mirrored = Hyperboloid {
            semi_axis: a,
            eccentricity: e,
            receiver_z: r.between(-0.5, 2.0) * a,
            intensity: r.between(0.5, 3.0),
            reflectance: r.between(0.3, 0.95),
        };
        let target = [r.between(-2.0, 2.0), r.between(-2.0, 2.0)];
        let root = mirrored.reflection(target[0], target[1]).expect("a root");
        if root.leg <= 0.0 {
            continue;
        }
        let b2 = a * a * (e * e - 1.0);
        let surface = |p: V| p[2] + a * (1.0 + (p[0] * p[0] + p[1] * p[1]) / b2).sqrt();
        compare(
            "hyperboloid",
            target,
            root.irradiance,
            mirrored.intensity,
            from_point([0.0, 0.0, a * e], root.specular_point),
            surface,
            (0.0, 20.0),
            |d, n| (mirror(d, n), mirrored.reflectance),
            mirrored.receiver_z,
        );
    }
}

#[test]
fn stigmatic_ellipsoid() {
    let mut r = Random(4);
    let mut lit = 0;
    for _ in 0..60 {
        let (n, a, e0) = (
            r.between(1.1, 2.2),
            r.between(0.5, 2.0),
            r.between(0.5, 3.0),
        );
        let lens = StigmaticRefractor {
            index: n,
            front: Front::Ellipsoid {
                semi_axis: a,
                irradiance: e0,
            },
            defocus: r.between(-0.3, 0.5) * a,
        };
        let g = lens.defocus.abs();
        let target = [r.between(-0.8, 0.8) * g, r.between(-0.8, 0.8) * g];
        let Some(root) = lens.refraction(target[0], target[1]) else {
            continue;
        };
        // Near the rim the light of neighbouring parameters misses the front.
        if root.leg <= 0.0 || root.transmittance < 0.6 {
            continue;
        }
        lit += 1;
        let e = 1.0 / n;
        let b2 = a * a * (1.0 - e * e);
        let surface = |p: V| {
            let z = p[2] - a * e;
            (p[0] * p[0] + p[1] * p[1]) / b2 + z * z / (a * a) - 1.0
        };
        // From just above the entry point, inside the beam: only the front sheet is met.
        let height = root.specular_point.z + 0.3 * a;
        compare(
            "stigmatic ellipsoid",
            target,
            root.irradiance,
            e0,
            from_above(root.specular_point, height),
            surface,
            (0.0, 0.6 * a),
            |d, normal| refract(d, normal, n),
            -lens.defocus,
        );
    }
    assert!(lit > 25, "{lit}");
}

#[test]
fn cartesian_oval() {
    let mut r = Random(5);
    let mut lit = 0;
    for _ in 0..60 {
        let (n, d) = (r.between(1.2, 2.0), r.between(0.8, 3.0));
        let c = d * (1.0 + (n - 1.0) * r.between(0.2, 0.7));
        let lens = StigmaticRefractor {
            index: n,
            front: Front::Oval {
                light_z: d,
                optical_length: c,
                intensity: 1.7,
            },
            defocus: r.between(-0.1, 0.3) * d,
        };
        let g = lens.defocus.abs();
        let target = [r.between(-0.3, 0.3) * g, r.between(-0.3, 0.3) * g];
        let Some(root) = lens.refraction(target[0], target[1]) else {
            continue;
        };
        // Near the rim the light of neighbouring parameters misses the front.
        if root.leg <= 0.0 || root.transmittance < 0.6 {
            continue;
        }
        lit += 1;
        let light = [0.0, 0.0, d];
        let surface = |p: V| {
            let q = add(p, light, -1.0);
            dot(q, q).sqrt() + n * dot(p, p).sqrt() - c
        };
        compare(
            "oval",
            target,
            root.irradiance,
            1.7,
            from_point(light, root.specular_point),
            surface,
            (0.0, 0.99 * d),
            |ray, normal| refract(ray, normal, n),
            -lens.defocus,
        );
    }
    assert!(lit > 25, "{lit}");
}
