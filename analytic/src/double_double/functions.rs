//! Elementary functions of double-doubles.
//!
//! * Sine and cosine: the nearest multiple of π/2 is taken off with π/2 to 159 bits, the rest is at most π/4, for which
//!   the Taylor series end below 2^-110 after 14 terms each.
//! * Angle: `libm`'s, corrected by the angle that is left after turning the point back by it; that one is below 1e-15, so
//!   that tan δ = δ.
//! * e^x - 1: Taylor series of x/512 (after multiples of ln 2), then nine doublings of m = e^r - 1 by m(m + 2).
//! * Logarithm: one Newton step from `libm`'s; next to 1 the series of 2 artanh((x - 1)/(x + 1)).

use super::{DoubleDouble, constant, two_product};
use crate::scalar::Scalar;

/// π/2 as a sum of three.
const HALF_PI: [f64; 3] = [
    core::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
];

const LN_2: DoubleDouble = constant(core::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);

/// Beyond this a multiple of π/2 is no longer exact to 1e-30.
const LARGEST_ANGLE: f64 = 1e9;

/// Sine and cosine of an angle up to 1e9 rad; NaN beyond.
pub(super) fn sine_and_cosine(angle: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    if !(angle.high.abs() <= LARGEST_ANGLE) {
        return (f64::NAN.into(), f64::NAN.into());
    }
    let turns = libm::rint(angle.high / HALF_PI[0]);
    let rest = HALF_PI
        .iter()
        .fold(angle, |rest, part| rest - two_product(turns, *part));
    let (sine, cosine) = (series(rest, 1), series(rest, 0));
    match turns.rem_euclid(4.0) as u8 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Σ (-1)^j x^{2j+first}/(2j+first)!, smallest terms first by Horner's rule.
fn series(x: DoubleDouble, first: u32) -> DoubleDouble {
    let square = x * x;
    let mut sum = DoubleDouble::ONE;
    for j in (1..=14).rev() {
        let last = f64::from(2 * j + first);
        sum = DoubleDouble::ONE - sum * square / DoubleDouble::from(last * (last - 1.0));
    }
    if first == 1 { sum * x } else { sum }
}

/// Angle of the point (x, y), in (-π, π].
pub(super) fn angle(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let start = DoubleDouble::from(libm::atan2(y.high, x.high));
    // The same length for both, near 1: neither squares nor products leave the range.
    let largest = f64::max(y.high.abs(), x.high.abs());
    if largest == 0.0 || !largest.is_finite() {
        return start;
    }
    let power = -libm::ilogb(largest);
    let (y, x) = (y.scaled(power), x.scaled(power));
    let (sine, cosine) = sine_and_cosine(start);
    start + (y * cosine - x * sine) / (x * cosine + y * sine)
}

/// e^x - 1.
pub(super) fn exponential_less_one(x: DoubleDouble) -> DoubleDouble {
    if x.high.abs() < 0.5 {
        small_exponential_less_one(x)
    } else {
        exponential(x) - DoubleDouble::ONE
    }
}

/// e^x.
pub(super) fn exponential(x: DoubleDouble) -> DoubleDouble {
    if x.high > 709.0 {
        return f64::INFINITY.into();
    }
    if x.high < -745.0 {
        return DoubleDouble::ZERO;
    }
    let turns = libm::rint(x.high / LN_2.high);
    let rest = x - LN_2 * DoubleDouble::from(turns);
    let sum = DoubleDouble::ONE + small_exponential_less_one(rest);
    sum.scaled(turns as i32)
}

fn small_exponential_less_one(x: DoubleDouble) -> DoubleDouble {
    let x = x.scaled(-9);
    let mut sum = DoubleDouble::ONE;
    for j in (2..=10).rev() {
        sum = DoubleDouble::ONE + sum * x / DoubleDouble::from(f64::from(j));
    }
    let mut m = sum * x;
    for _ in 0..9 {
        m = m * (m + DoubleDouble::TWO);
    }
    m
}

/// ln x; NaN below 0.
pub(super) fn logarithm(x: DoubleDouble) -> DoubleDouble {
    let start = libm::log(x.high);
    if !start.is_finite() {
        return start.into();
    }
    let off = x - DoubleDouble::ONE;
    if off.high.abs() < 0.1 {
        let z = off / (x + DoubleDouble::ONE);
        let square = z * z;
        let mut sum = DoubleDouble::ZERO;
        for j in (0..=13).rev() {
            sum = sum * square + DoubleDouble::ONE / DoubleDouble::from(f64::from(2 * j + 1));
        }
        return (sum * z).scaled(1);
    }
    let start = DoubleDouble::from(start);
    start + (x * exponential(-start) - DoubleDouble::ONE)
}
