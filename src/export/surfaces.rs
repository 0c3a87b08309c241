//! Curved surfaces as patches: points and normals over the unit square.

use std::sync::Arc;

use glam::DVec3;
use nephroid_analytic::scene::{Conic, ConicArc, Dish, LensFront, Ripple, SphereCap};

use super::model::{Geometry, Patch, round};
use crate::geometry::scene::unit;

/// The wall over an arc of a conic.
pub(super) fn conic_wall(wall: &ConicArc) -> Geometry {
    let (cx, cy) = wall.axis();
    let (along, across) = (DVec3::new(cx, cy, 0.0), DVec3::new(-cy, cx, 0.0));
    let [fx, fy] = wall.focus;
    let end = wall.half_arc().unwrap_or(std::f64::consts::PI);
    let (p, e, height) = (wall.parameter, wall.eccentricity, wall.height);
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let (sine, cosine) = libm::sincos(end * (2.0 * s - 1.0));
            let r = p / (1.0 + e * cosine);
            // The gradient of |q| + e x is the outer normal; the focus is on the inner side.
            let inner = -unit(along * (cosine + e) + across * sine);
            let q = (along * cosine + across * sine) * r;
            (DVec3::new(fx, fy, height * t) + q, inner)
        }),
        ruled: true,
    })
}

/// The part of a sphere about its highest point.
pub(super) fn cap(cap: &SphereCap) -> Geometry {
    let (center, radius) = (DVec3::from_array(cap.center), cap.radius);
    let end = cap.half_angle_degrees.to_radians();
    revolved(
        move |t| {
            let (sine, cosine) = libm::sincos(end * t);
            (
                [radius * sine, center.z + radius * cosine],
                [-sine, -cosine],
            )
        },
        [center.x, center.y],
    )
}

/// A surface of revolution about a vertical axis: from a parameter to (r, z) and the normal's components there.
fn revolved(
    profile: impl Fn(f64) -> ([f64; 2], [f64; 2]) + Send + Sync + 'static,
    [x, y]: [f64; 2],
) -> Geometry {
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let ([r, z], [nr, nz]) = profile(t);
            let out = round(std::f64::consts::TAU * s);
            let normal = unit(out * nr + DVec3::Z * nz);
            (DVec3::new(x, y, z) + out * r, normal)
        }),
        ruled: false,
    })
}

/// A paraboloid between two radii.
pub(super) fn dish(dish: &Dish) -> Geometry {
    let (inner, outer) = (dish.inner_radius, dish.outer_radius);
    let (four_f, vertex) = (4.0 * dish.focal_length, dish.vertex_z);
    revolved(
        move |t| {
            let r = inner + (outer - inner) * t;
            ([r, vertex - r * r / four_f], [-2.0 * r / four_f, -1.0])
        },
        dish.center,
    )
}

/// An ellipsoid above its rim, or a hyperboloid below it.
pub(super) fn conic(conic: &Conic) -> Geometry {
    let (a, e, center_z) = (conic.semi_axis, conic.eccentricity, conic.center_z());
    let rim = (conic.rim_z - center_z) / a;
    let b = a * libm::sqrt(f64::abs(1.0 - e * e));
    let ellipsoid = conic.is_ellipsoid();
    // Eccentric anomaly of the rim: z = a cos τ, r = b sin τ, or the hyperbolic functions.
    let end = if ellipsoid {
        libm::acos(rim)
    } else {
        libm::acosh(rim)
    };
    revolved(
        move |t| {
            let tau = end * t;
            if ellipsoid {
                let (sine, cosine) = libm::sincos(tau);
                // Inwards.
                ([b * sine, center_z + a * cosine], [-a * sine, -b * cosine])
            } else {
                let (sine, cosine) = (libm::sinh(tau), libm::cosh(tau));
                // Downwards, the convex side.
                ([b * sine, center_z + a * cosine], [a * sine, -b * cosine])
            }
        },
        conic.center,
    )
}

/// The front of the lens, and the radius of its rim.
pub(super) fn lens(lens: &LensFront) -> (Geometry, f64) {
    let n = lens.index;
    let a = lens.semi_axis;
    let (defocus, end) = (lens.defocus, lens.half_angle_degrees.to_radians());
    // The ellipse r = a (1 - 1/n²)/(1 - cos ψ/n) about its lower focus.
    let profile = move |t: f64| {
        let (sine, cosine) = libm::sincos(end * t);
        let distance = a * (n - 1.0) * (n + 1.0) / (n * (n - cosine));
        // The normal is along n (unit ray from the focus) - (the axis): refraction makes the one of the other.
        (
            [distance * sine, defocus + distance * cosine],
            [n * sine, n * cosine - 1.0],
        )
    };
    let ([rim, _], _) = profile(1.0);
    (revolved(profile, lens.center), rim)
}

/// The waves over a horizontal rectangle at the height z.
pub(super) fn ripples(base: Geometry, z: f64, waves: &[Ripple]) -> Geometry {
    let Geometry::Rectangle { center, u, v } = base else {
        return base;
    };
    let waves = waves.to_vec();
    Geometry::Patch(Patch {
        at: Arc::new(move |s, t| {
            let p = center + u * (2.0 * s - 1.0) + v * (2.0 * t - 1.0);
            let (mut height, mut slope) = (z, DVec3::ZERO);
            for wave in &waves {
                let [kx, ky] = wave.wave_vector;
                let (sine, cosine) = libm::sincos(kx * p.x + ky * p.y + wave.phase);
                height += wave.amplitude * cosine;
                slope -= DVec3::new(kx, ky, 0.0) * (wave.amplitude * sine);
            }
            (DVec3::new(p.x, p.y, height), unit(DVec3::Z - slope))
        }),
        ruled: false,
    })
}
