//! Decimal numbers of any length, exactly: on which side of an `f64` a decimal lies, and by how much.
//!
//! Every `f64` is a decimal of at most 767 digits, which the formatter writes out in full; two decimals are then
//! compared and subtracted digit by digit.

use core::cmp::Ordering;

/// A decimal number, ± 0.d₀d₁d₂… · 10^exponent, d₀ ≠ 0; no digits for 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Decimal {
    negative: bool,
    digits: Vec<u8>,
    exponent: i64,
}

/// The nearest `f64` of a decimal text and what is left: `text - nearest`, to a relative 2^-53 and with its sign.
///
/// `None` if the text is not a finite decimal number; infinite where the number exceeds every finite `f64`, with a rest
/// of 0.
pub(crate) fn nearest_and_rest(text: &str) -> Option<(f64, f64)> {
    let text = text.trim();
    let exact = Decimal::parse(text)?;
    let nearest: f64 = text.parse().ok()?;
    if !nearest.is_finite() {
        return Some((nearest, 0.0));
    }
    // Far below the smallest f64 the digits cannot be aligned, and need not be.
    let rest = if nearest == 0.0 {
        exact
    } else {
        exact.minus(&Decimal::of(nearest))
    };
    Some((nearest + 0.0, rest.to_f64()))
}

impl Decimal {
    /// Reads `[+-]digits[.digits][e[+-]digits]`.
    fn parse(text: &str) -> Option<Self> {
        let (negative, text) = match text.as_bytes().first()? {
            b'-' => (true, &text[1..]),
            b'+' => (false, &text[1..]),
            _ => (false, text),
        };
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let mut digits: Vec<u8> = whole.bytes().chain(fraction.bytes()).collect();
        if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
            return None;
        }
        digits.iter_mut().for_each(|d| *d -= b'0');
        let exponent = i64::from(exponent) + i64::try_from(whole.len()).ok()?;
        Some(Self::normalized(negative, digits, exponent))
    }

    /// All digits of a finite `f64`.
    fn of(value: f64) -> Self {
        Self::parse(&format!("{value:.800e}")).unwrap_or(Decimal {
            negative: false,
            digits: vec![],
            exponent: 0,
        })
    }

    fn normalized(negative: bool, mut digits: Vec<u8>, exponent: i64) -> Self {
        let leading = digits.iter().take_while(|d| **d == 0).count();
        digits.drain(..leading);
        while digits.last() == Some(&0) {
            digits.pop();
        }
        Decimal {
            negative: negative && !digits.is_empty(),
            exponent: if digits.is_empty() {
                0
            } else {
                exponent - leading as i64
            },
            digits,
        }
    }

    /// The difference. Both exponents must be those of numbers near an `f64`.
    fn minus(&self, o: &Self) -> Self {
        let top = self.exponent.max(o.exponent);
        let (a, b) = (self.aligned(top), o.aligned(top));
        let length = a.len().max(b.len());
        let digit = |v: &[u8], i: usize| v.get(i).copied().unwrap_or(0);
        if self.negative != o.negative {
            let mut sum = vec![0; length + 1];
            let mut carry = 0;
            for i in (0..length).rev() {
                let total = digit(&a, i) + digit(&b, i) + carry;
                sum[i + 1] = total % 10;
                carry = total / 10;
            }
            sum[0] = carry;
            return Self::normalized(self.negative, sum, top + 1);
        }
        let order = (0..length)
            .map(|i| digit(&a, i).cmp(&digit(&b, i)))
            .find(|o| o.is_ne())
            .unwrap_or(Ordering::Equal);
        let (large, small) = if order.is_lt() { (&b, &a) } else { (&a, &b) };
        let mut difference = vec![0; length];
        let mut borrow = 0;
        for i in (0..length).rev() {
            let take = digit(small, i) + borrow;
            let from = digit(large, i);
            borrow = u8::from(from < take);
            difference[i] = from + 10 * borrow - take;
        }
        Self::normalized(self.negative != order.is_lt(), difference, top)
    }

    fn aligned(&self, top: i64) -> Vec<u8> {
        let zeros = usize::try_from(top - self.exponent).unwrap_or(0);
        let mut out = vec![0; if self.digits.is_empty() { 0 } else { zeros }];
        out.extend(&self.digits);
        out
    }

    /// The nearest `f64` of the same sign: a number that is not 0 does not become 0.
    fn to_f64(&self) -> f64 {
        let digits: String = self.digits.iter().map(|d| char::from(b'0' + d)).collect();
        let sign = if self.negative { "-" } else { "" };
        let text = format!("{sign}0.{digits}0e{}", self.exponent);
        let nearest: f64 = text.parse().unwrap_or(f64::NAN);
        if nearest != 0.0 || self.digits.is_empty() {
            nearest
        } else if self.negative {
            -f64::from_bits(1)
        } else {
            f64::from_bits(1)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::nearest_and_rest;

    #[test]
    fn rests() {
        for (text, nearest, rest) in [
            ("0.5", 0.5, 0.0),
            ("-1.2500e2", -125.0, 0.0),
            // 2^-4 · 1.6 = 0x1.999999999999ap-4 is above a tenth by 5.55e-18.
            ("0.1", 0.1, -5.551115123125783e-18),
            ("+1e-1", 0.1, -5.551115123125783e-18),
            ("9007199254740993", 9007199254740992.0, 1.0),
            ("-9007199254740993", -9007199254740992.0, -1.0),
            ("1e-400", 0.0, f64::from_bits(1)),
            ("0.000e99999", 0.0, 0.0),
        ] {
            assert_eq!(nearest_and_rest(text), Some((nearest, rest)), "{text}");
        }
        assert_eq!(nearest_and_rest("1e999"), Some((f64::INFINITY, 0.0)));
        for wrong in ["", "-", ".", "1e", "nan", "inf", "1.2.3", "0x1", "1_0"] {
            assert_eq!(nearest_and_rest(wrong), None, "{wrong}");
        }
    }
}
