//! The light at the focus: the reflection at a conic wall without root finding.
//!
//! Reflected rays are those of the other focus F2, where s1 ± d2 = 2a along each ray (d2 = |Q F2|, the wall's equation about
//! F2), so that with d = |P F2|
//!
//! ```text
//! ellipse    F2 = (-2c, 0), behind which every ray passes: Q = F2 ± d2 (P - F2)/d, s1 = 2a - d2, s2 = d2 ∓ d
//! parabola   all rays run along -x: Q = ((p² - y²)/(2p), y), W = s1 = (p² + y²)/(2p)
//! hyperbola  F2 = (2c, 0), a virtual source: Q = F2 + d2 (P - F2)/d, s1 = d2 - 2a, s2 = d - d2
//! W = s1 d/d2,     d2 = p/|1 ∓ e cos β|,     c = e p/|1 - e²|,     a = p/|1 - e²|,
//! ```
//!
//! β the angle of Q - F2 from the direction of F2 to F and beyond, to the axis. For an ellipse P = F2 is a point focus.
//! Derived here from the two focal properties, without the curvature of the wall.

use super::{ConicWall, Root, Transfer};
use crate::gradient::Gradient;
use crate::scalar::Scalar;

/// A reflected ray: the point Q and the lengths s1, s2, W.
struct Leg<S> {
    at: (S, S),
    first: S,
    second: S,
    spread: S,
}

/// Which of the two rays of an ellipse: `side` is 1 where Q is beyond P from F2, and -1 behind F2.
fn leg<S: Scalar>(p: S, e: S, (x, y): (S, S), side: S) -> Option<Leg<S>> {
    if e == S::ONE {
        let (low, high) = (p.squared(), y.squared());
        let at = ((low - high) / (S::TWO * p), y);
        let first = (low + high) / (S::TWO * p);
        return Some(Leg {
            at,
            first,
            second: at.0 - x,
            spread: first,
        });
    }
    let gap = (S::ONE - e) * (S::ONE + e);
    let other = -(S::TWO * e * p / gap);
    let (dx, dy) = (x - other, y);
    let d = dx.hypot(dy);
    let w = (side * dx / d, side * dy / d);
    // 1 - e cos β, negative for a hyperbola: the branch about the other focus has no such point.
    let denominator = S::ONE - e * w.0;
    let hyperbola = e > S::ONE;
    let reach = if hyperbola {
        // β is from -x there, and P is on one side of F2 only.
        let denominator = -(S::ONE + e * w.0);
        if !(denominator > S::ZERO && side > S::ZERO) {
            return None;
        }
        p / denominator
    } else {
        p / denominator
    };
    let at = (other + reach * w.0, reach * w.1);
    let first = p - e * at.0;
    Some(Leg {
        at,
        first,
        second: if hyperbola {
            d - reach
        } else {
            reach - side * d
        },
        spread: first * d / reach,
    })
}

/// E/(I R).
fn transfer<S: Scalar>(leg: &Leg<S>, height: S) -> S {
    let s = leg.first + leg.second;
    let distance = s.hypot(height);
    height * s / (distance.squared() * distance * leg.spread)
}

impl<S: Scalar> ConicWall<S> {
    /// Visits the rays of a light at the focus that reach the floor point (x, y): two for an ellipse, one otherwise.
    pub fn for_each_focal_root(&self, x: S, y: S, mut visit: impl FnMut(Root<S>)) {
        type G<S> = Gradient<S, 5>;
        let b = self.local(x, y);
        let (p, e, h) = (self.parameter, self.eccentricity, self.light.z);
        let closing = e < S::ONE;
        if closing && {
            let gap = (S::ONE - e) * (S::ONE + e);
            let at_focus = (b.0 + S::TWO * e * p / gap).hypot(b.1);
            !(at_focus > S::ZERO)
        } {
            visit(self.focal_point(self.arc().min(S::PI), b));
            return;
        }
        let size = self.extent(x, y);
        for side in [S::ONE, -S::ONE] {
            if side < S::ZERO && !closing {
                break;
            }
            let Some(leg_) = leg(p, e, b, side) else {
                continue;
            };
            if !(leg_.second > S::ZERO) {
                continue;
            }
            let g = leg(
                G::input(p, 0, p),
                G::input(e, 1, e),
                (G::input(b.0, 2, size), G::input(b.1, 3, size)),
                if side < S::ZERO { -G::ONE } else { G::ONE },
            );
            let conditioning = g.map_or(S::ONE / S::ZERO, |g| {
                transfer(&g, G::input(h, 4, h)).relative_change()
            });
            let theta = leg_.at.1.atan2(leg_.at.0);
            let q = self.conic().point(theta);
            let moved = Transfer {
                irradiance: transfer(&leg_, h),
                first: leg_.first,
                second: leg_.second,
                cosine: q.delta / q.norm.sqrt(),
                spread: leg_.spread,
            };
            visit(self.root(theta, &q, b, moved, conditioning, false));
        }
    }
}
