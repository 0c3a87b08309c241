//! Where the caustic of a conic wall is.
//!
//! W = 0 at s2 = s1/(2 s1/(ρ cos i) - 1) on the ray by Q, if that is positive: the caustic curve, a fold with cusps where it
//! turns back. A light at one focus of an ellipse has the other focus as a point focus instead; at the focus of a parabola
//! or hyperbola it has no singularity at all.

use super::ConicWall;
use super::curve::Conic;
use crate::gradient::Gradient;
use crate::kinds::plan_caustic::{Touch, nearest};
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::scalar::Scalar;

/// The point of the caustic on the ray by θ, about focus and axis, and the ray's direction.
fn touching<S: Scalar>(conic: &Conic<S>, a: (S, S), theta: S) -> Option<((S, S), (S, S))> {
    let q = conic.point(theta);
    let (dx, dy) = (q.at.0 - a.0, q.at.1 - a.1);
    let first = dx.hypot(dy);
    let front = conic.front(&q, a);
    if !(q.delta > S::ZERO && front > S::ZERO) {
        return None;
    }
    let bend = first * q.delta.squared() * q.delta / (conic.parameter * q.norm * front);
    let power = S::TWO * first * bend - S::ONE;
    if !(power > S::ZERO) {
        return None;
    }
    let turn = S::TWO * front / q.norm;
    let w = (
        (dx + turn * q.normal.0) / first,
        (dy + turn * q.normal.1) / first,
    );
    let second = first / power;
    Some(((q.at.0 + second * w.0, q.at.1 + second * w.1), w))
}

impl ConicWall<f64> {
    /// The singularity nearest to the floor point (x, y) that the wall lights; `None` if there is none. Accurate to about
    /// 1e-9 of the wall's size; a caustic narrower than 1/256 of the arc can be missed.
    pub fn singularity(&self, x: f64, y: f64) -> Option<Singularity<f64>> {
        type G = Gradient<f64, 1>;
        let a = self.lamp();
        let p = self.local(x, y);
        if let Some(other) = self.image_focus() {
            let (fx, fy) = other?;
            return Some(Singularity {
                kind: SingularityKind::PointFocus,
                distance: libm::hypot(p.0 - fx, p.1 - fy),
            });
        }
        let conic = Conic {
            parameter: G::constant(self.parameter),
            eccentricity: G::constant(self.eccentricity),
        };
        let lamp = (G::constant(a.0), G::constant(a.1));
        let end = self.arc().min(core::f64::consts::PI);
        nearest(p, (-end, end), |theta| {
            let (c, w) = touching(&conic, lamp, G::input(theta, 0, 1.0))?;
            let point = (c.0.value, c.1.value);
            let direction = (w.0.value, w.1.value);
            let q = self.conic().point(theta);
            let transfer = self.conic().transfer(theta, a, point, self.light.z);
            let root = self.root(theta, &q, point, transfer, 0.0, true);
            Some(Touch {
                point,
                direction,
                speed: c.0.slopes[0] * direction.0 + c.1.slopes[0] * direction.1,
                lit: root.below_rim >= 0.0 && root.free >= 0.0,
            })
        })
    }

    /// If the light is at a focus, where the rays meet: `Some(None)` if they do not. About focus and axis.
    fn image_focus(&self) -> Option<Option<(f64, f64)>> {
        let (e, p) = (self.eccentricity, self.parameter);
        let (ax, ay) = self.lamp();
        let other = -2.0 * e * p / ((1.0 - e) * (1.0 + e));
        if (ax, ay) == (0.0, 0.0) {
            return Some((e < 1.0).then_some((other, 0.0)));
        }
        let rounding = 8.0 * f64::EPSILON * (self.extent(self.light.x, self.light.y) + p);
        if e < 1.0 && libm::hypot(ax - other, ay) <= rounding {
            return Some(Some((0.0, 0.0)));
        }
        None
    }
}
