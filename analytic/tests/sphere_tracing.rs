//! Spherical mirrors against a ray tracer of their own: reflection of vectors at an implicit sphere, Jacobians by finite
//! differences, root counts by dense search. Nothing of Alhazen's polynomial or of the wavefront formula is used.

use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::kinds::sphere_mirror::{Light, Root, Side, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};

/// SplitMix64: enough for choosing test cases.
struct Cases(u64);

impl Cases {
    fn next(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> Vec3<f64> {
        vec3(
            self.next(-size, size),
            self.next(-size, size),
            self.next(-size, size),
        )
    }

    fn direction(&mut self) -> Vec3<f64> {
        loop {
            let v = self.vector(1.0);
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalized();
            }
        }
    }

    fn mirror(&mut self, side: Side, beam: bool) -> SphereMirror<f64> {
        let centre = self.vector(0.3);
        let radius = self.next(0.7, 1.4);
        let light = if beam {
            let direction = self.direction();
            Light::Beam {
                direction,
                irradiance: self.next(1.0, 3.0),
            }
        } else {
            let reach = match side {
                Side::Concave => self.next(0.05, 1.8),
                Side::Convex => self.next(1.05, 3.0),
            };
            Light::Point {
                position: centre + self.direction() * (reach * radius),
                intensity: self.next(1.0, 5.0),
            }
        };
        SphereMirror {
            centre,
            radius,
            side,
            cap_axis: self.direction(),
            cap_cos_min: self.next(-0.9, 0.7),
            reflectance: self.next(0.5, 1.0),
            light,
            receiver_z: centre.z - self.next(-0.6, 1.6) * radius,
        }
    }

    fn receiver_point(&mut self, m: &SphereMirror<f64>) -> Vec3<f64> {
        let (x, y) = (self.next(-1.5, 1.5), self.next(-1.5, 1.5));
        vec3(m.centre.x + x, m.centre.y + y, m.receiver_z)
    }
}

/// Where a ray first meets the cap, and the outward normal there.
fn first_hit(m: &SphereMirror<f64>, o: Vec3<f64>, d: Vec3<f64>) -> Option<(f64, Vec3<f64>)> {
    let oc = o - m.centre;
    let (b, c) = (oc.dot(d), oc.dot(oc) - m.radius * m.radius);
    let disc = b * b - c;
    if disc <= 0.0 {
        return None;
    }
    [-b - disc.sqrt(), -b + disc.sqrt()]
        .into_iter()
        .filter(|&t| t > 1e-9)
        .map(|t| (t, (oc + d * t) * (1.0 / m.radius)))
        .find(|(_, n)| n.dot(m.cap_axis) >= m.cap_cos_min)
}

/// A ray of the light after one reflection at the mirror's front: mirror point and receiver point.
fn trace(m: &SphereMirror<f64>, o: Vec3<f64>, d: Vec3<f64>) -> Option<(Vec3<f64>, Vec3<f64>)> {
    let (t, n) = first_hit(m, o, d)?;
    let front = match m.side {
        Side::Concave => d.dot(n) > 0.0,
        Side::Convex => d.dot(n) < 0.0,
    };
    let (s, v) = (o + d * t, d - n * (2.0 * d.dot(n)));
    if !front || v.z >= 0.0 || s.z <= m.receiver_z {
        return None;
    }
    let rest = (m.receiver_z - s.z) / v.z;
    if first_hit(m, s, v).is_some_and(|(again, _)| again < rest) {
        return None;
    }
    let x = s + v * rest;
    Some((s, vec3(x.x, x.y, m.receiver_z)))
}

fn frame(d: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>) {
    let pole = if d.x.abs() < 0.6 {
        vec3(1.0, 0.0, 0.0)
    } else {
        vec3(0.0, 1.0, 0.0)
    };
    let e = pole.cross(d).normalized();
    (e, d.cross(e))
}

/// The ray with offsets (u, v) from the one that meets `s`: a flux of `density` per du dv.
fn ray(m: &SphereMirror<f64>, s: Vec3<f64>, u: f64, v: f64) -> (Vec3<f64>, Vec3<f64>, f64) {
    match m.light {
        Light::Point {
            position,
            intensity,
        } => {
            let d = (s - position).normalized();
            let (e, f) = frame(d);
            let k = 1.0 + u * u + v * v;
            let to = (d + e * u + f * v) * (1.0 / k.sqrt());
            (position, to, intensity / (k * k.sqrt()))
        }
        Light::Beam {
            direction,
            irradiance,
        } => {
            let (e, f) = frame(direction);
            let start = s - direction * 20.0 + e * u + f * v;
            (start, direction, irradiance)
        }
    }
}

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

fn lit_roots(m: &SphereMirror<f64>, x: Vec3<f64>) -> Vec<Root<f64>> {
    let mut roots = vec![];
    m.for_each_lit_root(x, |root| roots.push(root));
    roots
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

/// Across a fold at the reported distance the number of roots changes by two; on the axis the irradiance has no bound.
#[test]
fn singularities_are_where_they_are_reported() {
    let m = SphereMirror {
        centre: vec3(0.0, 0.0, 0.0),
        radius: 1.0,
        side: Side::Concave,
        cap_axis: vec3(0.0, 0.0, 1.0),
        cap_cos_min: 0.25,
        reflectance: 0.9,
        light: Light::Point {
            position: vec3(0.0, 0.0, 0.3),
            intensity: 1.0,
        },
        receiver_z: -0.5,
    };
    let at = |r: f64| vec3(0.6 * r, 0.8 * r, m.receiver_z);
    let near = m.singularity(at(0.035)).expect("a singularity");
    assert_eq!(near.kind, SingularityKind::Fold);
    let fold = 0.035 + near.distance;
    assert_eq!(lit_roots(&m, at(fold + 1e-7)).len(), 1);
    assert_eq!(lit_roots(&m, at(fold - 1e-7)).len(), 3);
    let axis = m.singularity(at(0.002)).expect("a singularity");
    assert_eq!(axis.kind, SingularityKind::LineFocus);
    assert!((axis.distance - 0.002).abs() < 1e-12);
    assert_eq!(m.caustic(at(0.0)).error, f64::INFINITY);
}

/// Nearest point where the traced map from mirror to receiver changes its orientation, on a grid of mirror points.
fn traced_singularity(m: &SphereMirror<f64>, x: Vec3<f64>) -> Option<f64> {
    const N: usize = 700;
    let (e, f) = frame(m.cap_axis);
    let land = |i: usize, j: usize| {
        let c = m.cap_cos_min + (1.0 - m.cap_cos_min) * (i as f64 + 0.5) / N as f64;
        let w = 2.0 * core::f64::consts::PI * j as f64 / N as f64;
        let out = (1.0 - c * c).sqrt();
        let n = m.cap_axis * c + e * (out * libm::cos(w)) + f * (out * libm::sin(w));
        let s = m.centre + n * m.radius;
        let (o, d, _) = ray(m, s, 0.0, 0.0);
        let (hit, p) = trace(m, o, d)?;
        ((hit - s).length() < 1e-8).then_some(p)
    };
    let rows: Vec<Vec<_>> = (0..N)
        .map(|i| (0..=N).map(|j| land(i, j)).collect())
        .collect();
    let turn = |i: usize, j: usize| {
        let (p, a, b) = (rows[i][j]?, rows[i + 1][j]?, rows[i][j + 1]?);
        let size = (a - p).length().max((b - p).length());
        let (a, b) = (a - p, b - p);
        Some((a.x * b.y - a.y * b.x, p, size))
    };
    let mut nearest: Option<f64> = None;
    for i in 0..N - 2 {
        for j in 0..N - 1 {
            let Some((here, p, size)) = turn(i, j) else {
                continue;
            };
            let flips = [turn(i + 1, j), turn(i, j + 1)]
                .into_iter()
                .flatten()
                .any(|(next, _, _)| (next < 0.0) != (here < 0.0));
            if flips && size < 0.015 {
                let d = (p - x).length();
                nearest = Some(nearest.map_or(d, |n: f64| n.min(d)));
            }
        }
    }
    nearest
}

#[test]
fn distances_to_singularities_match_the_traced_map() {
    let mut cases = Cases(5);
    let mut seen = 0;
    for case in 0..60 {
        // A cap on the upper side, so that most receivers get a caustic.
        let mut m = cases.mirror(Side::Concave, case % 2 == 0);
        m.cap_axis = (m.cap_axis + vec3(0.0, 0.0, 1.5)).normalized();
        m.receiver_z = m.centre.z - cases.next(-0.5, 0.7) * m.radius;
        match &mut m.light {
            Light::Point { position, .. } => *position = (*position + m.centre) * 0.5,
            Light::Beam { direction, .. } if direction.dot(m.cap_axis) < 0.0 => {
                *direction = -*direction;
            }
            Light::Beam { .. } => {}
        }
        let x = cases.receiver_point(&m);
        let near = m.singularity(x);
        let traced = traced_singularity(&m, x);
        if let Some(traced) = traced {
            seen += 1;
            let near = near.expect("a singularity").distance;
            // The spacing of the grid.
            assert!(
                (near - traced).abs() < 0.05,
                "{case} {m:?} {x:?} {near} {traced}"
            );
        }
    }
    assert!(seen > 8, "{seen}");
}
