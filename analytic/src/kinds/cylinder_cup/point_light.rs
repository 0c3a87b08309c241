//! A point light in the circular wall: the cardioid, and its relatives for a light anywhere inside.
//!
//! The light at A, height h, sends the ray with plan direction ψ to the wall; r1 is the plan length to the first hit,
//! C = a cos i half of every chord. After k bounces the ray has direction θ = ψ + k(π - 2i), sin i = A × d(ψ)/a, and with
//! τ the length of the last leg
//!
//! ```text
//! l = r1 + (k-1) 2C + τ,     J = ∂/∂ψ [p × d(θ) - A × d(ψ)] = (p·d) θ' - A·d(ψ),
//! E = Σ I R^k h l / ((l² + h²)^{3/2} |J|),      height of the first hit z = h (1 - r1/l).
//! ```
//!
//! For one bounce J = r1 + τ - 2 r1 τ/C; with the light on the wall r1 = 2C and J = r1 - 3τ: the cardioid τ = r1/3.
//! Derived here from theory §0.3 by differentiating the ray family of [`super::circle`].
//!
//! Roots are isolated in ψ with local bounds of the second derivative, so that a light close to the wall only costs
//! more subdivisions. Valid for a light inside the circle or on it. **Accuracy**: see `CylinderCup::conditioning`.

use super::beam::power;
use super::circle::LinearFamily;
use super::fold::FoldRay;
use super::{CylinderCup, Root, Wall};
use crate::kinds::{Estimate, rounding_error};
use crate::roots::{Isolated, Local, Sample, for_each_root_of};
use crate::scalar::Scalar;

/// A point light inside the circle or on the wall.
#[derive(Clone, Copy, Debug)]
pub struct Lamp<S> {
    /// x [m].
    pub x: S,
    /// y [m].
    pub y: S,
    /// Height above the floor, h > 0 [m].
    pub height: S,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
}

/// The ray with direction ψ after k bounces, and the derivatives that isolation and conditioning need.
#[derive(Clone, Copy, Debug)]
struct Ray<S> {
    /// A × d(ψ) = a sin i.
    across: S,
    /// A · d(ψ).
    ahead: S,
    /// a cos i.
    reach: S,
    /// θ' = dθ/dψ.
    turning: S,
    cos_theta: S,
    sin_theta: S,
    offset: S,
    along: S,
    spread: S,
}

/// dθ'/dψ = -2k i'': i'' = -L/C + M² L/C³.
fn turning_rate<S: Scalar>(k: S, across: S, ahead: S, reach: S) -> S {
    let ratio = ahead / reach;
    S::TWO * k * (across / reach) * (S::ONE - ratio.squared())
}

impl<S: Scalar> Lamp<S> {
    /// Distance from the axis [m].
    fn radius(&self) -> S {
        self.x.hypot(self.y)
    }

    /// Whether the light stands on the wall, to within rounding.
    pub(super) fn is_on(&self, wall: &Wall<S>) -> bool {
        (self.radius() - wall.radius).abs() <= wall.radius * S::EPSILON * S::from_f64(8.0)
    }

    /// The family of rays of a light on the wall, by incidence angle: ψ = φ_A + π - i.
    fn family(&self, wall: &Wall<S>, k: S) -> LinearFamily<S> {
        LinearFamily {
            radius: wall.radius,
            theta0: self.y.atan2(self.x) + (k + S::ONE) * S::PI,
            turns: S::TWO * k + S::ONE,
        }
    }

    /// The ray in the direction ψ, given by its sine and cosine, after k bounces.
    ///
    /// The direction is e^{iψ} (-e^{-2ii})^k, without the angle i.
    #[inline(always)]
    fn ray(&self, wall: &Wall<S>, bounces: u32, (x, y): (S, S), (s, c): (S, S)) -> Ray<S> {
        let a = wall.radius;
        let across = self.x * s - self.y * c;
        let ahead = self.x * c + self.y * s;
        let reach = ((a - across) * (a + across)).sqrt();
        let (sin_i, cos_i) = (across / a, reach / a);
        let turn = ((sin_i - cos_i) * (sin_i + cos_i), S::TWO * sin_i * cos_i);
        let (cos_theta, sin_theta) = (0..bounces).fold((c, s), |(c, s), _| {
            (c * turn.0 - s * turn.1, s * turn.0 + c * turn.1)
        });
        let along = x * cos_theta + y * sin_theta;
        let k = S::from_f64(f64::from(bounces));
        let turning = S::ONE - S::TWO * k * ahead / reach;
        Ray {
            across,
            ahead,
            reach,
            turning,
            cos_theta,
            sin_theta,
            offset: x * sin_theta - y * cos_theta - across,
            along,
            spread: along * turning - ahead,
        }
    }

    /// Visits the directions ψ of the rays through a point, of a light off the wall.
    ///
    /// With the ratios λ = L/C, μ = A·d(ψ)/C, θ'' = 2k λ (1 - μ²) and θ''' = 2k μ (1 - μ²)(1 + 3λ²).
    fn for_each_direction(
        &self,
        wall: &Wall<S>,
        bounces: u32,
        (x, y): (S, S),
        visit: impl FnMut(Isolated<S>),
    ) {
        let (r, light, a) = (x.hypot(y), self.radius(), wall.radius);
        let (one, three) = (S::ONE, S::from_f64(3.0));
        let twice = S::TWO * S::from_f64(f64::from(bounces));
        let noise = |ray: &Ray<S>| {
            let angle = S::TWO + twice * (S::TWO + light / ray.reach);
            S::EPSILON * S::from_f64(4.0) * (r * angle + light)
        };
        let at = |psi: S| {
            let ray = self.ray(wall, bounces, (x, y), psi.sin_cos());
            Sample {
                value: ray.offset,
                slope: ray.spread,
                noise: noise(&ray),
            }
        };
        let local = |psi: S, half: S| {
            let ray = self.ray(wall, bounces, (x, y), psi.sin_cos());
            // Bounds on the directions ψ ± half.
            let across = light.min(ray.across.abs() + light * half);
            let ahead = light.min(ray.ahead.abs() + light * half);
            let reach = ((a - across) * (a + across)).sqrt();
            let (lambda, mu) = (across / reach, ahead / reach);
            let turning = one + twice * mu;
            let stretch = one + mu.squared();
            let rate = twice * lambda * stretch;
            let whole = r * (turning.squared() + rate) + across;
            let third = turning * (turning.squared() + three * rate)
                + twice * mu * stretch * (one + three * lambda.squared());
            let bend = self.bend(&ray, twice);
            Local {
                value: ray.offset,
                slope: ray.spread,
                curvature: whole.min(bend.abs() + half * (r * third + light)),
                noise: noise(&ray),
            }
        };
        for_each_root_of(-S::PI, S::PI, at, local, visit);
    }

    /// ∂J/∂ψ = -(p × d) θ'² + (p · d) θ'' + A × d(ψ), `twice` = 2k.
    #[inline(always)]
    fn bend(&self, ray: &Ray<S>, twice: S) -> S {
        let ratio = ray.ahead / ray.reach;
        let rate = twice * (ray.across / ray.reach) * (S::ONE - ratio.squared());
        ray.across + ray.along * rate - (ray.offset + ray.across) * ray.turning.squared()
    }

    /// By how much the position angle changes along a chord after the first hit: π - 2i.
    pub(super) fn chord_turn(&self, wall: &Wall<S>, root: &Root<S>) -> S {
        // L = p × d is the same on every leg: take it from the first hit.
        let (px, py) = (wall.radius * root.cos_phi, wall.radius * root.sin_phi);
        let (dx, dy) = (px - self.x, py - self.y);
        let across = px * dy - py * dx;
        S::PI - S::TWO * across.atan2(px * dx + py * dy)
    }
}

impl<S: Scalar> CylinderCup<S> {
    pub(super) fn for_each_lamp_root(
        &self,
        lamp: &Lamp<S>,
        x: S,
        y: S,
        bounces: u32,
        mut visit: impl FnMut(Root<S>),
    ) {
        let k = S::from_f64(f64::from(bounces));
        let each = |root: Isolated<S>| match root {
            Isolated::Simple(u) => (u, false),
            Isolated::Touching(u) => (u, true),
        };
        if lamp.is_on(&self.wall) {
            let start = lamp.y.atan2(lamp.x) + S::PI;
            let family = lamp.family(&self.wall, k);
            family.for_each_root(x, y, |root| {
                let (i, touching) = each(root);
                let ray = family.through(x, y, i);
                let reach = self.wall.radius * ray.cos_i;
                let psi = (start - i).sin_cos();
                let theta = (ray.cos_theta, ray.sin_theta);
                let leg = (S::TWO * reach, reach, ray.along, ray.spread);
                self.visit_lamp_root(lamp, k, psi, theta, leg, touching, bounces, &mut visit);
            });
            return;
        }
        lamp.for_each_direction(&self.wall, bounces, (x, y), |root| {
            let (psi, touching) = each(root);
            let psi = psi.sin_cos();
            let ray = lamp.ray(&self.wall, bounces, (x, y), psi);
            let theta = (ray.cos_theta, ray.sin_theta);
            let leg = (ray.reach - ray.ahead, ray.reach, ray.along, ray.spread);
            self.visit_lamp_root(lamp, k, psi, theta, leg, touching, bounces, &mut visit);
        });
    }

    fn visit_lamp_root(
        &self,
        lamp: &Lamp<S>,
        k: S,
        (sin_psi, cos_psi): (S, S),
        (cos_theta, sin_theta): (S, S),
        (first, reach, along, spread): (S, S, S, S),
        touching: bool,
        bounces: u32,
        visit: &mut impl FnMut(Root<S>),
    ) {
        let tau = along + reach;
        if !(tau > S::ZERO && first > S::ZERO && reach > S::ZERO) {
            return;
        }
        let a = self.wall.radius;
        let after = (k - S::ONE) * S::TWO * reach + tau;
        let length = first + after;
        let distance = length.hypot(lamp.height);
        let flux = lamp.intensity * power(self.reflectance, bounces) * lamp.height * length;
        visit(Root {
            cos_phi: (lamp.x + first * cos_psi) / a,
            sin_phi: (lamp.y + first * sin_psi) / a,
            cos_theta,
            sin_theta,
            cos_incidence: reach / a,
            tau,
            length,
            wall_z: lamp.height * after / length,
            spread,
            irradiance: flux / (distance.squared() * distance * spread.abs()),
            touching,
        });
    }

    /// Upper bound of the relative change of a lamp root's irradiance per relative change of all lengths.
    ///
    /// A change δ of any coordinate moves the ray's offset by at most δ (1 + 2k r/C) each and the spread directly by
    /// δ H; the parameter then moves by dg/J and the spread by ∂J/∂u times that. The path length is stationary (Fermat).
    pub(super) fn lamp_conditioning(
        &self,
        lamp: &Lamp<S>,
        x: S,
        y: S,
        bounces: u32,
        root: &Root<S>,
    ) -> S {
        let k = S::from_f64(f64::from(bounces));
        let a = self.wall.radius;
        let (reach, r) = (a * root.cos_incidence, x.hypot(y));
        let j = root.spread.abs();
        let three = S::from_f64(3.0);
        let (turning, bend, direct) = if lamp.is_on(&self.wall) {
            let m = S::TWO * k + S::ONE;
            let across = (a.squared() - reach.squared()).abs().sqrt();
            (m, (m.squared() - S::ONE) * across, m * (S::ONE + r / a))
        } else {
            let (px, py) = (a * root.cos_phi, a * root.sin_phi);
            let (dx, dy) = (px - lamp.x, py - lamp.y);
            let first = dx.hypot(dy);
            let across = (lamp.x * dy - lamp.y * dx) / first;
            let ahead = (lamp.x * dx + lamp.y * dy) / first;
            let turning = S::ONE - S::TWO * k * ahead / reach;
            let rate = turning_rate(k, across, ahead, reach);
            let along = root.tau - reach;
            // ∂J/∂ψ = -(p × d) θ'² + (p · d) θ'' + A × d(ψ), and p × d = A × d(ψ) at a root.
            let bend = -across * turning.squared() + along * rate + across;
            let spill =
                S::TWO * k * (S::ONE / reach + (ahead * across).abs() / (reach.squared() * reach));
            (
                turning.abs(),
                bend.abs(),
                turning.abs() * S::TWO * k * r / reach + r * spill,
            )
        };
        let moved = three + S::TWO * S::TWO * k * r / reach;
        let scale = a.max(r);
        let distance = root.length.hypot(lamp.height);
        let falloff = (S::ONE / root.length + three / distance) * (S::TWO * k + three);
        let lengths =
            scale * (bend * moved / j.squared() + (turning + direct + S::ONE) / j + falloff);
        lengths + three * lamp.height / distance + S::ONE
    }

    pub(super) fn direct_from_lamp(&self, lamp: &Lamp<S>, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let (dx, dy) = (x - lamp.x, y - lamp.y);
        let plan = dx.hypot(dy);
        let distance = plan.hypot(lamp.height);
        let dark = self.hides_lamp(lamp, x, y);
        let e = lamp.intensity * lamp.height / (distance.squared() * distance);
        let size = x.hypot(y) + lamp.radius();
        if !dark {
            sum.add(e, S::from_f64(4.0) * (S::ONE + size / distance));
        }
        // A plan length's error times the slope of the ray is the error of a height, and back.
        let slant = S::ONE + lamp.height / plan + plan / lamp.height;
        let margin = rounding_error((size + lamp.height) * slant, S::ZERO);
        let other = [-margin, margin].into_iter().any(|d| {
            self.hides_lamp(lamp, x + d, y) != dark || self.hides_lamp(lamp, x, y + d) != dark
        });
        if other {
            sum.error += e;
        }
        sum
    }

    /// Whether the wall stands between the light and a floor point: only outside the circle.
    fn hides_lamp(&self, lamp: &Lamp<S>, x: S, y: S) -> bool {
        let a = self.wall.radius;
        if x.hypot(y) <= a {
            return false;
        }
        let (dx, dy) = (x - lamp.x, y - lamp.y);
        let plan = dx.hypot(dy);
        let (cx, cy) = (dx / plan, dy / plan);
        let across = lamp.x * cy - lamp.y * cx;
        let ahead = lamp.x * cx + lamp.y * cy;
        if !(across.abs() < a) {
            return false;
        }
        let exit = ((a - across) * (a + across)).sqrt() - ahead;
        let cos_phi = (lamp.x + exit * cx) / a;
        let z = lamp.height * (S::ONE - exit / plan);
        self.wall.covers(cos_phi) && self.wall.reaches(z)
    }
}

impl CylinderCup<f64> {
    /// The ray with this parameter (incidence angle for a light on the wall, direction otherwise), at the point where
    /// the caustic touches it.
    pub(super) fn lamp_fold_ray(
        &self,
        lamp: &Lamp<f64>,
        parameter: f64,
        bounces: u32,
    ) -> Option<FoldRay> {
        let k = f64::from(bounces);
        let (psi, theta, across, first, reach, along, speed) = if lamp.is_on(&self.wall) {
            let family = lamp.family(&self.wall, k);
            let ray = family.through(0.0, 0.0, parameter);
            let reach = self.wall.radius * ray.cos_i;
            let psi = libm::atan2(lamp.y, lamp.x) + core::f64::consts::PI - parameter;
            let across = self.wall.radius * ray.sin_i;
            let theta = (ray.cos_theta, ray.sin_theta);
            (
                psi,
                theta,
                across,
                2.0 * reach,
                reach,
                -reach / family.turns,
                across * (1.0 / family.turns - family.turns),
            )
        } else {
            let ray = lamp.ray(&self.wall, bounces, (0.0, 0.0), libm::sincos(parameter));
            let theta = (ray.cos_theta, ray.sin_theta);
            let along = ray.ahead / ray.turning;
            let rate = turning_rate(k, ray.across, ray.ahead, ray.reach);
            let speed = ray.across * ray.turning - (ray.across + along * rate) / ray.turning;
            (
                parameter,
                theta,
                ray.across,
                ray.reach - ray.ahead,
                ray.reach,
                along,
                speed,
            )
        };
        let mut found = None;
        let leg = (first, reach, along, 0.0);
        let psi = libm::sincos(psi);
        self.visit_lamp_root(lamp, k, psi, theta, leg, true, bounces, &mut |root| {
            found = Some(root)
        });
        found.map(|root| FoldRay {
            root,
            along,
            across,
            speed,
        })
    }
}
