//! Where a spherical mirror's singularities are reported, against root counts and against the traced map from mirror to
//! receiver.

mod sphere_tracer;

use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::kinds::sphere_mirror::{Light, Side, SphereMirror};
use nephroid_analytic::vector::{Vec3, vec3};
use sphere_tracer::{Cases, frame, lit_roots, ray, trace};

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
