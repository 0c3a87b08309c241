//! A vertical wall over an arc of a conic: parabola, ellipse or one branch of a hyperbola, under a point light.
//!
//! About its focus and axis the wall is r(θ) = p/(1 + e cos θ), |θ| ≤ half arc, from the floor z = 0 up to the height H. It
//! reflects on its inner side, which contains the focus, absorbs on its outer side and occludes from both. The light A
//! is on the inner side, at height h. A ray by Q reaches the floor point P, s1 = |AQ|, s2 = |QP|, s = s1 + s2, with
//!
//! ```text
//! E = Σ I R h/(s² + h²)^{3/2} · s/|W|,   W = s - 2 s1 s2/(ρ cos i) = s - 2 s1² s2 δ³/(p m² V_A),   z = h s2/s ≤ H
//! ```
//!
//! (design §2, with the curvature of [`curve`]). The roots are all zeros of a trigonometric polynomial of degree 3 with
//! proven bounds of its derivatives, isolated by [`for_each_root`]: at most 6. A light at the focus has the explicit
//! solution of [`focus`].
//!
//! **Second meetings.** The inner side is convex. The ray from the light to Q stays inside; the reflected ray meets the
//! curve once more, after the plan length τ, or never. If the wall stands there (it is lower there than at Q, hence below
//! the rim) the ray ends; else it goes on outside and cannot come back. So P is lit iff s2 ≤ τ or the wall does not cover
//! the second meeting. Direct light is stopped in the same way where it leaves the inner side below the rim.
//!
//! **Accuracy**: a few units of rounding times the conditioning, which grows like 1/distance to the caustic.

pub mod bundle;
mod curve;
pub mod focus;
pub mod fold;

use crate::gradient::Gradient;
use crate::kinds::{Estimate, rounding_error};
use crate::roots::{Isolated, for_each_root};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

use curve::{Conic, Point};

/// A conic wall with its light.
#[derive(Clone, Copy, Debug)]
pub struct ConicWall<S> {
    /// x of the focus [m].
    pub x: S,
    /// y of the focus [m].
    pub y: S,
    /// Unit vector in plan from the focus to the nearest point of the wall, θ = 0.
    pub axis: (S, S),
    /// Semi-latus rectum p [m].
    pub parameter: S,
    /// Eccentricity e: 0 circle, below 1 ellipse, 1 parabola, above 1 hyperbola.
    pub eccentricity: S,
    /// Half arc [rad], less than the asymptote's angle: e cos(half arc) > -1. `None` for a closed ellipse.
    pub half_arc: Option<S>,
    /// Height H of the rim [m].
    pub height: S,
    /// Specular reflectance R.
    pub reflectance: S,
    /// Position of the light, on the inner side and above the floor [m].
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
}

/// A ray from the light that reaches a floor point after one reflection at the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Angle θ of the hit about the focus, from the axis.
    pub theta: S,
    /// Where the wall reflects [m].
    pub hit: Vec3<S>,
    /// Cosine of the plan incidence angle i.
    pub cos_incidence: S,
    /// Plan length s1 from the light to the wall [m].
    pub to_wall: S,
    /// Plan length s2 from the wall to the floor point [m].
    pub from_wall: S,
    /// W [m]: zero on the caustic, of opposite sign on its two sides.
    pub spread: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the coordinates.
    pub conditioning: S,
    /// How far inside the arc the hit is, negative outside [rad].
    pub on_arc: S,
    /// How far below the rim the hit is, negative above [m].
    pub below_rim: S,
    /// How far the second meeting with the wall is from stopping the ray, negative where it does [m].
    pub free: S,
    /// Rounding cannot tell this root from none.
    pub touching: bool,
}

impl<S: Scalar> Root<S> {
    /// Whether the wall makes this reflection and lets it pass.
    pub fn is_lit(&self) -> bool {
        self.on_arc >= S::ZERO && self.below_rim >= S::ZERO && self.free >= S::ZERO
    }
}

/// What E needs of a reflection: E/(I R), s1, s2, cos i and W.
struct Transfer<S> {
    irradiance: S,
    first: S,
    second: S,
    cosine: S,
    spread: S,
}

impl<S: Scalar> Conic<S> {
    fn transfer(&self, theta: S, a: (S, S), b: (S, S), height: S) -> Transfer<S> {
        let q = self.point(theta);
        let first = (a.0 - q.at.0).hypot(a.1 - q.at.1);
        let second = (b.0 - q.at.0).hypot(b.1 - q.at.1);
        let front = self.front(&q, a);
        let s = first + second;
        let focusing = S::TWO * first.squared() * second * q.delta.squared() * q.delta
            / (self.parameter * q.norm * front);
        let spread = s - focusing;
        let distance = s.hypot(height);
        Transfer {
            irradiance: height * s / (distance.squared() * distance * spread.abs()),
            first,
            second,
            cosine: front / (q.norm.sqrt() * first),
            spread,
        }
    }
}

impl<S: Scalar> ConicWall<S> {
    fn conic(&self) -> Conic<S> {
        Conic {
            parameter: self.parameter,
            eccentricity: self.eccentricity,
        }
    }

    /// A floor position about focus and axis.
    fn local(&self, x: S, y: S) -> (S, S) {
        let (dx, dy, (c, s)) = (x - self.x, y - self.y, self.axis);
        (dx * c + dy * s, dy * c - dx * s)
    }

    fn lamp(&self) -> (S, S) {
        self.local(self.light.x, self.light.y)
    }

    /// Size of the coordinates that a position about the focus comes from [m].
    fn extent(&self, x: S, y: S) -> S {
        x.abs() + y.abs() + self.x.abs() + self.y.abs()
    }

    fn arc(&self) -> S {
        self.half_arc.unwrap_or(S::TWO * S::PI)
    }

    /// How far a floor point is on the inner side of the whole curve, negative outside [m].
    pub fn inside(&self, x: S, y: S) -> S {
        self.conic().inside(self.local(x, y))
    }

    /// Visits every ray that reaches the floor point (x, y) [m] after one reflection at the curve, from a wall of any
    /// height, with or without a second meeting ([`Root::is_lit`] tells). No allocation.
    pub fn for_each_root(&self, x: S, y: S, mut visit: impl FnMut(Root<S>)) {
        if self.lamp() == (S::ZERO, S::ZERO) {
            self.for_each_focal_root(x, y, visit);
        } else {
            self.for_each_general_root(x, y, &mut visit);
        }
    }

    /// As [`Self::for_each_root`], by isolation of the zeros of G, whether the light is at the focus or not.
    pub fn for_each_general_root(&self, x: S, y: S, mut visit: impl FnMut(Root<S>)) {
        let (conic, a, b) = (self.conic(), self.lamp(), self.local(x, y));
        let harmonics = conic.harmonics(a, b);
        // Roots that rounding could put on the other side of the arc's end are looked at as well.
        let wider = S::ONE + S::EPSILON.sqrt();
        let limit = self
            .half_arc
            .map_or(S::PI, |half| (half * wider).min(S::PI));
        if !(harmonics.bound(0) > harmonics.rounding) {
            // Every ray arrives here: light and point are the two foci.
            let end = self.arc().min(S::PI);
            visit(self.focal_point(end, b));
            return;
        }
        for_each_root(
            -limit,
            limit,
            |theta, half| harmonics.local(theta, half, conic.offset(theta, a, b)),
            |root| {
                let (theta, touching) = match root {
                    Isolated::Simple(u) => (u, false),
                    Isolated::Touching(u) => (u, true),
                };
                let q = conic.point(theta);
                let in_front = conic.front(&q, a) > S::ZERO && conic.front(&q, b) > S::ZERO;
                if q.delta > S::ZERO && in_front {
                    let transfer = conic.transfer(theta, a, b, self.light.z);
                    let conditioning = self.conditioning(x, y, theta);
                    visit(self.root(theta, &q, b, transfer, conditioning, touching));
                }
            },
        );
    }

    /// The root at which every ray arrives, by its lowest hit.
    fn focal_point(&self, end: S, b: (S, S)) -> Root<S> {
        let conic = self.conic();
        let q = conic.point(end);
        let infinite = S::ONE / S::ZERO;
        let mut transfer = conic.transfer(end, self.lamp(), b, self.light.z);
        transfer.irradiance = infinite;
        transfer.spread = S::ZERO;
        self.root(end, &q, b, transfer, infinite, true)
    }

    fn root(
        &self,
        theta: S,
        q: &Point<S>,
        b: (S, S),
        transfer: Transfer<S>,
        conditioning: S,
        touching: bool,
    ) -> Root<S> {
        let (first, second) = (transfer.first, transfer.second);
        let z = self.light.z * second / (first + second);
        let w = ((b.0 - q.at.0) / second, (b.1 - q.at.1) / second);
        let (c, s) = self.axis;
        let free = match self.conic().second_meeting(q, w) {
            None => S::ONE / S::ZERO,
            Some(tau) => {
                let (x, y) = (q.at.0 + tau * w.0, q.at.1 + tau * w.1);
                (tau - second).max((y.atan2(x).abs() - self.arc()) * x.hypot(y))
            }
        };
        Root {
            theta,
            hit: vec3(
                self.x + q.at.0 * c - q.at.1 * s,
                self.y + q.at.0 * s + q.at.1 * c,
                z,
            ),
            cos_incidence: transfer.cosine,
            to_wall: first,
            from_wall: second,
            spread: transfer.spread,
            irradiance: self.intensity * self.reflectance * transfer.irradiance,
            conditioning,
            on_arc: self.arc() - theta.abs(),
            below_rim: self.height - z,
            free,
            touching,
        }
    }

    /// Differentiates the irradiance along the root, dθ = -(∂G/∂p dp)/G'.
    fn conditioning(&self, x: S, y: S, theta: S) -> S {
        type G<S> = Gradient<S, 7>;
        let (a, b) = (self.lamp(), self.local(x, y));
        let (size_a, size_b) = (self.extent(self.light.x, self.light.y), self.extent(x, y));
        let conic = Conic {
            parameter: G::input(self.parameter, 0, self.parameter),
            eccentricity: G::input(self.eccentricity, 1, self.eccentricity),
        };
        let a = (G::input(a.0, 2, size_a), G::input(a.1, 3, size_a));
        let b = (G::input(b.0, 4, size_b), G::input(b.1, 5, size_b));
        let height = G::input(self.light.z, 6, self.light.z);
        let mut moving = G::constant(theta);
        let (value, slope) = conic.offset(moving, a, b);
        for (m, v) in moving.slopes.iter_mut().zip(value.slopes) {
            *m = -v / slope.value;
        }
        conic
            .transfer(moving, a, b, height)
            .irradiance
            .relative_change()
    }

    /// Irradiance of the floor point (x, y) by one reflection at the wall (LSDE) [W/m²]; infinite at a point focus.
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        self.for_each_root(x, y, |root| {
            let lit = root.is_lit();
            if lit {
                sum.add(root.irradiance, root.conditioning);
            }
            // The arc's, the rim's or the second meeting's edge within rounding: the root may be there or not.
            let near = |margin: S, size: S| margin.abs() <= rounding_error(size, root.conditioning);
            let length = root.to_wall + root.from_wall + self.extent(x, y);
            if root.touching && lit {
                sum.error = S::ONE / S::ZERO;
            } else if near(root.on_arc, S::PI)
                || near(root.below_rim, self.height + root.hit.z)
                || near(root.free, length)
            {
                sum.error += root.irradiance;
            }
        });
        sum
    }

    /// How far a direct ray to a floor point is from the edge of the wall's shadow [m]: negative in the shadow, infinite
    /// where there is none.
    pub fn clearance(&self, x: S, y: S) -> S {
        let (conic, a, b) = (self.conic(), self.lamp(), self.local(x, y));
        let s = (b.0 - a.0).hypot(b.1 - a.1);
        if s == S::ZERO {
            return S::ONE / S::ZERO;
        }
        let w = ((b.0 - a.0) / s, (b.1 - a.1) / s);
        let Some(tau) = conic.exit(a, w) else {
            return S::ONE / S::ZERO;
        };
        let (qx, qy) = (a.0 + tau * w.0, a.1 + tau * w.1);
        let beside = (qy.atan2(qx).abs() - self.arc()) * qx.hypot(qy);
        let over = self.light.z * (S::ONE - tau / s) - self.height;
        (tau - s).max(beside).max(over)
    }

    /// Direct irradiance of the floor point (x, y) (LDE), in the shadow of the wall or not [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let (dx, dy, h) = (x - self.light.x, y - self.light.y, self.light.z);
        let distance = dx.hypot(dy).hypot(h);
        let e = self.intensity * h / (distance.squared() * distance);
        let size = self.extent(x, y) + self.extent(self.light.x, self.light.y);
        let clearance = self.clearance(x, y);
        if clearance >= S::ZERO {
            sum.add(e, S::from_f64(4.0) * (S::ONE + size / distance));
        }
        if clearance.abs() <= rounding_error(size + h + self.parameter, S::ZERO) {
            sum.error += e;
        }
        sum
    }
}
