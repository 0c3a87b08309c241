//! The caustics of the glass pillar.
//!
//! J = 0 at p·d = a cos i/δ' on the ray; that is outside the glass, on the last leg, for 0 < δ' < 1. It is a fold with a
//! cusp at i = 0 for m = 2 (the paraxial line focus, a/(2(1 - 1/n')) from the axis where that is outside), and for m ≥ 3
//! runs off to infinity along the rainbow direction δ' = 0.

use super::GlassPillar;
use crate::gradient::Gradient;
use crate::kinds::plan_caustic::{Touch, nearest};
use crate::kinds::singularity::Singularity;
use crate::scalar::Scalar;

/// The point where the caustic touches the ray with incidence i, and the ray's direction, from the axis.
fn touching<S: Scalar>(
    pillar: &GlassPillar<S>,
    i: S,
    interactions: u32,
) -> Option<((S, S), (S, S))> {
    let ray = pillar.meridian().ray(i, interactions);
    if !(ray.turn > S::ZERO && ray.turn < S::ONE) {
        return None;
    }
    let along = pillar.radius * ray.cos_i / ray.turn;
    let across = pillar.radius * ray.sin_i;
    let d = (ray.cos_d, -ray.sin_d);
    // The side on which the ray passes the axis: G = 0.
    let p = (
        along * d.0 + across * ray.sin_d,
        along * d.1 + across * ray.cos_d,
    );
    Some((p, d))
}

impl GlassPillar<f64> {
    /// The singularity of rays with exactly `interactions` that is nearest to the floor point (x, y); `None` if none is
    /// lit. Accurate to about 1e-9 of the radius.
    pub fn singularity(&self, x: f64, y: f64, interactions: u32) -> Option<Singularity<f64>> {
        type G = Gradient<f64, 1>;
        let quarter = core::f64::consts::FRAC_PI_2;
        let pillar = GlassPillar {
            x: G::constant(self.x),
            y: G::constant(self.y),
            radius: G::constant(self.radius),
            height: G::constant(self.height),
            index: G::constant(self.index),
            irradiance: G::constant(self.irradiance),
            sin_elevation: G::constant(self.sin_elevation),
            cos_elevation: G::constant(self.cos_elevation),
        };
        nearest(self.local(x, y), (-quarter, quarter), |i| {
            let (c, d) = touching(&pillar, G::input(i, 0, 1.0), interactions)?;
            let point = (c.0.value, c.1.value);
            let direction = (d.0.value, d.1.value);
            let ray = self.meridian().ray(i, interactions);
            let (_, along) = self.impact(&ray, point);
            let arrival = self.arrival(&ray, along, interactions);
            Some(Touch {
                point,
                direction,
                speed: c.0.slopes[0] * direction.0 + c.1.slopes[0] * direction.1,
                lit: arrival.tau > 0.0 && arrival.entry_z <= self.height,
            })
        })
    }
}
