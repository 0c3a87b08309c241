//! Elementary functions of enclosures: ranges, with the extrema and poles inside them.

use super::rounding::{mul_down, mul_up, sqrt_down, sqrt_up};
use super::{Enclosure, MARGIN};
use crate::decimal::nearest_and_rest;
use crate::scalar::Scalar;

/// Beyond this a period of sine cannot be told apart: sin and cos are anything, tan too.
const LARGEST_ANGLE: f64 = 1e15;

impl Enclosure {
    /// Both ends moved outward by the margin of a transcendental function.
    fn widened(low: f64, high: f64) -> Self {
        let (mut low, mut high) = (low, high);
        for _ in 0..MARGIN {
            (low, high) = (low.next_down(), high.next_up());
        }
        Self::new(low, high)
    }

    /// The part of it within [low, high]; the whole of [low, high] if there is none.
    fn clipped(self, low: f64, high: f64) -> Self {
        self.intersection(Enclosure { low, high })
            .unwrap_or(Enclosure { low, high })
    }

    /// Whether `offset + k period` may be inside for an integer k.
    fn may_meet(self, offset: Self, period: Self) -> bool {
        let turns = (self - offset) / period;
        turns.low.ceil() <= turns.high
    }

    fn half_pi() -> Self {
        Self::PI * Self::HALF
    }

    /// The cosine of the angles in `self`, of which `first` and `last` are the values at the ends of `angles`.
    fn wave(self, first: f64, last: f64, angles: Self) -> Self {
        if !(angles.abs().high < LARGEST_ANGLE) {
            return Self::new(-1.0, 1.0);
        }
        let ends = Self::widened(f64::min(first, last), f64::max(first, last)).clipped(-1.0, 1.0);
        let turn = Self::TWO * Self::PI;
        let high = if self.may_meet(Self::ZERO, turn) {
            1.0
        } else {
            ends.high
        };
        let low = if self.may_meet(Self::PI, turn) {
            -1.0
        } else {
            ends.low
        };
        Enclosure { low, high }
    }
}

const fn constant(value: f64) -> Enclosure {
    Enclosure {
        low: value,
        high: value,
    }
}

impl Scalar for Enclosure {
    const ZERO: Self = constant(0.0);
    const ONE: Self = constant(1.0);
    const TWO: Self = constant(2.0);
    const HALF: Self = constant(0.5);
    // The nearest f64 is below π by 1.2e-16.
    const PI: Self = Enclosure {
        low: core::f64::consts::PI,
        high: core::f64::consts::PI.next_up(),
    };
    const EPSILON: Self = constant(f64::EPSILON);

    fn from_f64(value: f64) -> Self {
        Self::point(value)
    }
    fn to_f64(self) -> f64 {
        self.middle()
    }
    /// The tightest interval that contains the decimal.
    fn from_decimal(text: &str) -> Option<Self> {
        let (nearest, rest) = nearest_and_rest(text)?;
        Some(if nearest == f64::INFINITY {
            Self::new(f64::MAX, nearest)
        } else if nearest == f64::NEG_INFINITY {
            Self::new(nearest, f64::MIN)
        } else if rest > 0.0 {
            Self::new(nearest, nearest.next_up())
        } else if rest < 0.0 {
            Self::new(nearest.next_down(), nearest)
        } else {
            Self::point(nearest)
        })
    }
    fn sqrt(self) -> Self {
        if self.high < 0.0 {
            return Self::ENTIRE;
        }
        Enclosure {
            low: sqrt_down(f64::max(self.low, 0.0)),
            high: sqrt_up(self.high),
        }
    }
    fn abs(self) -> Self {
        if self.low >= 0.0 {
            self
        } else if self.high <= 0.0 {
            -self
        } else {
            Enclosure {
                low: 0.0,
                high: f64::max(-self.low, self.high),
            }
        }
    }
    fn sin(self) -> Self {
        (self - Self::half_pi()).wave(libm::sin(self.low), libm::sin(self.high), self)
    }
    fn cos(self) -> Self {
        self.wave(libm::cos(self.low), libm::cos(self.high), self)
    }
    fn tan(self) -> Self {
        if !(self.abs().high < LARGEST_ANGLE) || self.may_meet(Self::half_pi(), Self::PI) {
            return Self::ENTIRE;
        }
        Self::widened(libm::tan(self.low), libm::tan(self.high))
    }
    fn asin(self) -> Self {
        if self.high < -1.0 || self.low > 1.0 {
            return Self::ENTIRE;
        }
        let inside = self.clipped(-1.0, 1.0);
        Self::widened(libm::asin(inside.low), libm::asin(inside.high))
    }
    fn atan(self) -> Self {
        Self::widened(libm::atan(self.low), libm::atan(self.high))
    }
    /// The angles of a box; all of them if it contains the origin or touches the cut along the negative axis from below.
    fn atan2(self, x: Self) -> Self {
        let y = self;
        let cut = y.low < 0.0 && y.high >= 0.0 && x.low < 0.0;
        let origin = y.low <= 0.0 && y.high >= 0.0 && x.low <= 0.0 && x.high >= 0.0;
        if cut || origin {
            let pi = Self::PI.high;
            return Enclosure { low: -pi, high: pi };
        }
        // Seen from outside, the outermost points of a box are corners.
        let corners = [
            libm::atan2(y.low, x.low),
            libm::atan2(y.low, x.high),
            libm::atan2(y.high, x.low),
            libm::atan2(y.high, x.high),
        ];
        let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self::widened(low, high)
    }
    fn exp(self) -> Self {
        let out = Self::widened(libm::exp(self.low), libm::exp(self.high));
        out.clipped(0.0, f64::INFINITY)
    }
    fn exp_m1(self) -> Self {
        let out = Self::widened(libm::expm1(self.low), libm::expm1(self.high));
        out.clipped(-1.0, f64::INFINITY)
    }
    fn ln(self) -> Self {
        if !(self.high > 0.0) {
            return Self::ENTIRE;
        }
        let low = if self.low > 0.0 {
            libm::log(self.low)
        } else {
            f64::NEG_INFINITY
        };
        Self::widened(low, libm::log(self.high))
    }
    fn hypot(self, other: Self) -> Self {
        (self.squared() + other.squared()).sqrt()
    }
    fn is_finite(self) -> bool {
        self.low.is_finite() && self.high.is_finite()
    }
    fn squared(self) -> Self {
        let modulus = self.abs();
        Enclosure {
            low: f64::max(mul_down(modulus.low, modulus.low), 0.0),
            high: mul_up(modulus.high, modulus.high),
        }
    }
    fn max(self, other: Self) -> Self {
        Enclosure {
            low: f64::max(self.low, other.low),
            high: f64::max(self.high, other.high),
        }
    }
    fn min(self, other: Self) -> Self {
        Enclosure {
            low: f64::min(self.low, other.low),
            high: f64::min(self.high, other.high),
        }
    }
}
