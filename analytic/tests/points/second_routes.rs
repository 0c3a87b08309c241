//! Mirror and interface against a second route that shares no code with it: forward tracing with vectors in three dimensions, and finite
//! differences for the Jacobian. Parameters are drawn anew for each case, with a fixed seed.

use std::f64::consts::PI;

use crate::forward::{Cases, V, add, dot, jacobian, land, unit};
use libm::{acos, asin, cos, hypot, sin, sqrt, tan};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::planar_mirror::{PlanarMirror, Rectangle};
use nephroid_analytic::vector::vec3;

/// Vector product.
fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Snell's law for vectors, and the unpolarised reflectance in angles.
fn refract(d: V, n1: f64, n2: f64) -> Option<V> {
    let eta = n1 / n2;
    let up = if d[2] > 0.0 { 1.0 } else { -1.0 };
    let c = d[2] * up;
    let k = 1.0 - eta * eta * (1.0 - c * c);
    (k > 0.0).then(|| [eta * d[0], eta * d[1], up * sqrt(k)])
}

fn fresnel(d: V, n1: f64, n2: f64) -> f64 {
    let i = acos(d[2].abs());
    let s = n1 / n2 * sin(i);
    if s >= 1.0 {
        return 1.0;
    }
    let t = asin(s);
    let (rs, rp) = (sin(i - t) / sin(i + t), tan(i - t) / tan(i + t));
    0.5 * (rs * rs + rp * rp)
}

#[test]
fn flat_interface_in_all_directions() {
    let mut cases = Cases(3);
    for case in 0..200 {
        let surface = cases.uniform(-1.0, 2.0);
        let n = cases.uniform(1.05, 2.4);
        let side = |above: bool| if above { 1.0 } else { -1.0 };
        let (light_above, receiver_above) = (case % 2 == 0, case % 4 < 2);
        let light = [
            cases.uniform(-1.0, 1.0),
            cases.uniform(-1.0, 1.0),
            surface + side(light_above) * cases.uniform(0.1, 2.0),
        ];
        let receiver_z = surface + side(receiver_above) * cases.uniform(0.1, 2.0);
        let intensity = cases.uniform(0.5, 3.0);
        let water = FlatInterface {
            surface_z: surface,
            index: n,
            light: vec3(light[0], light[1], light[2]),
            intensity,
            receiver_z,
        };
        let (n1, n2) = if light_above { (1.0, n) } else { (n, 1.0) };
        let through = light_above != receiver_above;
        let follow = |d: V| -> Option<(V, f64)> {
            let s = add(light, d, (surface - light[2]) / d[2]);
            let f = fresnel(d, n1, n2);
            let (q, w) = if through {
                (refract(d, n1, n2)?, 1.0 - f)
            } else {
                ([d[0], d[1], -d[2]], f)
            };
            Some((add(s, q, (receiver_z - surface) / q[2]), w))
        };
        let toward = if light_above { -1.0 } else { 1.0 };
        // A direction at random: where it lands the closed form must find it again.
        let critical = if through && n1 > n2 {
            asin(n2 / n1)
        } else {
            0.5 * PI
        };
        let theta = cases.uniform(0.02, 0.95) * critical;
        let azimuth = cases.uniform(-PI, PI);
        let ray = |theta: f64, azimuth: f64| {
            [
                sin(theta) * cos(azimuth),
                sin(theta) * sin(azimuth),
                toward * cos(theta),
            ]
        };
        let (at, weight) = follow(ray(theta, azimuth)).expect("below the critical angle");
        let map = |t: f64, a: f64| follow(ray(t, a)).map(|(p, _)| [p[0], p[1]]);
        let det = jacobian(map, theta, azimuth, [1e-6 * critical, 1e-5]).expect("lands");
        let expected = intensity * weight * sin(theta) / det;
        let found = water.caustic(at[0], at[1]);
        assert!(
            (found.value - expected).abs() <= 1e-6 * expected,
            "case {case}: traced {expected}, closed form {found:?}"
        );
        let root = water.root(at[0], at[1]);
        assert!((root.ray_parameter - n1 * sin(theta)).abs() <= 1e-10);
        assert!((root.weight - weight).abs() <= 1e-9 * weight, "case {case}");
        let s = add(
            light,
            ray(theta, azimuth),
            (surface - light[2]) / (toward * cos(theta)),
        );
        assert!((root.specular_point.x - s[0]).abs() <= 1e-9 * (1.0 + s[0].abs()));
        assert!((root.specular_point.y - s[1]).abs() <= 1e-9 * (1.0 + s[1].abs()));
        // A camera at the light sees the same point, with the weight of the same ray.
        let aim = add(light, ray(theta, azimuth), 0.3);
        let seen = water
            .look(water.light, vec3(aim[0], aim[1], aim[2]))
            .expect("meets the surface");
        assert!((seen.receiver.x - at[0]).abs() <= 1e-9 * (1.0 + at[0].abs()));
        assert!((seen.receiver.y - at[1]).abs() <= 1e-9 * (1.0 + at[1].abs()));
        let factor = if through { (n1 / n2) * (n1 / n2) } else { 1.0 };
        assert!((seen.weight - weight * factor).abs() <= 1e-9 * seen.weight);
    }
}

#[test]
fn planar_mirror_by_two_segments() {
    let mut cases = Cases(4);
    let (mut lit, mut clipped) = (0, 0);
    for case in 0..400 {
        let normal = unit([
            cases.uniform(-1.0, 1.0),
            cases.uniform(-1.0, 1.0),
            cases.uniform(-0.7, 0.7),
        ]);
        let point = [
            cases.uniform(-1.0, 1.0),
            cases.uniform(-1.0, 1.0),
            cases.uniform(0.8, 2.0),
        ];
        let edge = unit(cross(normal, [0.3, -0.2, 0.9]));
        let other = cross(normal, edge);
        let (w, h) = (cases.uniform(0.3, 1.5), cases.uniform(0.2, 0.6));
        let in_plane = add(
            add(point, edge, cases.uniform(-1.5, 1.5)),
            other,
            cases.uniform(-0.6, 0.6),
        );
        let light = add(in_plane, normal, cases.uniform(0.2, 1.5));
        // A mirror point at random, inside the rectangle or not; the floor point it lights by the law of reflection.
        let (u, v) = (cases.uniform(-1.5, 1.5) * w, cases.uniform(-1.5, 1.5) * h);
        let s = add(add(point, edge, u), other, v);
        let follow = |target: V| -> Option<[f64; 2]> {
            let d = unit(add(target, light, -1.0));
            let hit = add(
                light,
                d,
                dot(add(point, light, -1.0), normal) / dot(d, normal),
            );
            let q = add(d, normal, -2.0 * dot(d, normal));
            (q[2] < 0.0 && hit[2] > 0.0).then(|| land((hit, q)))
        };
        let Some(x) = follow(s).filter(|x| hypot(x[0], x[1]) < 20.0) else {
            continue;
        };
        if light[2] < 0.05 {
            continue;
        }
        let (intensity, reflectance) = (cases.uniform(0.5, 3.0), cases.uniform(0.3, 1.0));
        let vector = |v: V| vec3(v[0], v[1], v[2]);
        let mirror = PlanarMirror::new(
            vector(light),
            intensity,
            reflectance,
            vector(point),
            vector(normal),
            Some(Rectangle {
                edge: vector(edge),
                other: vector(other),
                half_width: w,
                half_height: h,
            }),
        );
        let found = mirror.caustic(vec3(x[0], x[1], 0.0));
        if u.abs() > w || v.abs() > h {
            clipped += 1;
            assert_eq!(found.value, 0.0, "case {case}");
            continue;
        }
        lit += 1;
        let at = |u: f64, v: f64| add(add(point, edge, u), other, v);
        let det = jacobian(|u, v| follow(at(u, v)), u, v, [1e-5, 1e-5]).expect("lands");
        let d = add(s, light, -1.0);
        let squared = dot(d, d);
        let solid_angle = dot(d, normal).abs() / (squared * sqrt(squared));
        let expected = intensity * reflectance * solid_angle / det;
        assert!(
            (found.value - expected).abs() <= 2e-6 * expected,
            "case {case}: traced {expected}, closed form {found:?}"
        );
        let seen = mirror
            .look(mirror.light, vector(s), 0.0)
            .expect("meets the mirror");
        assert!(
            hypot(seen.floor.x - x[0], seen.floor.y - x[1]) <= 1e-9 * (1.0 + hypot(x[0], x[1]))
        );
    }
    assert!(lit > 50 && clipped > 50, "{lit} {clipped}");
}
