//! Constants of an expression: exact rationals as long as they are, so that a boundary such as λ = 1/d is met exactly.

use core::cmp::Ordering;
use core::fmt;

/// A real constant: its `f64` and, where it is rational with numerator and denominator in range, its exact value.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    value: f64,
    exact: Option<(i128, i128)>,
}

impl Number {
    /// 0.
    pub const ZERO: Self = Self::integer(0);
    /// 1.
    pub const ONE: Self = Self::integer(1);

    /// A whole number.
    pub const fn integer(n: i64) -> Self {
        Self {
            value: n as f64,
            exact: Some((n as i128, 1)),
        }
    }

    /// A number that is only known as `f64`.
    pub const fn inexact(value: f64) -> Self {
        Self { value, exact: None }
    }

    /// `n`/`d`, d ≠ 0.
    fn ratio(n: i128, d: i128) -> Option<Self> {
        let g = gcd(n.unsigned_abs(), d.unsigned_abs());
        let g = i128::try_from(g).ok().filter(|g| *g > 0)?;
        let (n, d) = (n / g, d / g);
        let (n, d) = if d < 0 {
            (n.checked_neg()?, d.checked_neg()?)
        } else {
            (n, d)
        };
        // Products of two such numbers fit.
        let limit = 1_i128 << 62;
        (n.abs() <= limit && d <= limit).then_some(Self {
            value: n as f64 / d as f64,
            exact: Some((n, d)),
        })
    }

    /// Reads digits with an optional point and exponent.
    pub(crate) fn decimal(text: &str) -> Option<Self> {
        let value: f64 = text.parse().ok()?;
        Some(Self::exact_decimal(text).unwrap_or(Self::inexact(value)))
    }

    fn exact_decimal(text: &str) -> Option<Self> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((m, e)) => (m, e.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let ten = 10_i128.checked_pow(exponent.unsigned_abs())?;
        if exponent < 0 {
            Self::ratio(digits, ten)
        } else {
            Self::ratio(digits.checked_mul(ten)?, 1)
        }
    }

    /// The nearest `f64`.
    pub const fn value(self) -> f64 {
        self.value
    }

    /// The whole number that this is exactly.
    pub(crate) fn whole(self) -> Option<i128> {
        self.exact.filter(|e| e.1 == 1).map(|e| e.0)
    }

    /// Whether it is known as a fraction.
    pub(crate) fn is_exact(self) -> bool {
        self.exact.is_some()
    }

    /// Whether it is exactly 0, or an inexact 0.
    pub fn is_zero(self) -> bool {
        self.value == 0.0
    }

    pub(crate) fn plus(self, o: Self) -> Self {
        let exact = self.both(o).and_then(|((a, b), (c, d))| {
            let n = a.checked_mul(d)?.checked_add(c.checked_mul(b)?)?;
            Self::ratio(n, b.checked_mul(d)?)
        });
        exact.unwrap_or(Self::inexact(self.value + o.value))
    }

    pub(crate) fn negated(self) -> Self {
        Self {
            value: -self.value,
            exact: self.exact.map(|(n, d)| (-n, d)),
        }
    }

    pub(crate) fn minus(self, o: Self) -> Self {
        self.plus(o.negated())
    }

    pub(crate) fn times(self, o: Self) -> Self {
        let exact = self
            .both(o)
            .and_then(|((a, b), (c, d))| Self::ratio(a.checked_mul(c)?, b.checked_mul(d)?));
        exact.unwrap_or(Self::inexact(self.value * o.value))
    }

    pub(crate) fn over(self, o: Self) -> Self {
        let exact = self
            .both(o)
            .filter(|(_, o)| o.0 != 0)
            .and_then(|((a, b), (c, d))| Self::ratio(a.checked_mul(d)?, b.checked_mul(c)?));
        exact.unwrap_or(Self::inexact(self.value / o.value))
    }

    /// A power, exact for whole exponents and for square roots of squares.
    pub(crate) fn power(self, o: Self) -> Self {
        let root = || {
            let (n, d) = self.exact?;
            (o.exact? == (1, 2)).then_some(())?;
            Self::ratio(square_root(n)?, square_root(d)?)
        };
        let whole = || {
            let (n, d) = self.exact?;
            let k = o.whole().and_then(|k| i32::try_from(k).ok())?;
            let (top, bottom) = (
                n.checked_pow(k.unsigned_abs())?,
                d.checked_pow(k.unsigned_abs())?,
            );
            let (top, bottom) = if k < 0 { (bottom, top) } else { (top, bottom) };
            (bottom != 0).then_some(())?;
            Self::ratio(top, bottom)
        };
        let exact = whole().or_else(root);
        exact.unwrap_or_else(|| Self::inexact(libm::pow(self.value, o.value)))
    }

    /// Order; `None` where two numbers that are not both exact are too close to tell. Two inexact ones with the same bits
    /// count as the same: they come from the same part of an expression.
    pub fn compare(self, o: Self) -> Option<Ordering> {
        if let Some(((a, b), (c, d))) = self.both(o) {
            return Some((a * d).cmp(&(c * b)));
        }
        if self.exact.is_none() && o.exact.is_none() && self.value == o.value {
            return Some(Ordering::Equal);
        }
        let close = 1e-12 * f64::abs(self.value).max(f64::abs(o.value)).max(1e-300);
        if f64::abs(self.value - o.value) <= close {
            None
        } else {
            self.value.partial_cmp(&o.value)
        }
    }

    fn both(self, o: Self) -> Option<((i128, i128), (i128, i128))> {
        Some((self.exact?, o.exact?))
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.exact {
            Some((n, 1)) => write!(f, "{n}"),
            Some((n, d)) if d <= 1000 && !is_short_decimal(d) => write!(f, "{n}/{d}"),
            _ if self.exact.is_some() => write!(f, "{}", self.value),
            _ => write!(f, "{}", significant(self.value)),
        }
    }
}

/// Six significant digits, without zeros at the end.
pub(crate) fn significant(value: f64) -> String {
    let magnitude = f64::abs(value);
    if value == 0.0 || !value.is_finite() || !(1e-4..1e6).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    let before = libm::floor(libm::log10(magnitude)) as i32;
    let places = usize::try_from(5 - before).unwrap_or(0);
    let text = format!("{value:.places$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

fn is_short_decimal(d: i128) -> bool {
    [
        2, 4, 5, 8, 10, 20, 25, 40, 50, 100, 125, 200, 250, 500, 1000,
    ]
    .contains(&d)
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

fn square_root(n: i128) -> Option<i128> {
    let root = f64::sqrt(n as f64) as i128;
    [root - 1, root, root + 1]
        .into_iter()
        .find(|r| *r >= 0 && r * r == n)
}
