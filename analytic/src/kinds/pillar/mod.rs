//! A convex vertical mirror: a circular pillar on a floor, under a point light.
//!
//! The pillar of radius a and height H stands on z = 0; its side reflects with R, its top absorbs. The light y at height
//! h is outside. In plan (0 the axis, A the light, P the floor point, Q = a n(θ) the side, t = dn/dθ) with u = A - Q and
//! v = P - Q, Q reflects if u·n > 0, v·n > 0 and
//!
//! ```text
//! F(θ) = (u·t)(v·n) + (v·t)(u·n) = 0,     F' = -a (u·n + v·n) - 2 (u·n)(v·n) + 2 (u·t)(v·t),
//! E = I R h/(s² + h²)^{3/2} · s cos i/(s cos i + 2 s1 s2/a),     z = h s2/s ≤ H,
//! ```
//!
//! s1 = |u|, s2 = |v|, s = s1 + s2 (design: s/|W| with the radius of curvature -a of a convex wall).
//!
//! **Exactly one root.** Let φ be the angle of Q from A towards P, 0 ≤ φ ≤ γ, γ the angle from A to P. The incidence
//! angle grows with φ from 0 at φ = 0 to π/2 at the light's tangent point φ_A = acos(a/|A|), the exit angle falls with φ
//! from π/2 at γ - φ_P, φ_P = acos(a/|P|), to 0 at φ = γ. Their difference is strictly monotone, F is |u||v| times its
//! sine, and it changes sign on [max(0, γ - φ_P), min(φ_A, γ)]: one zero if γ < φ_A + φ_P, which says that the segment AP
//! misses the disc; outside of [0, γ] both angles lie on the same side of the normal, so there is none. In the plan shadow
//! there is none either. Derived here.
//!
//! No singularity: W ≥ s, and E falls to 0 continuously at the edge of the plan shadow, where cos i = 0. Valid for |A| > a
//! and h > 0. **Accuracy**: a few units of rounding times the conditioning.

pub mod bundle;

use crate::gradient::Gradient;
use crate::kinds::singularity::Singularity;
use crate::kinds::{Estimate, rounding_error};
use crate::roots::bracketed_from;
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// A reflecting pillar with its light.
#[derive(Clone, Copy, Debug)]
pub struct Pillar<S> {
    /// x of the axis [m].
    pub x: S,
    /// y of the axis [m].
    pub y: S,
    /// Radius a [m].
    pub radius: S,
    /// Height H of the top above the floor [m].
    pub height: S,
    /// Specular reflectance R of the side.
    pub reflectance: S,
    /// Position of the light, farther from the axis than the radius and above the floor [m].
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
}

/// The reflection that lights a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Where the side reflects [m].
    pub hit: Vec3<S>,
    /// Cosine of the plan incidence angle i.
    pub cos_incidence: S,
    /// Plan length s1 from the light to the side [m].
    pub to_wall: S,
    /// Plan length s2 from the side to the floor point [m].
    pub from_wall: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the coordinates.
    pub conditioning: S,
    /// How far below the top the hit is, negative above it [m].
    pub inside: S,
}

/// Light and floor point in plan, from the axis, with the radius and the light's height.
#[derive(Clone, Copy)]
struct Plan<S> {
    light: (S, S),
    point: (S, S),
    radius: S,
    height: S,
}

/// The side seen from light and floor point.
struct Side<S> {
    /// u·n and u·t.
    light: (S, S),
    /// v·n and v·t.
    point: (S, S),
}

impl<S: Scalar> Plan<S> {
    fn side(&self, theta: S) -> Side<S> {
        let (c, s) = (theta.cos(), theta.sin());
        let seen = |(x, y): (S, S)| (x * c + y * s - self.radius, y * c - x * s);
        Side {
            light: seen(self.light),
            point: seen(self.point),
        }
    }

    /// F and F'.
    fn offset(&self, theta: S) -> (S, S) {
        let Side {
            light: (un, ut),
            point: (vn, vt),
        } = self.side(theta);
        let slope = S::TWO * (ut * vt - un * vn) - self.radius * (un + vn);
        (ut * vn + vt * un, slope)
    }

    /// E/(I R), s1, s2 and cos i.
    fn transfer(&self, theta: S) -> (S, S, S, S) {
        let side = self.side(theta);
        let (first, second) = (
            side.light.0.hypot(side.light.1),
            side.point.0.hypot(side.point.1),
        );
        let cosine = side.light.0 / first;
        let s = first + second;
        let spread = s * cosine + S::TWO * first * second / self.radius;
        let distance = s.hypot(self.height);
        let e = self.height * s * cosine / (distance.squared() * distance * spread);
        (e, first, second, cosine)
    }

    /// The angle θ of the reflection; light and point are in sight of each other.
    fn reflection(&self) -> S {
        let (a, (ax, ay), (px, py)) = (self.radius, self.light, self.point);
        let (cross, dot) = (ax * py - ay * px, ax * px + ay * py);
        let gamma = cross.abs().atan2(dot);
        let tangent = |(x, y): (S, S)| {
            let r = x.hypot(y);
            ((r - a) * (r + a)).max(S::ZERO).sqrt().atan2(a)
        };
        let low = (gamma - tangent(self.point)).max(S::ZERO);
        let high = tangent(self.light).min(gamma);
        let sign = if cross < S::ZERO { -S::ONE } else { S::ONE };
        let start = ay.atan2(ax);
        let phi = bracketed_from(
            |phi| {
                let (value, slope) = self.offset(start + sign * phi);
                (sign * value, slope)
            },
            low,
            high,
            S::HALF * (low + high),
            false,
        );
        start + sign * phi
    }
}

impl<S: Scalar> Pillar<S> {
    fn plan(&self, x: S, y: S) -> Plan<S> {
        Plan {
            light: (self.light.x - self.x, self.light.y - self.y),
            point: (x - self.x, y - self.y),
            radius: self.radius,
            height: self.light.z,
        }
    }

    /// Size of the coordinates that a plan distance comes from [m].
    fn extent(&self, x: S, y: S) -> S {
        let axis = self.x.abs() + self.y.abs();
        x.abs() + y.abs() + self.light.x.abs() + self.light.y.abs() + axis + self.radius
    }

    /// How far outside the pillar's foot a floor point is, negative under it [m].
    pub fn outside(&self, x: S, y: S) -> S {
        (x - self.x).hypot(y - self.y) - self.radius
    }

    /// How far the segment from the light to a floor point passes the disc in plan, negative through it [m]; and the
    /// height at which it leaves the disc [m], where it goes through it.
    fn passage(&self, x: S, y: S) -> (S, S) {
        let Plan { light, point, .. } = self.plan(x, y);
        let (dx, dy) = (point.0 - light.0, point.1 - light.1);
        let s = dx.hypot(dy);
        let foot = -(light.0 * dx + light.1 * dy) / s;
        if !(foot > S::ZERO && foot < s) {
            // The nearest point is an end.
            let ends = light.0.hypot(light.1).min(point.0.hypot(point.1));
            return (ends - self.radius, S::ONE / S::ZERO);
        }
        let across = (light.0 * dy - light.1 * dx).abs() / s;
        let half = ((self.radius - across) * (self.radius + across))
            .max(S::ZERO)
            .sqrt();
        let leave = self.light.z * (S::ONE - (foot + half) / s);
        (across - self.radius, leave)
    }

    /// The reflection at the side, of a pillar of any height, that lights the floor point (x, y) [m]; `None` in the plan
    /// shadow and under the pillar.
    pub fn reflection(&self, x: S, y: S) -> Option<Root<S>> {
        if !(self.outside(x, y) > S::ZERO && self.passage(x, y).0 > S::ZERO) {
            return None;
        }
        let plan = self.plan(x, y);
        let theta = plan.reflection();
        let (transfer, first, second, cosine) = plan.transfer(theta);
        if !(cosine > S::ZERO) {
            return None;
        }
        let z = self.light.z * second / (first + second);
        Some(Root {
            hit: vec3(
                self.x + self.radius * theta.cos(),
                self.y + self.radius * theta.sin(),
                z,
            ),
            cos_incidence: cosine,
            to_wall: first,
            from_wall: second,
            irradiance: self.intensity * self.reflectance * transfer,
            conditioning: self.conditioning(x, y, theta),
            inside: self.height - z,
        })
    }

    /// Differentiates the irradiance along the root, dθ = -(∂F/∂p dp)/F'.
    fn conditioning(&self, x: S, y: S, theta: S) -> S {
        type G<S> = Gradient<S, 6>;
        let fixed = self.plan(x, y);
        let (of_light, of_point) = (
            self.light.x.abs() + self.light.y.abs() + self.x.abs() + self.y.abs(),
            x.abs() + y.abs() + self.x.abs() + self.y.abs(),
        );
        let plan = Plan {
            light: (
                G::input(fixed.light.0, 0, of_light),
                G::input(fixed.light.1, 1, of_light),
            ),
            point: (
                G::input(fixed.point.0, 2, of_point),
                G::input(fixed.point.1, 3, of_point),
            ),
            radius: G::input(fixed.radius, 4, fixed.radius),
            height: G::input(fixed.height, 5, fixed.height),
        };
        let mut moving = G::constant(theta);
        let (value, slope) = plan.offset(moving);
        for (m, v) in moving.slopes.iter_mut().zip(value.slopes) {
            *m = -v / slope.value;
        }
        plan.transfer(moving).0.relative_change()
    }

    /// Irradiance of the floor point (x, y) by reflection at the pillar (LSDE) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        if let Some(root) = self.reflection(x, y) {
            if root.inside >= S::ZERO {
                sum.add(root.irradiance, root.conditioning);
            }
            if root.inside.abs() <= rounding_error(self.height + root.hit.z, root.conditioning) {
                sum.error += root.irradiance;
            }
        }
        self.add_shadow_error(x, y, &mut sum);
        self.add_foot_error(x, y, &mut sum);
        sum
    }

    /// At the edge of the plan shadow rounding decides whether there is a root. A ray that passes the side at a distance δ
    /// comes from a reflection with cos i = δ s/(2 s1 s2) to first order (the height of the triangle A Q P), so the light
    /// that may be missing is that of δ within rounding: I R h a s² δ/(4 s1² s2² d³), s1 and s2 to the tangent points.
    fn add_shadow_error(&self, x: S, y: S, sum: &mut Estimate<S>) {
        let (clearance, leave) = self.passage(x, y);
        let margin = rounding_error(self.extent(x, y), S::ZERO);
        let is_near = clearance.abs() <= margin && leave < S::ONE / S::ZERO;
        if !is_near {
            return;
        }
        let Plan { light, point, .. } = self.plan(x, y);
        let tangent = |(x, y): (S, S)| {
            let r = x.hypot(y);
            ((r - self.radius) * (r + self.radius)).max(S::ZERO).sqrt()
        };
        let (first, second) = (tangent(light), tangent(point));
        let s = first + second;
        let distance = s.hypot(self.light.z);
        let product = S::TWO * first * second / s;
        let transfer = self.light.z * self.radius / (distance.squared() * distance);
        sum.error +=
            self.intensity * self.reflectance * transfer * (margin + margin) / product.squared();
    }

    /// At the foot of the side rounding decides whether the point is in front of it.
    fn add_foot_error(&self, x: S, y: S, sum: &mut Estimate<S>) {
        let extent = self.extent(x, y);
        if self.outside(x, y).abs() <= rounding_error(extent, S::ZERO) {
            sum.error = S::ONE / S::ZERO;
        }
    }

    /// Whether the pillar keeps the light from a floor point: the point is under it, or the ray comes through it below
    /// the top. With it, how far from the edge of the shadow the ray passes [m].
    pub fn shadow(&self, x: S, y: S) -> (bool, S) {
        let outside = self.outside(x, y);
        if !(outside > S::ZERO) {
            return (true, -outside);
        }
        let (clearance, leave) = self.passage(x, y);
        let over = leave - self.height;
        // Free if past the side or over the top.
        let free = clearance.max(over);
        (!(free > S::ZERO), free.abs())
    }

    /// Direct irradiance of the floor point (x, y) (LDE) [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let (dark, margin) = self.shadow(x, y);
        let (dx, dy, h) = (x - self.light.x, y - self.light.y, self.light.z);
        let distance = dx.hypot(dy).hypot(h);
        let e = self.intensity * h / (distance.squared() * distance);
        let size = self.extent(x, y);
        if !dark {
            sum.add(e, S::from_f64(4.0) * (S::ONE + size / distance));
        }
        // A plan length's error times the slope of the ray is the error of a height.
        let slant = S::ONE + h / dx.hypot(dy);
        if margin <= rounding_error((size + h) * slant, S::ZERO) {
            sum.error += e;
        }
        self.add_foot_error(x, y, &mut sum);
        sum
    }

    /// A convex wall makes no caustic.
    pub fn singularity(&self, _x: S, _y: S) -> Option<Singularity<S>> {
        None
    }
}
