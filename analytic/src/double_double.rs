//! Sums of two `f64`: about 31 digits, a second precision to measure the first by.
//!
//! Error-free transformations: Knuth's two-sum and Dekker's two-product with Veltkamp splitting (T. J. Dekker, "A
//! floating-point technique for extending the available precision", Numerische Mathematik 18, 1971), so that no fused
//! multiply-add is needed. Valid while no intermediate exceeds 1e290 or falls below 1e-250.
//!
//! **Accuracy**: `+ - *` within 2^-104 relative, `/` and `sqrt` within 2^-102; the transcendental functions, in
//! [`functions`], within 1e-30 of the larger of the value and of what its argument's last bit changes, for angles up to
//! 1e9 rad.

mod functions;

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::decimal::nearest_and_rest;
use crate::scalar::Scalar;

/// The unevaluated sum `high + low`, |low| ≤ ulp(high)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub high: f64,
    /// The rest.
    pub low: f64,
}

/// `a + b` exactly, barring overflow.
pub(crate) fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let sum = a + b;
    let v = sum - a;
    DoubleDouble {
        high: sum,
        low: (a - (sum - v)) + (b - v),
    }
}

fn quick_two_sum(a: f64, b: f64) -> DoubleDouble {
    let sum = a + b;
    DoubleDouble {
        high: sum,
        low: b - (sum - a),
    }
}

fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a;
    let high = t - (t - a);
    (high, a - high)
}

/// `a b` exactly, barring over- and underflow.
pub(crate) fn two_product(a: f64, b: f64) -> DoubleDouble {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    DoubleDouble {
        high: product,
        low: ((ah * bh - product) + ah * bl + al * bh) + al * bl,
    }
}

const fn constant(high: f64, low: f64) -> DoubleDouble {
    DoubleDouble { high, low }
}

impl DoubleDouble {
    /// `self · 2^power`, exactly.
    fn scaled(self, power: i32) -> Self {
        let by = |v: f64| libm::scalbn(v, power);
        constant(by(self.high), by(self.low))
    }

    /// A result whose leading part is infinite or NaN carries no rest.
    fn sound(self) -> Self {
        if self.high.is_finite() {
            self
        } else {
            constant(self.high, 0.0)
        }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        DoubleDouble { high, low: 0.0 }
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&o.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&o.low),
            order => order,
        }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let s = two_sum(self.high, o.high);
        let t = two_sum(self.low, o.low);
        let u = quick_two_sum(s.high, s.low + t.high);
        let sum = quick_two_sum(u.high, u.low + t.low);
        if s.high.is_finite() {
            sum
        } else {
            constant(s.high, 0.0)
        }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        DoubleDouble {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = two_product(self.high, o.high);
        if !p.high.is_finite() {
            return constant(p.high, 0.0);
        }
        quick_two_sum(p.high, p.low + (self.high * o.low + self.low * o.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let q1 = self.high / o.high;
        if !q1.is_finite() || !o.high.is_finite() {
            return constant(q1, 0.0);
        }
        let r = self - o * DoubleDouble::from(q1);
        let q2 = r.high / o.high;
        let r = r - o * DoubleDouble::from(q2);
        let q = quick_two_sum(q1, q2);
        q + DoubleDouble::from(r.high / o.high)
    }
}

impl AddAssign for DoubleDouble {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl SubAssign for DoubleDouble {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl Scalar for DoubleDouble {
    const ZERO: Self = constant(0.0, 0.0);
    const ONE: Self = constant(1.0, 0.0);
    const TWO: Self = constant(2.0, 0.0);
    const HALF: Self = constant(0.5, 0.0);
    const PI: Self = constant(core::f64::consts::PI, 1.224_646_799_147_353_2e-16);
    // 2^-104: what a product may lose.
    const EPSILON: Self = constant(4.930_380_657_631_324e-32, 0.0);

    fn from_f64(value: f64) -> Self {
        value.into()
    }
    fn to_f64(self) -> f64 {
        self.high
    }
    fn from_decimal(text: &str) -> Option<Self> {
        let (high, low) = nearest_and_rest(text)?;
        Some(quick_two_sum(high, low).sound())
    }
    fn sqrt(self) -> Self {
        let root = self.high.sqrt();
        if root == 0.0 || !root.is_finite() {
            return root.into();
        }
        // One step of Newton's method doubles the digits.
        let rest = self - two_product(root, root);
        quick_two_sum(root, 0.0) + rest / DoubleDouble::from(2.0 * root)
    }
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    fn sin(self) -> Self {
        functions::sine_and_cosine(self).0
    }
    fn cos(self) -> Self {
        functions::sine_and_cosine(self).1
    }
    fn tan(self) -> Self {
        let (sine, cosine) = functions::sine_and_cosine(self);
        sine / cosine
    }
    fn asin(self) -> Self {
        let other = (Self::ONE - self) * (Self::ONE + self);
        self.atan2(other.sqrt())
    }
    fn atan(self) -> Self {
        self.atan2(Self::ONE)
    }
    fn atan2(self, x: Self) -> Self {
        functions::angle(self, x)
    }
    fn exp(self) -> Self {
        functions::exponential(self)
    }
    fn exp_m1(self) -> Self {
        functions::exponential_less_one(self)
    }
    fn ln(self) -> Self {
        functions::logarithm(self)
    }
    fn hypot(self, other: Self) -> Self {
        let (a, b) = (self.abs(), other.abs());
        let (large, small) = if a < b { (b, a) } else { (a, b) };
        if large.high == 0.0 || !large.high.is_finite() {
            return large;
        }
        let power = libm::ilogb(large.high);
        let (p, q) = (large.scaled(-power), small.scaled(-power));
        (p * p + q * q).sqrt().scaled(power)
    }
    fn is_finite(self) -> bool {
        self.high.is_finite()
    }
}
