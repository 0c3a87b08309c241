//! The operations of IEEE arithmetic rounded down and up.
//!
//! The rounding error of a sum, a product, a quotient or a root is known exactly, up to its sign at least, from
//! error-free transformations (D. E. Knuth, The Art of Computer Programming 2, §4.2.2; T. J. Dekker, Numerische
//! Mathematik 18, 1971): only a result that is on the wrong side moves by one unit in the last place.

use crate::double_double::{two_product, two_sum};

/// Products within these moduli are split without over- or underflow.
const RANGE: core::ops::Range<f64> = 1e-140..1e140;

fn in_range(value: f64) -> bool {
    RANGE.contains(&value.abs())
}

/// `value`, moved down if the exact result is `error` (or unknown, a NaN) away.
fn down(value: f64, error: f64) -> f64 {
    if error >= 0.0 {
        value
    } else {
        value.next_down()
    }
}

fn up(value: f64, error: f64) -> f64 {
    if error <= 0.0 {
        value
    } else {
        value.next_up() + 0.0
    }
}

pub(super) fn add_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.is_nan() {
        return f64::NEG_INFINITY;
    }
    // NaN on overflow.
    down(sum, two_sum(a, b).low)
}

pub(super) fn add_up(a: f64, b: f64) -> f64 {
    // From 0.0, so that no end becomes -0.
    0.0 - add_down(-a, -b)
}

pub(super) fn mul_down(a: f64, b: f64) -> f64 {
    // Ends may be infinite, factors are not: 0 · ∞ is 0 as an end.
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    let product = a * b;
    let error = if in_range(a) && in_range(b) && in_range(product) {
        two_product(a, b).low
    } else {
        f64::NAN
    };
    down(product, error)
}

pub(super) fn mul_up(a: f64, b: f64) -> f64 {
    0.0 - mul_down(-a, b)
}

/// `a/b` for b > 0.
pub(super) fn div_down(a: f64, b: f64) -> f64 {
    if a == 0.0 {
        return 0.0;
    }
    let quotient = a / b;
    if quotient.is_nan() {
        return f64::NEG_INFINITY;
    }
    let error = if in_range(a) && in_range(b) && in_range(quotient) {
        // The remainder a - q b is a number of the format; its sign is that of the error.
        let product = quotient * b;
        (a - product) - two_product(quotient, b).low
    } else {
        f64::NAN
    };
    down(quotient, error)
}

pub(super) fn div_up(a: f64, b: f64) -> f64 {
    0.0 - div_down(-a, b)
}

fn sqrt_error(a: f64, root: f64) -> f64 {
    if a == 0.0 {
        0.0
    } else if in_range(a) {
        let square = root * root;
        (a - square) - two_product(root, root).low
    } else {
        f64::NAN
    }
}

pub(super) fn sqrt_down(a: f64) -> f64 {
    let root = a.sqrt();
    f64::max(down(root, sqrt_error(a, root)), 0.0)
}

pub(super) fn sqrt_up(a: f64) -> f64 {
    let root = a.sqrt();
    up(root, sqrt_error(a, root))
}
