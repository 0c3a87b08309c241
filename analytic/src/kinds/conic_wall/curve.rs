//! The conic in plan, about its focus, and the equation of a reflection at it.
//!
//! With δ = 1 + e cos θ the curve is Q = (p/δ)(cos θ, sin θ). Up to common positive factors its tangent is
//! T = (-sin θ, e + cos θ) and its inner normal N = -(e + cos θ, sin θ), |N|² = m² = 1 + 2e cos θ + e². Q·N = -p and
//! δ Q·T = e p sin θ, so that for a point A with u = A - Q
//!
//! ```text
//! V_A = u·N = A·N + p,        U_A = δ u·T = δ A·T - e p sin θ,
//! ```
//!
//! and a ray from A is reflected to P where G(θ) = U_A V_P + U_P V_A = 0 with V_A, V_P > 0: a trigonometric polynomial of
//! degree 3, whose coefficients give proven bounds of its derivatives. Radius of curvature p (m/δ)³. Derived here.

use crate::roots::Local;
use crate::scalar::Scalar;

/// A conic section about its focus at 0, nearest to it (or, for e = 0, as near as anywhere) at θ = 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic<S> {
    /// Semi-latus rectum p [m].
    pub parameter: S,
    /// Eccentricity e ≥ 0.
    pub eccentricity: S,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point<S> {
    pub cos: S,
    pub sin: S,
    /// δ.
    pub delta: S,
    /// The point Q [m].
    pub at: (S, S),
    /// N.
    pub normal: (S, S),
    /// m².
    pub norm: S,
}

/// U and V with their derivatives.
struct Seen<S> {
    u: S,
    u_1: S,
    v: S,
    v_1: S,
}

impl<S: Scalar> Conic<S> {
    pub fn point(&self, theta: S) -> Point<S> {
        let (cos, sin) = (theta.cos(), theta.sin());
        let e = self.eccentricity;
        let delta = S::ONE + e * cos;
        let r = self.parameter / delta;
        let normal = (-(e + cos), -sin);
        Point {
            cos,
            sin,
            delta,
            at: (r * cos, r * sin),
            normal,
            norm: normal.0.squared() + normal.1.squared(),
        }
    }

    /// Whether a point is on the inner side: positive there, 0 on the curve [m].
    pub fn inside(&self, (x, y): (S, S)) -> S {
        self.parameter - self.eccentricity * x - x.hypot(y)
    }

    /// V = u·N: positive in front of the tangent line.
    pub fn front(&self, q: &Point<S>, (x, y): (S, S)) -> S {
        x * q.normal.0 + y * q.normal.1 + self.parameter
    }

    fn seen(&self, q: &Point<S>, (x, y): (S, S)) -> Seen<S> {
        let (p, e, c, s) = (self.parameter, self.eccentricity, q.cos, q.sin);
        let across = y * (e + c) - x * s;
        let turned = -(y * s + x * c);
        Seen {
            u: q.delta * across - e * p * s,
            u_1: q.delta * turned - e * s * across - e * p * c,
            v: self.front(q, (x, y)),
            v_1: x * s - y * c,
        }
    }

    /// G and G'.
    pub fn offset(&self, theta: S, a: (S, S), b: (S, S)) -> (S, S) {
        let q = self.point(theta);
        let (a, b) = (self.seen(&q, a), self.seen(&q, b));
        (
            a.u * b.v + b.u * a.v,
            a.u_1 * b.v + a.u * b.v_1 + b.u_1 * a.v + b.u * a.v_1,
        )
    }

    /// G as a polynomial in cos kθ and sin kθ.
    pub fn harmonics(&self, a: (S, S), b: (S, S)) -> Harmonics<S> {
        let mut sum = Harmonics {
            cosines: [S::ZERO; 4],
            sines: [S::ZERO; 4],
            rounding: S::ZERO,
        };
        self.add_product(&mut sum, a, b);
        self.add_product(&mut sum, b, a);
        sum
    }

    /// Adds U_A V_B.
    fn add_product(&self, sum: &mut Harmonics<S>, (ax, ay): (S, S), (bx, by): (S, S)) {
        let (p, e, half) = (self.parameter, self.eccentricity, S::HALF);
        let (c0, c1, s1) = (
            S::from_f64(1.5) * e * ay,
            ay * (S::ONE + e.squared()),
            -(ax + p * e),
        );
        let (c2, s2) = (half * e * ay, -(half * e * ax));
        let (d0, d1, t1) = (p - e * bx, -bx, -by);
        sum.cosines[0] += c0 * d0 + half * (c1 * d1 + s1 * t1);
        sum.cosines[1] += c0 * d1 + c1 * d0 + half * (c2 * d1 + s2 * t1);
        sum.sines[1] += c0 * t1 + s1 * d0 + half * (s2 * d1 - c2 * t1);
        sum.cosines[2] += c2 * d0 + half * (c1 * d1 - s1 * t1);
        sum.sines[2] += s2 * d0 + half * (c1 * t1 + s1 * d1);
        sum.cosines[3] += half * (c2 * d1 - s2 * t1);
        sum.sines[3] += half * (c2 * t1 + s2 * d1);
        let u = (ax.abs() + ay.abs()) * (S::ONE + e).squared() + p * e;
        let v = (bx.abs() + by.abs()) * (S::ONE + e) + p;
        sum.rounding += S::from_f64(4.0) * S::EPSILON * u * v;
    }

    /// For the ray from the point Q of the curve in the unit direction w into the inner side: the plan length to its
    /// second meeting with the curve, or `None` if there is none.
    ///
    /// On the line (p - e x)² - r² = 2 (p/δ)(N·w) τ - (1 - e² w_x²) τ², and where 1 - e² w_x² ≤ 0 the other zero is behind
    /// Q or on the other branch of a hyperbola.
    pub fn second_meeting(&self, q: &Point<S>, w: (S, S)) -> Option<S> {
        let forward = q.normal.0 * w.0 + q.normal.1 * w.1;
        let bend = S::ONE - (self.eccentricity * w.0).squared();
        (bend > S::ZERO).then(|| S::TWO * (self.parameter / q.delta) * forward / bend)
    }

    /// The plan length after which the ray from a point A of the inner side in the unit direction w leaves it.
    pub fn exit(&self, (x, y): (S, S), w: (S, S)) -> Option<S> {
        let (p, e) = (self.parameter, self.eccentricity);
        let far = p - e * x;
        let a = S::ONE - (e * w.0).squared();
        let b = x * w.0 + y * w.1 + e * w.0 * far;
        let r = x.hypot(y);
        let c = (far - r) * (far + r);
        let discriminant = b.squared() + a * c;
        if !(discriminant >= S::ZERO) {
            return None;
        }
        let sum = b + discriminant.sqrt();
        (sum > S::ZERO).then(|| c / sum)
    }
}

/// A trigonometric polynomial of degree 3.
#[derive(Clone, Copy, Debug)]
pub(super) struct Harmonics<S> {
    cosines: [S; 4],
    sines: [S; 4],
    /// What rounding of the coordinates does to the value.
    pub rounding: S,
}

impl<S: Scalar> Harmonics<S> {
    /// Bound of the modulus of the n-th derivative: Σ k^n (|c_k| + |s_k|).
    pub fn bound(&self, n: i32) -> S {
        (0..4).fold(S::ZERO, |sum, k| {
            let weight = (0..n).fold(S::ONE, |w, _| w * S::from_f64(f64::from(k)));
            sum + weight * (self.cosines[k as usize].abs() + self.sines[k as usize].abs())
        })
    }

    fn second(&self, theta: S) -> S {
        (1..4).fold(S::ZERO, |sum, k| {
            let n = S::from_f64(f64::from(k));
            let (c, s) = (self.cosines[k as usize], self.sines[k as usize]);
            sum - n.squared() * (c * (n * theta).cos() + s * (n * theta).sin())
        })
    }

    /// For [`crate::roots::for_each_root`], with the value and slope of G: |G''| on the piece is at most its value at the
    /// centre plus half the width times the bound of G'''.
    pub fn local(&self, theta: S, half: S, (value, slope): (S, S)) -> Local<S> {
        let whole = self.bound(2);
        let near = self.second(theta).abs() + half * self.bound(3) + self.rounding;
        Local {
            value,
            slope,
            curvature: near.min(whole),
            noise: self.rounding,
        }
    }
}
