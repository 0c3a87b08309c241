//! Spherical mirrors against a ray tracer of their own: reflection of vectors at an implicit sphere, Jacobians by finite
//! differences, root counts by dense search. Nothing of Alhazen's polynomial or of the wavefront formula is used.

use crate::sphere_tracer::{Cases, frame, lit_roots, ray, trace};
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};

/// Irradiance by fourth-order differences of the landing point; `None` if a neighbouring ray is blocked.
fn irradiance(m: &SphereMirror<f64>, s: Vec3<f64>) -> Option<f64> {
    let h = 3e-5;
    let land = |u: f64, v: f64| {
        let (o, d, _) = ray(m, s, u, v);
        trace(m, o, d).map(|(_, x)| x)
    };
    let slope = |a: f64, b: f64| {
        let near = land(a * h, b * h)? - land(-a * h, -b * h)?;
        let far = land(2.0 * a * h, 2.0 * b * h)? - land(-2.0 * a * h, -2.0 * b * h)?;
        Some((near * 8.0 - far) * (1.0 / (12.0 * h)))
    };
    let (p, q) = (slope(1.0, 0.0)?, slope(0.0, 1.0)?);
    let (_, _, density) = ray(m, s, 0.0, 0.0);
    Some(m.reflectance * density / (p.x * q.y - p.y * q.x).abs())
}

const KINDS: [(Side, bool); 4] = [
    (Side::Concave, false),
    (Side::Concave, true),
    (Side::Convex, false),
    (Side::Convex, true),
];

/// Rays that are sent out at random must be found again from where they land: no root is lost.
#[test]
fn every_traced_ray_is_a_root() {
    let mut cases = Cases(1);
    for (side, beam) in KINDS {
        let mut landed = 0;
        while landed < 1500 {
            let m = cases.mirror(side, beam);
            for _ in 0..40 {
                let target = m.centre + cases.direction() * m.radius;
                let (o, d, _) = ray(&m, target, 0.0, 0.0);
                let Some((s, x)) = trace(&m, o, d) else {
                    continue;
                };
                landed += 1;
                let mut found = false;
                m.for_each_root(x, |root| {
                    let room = 1e-13 * (1.0 + root.conditioning);
                    let seen = root.margin >= -1e-9;
                    found |= seen && (root.specular_point - s).length() <= room;
                });
                let nearest = m.singularity(x).map(|s| s.distance);
                assert!(
                    found || nearest.is_some_and(|d| d < 1e-6),
                    "{m:?} {s:?} {x:?} {:?}",
                    lit_roots(&m, x)
                );
            }
        }
    }
}

/// Every lit root is a ray of the tracer, every dark one is not, and its irradiance is that of the traced bundle.
#[test]
fn every_root_is_a_traced_ray_with_its_irradiance() {
    let mut cases = Cases(2);
    for (side, beam) in KINDS {
        let (mut lit, mut dark, mut compared) = (0, 0, 0);
        let mut most = 0;
        while compared < 400 {
            let m = cases.mirror(side, beam);
            for _ in 0..20 {
                let x = cases.receiver_point(&m);
                most = most.max(lit_roots(&m, x).len());
                m.for_each_root(x, |root| {
                    if root.margin.abs() < 1e-6 || root.conditioning > 1e5 {
                        return;
                    }
                    let s = root.specular_point;
                    let (o, d, _) = ray(&m, s, 0.0, 0.0);
                    let traced = trace(&m, o, d).filter(|(hit, _)| (*hit - s).length() < 1e-8);
                    assert_eq!(traced.is_some(), root.margin > 0.0, "{m:?} {x:?} {root:?}");
                    let Some((_, end)) = traced else {
                        dark += 1;
                        return;
                    };
                    lit += 1;
                    let room = 1e-11 * root.conditioning;
                    assert!((end - x).length() <= room, "{m:?} {x:?} {end:?} {root:?}");
                    if root.conditioning < 300.0
                        && root.margin > 0.05
                        && let Some(e) = irradiance(&m, s)
                    {
                        compared += 1;
                        let difference = (root.irradiance - e).abs();
                        assert!(difference <= 2e-6 * e, "{m:?} {x:?} {root:?} {e}");
                    }
                });
            }
        }
        assert!(lit > 400 && dark > 20, "{side:?} {beam}: {lit} {dark}");
        if side == Side::Concave {
            assert!(most >= 2, "{side:?} {beam}: never more than {most} roots");
        } else {
            assert_eq!(most, 1);
        }
    }
}

/// The number of roots of the whole sphere, legs on the right side, against sign changes of the law of reflection on a
/// dense circle; four roots must occur.
#[test]
fn root_counts_match_a_dense_search() {
    let mut cases = Cases(3);
    let mut counts = [0; 5];
    for case in 0..400 {
        // Light and receiver far out in a full concave sphere, so that up to four roots exist.
        let radius = cases.next(0.5, 2.0);
        let (a, b) = (cases.next(0.3, 0.99), cases.next(0.3, 0.99));
        let position = cases.direction() * (a * radius);
        let angle = cases.next(0.0, core::f64::consts::PI);
        let (e, _) = frame(position.normalized());
        let side = position.normalized() * libm::cos(angle) + e * libm::sin(angle);
        let x = side * (b * radius);
        let m = SphereMirror {
            centre: vec3(0.0, 0.0, 0.0),
            radius,
            side: Side::Concave,
            cap_axis: vec3(0.0, 0.0, 1.0),
            cap_cos_min: -1.0,
            reflectance: 1.0,
            light: Light::Point {
                position,
                intensity: 1.0,
            },
            // Far below: only legs count here, not which roots are above the receiver.
            receiver_z: -10.0,
        };
        let mut found = 0;
        m.for_each_root(x, |root| {
            found += 1;
            assert!(root.margin >= 0.0 && !root.touching, "{case} {root:?}");
        });
        // Unit vectors along both legs: their sum has no component along the circle.
        let law = |phi: f64| {
            let n = position.normalized() * libm::cos(phi) + e * libm::sin(phi);
            let t = e * libm::cos(phi) - position.normalized() * libm::sin(phi);
            let sum = (position - n * radius).normalized() + (x - n * radius).normalized();
            sum.dot(t)
        };
        let steps = 40_000;
        let turn = 2.0 * core::f64::consts::PI / f64::from(steps);
        let mut expected = 0;
        let mut last = law(-0.5 * turn);
        for k in 0..steps {
            let next = law((f64::from(k) + 0.5) * turn);
            expected += usize::from((last < 0.0) != (next < 0.0));
            last = next;
        }
        assert_eq!(found, expected, "{case}: {m:?} {x:?}");
        counts[found] += 1;
    }
    assert!(counts[4] > 5 && counts[2] > 20, "{counts:?}");
}

/// f32 formulas stay within their own error bound of the f64 ones.
#[test]
fn f32_stays_within_its_bound() {
    let mut cases = Cases(4);
    let mut tight = 0;
    for (side, beam) in KINDS {
        for _ in 0..3000 {
            let single = |v: Vec3<f64>| vec3(v.x as f32, v.y as f32, v.z as f32);
            let double = |v: Vec3<f32>| vec3(f64::from(v.x), f64::from(v.y), f64::from(v.z));
            let m = cases.mirror(side, beam);
            let light = match m.light {
                Light::Point {
                    position,
                    intensity,
                } => Light::Point {
                    position: single(position),
                    intensity: intensity as f32,
                },
                Light::Beam {
                    direction,
                    irradiance,
                } => Light::Beam {
                    direction: single(direction),
                    irradiance: irradiance as f32,
                },
            };
            let low = SphereMirror {
                centre: single(m.centre),
                radius: m.radius as f32,
                side,
                cap_axis: single(m.cap_axis),
                cap_cos_min: m.cap_cos_min as f32,
                reflectance: m.reflectance as f32,
                light,
                receiver_z: m.receiver_z as f32,
            };
            let x = single(cases.receiver_point(&m));
            let high = SphereMirror {
                centre: double(low.centre),
                radius: f64::from(low.radius),
                side,
                cap_axis: double(low.cap_axis),
                cap_cos_min: f64::from(low.cap_cos_min),
                reflectance: f64::from(low.reflectance),
                light: match low.light {
                    Light::Point {
                        position,
                        intensity,
                    } => Light::Point {
                        position: double(position),
                        intensity: f64::from(intensity),
                    },
                    Light::Beam {
                        direction,
                        irradiance,
                    } => Light::Beam {
                        direction: double(direction),
                        irradiance: f64::from(irradiance),
                    },
                },
                receiver_z: f64::from(low.receiver_z),
            };
            let (a, b) = (low.caustic(x), high.caustic(double(x)));
            let difference = (f64::from(a.value) - b.value).abs();
            assert!(
                !(difference > f64::from(a.error)),
                "{low:?} {x:?} {a:?} {b:?}"
            );
            tight += usize::from(b.value > 0.0 && f64::from(a.error) < 1e-3 * b.value);
            let (a, b) = (low.direct(x), high.direct(double(x)));
            let difference = (f64::from(a.value) - b.value).abs();
            assert!(
                difference <= f64::from(a.error),
                "{low:?} {x:?} {a:?} {b:?}"
            );
        }
    }
    assert!(tight > 1000, "bounds are useless: {tight}");
}
