//! Alhazen's problem on the unit circle: all points that reflect a source to a receiver.
//!
//! In the plane of the centre (origin), the source s and the receiver b, as complex numbers, a mirror point z = e^{iφ}
//! reflects s to b if (s - z)(b - z)/z² is real. With w = 1,
//!
//! ```text
//! g(φ) = Im[s b z⁻²] - Im[(s + w b) z⁻¹] = 0;
//! ```
//!
//! for a source at infinity in direction s, |s| = 1, the same with w = 0. g is a trigonometric polynomial of degree two:
//! at most four zeros, among them those where only one of both legs is on the mirror's side. The isolation needs no start:
//! pieces are halved until the local bound |g''| ≤ |g''(m)| + h (8|s b| + |s + w b|) proves them monotone or free of zeros.
//!
//! The circle is cut where |g| is largest among seven equidistant points. A polynomial with at most four zeros cannot be
//! small at all of them, so that no zero lies on the cut.

use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;

/// The function g.
#[derive(Clone, Copy, Debug)]
pub(super) struct Alhazen<S> {
    product: (S, S),
    sum: (S, S),
}

impl<S: Scalar> Alhazen<S> {
    /// Source `s` (a unit vector if it is `far`) and receiver `b`, in units of the radius.
    pub fn new(s: (S, S), b: (S, S), far: bool) -> Self {
        let w = if far { S::ZERO } else { S::ONE };
        Alhazen {
            product: (s.0 * b.0 - s.1 * b.1, s.0 * b.1 + s.1 * b.0),
            sum: (s.0 + w * b.0, s.1 + w * b.1),
        }
    }

    /// An upper bound of |g|.
    fn size(&self) -> S {
        self.product.0.hypot(self.product.1) + self.sum.0.hypot(self.sum.1)
    }

    fn local(&self, phi: S, half: S) -> Local<S> {
        let (c, s) = (phi.cos(), phi.sin());
        let (c2, s2) = ((c - s) * (c + s), S::TWO * s * c);
        let ((px, py), (mx, my)) = (self.product, self.sum);
        let four = S::from_f64(4.0);
        let bend = my * c - mx * s - four * (py * c2 - px * s2);
        let third = S::from_f64(8.0) * px.hypot(py) + mx.hypot(my);
        Local {
            value: py * c2 - px * s2 - (my * c - mx * s),
            slope: my * s + mx * c - S::TWO * (py * s2 + px * c2),
            curvature: bend.abs() + half * third,
            noise: four * S::EPSILON * self.size(),
        }
    }

    /// Visits all zeros, with cos φ, sin φ and whether rounding cannot tell the zero from none. No zero is visited where g
    /// vanishes everywhere: source and receiver both at the centre.
    pub fn for_each_root(&self, mut visit: impl FnMut((S, S), bool)) {
        let step = S::TWO * S::PI / S::from_f64(7.0);
        let mut cut = (S::ZERO, -S::ONE);
        for k in 0..7 {
            // The offset keeps the symmetric zeros 0 and π away from all candidates.
            let phi = step * S::from_f64(f64::from(k) - 3.4);
            let value = self.local(phi, S::ZERO).value.abs();
            if value > cut.1 {
                cut = (phi, value);
            }
        }
        if !(cut.1 > S::from_f64(64.0) * S::EPSILON * self.size()) {
            return;
        }
        for_each_root(
            cut.0,
            cut.0 + S::TWO * S::PI,
            |phi, half| self.local(phi, half),
            |root| {
                let (phi, touching) = match root {
                    Isolated::Simple(phi) => (phi, false),
                    Isolated::Touching(phi) => (phi, true),
                };
                visit((phi.cos(), phi.sin()), touching);
            },
        );
    }
}
