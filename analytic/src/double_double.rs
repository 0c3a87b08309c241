//! Sums of two `f64`: about 32 digits, for the few places where 16 are not enough to round the 16th correctly.
//!
//! Error-free transformations: Knuth's two-sum and Dekker's two-product with Veltkamp splitting (T. J. Dekker, "A
//! floating-point technique for extending the available precision", Numerische Mathematik 18, 1971), so that no fused
//! multiply-add is needed. Valid while no intermediate exceeds 1e290 or falls below 1e-290.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// The unevaluated sum `high + low`, |low| ≤ ulp(high)/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub high: f64,
    /// The rest.
    pub low: f64,
}

fn two_sum(a: f64, b: f64) -> DoubleDouble {
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

fn two_product(a: f64, b: f64) -> DoubleDouble {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    DoubleDouble {
        high: product,
        low: ((ah * bh - product) + ah * bl + al * bh) + al * bl,
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        DoubleDouble { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let s = two_sum(self.high, o.high);
        let t = two_sum(self.low, o.low);
        let u = quick_two_sum(s.high, s.low + t.high);
        quick_two_sum(u.high, u.low + t.low)
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
        quick_two_sum(p.high, p.low + (self.high * o.low + self.low * o.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let q1 = self.high / o.high;
        let r = self - o * DoubleDouble::from(q1);
        let q2 = r.high / o.high;
        let r = r - o * DoubleDouble::from(q2);
        let q = quick_two_sum(q1, q2);
        q + DoubleDouble::from(r.high / o.high)
    }
}
