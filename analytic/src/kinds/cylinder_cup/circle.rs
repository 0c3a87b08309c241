//! Rays inside a reflecting circle, in plan.
//!
//! A ray is the pair (direction θ, signed offset L = p × d(θ) for any point p on it). Reflection at the circle |p| = a
//! keeps L = a sin i and turns θ by π - 2i, so that all incidence angles i and all chords 2 a cos i are equal. After
//! k reflections the rays of a source form a family θ(u), L(u), and those through p are the zeros of
//!
//! ```text
//! g(u) = p × d(θ(u)) - L(u),        |∂g/∂u| = distance between neighbouring rays at p per du.
//! ```
//!
//! For parallel light and for a light on the wall both are linear in i: θ = θ0 - m i, L = a sin i, with m = 2k for the
//! beam and m = 2k + 1 for the light on the wall. Derived here.

use crate::roots::{Isolated, Local, Sample, for_each_root_of};
use crate::scalar::Scalar;

/// Rays θ = θ0 - m i, L = a sin i, |i| < π/2.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearFamily<S> {
    /// Radius a [m].
    pub radius: S,
    /// Direction at i = 0 [rad].
    pub theta0: S,
    /// Turns per unit of incidence angle.
    pub turns: S,
}

/// The ray of a family with parameter u, seen from a point p.
#[derive(Clone, Copy, Debug)]
pub(super) struct Through<S> {
    /// g(u): zero if the ray passes through the point.
    pub offset: S,
    /// ∂g/∂u: the spread of the family at the point.
    pub spread: S,
    /// p · d: position of the point along the ray, from the foot of the perpendicular from the centre.
    pub along: S,
    /// cos θ.
    pub cos_theta: S,
    /// sin θ.
    pub sin_theta: S,
    /// sin i.
    pub sin_i: S,
    /// cos i.
    pub cos_i: S,
}

impl<S: Scalar> LinearFamily<S> {
    /// The ray with incidence angle i, seen from (x, y).
    #[inline]
    pub fn through(&self, x: S, y: S, i: S) -> Through<S> {
        let theta = self.theta0 - self.turns * i;
        let (sin_theta, cos_theta) = theta.sin_cos();
        let (sin_i, cos_i) = i.sin_cos();
        let along = x * cos_theta + y * sin_theta;
        Through {
            offset: x * sin_theta - y * cos_theta - self.radius * sin_i,
            spread: -(self.turns * along + self.radius * cos_i),
            along,
            cos_theta,
            sin_theta,
            sin_i,
            cos_i,
        }
    }

    /// Visits the rays through a point in ascending incidence angle.
    #[inline]
    pub fn for_each_root(&self, x: S, y: S, visit: impl FnMut(Isolated<S>)) {
        let (m, a) = (self.turns, self.radius);
        let r = x.hypot(y);
        let noise = S::EPSILON * S::from_f64(4.0) * (r * (S::TWO + S::TWO * m) + a);
        let (second, third) = (m.squared() * r + a, m.squared() * m * r + a);
        let half_turn = S::HALF * S::PI;
        let at = |i: S| {
            let ray = self.through(x, y, i);
            Sample {
                value: ray.offset,
                slope: ray.spread,
                noise,
            }
        };
        let local = |i: S, half: S| {
            let ray = self.through(x, y, i);
            // ∂²g/∂i² = a sin i - m² p × d at the middle, and |∂³g/∂i³| ≤ m³ |p| + a around it.
            let across = a * ray.sin_i;
            let bend = across - m.squared() * (ray.offset + across);
            Local {
                value: ray.offset,
                slope: ray.spread,
                curvature: second.min(bend.abs() + half * third),
                noise,
            }
        };
        for_each_root_of(-half_turn, half_turn, at, local, visit);
    }
}
