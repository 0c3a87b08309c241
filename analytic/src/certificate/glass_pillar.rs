//! A vertical glass cylinder in the sun: all rays to a floor point after a number of interactions, counted. Design §2.
//!
//! In plan the pillar refracts with n' = √(n² - sin² ε)/cos ε, and a ray keeps its moment about the axis: coming in along +x
//! at y = a sin i and turned clockwise by δ it passes the floor point p, as seen from the axis, where
//!
//! ```text
//! G(i) = a sin i - p_y cos δ - p_x sin δ = 0,     τ = p·d - a cos i > 0,     d = (cos δ, -sin δ),
//! E = E0 sin ε W a cos i/|G'(i)|,      0 < (τ + (m - 1) 2a cos r/n') tan ε ≤ H,
//! ```
//!
//! searched on all incidence angles. A strip a cos i di of the side takes E0 cos ε a cos i di dz, and lands on |G'| di dτ with
//! dτ = dz/tan ε.

use crate::certificate::Certified;
use crate::certificate::Lit;
use crate::certificate::radiometry::{
    Bundle, plan_squared, power_enclosed, reflectance_enclosed, transmittance_enclosed, whole,
};
use crate::certificate::roots::{Jet, isolate};
use crate::enclosure::Enclosure;
use crate::kinds::glass_pillar::GlassPillar;
use crate::scalar::Scalar;

/// n', the index in plan.
fn plan_index(pillar: &GlassPillar<Enclosure>) -> Enclosure {
    let squared = pillar.index.squared() - pillar.sin_elevation.squared();
    squared.sqrt() / pillar.cos_elevation
}

/// The clockwise turn of a ray after `interactions`, and n' cos r.
fn turn(n: Enclosure, i: Jet, interactions: u32) -> (Jet, Jet) {
    let jet = Jet::constant;
    let q = (jet(n.squared() - Enclosure::ONE) + i.cos().squared()).sqrt();
    if interactions == 1 {
        return (i + i - Jet::PI, q);
    }
    let r = (i.sin() / q).atan();
    let inside = jet(whole(interactions - 2));
    ((i - r) * Jet::TWO + (Jet::PI - r - r) * inside, q)
}

/// Light after `interactions` ≥ 1 with the side, at the floor point (x, y).
pub fn caustic_enclosed(
    pillar: &GlassPillar<Enclosure>,
    x: Enclosure,
    y: Enclosure,
    interactions: u32,
) -> Bundle {
    let mut bundle = Bundle::default();
    let (px, py, a) = (x - pillar.x, y - pillar.y, pillar.radius);
    let outside = Lit::where_positive(plan_squared(px, py) - a.squared());
    if outside == Lit::No || interactions == 0 {
        return bundle;
    }
    let n = plan_index(pillar);
    let jet = Jet::constant;
    let moment = |i: Jet| {
        let (delta, _) = turn(n, i, interactions);
        jet(a) * i.sin() - jet(py) * delta.cos() - jet(px) * delta.sin()
    };
    let ray = |i: Enclosure| {
        let one = Enclosure::ONE;
        let (delta, q) = turn(n, jet(i), interactions);
        let (delta, q) = (delta.value, q.value);
        let reach = a * i.cos();
        let tau = px * delta.cos() - py * delta.sin() - reach;
        let slope = moment(Jet::input(i, 0, one)).slopes[0];
        let outer = pillar.cos_elevation * i.cos();
        let inner = (pillar.index.squared() - one + outer.squared()).sqrt();
        let f = reflectance_enclosed(one, outer, pillar.index, inner);
        let weight = if interactions == 1 {
            f
        } else {
            let t = transmittance_enclosed(one, outer, pillar.index, inner);
            t.squared() * power_enclosed(f, interactions - 2)
        };
        let e = pillar.irradiance * pillar.sin_elevation * weight * reach / slope.abs();
        let chords = whole(interactions - 1) * Enclosure::TWO * a * q / n.squared();
        let entry = (tau + chords) * pillar.sin_elevation / pillar.cos_elevation;
        let lit = Lit::where_positive(tau)
            .and(Lit::where_not_negative(pillar.height - entry))
            .and(outside);
        (e, lit)
    };
    let quarter = (Enclosure::PI * Enclosure::HALF).high();
    let zeros = isolate(-quarter, quarter, moment);
    for i in zeros.simple {
        let (e, lit) = ray(i);
        bundle.add(e, lit);
    }
    for i in zeros.undecided {
        if ray(i).1 != Lit::No {
            bundle.total.add_unresolved();
        }
    }
    bundle
}

/// Direct light at the floor point (x, y): dark where the side, or the top, stands between it and the sun.
pub fn direct_enclosed(pillar: &GlassPillar<Enclosure>, x: Enclosure, y: Enclosure) -> Certified {
    let (px, py, a) = (x - pillar.x, y - pillar.y, pillar.radius);
    let squared = (a - py) * (a + py);
    // Height at which the ray to the sun meets the near side, if it does.
    let near = px - squared.sqrt();
    let height = near * pillar.sin_elevation / pillar.cos_elevation;
    let blocked = Lit::where_positive(squared)
        .and(Lit::where_positive(near))
        .and(Lit::where_not_negative(pillar.height - height));
    let outside = Lit::where_positive(plan_squared(px, py) - a.squared());
    let mut sum = Certified::NONE;
    sum.add(
        pillar.irradiance * pillar.sin_elevation,
        outside.and(blocked.inverted()),
    );
    sum
}
