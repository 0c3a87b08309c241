//! Every closed form against a second route that shares no code with it: forward tracing with vectors in three
//! dimensions, and finite differences for the Jacobian. Parameters are drawn anew for each case, with a fixed seed.

use std::f64::consts::PI;

use libm::{acos, asin, atan, cos, hypot, sin, sqrt, tan};
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall};
use nephroid_analytic::kinds::flat_interface::FlatInterface;
use nephroid_analytic::kinds::planar_mirror::{PlanarMirror, Rectangle};
use nephroid_analytic::vector::vec3;

type V = [f64; 3];

fn add(a: V, b: V, k: f64) -> V {
    [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]]
}

fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn unit(a: V) -> V {
    let l = sqrt(dot(a, a));
    a.map(|c| c / l)
}

/// Uniform numbers from SplitMix64 (Steele, Lea & Flood 2014): enough to choose test cases.
struct Cases(u64);

impl Cases {
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let u = ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64;
        low + (high - low) * u
    }
}

/// The last leg of a ray that has been reflected `bounces` times inside a cylinder of radius a: start and direction, or
/// nothing if it reaches the floor earlier.
fn trace(mut p: V, mut d: V, a: f64, bounces: u32) -> Option<(V, V)> {
    for _ in 0..bounces {
        // The far intersection with the cylinder.
        let (qa, qb) = (d[0] * d[0] + d[1] * d[1], p[0] * d[0] + p[1] * d[1]);
        let qc = p[0] * p[0] + p[1] * p[1] - a * a;
        let t = (-qb + sqrt((qb * qb - qa * qc).max(0.0))) / qa;
        p = add(p, d, t);
        let n = [-p[0] / a, -p[1] / a, 0.0];
        d = add(d, n, -2.0 * dot(d, n));
    }
    (p[2] > 0.0).then_some((p, d))
}

fn land((p, d): (V, V)) -> [f64; 2] {
    let q = add(p, d, -p[2] / d[2]);
    [q[0], q[1]]
}

/// |det| of a map of two parameters by central differences.
fn jacobian(
    map: impl Fn(f64, f64) -> Option<[f64; 2]>,
    u: f64,
    v: f64,
    h: [f64; 2],
) -> Option<f64> {
    let (a, b) = (map(u + h[0], v)?, map(u - h[0], v)?);
    let (c, d) = (map(u, v + h[1])?, map(u, v - h[1])?);
    let du = [(a[0] - b[0]) / (2.0 * h[0]), (a[1] - b[1]) / (2.0 * h[0])];
    let dv = [(c[0] - d[0]) / (2.0 * h[1]), (c[1] - d[1]) / (2.0 * h[1])];
    Some((du[0] * dv[1] - du[1] * dv[0]).abs())
}

/// All zeros of f that a dense scan of [low, high] sees, by bisection.
fn scan(f: impl Fn(f64) -> f64, low: f64, high: f64, steps: u32) -> Vec<f64> {
    let at = |n: u32| low + (high - low) * (f64::from(n) + 0.5) / f64::from(steps);
    let mut found = vec![];
    let mut before = f(at(0));
    for n in 1..steps {
        let after = f(at(n));
        if (before < 0.0) != (after < 0.0) {
            let (mut a, mut b) = (at(n - 1), at(n));
            for _ in 0..60 {
                let m = 0.5 * (a + b);
                if (f(m) < 0.0) == (before < 0.0) {
                    a = m;
                } else {
                    b = m;
                }
            }
            found.push(0.5 * (a + b));
        }
        before = after;
    }
    found
}

#[test]
fn beam_in_the_cup() {
    let mut cases = Cases(1);
    let (mut roots, mut shaded) = (0, 0);
    for case in 0..240 {
        let a = cases.uniform(0.5, 3.0);
        let e = cases.uniform(0.1, 1.3);
        let bounces = 1 + case % 4;
        let closed = case % 3 == 0;
        let half_arc = cases.uniform(0.4, 2.8);
        let height = a * tan(e) * cases.uniform(0.3, 2.0 * f64::from(bounces));
        let (r, t) = (a * sqrt(cases.uniform(0.0, 0.95)), cases.uniform(-PI, PI));
        let (x, y) = (r * cos(t), r * sin(t));
        let (e0, reflectance) = (cases.uniform(0.5, 3.0), cases.uniform(0.3, 1.0));
        let cup = CylinderCup {
            wall: Wall {
                radius: a,
                height: Some(height),
                cos_half_arc: (!closed).then(|| cos(half_arc)),
            },
            reflectance,
            light: Light::Beam(Beam {
                irradiance: e0,
                sin_elevation: sin(e),
                cos_elevation: cos(e),
            }),
        };
        let sum = cup.caustic(x, y, bounces);
        if !(sum.conditioning() < 3e3) || sum.error > 1e-9 * sum.value.max(1e-3) {
            continue;
        }
        let mut unclipped = vec![];
        cup.for_each_root(x, y, bounces, |root| unclipped.push(root));
        if unclipped.iter().any(|q| q.spread.abs() < 1e-2 * a) {
            continue;
        }
        let d = [cos(e), 0.0, -sin(e)];
        // The offset of the point from the last leg in plan, whatever the heights: start high enough.
        let top = 100.0 * a * tan(e) * f64::from(bounces);
        let from = |phi: f64, z: f64| -> V {
            add([a * cos(phi), a * sin(phi), z], d, -1e-3 * a * cos(phi))
        };
        let offset = |phi: f64| {
            let (p, d) = trace(from(phi, top), d, a, bounces).expect("high above the floor");
            (x - p[0]) * d[1] - (y - p[1]) * d[0]
        };
        let arc = |p: V| closed || acos((p[0] / a).clamp(-1.0, 1.0)) <= half_arc;
        let mut total = 0.0;
        for phi in scan(offset, -0.5 * PI, 0.5 * PI, 20_000) {
            let (p, q) = trace(from(phi, top), d, a, bounces).expect("high");
            let plan = ((x - p[0]) * q[0] + (y - p[1]) * q[1]) / hypot(q[0], q[1]);
            if plan <= 0.0 {
                continue;
            }
            // The height at which the first hit must be for the ray to come down at the point.
            let chord = 2.0 * a * cos(phi);
            let z1 = (plan + f64::from(bounces - 1) * chord) * tan(e);
            let entry = [-a * cos(phi), a * sin(phi), z1 + chord * tan(e)];
            let hits = (1..=bounces + 1).map(|k| {
                let (p, _) = trace(from(phi, top), d, a, k).expect("high");
                p
            });
            let hits: Vec<V> = hits.collect();
            let lit = z1 <= height
                && hits[..bounces as usize].iter().all(|&p| arc(p))
                && (plan <= chord || !arc(hits[bounces as usize]))
                && (!arc(entry) || entry[2] >= height);
            if !lit {
                shaded += 1;
                continue;
            }
            roots += 1;
            let map = |phi: f64, z: f64| trace(from(phi, z), d, a, bounces).map(land);
            let det = jacobian(map, phi, z1, [1e-5, 1e-5 * a]).expect("lands");
            // Beam cross-section of the wall element a dφ dz.
            let normal = [cos(phi), sin(phi), 0.0];
            total += e0 * libm::pow(reflectance, f64::from(bounces)) * a * dot(d, normal) / det;
        }
        assert!(
            (total - sum.value).abs() <= 1e-5 * (sum.value + 1e-6),
            "case {case}: traced {total}, closed form {sum:?}"
        );
    }
    assert!(roots > 80 && shaded > 80, "{roots} roots, {shaded} shaded");
}

#[test]
fn point_light_in_the_cup() {
    let mut cases = Cases(2);
    let mut roots = 0;
    for case in 0..160 {
        let a = cases.uniform(0.5, 3.0);
        let bounces = 1 + case % 3;
        let on_wall = case % 4 == 0;
        let radius = if on_wall {
            a
        } else {
            a * cases.uniform(0.0, 0.97)
        };
        let at = cases.uniform(-PI, PI);
        let h = a * cases.uniform(0.2, 2.0);
        let light = [radius * cos(at), radius * sin(at), h];
        let (r, t) = (a * sqrt(cases.uniform(0.0, 0.95)), cases.uniform(-PI, PI));
        let (x, y) = (r * cos(t), r * sin(t));
        let height = h * cases.uniform(0.1, 1.1);
        let (intensity, reflectance) = (cases.uniform(0.5, 3.0), cases.uniform(0.3, 1.0));
        let cup = CylinderCup {
            wall: Wall {
                radius: a,
                height: Some(height),
                cos_half_arc: None,
            },
            reflectance,
            light: Light::Point(Lamp {
                x: light[0],
                y: light[1],
                height: h,
                intensity,
            }),
        };
        let sum = cup.caustic(x, y, bounces);
        let mut unclipped = vec![];
        cup.for_each_root(x, y, bounces, |root| unclipped.push(root));
        let near = unclipped.iter().any(|q| q.spread.abs() < 2e-2 * a);
        if near || !(sum.error <= 1e-9 * sum.value.max(1e-3)) {
            continue;
        }
        let ray = |psi: f64, eta: f64| [cos(psi) * cos(eta), sin(psi) * cos(eta), -sin(eta)];
        // Nearly horizontal rays bounce as often as one likes before they come down.
        let offset = |psi: f64| {
            let (p, d) = trace(light, ray(psi, 1e-6), a, bounces).expect("nearly horizontal");
            (x - p[0]) * d[1] - (y - p[1]) * d[0]
        };
        let (low, high) = if on_wall {
            (at + 0.5 * PI, at + 1.5 * PI)
        } else {
            (-PI, PI)
        };
        let mut total = 0.0;
        for psi in scan(offset, low, high, 40_000) {
            let mut length = 0.0;
            let mut p = light;
            let mut first = 0.0;
            for k in 1..=bounces {
                let (q, _) = trace(light, ray(psi, 1e-6), a, k).expect("nearly horizontal");
                length += hypot(q[0] - p[0], q[1] - p[1]);
                if k == 1 {
                    first = length;
                }
                p = q;
            }
            let (_, d) = trace(light, ray(psi, 1e-6), a, bounces).expect("nearly horizontal");
            let tau = ((x - p[0]) * d[0] + (y - p[1]) * d[1]) / hypot(d[0], d[1]);
            if tau <= 0.0 {
                continue;
            }
            let eta = atan(h / (length + tau));
            if h - first * tan(eta) > height {
                continue;
            }
            roots += 1;
            let map = |psi: f64, eta: f64| trace(light, ray(psi, eta), a, bounces).map(land);
            let Some(det) = jacobian(map, psi, eta, [1e-5, 1e-6]) else {
                continue;
            };
            total += intensity * libm::pow(reflectance, f64::from(bounces)) * cos(eta) / det;
        }
        assert!(
            (total - sum.value).abs() <= 3e-5 * (sum.value + 1e-6),
            "case {case}: traced {total}, closed form {sum:?}"
        );
    }
    assert!(roots > 150, "{roots}");
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

#[test]
fn views_in_the_cup() {
    let mut cases = Cases(5);
    let mut counts = [0; 4];
    for case in 0..600 {
        let a = cases.uniform(0.5, 3.0);
        let half_arc = cases.uniform(0.5, 3.1);
        let height = a * cases.uniform(0.5, 2.5);
        let cup = CylinderCup {
            wall: Wall {
                radius: a,
                height: Some(height),
                cos_half_arc: Some(cos(half_arc)),
            },
            reflectance: 0.8,
            light: Light::Beam(Beam {
                irradiance: 1.0,
                sin_elevation: 0.6,
                cos_elevation: 0.8,
            }),
        };
        let camera = [
            a * cases.uniform(-0.6, 0.6),
            a * cases.uniform(-0.6, 0.6),
            a * cases.uniform(0.5, 2.0),
        ];
        let d = unit([
            cases.uniform(-1.0, 1.0),
            cases.uniform(-1.0, 1.0),
            -cases.uniform(0.1, 0.7),
        ]);
        let on_arc = |p: V| acos((p[0] / a).clamp(-1.0, 1.0)) <= half_arc;
        // Follow the ray bounce by bounce; it is seen by reflection if the floor comes before the next hit.
        let mut expected = None;
        let mut leg = (camera, d);
        for bounces in 0..4 {
            let next = trace(leg.0, leg.1, a, 1);
            let meets = next.filter(|(p, _)| on_arc(*p) && p[2] <= height);
            match meets {
                Some(n) => leg = n,
                None => {
                    if bounces > 0 {
                        expected = Some((bounces, land(leg)));
                    }
                    break;
                }
            }
        }
        let aim = add(camera, d, 0.7);
        let seen = cup.look(
            vec3(camera[0], camera[1], camera[2]),
            vec3(aim[0], aim[1], aim[2]),
            3,
        );
        match (seen, expected) {
            (None, None) => counts[0] += 1,
            (Some(s), Some((bounces, at))) => {
                assert_eq!(s.bounces, bounces, "case {case}");
                assert!(hypot(s.x - at[0], s.y - at[1]) <= 1e-9 * a, "case {case}");
                counts[bounces as usize] += 1;
            }
            // More bounces than asked for.
            (None, Some((bounces, _))) if bounces > 3 => {}
            other => panic!("case {case}: {other:?}"),
        }
    }
    assert!(counts.iter().all(|&c| c > 3), "{counts:?}");
}
