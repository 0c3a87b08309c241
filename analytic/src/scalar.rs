//! The scalar that every formula is generic over.
//!
//! Formulas are written once against [`Scalar`] and instantiated in `f64` (fast) and `f32` (stability study). Interval
//! and double-double scalars implement the same trait, so a formula must stay scalar and branch-light: compare only
//! where the mathematics branches, and never convert to `f64` in the middle.
//!
//! Transcendental functions come from the `libm` crate, so that the same input gives the same bits on every platform.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number type in which the closed forms are evaluated.
///
/// **Accuracy**: `+ - * / sqrt abs` are correctly rounded; the rest is as accurate as `libm` (1 ULP).
pub trait Scalar:
    Copy
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// 1/2.
    const HALF: Self;
    /// π.
    const PI: Self;
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;

    /// The nearest value to an `f64`.
    fn from_f64(value: f64) -> Self;
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// Reads a decimal number; `None` if it is not one.
    fn from_decimal(text: &str) -> Option<Self>;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// Sine of an angle in radians.
    fn sin(self) -> Self;
    /// Cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Arc sine, in [-π/2, π/2].
    fn asin(self) -> Self;
    /// Arc tangent, in (-π/2, π/2).
    fn atan(self) -> Self;
    /// Angle of the point (`x`, `self`), in (-π, π].
    fn atan2(self, x: Self) -> Self;
    /// Sine and cosine of one angle, the same as those of [`Self::sin`] and [`Self::cos`], for less than both.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// `e^self`.
    fn exp(self) -> Self;
    /// `e^self - 1` without cancellation near 0.
    fn exp_m1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Euclidean length of (`self`, `other`) without overflow.
    fn hypot(self, other: Self) -> Self;
    /// Whether the value is neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// `self²`.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }

    /// The larger of two values (`other` if `self` is NaN).
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The smaller of two values (`other` if `self` is NaN).
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
}

macro_rules! implement_scalar {
    ($t:ty, $pi:expr, $($name:ident => $function:path),* $(,)?) => {
        impl Scalar for $t {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const TWO: Self = 2.0;
            const HALF: Self = 0.5;
            const PI: Self = $pi;
            const EPSILON: Self = <$t>::EPSILON;

            #[inline(always)]
            fn from_f64(value: f64) -> Self { value as $t }
            #[inline(always)]
            fn to_f64(self) -> f64 { self as f64 }
            fn from_decimal(text: &str) -> Option<Self> { text.trim().parse().ok() }
            // sqrt and abs are exactly rounded in hardware: the same bits everywhere.
            #[inline(always)]
            fn sqrt(self) -> Self { <$t>::sqrt(self) }
            #[inline(always)]
            fn abs(self) -> Self { <$t>::abs(self) }
            #[inline(always)]
            fn is_finite(self) -> bool { <$t>::is_finite(self) }
            $(
                #[inline(always)]
                fn $name(self) -> Self { $function(self) }
            )*
            #[inline(always)]
            fn atan2(self, x: Self) -> Self { atan2_of(self, x) }
            #[inline(always)]
            fn hypot(self, other: Self) -> Self { hypot_of(self, other) }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) { sin_cos_of(self) }
        }
    };
}

const _: () = {
    use libm::{atan2 as atan2_of, hypot as hypot_of, sincos as sin_cos_of};
    implement_scalar!(f64, core::f64::consts::PI,
        sin => libm::sin, cos => libm::cos, tan => libm::tan, asin => libm::asin, atan => libm::atan,
        exp => libm::exp, exp_m1 => libm::expm1, ln => libm::log,
    );
};

const _: () = {
    use libm::{atan2f as atan2_of, hypotf as hypot_of, sincosf as sin_cos_of};
    implement_scalar!(f32, core::f32::consts::PI,
        sin => libm::sinf, cos => libm::cosf, tan => libm::tanf, asin => libm::asinf, atan => libm::atanf,
        exp => libm::expf, exp_m1 => libm::expm1f, ln => libm::logf,
    );
};

#[cfg(test)]
mod tests {
    use super::Scalar;

    #[test]
    fn sine_and_cosine_together_have_the_bits_of_each() {
        for k in -4000..=4000_i16 {
            let x = f64::from(k) * 0.013_7;
            assert_eq!(Scalar::sin_cos(x), (libm::sin(x), libm::cos(x)), "{x}");
            let y = f32::from(k) * 0.013_7;
            assert_eq!(Scalar::sin_cos(y), (libm::sinf(y), libm::cosf(y)), "{y}");
        }
    }
}
