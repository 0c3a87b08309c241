//! Numbers that carry their partial derivatives: the conditioning of a closed form, from the closed form itself.
//!
//! Forward differentiation: every operation applies the chain rule to N partial derivatives (A. Griewank & A. Walther,
//! Evaluating Derivatives, 2nd ed., SIAM 2008, §3.1). An input p that is known to a relative error ε is seeded with the
//! slope |p|; the sum of the moduli of the result's slopes, over its value, is then its relative change per ε.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::scalar::Scalar;

/// A value with `N` partial derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<S, const N: usize> {
    /// The value.
    pub value: S,
    /// Its derivatives.
    pub slopes: [S; N],
}

impl<S: Scalar, const N: usize> Gradient<S, N> {
    /// A number that depends on nothing.
    #[inline(always)]
    pub fn constant(value: S) -> Self {
        Gradient {
            value,
            slopes: [S::ZERO; N],
        }
    }

    /// Input number `index`, which changes by `size`.
    #[inline(always)]
    pub fn input(value: S, index: usize, size: S) -> Self {
        let mut out = Self::constant(value);
        if let Some(slope) = out.slopes.get_mut(index) {
            *slope = size;
        }
        out
    }

    /// Sum of the moduli of all slopes: the change of the value when every input changes by its size.
    #[inline]
    pub fn change(&self) -> S {
        self.slopes.iter().fold(S::ZERO, |sum, s| sum + s.abs())
    }

    /// The change over the value; 0 for the value 0.
    #[inline]
    pub fn relative_change(&self) -> S {
        if self.value == S::ZERO {
            S::ZERO
        } else {
            self.change() / self.value.abs()
        }
    }

    /// `value`, with the slopes times `factor`: the chain rule.
    #[inline(always)]
    fn chain(self, value: S, factor: S) -> Self {
        Gradient {
            value,
            slopes: self.slopes.map(|s| s * factor),
        }
    }

    #[inline(always)]
    fn combine(self, o: Self, value: S, factor: S, other_factor: S) -> Self {
        let mut slopes = self.slopes;
        for (s, t) in slopes.iter_mut().zip(o.slopes) {
            *s = *s * factor + t * other_factor;
        }
        Gradient { value, slopes }
    }
}

/// Relative change of `f` per relative change of its inputs, all of them changing for the worse.
#[inline]
pub fn conditioning<S: Scalar, const N: usize>(
    inputs: [S; N],
    f: impl Fn([Gradient<S, N>; N]) -> Gradient<S, N>,
) -> S {
    let mut index = 0;
    let seeded = inputs.map(|p| {
        index += 1;
        Gradient::input(p, index - 1, p.abs())
    });
    f(seeded).relative_change()
}

impl<S: Scalar, const N: usize> PartialEq for Gradient<S, N> {
    #[inline(always)]
    fn eq(&self, o: &Self) -> bool {
        self.value == o.value
    }
}

impl<S: Scalar, const N: usize> PartialOrd for Gradient<S, N> {
    #[inline(always)]
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&o.value)
    }
}

impl<S: Scalar, const N: usize> Add for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        self.combine(o, self.value + o.value, S::ONE, S::ONE)
    }
}

impl<S: Scalar, const N: usize> Sub for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self.combine(o, self.value - o.value, S::ONE, -S::ONE)
    }
}

impl<S: Scalar, const N: usize> Mul for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        self.combine(o, self.value * o.value, o.value, self.value)
    }
}

impl<S: Scalar, const N: usize> Div for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, o: Self) -> Self {
        let value = self.value / o.value;
        self.combine(o, value, S::ONE / o.value, -value / o.value)
    }
}

impl<S: Scalar, const N: usize> Neg for Gradient<S, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.chain(-self.value, -S::ONE)
    }
}

impl<S: Scalar, const N: usize> AddAssign for Gradient<S, N> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl<S: Scalar, const N: usize> SubAssign for Gradient<S, N> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl<S: Scalar, const N: usize> Scalar for Gradient<S, N> {
    const ZERO: Self = Gradient {
        value: S::ZERO,
        slopes: [S::ZERO; N],
    };
    const ONE: Self = Gradient {
        value: S::ONE,
        slopes: [S::ZERO; N],
    };
    const TWO: Self = Gradient {
        value: S::TWO,
        slopes: [S::ZERO; N],
    };
    const HALF: Self = Gradient {
        value: S::HALF,
        slopes: [S::ZERO; N],
    };
    const PI: Self = Gradient {
        value: S::PI,
        slopes: [S::ZERO; N],
    };
    const EPSILON: Self = Gradient {
        value: S::EPSILON,
        slopes: [S::ZERO; N],
    };

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::constant(S::from_f64(value))
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    fn from_decimal(text: &str) -> Option<Self> {
        S::from_decimal(text).map(Self::constant)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        // √0 of a number that does not change does not change either.
        if root == S::ZERO && self.change() == S::ZERO {
            return Self::constant(root);
        }
        self.chain(root, S::HALF / root)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        if self.value < S::ZERO { -self } else { self }
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.chain(sine, cosine), self.chain(cosine, -sine))
    }
    #[inline(always)]
    fn tan(self) -> Self {
        let tangent = self.value.tan();
        self.chain(tangent, S::ONE + tangent.squared())
    }
    #[inline(always)]
    fn asin(self) -> Self {
        let v = self.value;
        let root = ((S::ONE - v) * (S::ONE + v)).sqrt();
        self.chain(v.asin(), S::ONE / root)
    }
    #[inline(always)]
    fn atan(self) -> Self {
        let v = self.value;
        self.chain(v.atan(), S::ONE / (S::ONE + v.squared()))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let (s, c) = (self.value, x.value);
        let squared = s.squared() + c.squared();
        self.combine(x, s.atan2(c), c / squared, -s / squared)
    }
    #[inline(always)]
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.chain(e, e)
    }
    #[inline(always)]
    fn exp_m1(self) -> Self {
        self.chain(self.value.exp_m1(), self.value.exp())
    }
    #[inline(always)]
    fn ln(self) -> Self {
        self.chain(self.value.ln(), S::ONE / self.value)
    }
    #[inline(always)]
    fn hypot(self, other: Self) -> Self {
        let h = self.value.hypot(other.value);
        if h == S::ZERO && self.change() + other.change() == S::ZERO {
            return Self::constant(h);
        }
        self.combine(other, h, self.value / h, other.value / h)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
    // Not the product: the square of an interval is narrower.
    #[inline(always)]
    fn squared(self) -> Self {
        self.chain(self.value.squared(), S::TWO * self.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type G = Gradient<f64, 2>;

    /// Every operation once, in one expression.
    fn everything<S: Scalar>(x: S, y: S) -> S {
        let mut sum = (x * y).sin() + (x / y).cos() - (x - y).tan();
        sum += (x * S::HALF).asin() + (x + y).atan() + x.atan2(y) + (-x).exp();
        sum -= y.exp_m1() + x.ln() + x.hypot(y) + (x - S::TWO).abs() + y.sqrt();
        sum
    }

    #[test]
    fn slopes_are_those_of_differences() {
        let (x, y) = (0.7, 1.3);
        let g = everything(G::input(x, 0, 1.0), G::input(y, 1, 1.0));
        assert_eq!(g.value, everything(x, y));
        let h = 1e-3;
        // Fourth-order central differences: error about h⁴ and 1e-13/h.
        let difference = |f: &dyn Fn(f64) -> f64| {
            (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
        };
        let dx = difference(&|t| everything(x + t, y));
        let dy = difference(&|t| everything(x, y + t));
        assert!((g.slopes[0] - dx).abs() < 1e-9, "{} {dx}", g.slopes[0]);
        assert!((g.slopes[1] - dy).abs() < 1e-9, "{} {dy}", g.slopes[1]);
    }

    #[test]
    fn conditioning_of_a_power_and_of_a_cancellation() {
        let cube = conditioning([2.0], |[x]| x * x * x);
        assert!((cube - 3.0).abs() < 1e-15);
        let difference = conditioning([1.0, 0.999], |[x, y]| x - y);
        assert!((difference - 1999.0).abs() < 1e-9);
    }
}
