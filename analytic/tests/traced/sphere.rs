//! The glass sphere against traced light: number of roots by a dense scan, flux density by differences.

use nephroid_analytic::kinds::glass_sphere::GlassSphere;
use nephroid_analytic::kinds::singularity::SingularityKind;

use crate::tracing::{Random, V, add, determinant, dot, mirror, refract, to_plane, unit};

/// The second end of a chord of the sphere around 0.
fn chord(from: V, d: V) -> V {
    add(from, d, -2.0 * dot(from, d))
}

/// Traces a ray of the beam that enters at (x, y): landing point and weight.
fn trace(s: &GlassSphere<f64>, x: f64, y: f64, interactions: u32) -> Option<(V, f64)> {
    let a = s.radius;
    let squared = a * a - x * x - y * y;
    if !(squared > 0.0) {
        return None;
    }
    let mut at = [x, y, -squared.sqrt()];
    let mut d = [0.0, 0.0, 1.0];
    // Unit vectors again and again: the drift of a chain of chords would grow.
    let outward = unit;
    let (inside, t) = refract(d, outward(at), s.index);
    let mut weight = t;
    if interactions == 1 {
        d = mirror(d, outward(at));
        weight = 1.0 - t;
    } else {
        d = inside;
        for _ in 2..interactions {
            at = chord(at, d);
            d = unit(mirror(d, outward(at)));
            weight *= 1.0 - t;
        }
        at = chord(at, d);
        let inward = outward(at).map(|c| -c);
        let (out, t) = refract(d, inward, 1.0 / s.index);
        d = unit(out);
        weight *= t;
    }
    // The receiver faces the sphere.
    let p = to_plane(at, d, s.receiver_z)?;
    (d[2] * s.receiver_z > 0.0).then_some((p, weight))
}

/// Number of rays that reach (rho, 0), by sign changes over many rays in the plane y = 0.
fn count(s: &GlassSphere<f64>, rho: f64, interactions: u32) -> usize {
    let rays = 15_000;
    let limit = s.max_incidence;
    let landing = |k: i32| {
        let i = limit * (f64::from(k) - 0.5) / f64::from(rays);
        trace(s, s.radius * libm::sin(i), 0.0, interactions).map(|(p, _)| p[0] - rho)
    };
    let mut roots = 0;
    let mut last: Option<f64> = None;
    for k in 1 - rays..=rays {
        let now = landing(k);
        if let (Some(before), Some(after)) = (last, now)
            && (before < 0.0) != (after < 0.0)
        {
            roots += 1;
        }
        last = now;
    }
    roots
}

#[test]
fn all_rays_are_found_and_carry_the_traced_flux() {
    let mut r = Random(6);
    let (mut seen, mut most, mut skipped) = (0, 0, 0);
    for trial in 0..140 {
        let a = r.between(0.5, 2.0);
        let side = if r.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
        let s = GlassSphere {
            index: r.between(1.05, 2.4),
            radius: a,
            irradiance: r.between(0.5, 3.0),
            receiver_z: side * a * r.between(1.02, 5.0),
            max_incidence: r.between(0.9, 1.5),
        };
        let interactions = 1 + trial % 5;
        // Half of the points within the folds, if there are some.
        let mut rho = a * r.between(0.01, 2.5);
        let mut folds = vec![];
        s.for_each_fold(interactions, |f| folds.push(f.radius));
        if let Some(fold) = folds.first()
            && trial % 2 == 0
        {
            rho = fold * r.between(0.2, 0.995);
        }
        let nearest = folds
            .iter()
            .fold(f64::INFINITY, |m, f| m.min((f - rho).abs()));
        let mut roots = vec![];
        s.for_each_root(rho, interactions, |root| roots.push(root));
        let edge = roots.iter().any(|root| root.inside.abs() < 1e-3);
        if nearest < 1e-4 * a || edge || rho > 50.0 * a {
            skipped += 1;
            continue;
        }
        assert_eq!(
            roots.len(),
            count(&s, rho, interactions),
            "{s:?} m = {interactions} rho = {rho} {roots:?}"
        );
        most = most.max(roots.len());
        for root in &roots {
            let x = a * libm::sin(root.incidence);
            let path = |u: f64, v: f64| trace(&s, x + u, v, interactions);
            let (landed, weight) = path(0.0, 0.0).expect("the ray lands");
            let size = (rho + s.receiver_z.abs()) * 1e-15 * (1.0 + root.conditioning);
            assert!(
                libm::hypot(landed[0] - rho, landed[1]) <= 4.0 * size,
                "{s:?} {landed:?} {rho} {root:?}"
            );
            if root.conditioning > 1e3 || root.incidence.abs() > 1.35 {
                continue;
            }
            seen += 1;
            let h = 2e-5 * a;
            let area = determinant(|u, v| path(u, v).map(|(p, _)| p), h).expect("a map");
            let traced = s.irradiance * weight / area;
            let difference = (traced / root.irradiance - 1.0).abs();
            assert!(
                difference < 1e-6,
                "{s:?} {root:?} {traced:e} {difference:e}"
            );
        }
    }
    assert!(
        seen > 80 && most >= 3 && skipped < 40,
        "{seen} {most} {skipped}"
    );
}

/// Theory block K: the fold ring of K1, the bow of K3, the paraxial focus n a/(2(n - 1)).
#[test]
fn folds_and_axis() {
    let s = GlassSphere {
        index: 1.5,
        radius: 1.0,
        irradiance: 1.0,
        receiver_z: 1.2,
        max_incidence: 1.4,
    };
    let mut folds = vec![];
    s.for_each_fold(2, |f| folds.push(f));
    assert_eq!(folds.len(), 1);
    assert!((folds[0].radius - 0.074_023_154_729_341_51_f64).abs() < 1e-15);
    assert!((folds[0].incidence - 0.550_152_603_948_582_4_f64).abs() < 1e-7);
    assert!(s.has_axial_line(2));
    let near = s.singularity(0.01, 2).expect("the axis");
    assert_eq!(
        (near.kind, near.distance),
        (SingularityKind::LineFocus, 0.01)
    );
    let near = s.singularity(0.07, 2).expect("the ring");
    assert_eq!(near.kind, SingularityKind::Fold);
    assert!(s.caustic(0.0, 2).value == f64::INFINITY);
    // Behind the paraxial focus nothing is singular, and the axis has one ray.
    let behind = GlassSphere {
        receiver_z: 2.5,
        ..s
    };
    assert!(behind.singularity(0.0, 2).is_none());
    assert_eq!(behind.caustic(0.0, 2).roots, 1);
    let focus = GlassSphere {
        receiver_z: 1.5,
        ..s
    };
    let near = focus.singularity(0.0, 2).expect("the paraxial focus");
    assert_eq!(near.distance, 0.0);
    assert!(focus.caustic(0.0, 2).error == f64::INFINITY);
    let bow = GlassSphere {
        index: 1.333,
        receiver_z: -4.0,
        max_incidence: 1.5,
        ..s
    };
    let near = bow.singularity(4.7, 3).expect("the bow");
    assert!((near.distance - 0.081_664_000_208_236_3).abs() < 1e-14);
    // Across the fold the number of rays changes by two.
    assert_eq!(s.caustic(0.0740, 2).roots, 3);
    assert_eq!(s.caustic(0.0741, 2).roots, 1);
}
