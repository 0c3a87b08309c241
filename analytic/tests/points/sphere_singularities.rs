//! Where a spherical mirror's singularities are reported, against root counts and against the traced map from mirror to
//! receiver.

use crate::sphere_tracer::{Cases, frame, lit_roots, ray, trace};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereCaustic, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};

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

/// Points of the folds on the receiver, by the tangential foci of a fine grid of rays. A fold is lit if next to it a root
/// arrives from where the ray was reflected.
fn folds_on_a_grid(m: &SphereMirror<f64>, light: Vec3<f64>) -> Vec<Vec3<f64>> {
    let (e, f) = frame(m.cap_axis);
    let focus = |theta: f64, w: f64| {
        let radial = e * libm::cos(w) + f * libm::sin(w);
        let n = m.cap_axis * libm::cos(theta) + radial * libm::sin(theta);
        let s = m.centre + n * m.radius;
        let leg = s - light;
        let (r1, d) = (leg.length(), leg.normalized());
        let cosine = d.dot(n);
        // 1/r1 + 1/r2 = 2/(a cos i).
        let r2 = 1.0 / (2.0 / (m.radius * cosine) - 1.0 / r1);
        let at = s + (d - n * (2.0 * cosine)) * r2;
        (cosine > 0.0 && r2 > 0.0).then_some((s, at))
    };
    let lit = |s: Vec3<f64>, at: Vec3<f64>| {
        (0..8).any(|k| {
            let turn = core::f64::consts::FRAC_PI_4 * f64::from(k);
            let by = vec3(libm::cos(turn), libm::sin(turn), 0.0) * 1e-4;
            let mut found = false;
            m.for_each_lit_root(at + by, |r| {
                found |= (r.specular_point - s).length() < 0.1 * m.radius;
            });
            found
        })
    };
    let (rows, columns) = (800, 800);
    let limit = libm::acos(m.cap_cos_min);
    let mut points = vec![];
    for j in 0..columns {
        let w = 2.0 * core::f64::consts::PI * f64::from(j) / f64::from(columns);
        let above = |i: u32| {
            let theta = limit * f64::from(i) / f64::from(rows);
            focus(theta, w).map(|(s, at)| (s, at, at.z - m.receiver_z))
        };
        for i in 1..=rows {
            let (Some((s, p, a)), Some((_, q, b))) = (above(i - 1), above(i)) else {
                continue;
            };
            let at = p + (q - p) * (a / (a - b));
            if (a < 0.0) != (b < 0.0) && lit(s, vec3(at.x, at.y, m.receiver_z)) {
                points.push(at);
            }
        }
    }
    points
}

/// No branch is missed, and none is nearer than it is.
#[test]
fn no_fold_on_a_grid_is_nearer_than_the_reported_one() {
    let mut cases = Cases(17);
    let mut folds = 0;
    for _ in 0..4 {
        let light = vec3(
            cases.next(-0.4, 0.4),
            cases.next(-0.4, 0.4),
            cases.next(0.1, 0.5),
        );
        let m = SphereMirror {
            centre: vec3(0.0, 0.0, 0.0),
            radius: 1.0,
            side: Side::Concave,
            cap_axis: vec3(0.0, 0.0, 1.0),
            cap_cos_min: cases.next(0.1, 0.5),
            reflectance: 0.9,
            light: Light::Point {
                position: light,
                intensity: 1.0,
            },
            receiver_z: -cases.next(0.15, 0.6),
        };
        let grid = folds_on_a_grid(&m, light);
        let caustic = SphereCaustic::new(&m);
        for _ in 0..100 {
            let x = vec3(cases.next(-0.9, 0.9), cases.next(-0.9, 0.9), m.receiver_z);
            let nearest = grid.iter().map(|p| (*p - x).length());
            let on_grid = nearest.fold(f64::INFINITY, f64::min);
            let found = caustic.nearest(x);
            let distance = found.map_or(f64::INFINITY, |s| s.distance);
            // An end of the light is found to the spacing of the grid.
            assert!(
                distance <= on_grid + 2e-3,
                "{m:?} {x:?} {found:?} {on_grid}"
            );
            if found.is_some_and(|s| s.kind == SingularityKind::Fold) {
                folds += 1;
                assert!(
                    distance >= on_grid - 0.02,
                    "{m:?} {x:?} {found:?} {on_grid}"
                );
            }
        }
    }
    assert!(folds > 40, "{folds}");
}
