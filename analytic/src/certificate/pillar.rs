//! A convex circular pillar under a point light: all reflections at its side, counted. Design §2, vertical walls.
//!
//! In plan, with u = A - Q and v = P - Q from the side Q = a n(θ) to light and floor point, Q reflects where
//! (u·t)(v·n) + (v·t)(u·n) = 0 with both u·n and v·n above 0, which is searched on a full turn. Both legs then stay in front of
//! the tangent. E = I R h s/((s² + h²)^{3/2} W), W = s + 2 s1 s2/(a cos i), at the height h s2/s of the side.

use crate::certificate::radiometry::{Bundle, Facing, plan_squared, point_light_enclosed};
use crate::certificate::roots::{Jet, full_turn};
use crate::certificate::{Certified, Lit};
use crate::enclosure::Enclosure;
use crate::kinds::pillar::Pillar;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// Light by one reflection at the side, at the floor point (x, y).
pub fn caustic_enclosed(pillar: &Pillar<Enclosure>, x: Enclosure, y: Enclosure) -> Bundle {
    let mut bundle = Bundle::default();
    let a = pillar.radius;
    let light = (pillar.light.x - pillar.x, pillar.light.y - pillar.y);
    let point = (x - pillar.x, y - pillar.y);
    let outside = Lit::where_positive(plan_squared(point.0, point.1) - a.squared());
    if outside == Lit::No {
        return bundle;
    }
    let jet = Jet::constant;
    let zeros = full_turn(|theta| {
        let (c, s) = (theta.cos(), theta.sin());
        let seen = |(x, y): (Enclosure, Enclosure)| {
            (jet(x) * c + jet(y) * s - jet(a), jet(y) * c - jet(x) * s)
        };
        let ((un, ut), (vn, vt)) = (seen(light), seen(point));
        ut * vn + vt * un
    });
    let Some(zeros) = zeros else {
        bundle.total.add_unresolved();
        return bundle;
    };
    let ray = |theta: Enclosure| {
        let (c, s) = (theta.cos(), theta.sin());
        let normal = |(x, y): (Enclosure, Enclosure)| x * c + y * s - a;
        let length = |(x, y): (Enclosure, Enclosure)| plan_squared(x - a * c, y - a * s).sqrt();
        let (s1, s2, h) = (length(light), length(point), pillar.light.z);
        let cosine = normal(light) / s1;
        let sum = s1 + s2;
        let spread = sum + Enclosure::TWO * s1 * s2 / (a * cosine);
        let squared = sum.squared() + h.squared();
        let e =
            pillar.intensity * pillar.reflectance * h * sum / (squared * squared.sqrt() * spread);
        let lit = Lit::where_positive(normal(light))
            .and(Lit::where_positive(normal(point)))
            .and(Lit::where_not_negative(pillar.height - h * s2 / sum))
            .and(outside);
        (e, lit)
    };
    for theta in zeros.simple {
        let (e, lit) = ray(theta);
        bundle.add(e, lit);
    }
    for theta in zeros.undecided {
        if ray(theta).1 != Lit::No {
            bundle.total.add_unresolved();
        }
    }
    bundle
}

/// Direct light at the floor point (x, y), in the shadow of the pillar or not.
pub fn direct_enclosed(pillar: &Pillar<Enclosure>, x: Enclosure, y: Enclosure) -> Certified {
    let a = pillar.radius;
    let (e, above) = point_light_enclosed(
        pillar.light,
        pillar.intensity,
        vec3(x, y, Enclosure::ZERO),
        Facing::Up,
    );
    let light = (pillar.light.x - pillar.x, pillar.light.y - pillar.y);
    let point = (x - pillar.x, y - pillar.y);
    let (dx, dy) = (point.0 - light.0, point.1 - light.1);
    let squared = plan_squared(dx, dy);
    // Where the segment, from the light, is next to the axis and leaves the disc, in shares of its length.
    let foot = -(light.0 * dx + light.1 * dy) / squared;
    let across = (light.0 * dy - light.1 * dx).squared() / squared;
    let inside = a.squared() - across;
    let leave = foot + (inside / squared).sqrt();
    let height = pillar.light.z * (Enclosure::ONE - leave);
    let between = Lit::where_positive(foot).and(Lit::where_positive(Enclosure::ONE - foot));
    let through = Lit::where_positive(inside).and(between);
    let blocked = through.and(Lit::where_not_negative(pillar.height - height));
    let outside = Lit::where_positive(plan_squared(point.0, point.1) - a.squared());
    let mut sum = Certified::NONE;
    sum.add(e, above.and(blocked.inverted()).and(outside));
    sum
}
