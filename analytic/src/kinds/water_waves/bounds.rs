//! Bounds of the surface and of the refraction over an interval: what proves that no root is lost.

use super::{Surface, Wave, refraction};
use crate::scalar::Scalar;

/// Sums over the waves that bound ζ and its derivatives everywhere.
#[derive(Clone, Debug)]
pub struct Sums<S> {
    /// Σ|A| [m].
    pub height: S,
    /// Σ|A k|.
    pub slope: S,
    /// Σ|A| k² [1/m].
    pub second: S,
    /// Σ|A k³| [1/m²].
    pub third: S,
    /// Σ|A| k⁴ [1/m³].
    pub fourth: S,
    /// Σ|A k^j p| for j = 0, 1, 2.
    phase: [S; 3],
    /// The largest |k| [1/m].
    pub largest_wave_number: S,
    /// The smallest |k| > 0 of a wave with an amplitude [1/m]; 0 without any.
    pub smallest_wave_number: S,
}

impl<S: Scalar> Sums<S> {
    pub(super) fn of(waves: &[Wave<S>]) -> Self {
        let zero = S::ZERO;
        let mut sums = Sums {
            height: zero,
            slope: zero,
            second: zero,
            third: zero,
            fourth: zero,
            phase: [zero; 3],
            largest_wave_number: zero,
            smallest_wave_number: zero,
        };
        for wave in waves {
            let (a, k, p) = (
                wave.amplitude.abs(),
                wave.wave_number.abs(),
                wave.phase.abs(),
            );
            sums.height += a;
            sums.slope += a * k;
            sums.second += a * k.squared();
            sums.third += a * k.squared() * k;
            sums.fourth += a * k.squared().squared();
            for (sum, power) in sums.phase.iter_mut().zip([S::ONE, k, k.squared()]) {
                *sum += a * power * p;
            }
            if a > zero && k > zero {
                sums.largest_wave_number = sums.largest_wave_number.max(k);
                let smallest = sums.smallest_wave_number;
                sums.smallest_wave_number = if smallest > zero { smallest.min(k) } else { k };
            }
        }
        sums
    }

    /// By how much ζ, ζ' and ζ'' change when u and every A, k and p change by themselves, each for the worse: the
    /// amplitudes and their powers of k once, the angle kx + p twice by k and u and once by p.
    pub(super) fn changes(&self, u: S) -> [S; 3] {
        let two_u = S::TWO * u;
        let [p0, p1, p2] = self.phase;
        [
            self.height + two_u * self.slope + p0,
            S::TWO * self.slope + two_u * self.second + p1,
            S::from_f64(3.0) * self.second + two_u * self.third + p2,
        ]
    }

    /// Bound of |ζ'| within `half` of a place.
    pub(super) fn slope_within(&self, at: &Surface<S>, half: S) -> S {
        let near = at.slope.abs() + (at.second.abs() + S::HALF * self.third * half) * half;
        near.min(self.slope)
    }

    /// Bound of |ζ''| within `half` of a place.
    pub(super) fn second_within(&self, at: &Surface<S>, half: S) -> S {
        let near = at.second.abs() + (at.third.abs() + S::HALF * self.fourth * half) * half;
        near.min(self.second)
    }

    /// Bound of |ζ'''| within `half` of a place.
    pub(super) fn third_within(&self, at: &Surface<S>, half: S) -> S {
        (at.third.abs() + self.fourth * half).min(self.third)
    }
}

/// Bounds of |τ| and of its derivatives for all slopes up to `slope`.
#[derive(Clone, Copy, Debug)]
pub struct SlopeBounds<S> {
    /// The steepest slope.
    pub slope: S,
    /// |τ|: it increases with s.
    pub tau: S,
    /// |τ'|.
    pub tau_1: S,
    /// |τ''|.
    pub tau_2: S,
    /// |τ'''|.
    pub tau_3: S,
}

impl<S: Scalar> SlopeBounds<S> {
    /// Bounds for |s| ≤ `slope`.
    ///
    /// τ' = n² (1 - 1/Q) (1 + s²)/(Q + s²)². The middle factor increases with s, and Q ≥ n bounds the last by its maximum
    /// at s² = max(0, n - 2). τ'' = τ' s B(s) with
    ///
    /// ```text
    /// B = 2/(1 + s²) + (Q + 1)/(Q (1 + s²)) - (n² - 1)/Q² - 2((n² - 1)/Q + 2)/(Q + s²),
    /// ```
    ///
    /// a difference of two positive sums, and τ''' = τ' ((s B)² + B + s B'), |s B'| bounded term by term with
    /// s Q' = (n² - 1)s²/Q ≤ Q.
    pub(super) fn of(n: S, slope: S) -> Self {
        let r = refraction(n, slope);
        let (one, two, four) = (S::ONE, S::TWO, S::from_f64(4.0));
        let m = n.squared();
        let gap = (n - one) * (n + one);
        let peak = if n > two {
            one / (four * (n - one))
        } else {
            one / m
        };
        let tau_1 = m * (one - one / r.q) * peak;
        let last = two * (gap / n + two) / n;
        let b = (S::from_f64(3.0) + one / n).max(gap / m + last);
        let b_1 = one + S::HALF * (one + one / n) + one / n + four * gap / m + two * last;
        let turn = slope * b;
        SlopeBounds {
            slope,
            tau: r.tau.abs(),
            tau_1,
            tau_2: tau_1 * turn,
            tau_3: tau_1 * (turn.squared() + b + b_1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bounds against differences of the formula, on a grid of slopes and indices.
    #[test]
    fn derivatives_of_the_refraction_stay_below_their_bounds() {
        for n in [1.001, 1.2, 1.333, 1.9, 2.4, 5.0, 10.0] {
            for steepest in [0.01, 0.2, 1.0, 3.0] {
                let b = SlopeBounds::of(n, steepest);
                for j in 0..=200 {
                    let s = steepest * f64::from(j) / 200.0;
                    let h = 1e-4;
                    let f = |s: f64| refraction(n, s);
                    let second = (f(s + h).tau_1 - f(s - h).tau_1) / (2.0 * h);
                    let third = (f(s + h).tau_1 - 2.0 * f(s).tau_1 + f(s - h).tau_1) / (h * h);
                    let slope = (f(s + h).tau - f(s - h).tau) / (2.0 * h);
                    assert!((slope - f(s).tau_1).abs() < 1e-6, "{n} {s}");
                    assert!(f(s).tau <= b.tau * (1.0 + 1e-14), "{n} {s}");
                    assert!(f(s).tau_1 <= b.tau_1 * (1.0 + 1e-12), "{n} {s}");
                    assert!(second.abs() <= b.tau_2 + 1e-6, "{n} {s} {second}");
                    assert!(third.abs() <= b.tau_3 + 1e-5, "{n} {s} {third}");
                }
            }
        }
    }
}
