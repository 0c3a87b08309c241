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

use crate::roots::{Isolated, Local, Sample, for_each_root_of};
use crate::scalar::Scalar;

/// The function g.
#[derive(Clone, Copy, Debug)]
pub(super) struct Alhazen<S> {
    product: (S, S),
    sum: (S, S),
    /// What rounding does to g.
    noise: S,
    /// Bound of |g'''|.
    third: S,
}

impl<S: Scalar> Alhazen<S> {
    /// Source `s` (a unit vector if it is `far`) and receiver `b`, in units of the radius.
    pub fn new(s: (S, S), b: (S, S), far: bool) -> Self {
        let w = if far { S::ZERO } else { S::ONE };
        let product = (s.0 * b.0 - s.1 * b.1, s.0 * b.1 + s.1 * b.0);
        let sum = (s.0 + w * b.0, s.1 + w * b.1);
        let length = |(x, y): (S, S)| (x.squared() + y.squared()).sqrt();
        let (of_product, of_sum) = (length(product), length(sum));
        Alhazen {
            product,
            sum,
            noise: S::from_f64(4.0) * S::EPSILON * (of_product + of_sum),
            third: S::from_f64(8.0) * of_product + of_sum,
        }
    }

    /// s b z⁻² and (s + w b) z⁻¹ at z = e^{iφ}: imaginary parts, then real parts.
    #[inline(always)]
    fn parts(&self, (s, c): (S, S)) -> ((S, S), (S, S)) {
        let (c2, s2) = ((c - s) * (c + s), S::TWO * s * c);
        let ((px, py), (mx, my)) = (self.product, self.sum);
        (
            (py * c2 - px * s2, my * c - mx * s),
            (py * s2 + px * c2, my * s + mx * c),
        )
    }

    #[inline(always)]
    fn at(&self, phi: S) -> Sample<S> {
        let ((double, single), (double_1, single_1)) = self.parts(phi.sin_cos());
        Sample {
            value: double - single,
            slope: single_1 - S::TWO * double_1,
            noise: self.noise,
        }
    }

    #[inline(always)]
    fn local(&self, phi: S, half: S) -> Local<S> {
        let ((double, single), (double_1, single_1)) = self.parts(phi.sin_cos());
        let bend = single - S::from_f64(4.0) * double;
        Local {
            value: double - single,
            slope: single_1 - S::TWO * double_1,
            curvature: bend.abs() + half * self.third,
            noise: self.noise,
        }
    }

    /// Visits all zeros, with cos φ, sin φ and whether rounding cannot tell the zero from none. No zero is visited where g
    /// vanishes everywhere: source and receiver both at the centre.
    pub fn for_each_root(&self, mut visit: impl FnMut((S, S), bool)) {
        let step = S::TWO * S::PI / S::from_f64(7.0);
        let mut cut = (S::ZERO, -S::ONE);
        for (k, (sine, cosine)) in (0..7).zip(CUTS) {
            let direction = (S::from_f64(sine), S::from_f64(cosine));
            let ((double, single), _) = self.parts(direction);
            let value = (double - single).abs();
            if value > cut.1 {
                cut = (step * S::from_f64(f64::from(k) - OFFSET), value);
            }
        }
        if !(cut.1 > S::from_f64(16.0) * self.noise) {
            return;
        }
        for_each_root_of(
            cut.0,
            cut.0 + S::TWO * S::PI,
            |phi| self.at(phi),
            |phi, half| self.local(phi, half),
            |root| {
                let (phi, touching) = match root {
                    Isolated::Simple(phi) => (phi, false),
                    Isolated::Touching(phi) => (phi, true),
                };
                let (s, c) = phi.sin_cos();
                visit((c, s), touching);
            },
        );
    }
}

/// The candidates for the cut are (2π/7)(k - OFFSET): the symmetric zeros 0 and π are away from all of them.
const OFFSET: f64 = 3.4;

/// Sine and cosine of the candidates; a cut needs no more digits.
const CUTS: [(f64, f64); 7] = [
    (-0.090, -0.996),
    (-0.835, -0.551),
    (-0.951, 0.309),
    (-0.351, 0.936),
    (0.513, 0.858),
    (0.991, 0.134),
    (0.723, -0.691),
];
