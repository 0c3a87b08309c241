//! Intervals that provably contain a real number.
//!
//! Every operation returns the interval of all results for all numbers in its operands, rounded outward:
//!
//! * `+ - * / sqrt` are correctly rounded in IEEE arithmetic; an error-free transformation tells on which side of the
//!   rounded result the exact one lies, so that only this end moves, by one unit in the last place. Where the
//!   transformation could over- or underflow both ends move.
//! * For the transcendental functions the `libm` crate documents errors below 1 ULP (2 ULP for `atan2`, which divides
//!   first). [`MARGIN`] = 4 ULP are added on both sides: twice the worst documented error, so that a port that is one
//!   bit worse than its original is still enclosed.
//! * Outside a function's domain (√ of negative numbers, ln, asin) the domain is cut out: the answer holds for those
//!   numbers of the operand for which there is one, and is the whole line if there are none. Division by an interval that
//!   contains 0 inside is the whole line.
//!
//! **Comparisons.** `a < b` holds if it holds for all numbers of both. Where the intervals overlap the comparison is
//! undecided: `partial_cmp` is `None`, so that every operator answers `false`, and a generic formula that branches on it
//! would silently take one side. Every such event is counted; [`decided`] runs a computation and hands out its result
//! only if none occurred. An iteration that stops when it has converged encloses its last iterate, not the limit:
//! never certify through one.

use core::cell::Cell;
use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::scalar::Scalar;

mod functions;
mod rounding;

use rounding::{add_down, add_up, div_down, div_up, mul_down, mul_up};

/// Units in the last place added on both sides of a transcendental function's value.
pub const MARGIN: u32 = 4;

thread_local! {
    static UNDECIDED: Cell<u64> = const { Cell::new(0) };
}

/// The result of `f` if no comparison of enclosures in it, on this thread, was undecided.
pub fn decided<T>(f: impl FnOnce() -> T) -> Option<T> {
    let before = UNDECIDED.get();
    let result = f();
    (UNDECIDED.get() == before).then_some(result)
}

/// A closed interval [low, high]; the ends may be infinite.
#[derive(Clone, Copy, Debug)]
pub struct Enclosure {
    low: f64,
    high: f64,
}

impl Enclosure {
    /// The whole line.
    pub const ENTIRE: Self = Enclosure {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// A single number; the whole line for a NaN.
    pub fn point(value: f64) -> Self {
        Self::new(value, value)
    }

    /// All numbers between two, in any order; the whole line if one is a NaN.
    pub fn new(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self::ENTIRE;
        }
        // -0 would turn atan2 and division round.
        Enclosure {
            low: f64::min(a, b) + 0.0,
            high: f64::max(a, b) + 0.0,
        }
    }

    /// The lower end.
    pub fn low(self) -> f64 {
        self.low
    }

    /// The upper end.
    pub fn high(self) -> f64 {
        self.high
    }

    /// Width, rounded up.
    pub fn width(self) -> f64 {
        add_up(self.high, -self.low)
    }

    /// Width over the smallest modulus; 0 for a single number, infinite if 0 is inside.
    pub fn relative_width(self) -> f64 {
        if self.low == self.high {
            return 0.0;
        }
        let smallest = self.abs().low;
        if smallest > 0.0 {
            div_up(self.width(), smallest)
        } else {
            f64::INFINITY
        }
    }

    /// A finite number in the middle.
    pub fn middle(self) -> f64 {
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => (0.5 * self.low + 0.5 * self.high).clamp(self.low, self.high),
            (true, false) => f64::max(1.0, 2.0 * self.low).min(f64::MAX),
            (false, true) => f64::min(-1.0, 2.0 * self.high).max(f64::MIN),
            (false, false) => 0.0,
        }
    }

    /// Whether `value` is inside.
    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Whether all of `other` is inside.
    pub fn encloses(self, other: Self) -> bool {
        self.low <= other.low && other.high <= self.high
    }

    /// What both have in common.
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (low, high) = (
            f64::max(self.low, other.low),
            f64::min(self.high, other.high),
        );
        (low <= high).then_some(Enclosure { low, high })
    }

    /// The smallest interval that contains both.
    pub fn hull(self, other: Self) -> Self {
        Enclosure {
            low: f64::min(self.low, other.low),
            high: f64::max(self.high, other.high),
        }
    }

    /// Whether all of it is above 0.
    pub fn is_positive(self) -> bool {
        self.low > 0.0
    }

    /// Whether all of it is below 0.
    pub fn is_negative(self) -> bool {
        self.high < 0.0
    }

    /// +1 or -1 if all of it has that sign; `None` if 0 is inside.
    pub fn sign(self) -> Option<i8> {
        if self.is_positive() {
            Some(1)
        } else if self.is_negative() {
            Some(-1)
        } else {
            None
        }
    }

    /// Whether a number of the interval can be 0.
    pub fn may_vanish(self) -> bool {
        self.sign().is_none()
    }
}

impl PartialEq for Enclosure {
    /// Whether both are one and the same number. Unlike the order this is never counted as undecided.
    fn eq(&self, o: &Self) -> bool {
        self.low == self.high && o.low == o.high && self.low == o.low
    }
}

impl PartialOrd for Enclosure {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        if self == o {
            Some(Ordering::Equal)
        } else if self.high < o.low {
            Some(Ordering::Less)
        } else if self.low > o.high {
            Some(Ordering::Greater)
        } else {
            UNDECIDED.set(UNDECIDED.get() + 1);
            None
        }
    }
}

impl Add for Enclosure {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Enclosure {
            low: add_down(self.low, o.low),
            high: add_up(self.high, o.high),
        }
    }
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        Enclosure {
            low: 0.0 - self.high,
            high: 0.0 - self.low,
        }
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let corners = [
            (self.low, o.low),
            (self.low, o.high),
            (self.high, o.low),
            (self.high, o.high),
        ];
        let low = corners.iter().map(|&(a, b)| mul_down(a, b));
        let high = corners.iter().map(|&(a, b)| mul_up(a, b));
        Enclosure {
            low: low.fold(f64::INFINITY, f64::min),
            high: high.fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

impl Div for Enclosure {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        if o.low < 0.0 && o.high > 0.0 || o.low == 0.0 && o.high == 0.0 {
            return Self::ENTIRE;
        }
        if o.high <= 0.0 {
            return -self / -o;
        }
        // The divisor is above 0, or from 0 upward.
        let (low, high) = if o.low == 0.0 {
            (
                if self.low < 0.0 {
                    f64::NEG_INFINITY
                } else {
                    div_down(self.low, o.high)
                },
                if self.high > 0.0 {
                    f64::INFINITY
                } else {
                    div_up(self.high, o.high)
                },
            )
        } else {
            let by = |end: f64, towards_high: bool| {
                if towards_high {
                    (end, o.low)
                } else {
                    (end, o.high)
                }
            };
            let (a, b) = by(self.low, self.low < 0.0);
            let (c, d) = by(self.high, self.high > 0.0);
            (div_down(a, b), div_up(c, d))
        };
        Enclosure { low, high }
    }
}

impl AddAssign for Enclosure {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl SubAssign for Enclosure {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}
