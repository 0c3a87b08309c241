//! The circular wall against a second route that shares no code with it: forward tracing with vectors in three dimensions, and finite
//! differences for the Jacobian. Parameters are drawn anew for each case, with a fixed seed.

use std::f64::consts::PI;

use crate::forward::{Cases, V, add, dot, jacobian, land, unit};
use libm::{acos, atan, cos, hypot, sin, sqrt, tan};
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall};
use nephroid_analytic::vector::vec3;

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
        // The listed hits are those of the traced ray.
        cup.for_each_lit_root(x, y, bounces, |root| {
            for n in 1..=bounces {
                let (p, _) =
                    trace(from(root.phi(), root.wall_z), d, a, n).expect("above the floor");
                let hit = cup.hit(&root, bounces, n);
                let off = hypot(hypot(hit.x - p[0], hit.y - p[1]), hit.z - p[2]);
                assert!(off <= 1e-9 * a, "case {case}, hit {n}: {hit:?} {p:?}");
            }
        });
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
