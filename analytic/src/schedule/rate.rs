//! How the bias and the variance of a mean fall: sums of powers of αₖ divided by powers of n.

use core::cmp::Ordering;
use core::fmt;

use super::asymptotics::{Behaviour, Expansion, Range, Reason, because};
use super::growth::{Growth, SumGrowth, order};
use super::number::{Number, significant};

/// A growth, times (ln ln n)ᵐ, with a coefficient that may be unknown.
#[derive(Clone, Debug)]
pub struct Rate {
    /// Powers, logarithms and exponentials.
    pub growth: Growth,
    /// m.
    pub log_log: i64,
    /// Whether the growth's coefficient is the limit of the quotient; otherwise it means nothing.
    pub has_coefficient: bool,
}

impl Rate {
    fn of(growth: Growth) -> Self {
        Self {
            growth,
            log_log: 0,
            has_coefficient: true,
        }
    }

    pub(super) fn without_coefficient(growth: Growth) -> Self {
        Self {
            has_coefficient: false,
            ..Self::of(growth)
        }
    }

    /// The coefficient, where it is known.
    pub fn coefficient(&self) -> Option<f64> {
        Some(self.growth.coefficient.value()).filter(|c| self.has_coefficient && c.is_finite())
    }

    /// The exponent a of nᵃ.
    pub fn power(&self) -> f64 {
        self.growth.power.value()
    }

    pub(super) fn order(&self, o: &Self) -> Result<Ordering, Reason> {
        let order = self.growth.order(&o.growth)?;
        Ok(order.then(self.log_log.cmp(&o.log_log)))
    }

    /// `Less` if it vanishes.
    pub(super) fn trend(&self) -> Result<Ordering, Reason> {
        Ok(self.growth.trend()?.then(self.log_log.cmp(&0)))
    }

    pub(super) fn plus(&self, o: &Self) -> Result<Self, Reason> {
        Ok(match self.order(o)? {
            Ordering::Greater => self.clone(),
            Ordering::Less => o.clone(),
            Ordering::Equal => {
                let mut sum = self.clone();
                sum.growth.coefficient = self.growth.coefficient.plus(o.growth.coefficient);
                sum.has_coefficient &= o.has_coefficient;
                sum
            }
        })
    }

    pub(super) fn times(&self, o: &Self) -> Result<Self, Reason> {
        Ok(Self {
            growth: self.growth.times(&o.growth)?,
            log_log: self.log_log + o.log_log,
            has_coefficient: self.has_coefficient && o.has_coefficient,
        })
    }

    pub(super) fn inverse(&self) -> Self {
        Self {
            growth: self.growth.raised(Number::integer(-1)),
            log_log: -self.log_log,
            has_coefficient: self.has_coefficient,
        }
    }

    /// Divided by (share · n)ᵏ.
    pub(super) fn over_count(&self, k: i64, share: f64) -> Result<Self, Reason> {
        let factor = libm::pow(share, -(k as f64));
        let power = Number::integer(-k);
        self.times(&Self::of(Growth::power_log(
            if share == 1.0 {
                Number::ONE
            } else {
                Number::inexact(factor)
            },
            power,
            Number::ZERO,
        )))
    }
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shape = self.growth.shape();
        if self.log_log != 0 {
            let space = if shape.is_empty() { "" } else { " " };
            shape = match self.log_log {
                1 => format!("{shape}{space}ln(ln(n))"),
                m => format!("{shape}{space}ln(ln(n))^{m}"),
            };
        }
        match (self.coefficient(), shape.is_empty()) {
            (Some(c), true) => f.write_str(&significant(c)),
            (Some(c), false) => write!(f, "{} {shape}", significant(c)),
            (None, true) => f.write_str("constant"),
            (None, false) => f.write_str(&shape),
        }
    }
}

/// Bounds of a quantity that depends on n.
#[derive(Clone, Debug)]
pub struct Rates {
    /// Not more than the limes superior, in the same sense as `most`.
    pub least: Rate,
    /// From above.
    pub most: Rate,
}

impl Rates {
    pub(super) fn map(&self, f: impl Fn(&Rate) -> Result<Rate, Reason>) -> Result<Self, Reason> {
        Ok(Self {
            least: f(&self.least)?,
            most: f(&self.most)?,
        })
    }

    /// Whether it vanishes; `None` where the bounds do not tell.
    pub(super) fn vanishes(&self) -> Result<Option<bool>, Reason> {
        Ok(if self.most.trend()? == Ordering::Less {
            Some(true)
        } else if self.least.trend()? != Ordering::Less {
            Some(false)
        } else {
            None
        })
    }
}

/// How Σ αₖ^e grows over the samples that are kept: those after the first ⌊β n⌋.
pub(super) fn power_sum(behaviour: &Behaviour, e: Number, discarded: f64) -> Result<Rates, Reason> {
    let usual = bounds(&behaviour.usual, e)?;
    let mut least = kept(&usual.0, discarded)?;
    let mut most = kept(&usual.1, discarded)?;
    if let Some((base, range)) = &behaviour.rare {
        let rare = bounds(range, e)?;
        least = least.plus(&sum_at_powers(&rare.0, *base, discarded)?)?;
        most = most.plus(&sum_at_powers(&rare.1, *base, discarded)?)?;
    }
    Ok(Rates { least, most })
}

/// The smallest and the largest growth of αₙ^e.
fn bounds(range: &Range, e: Number) -> Result<(Growth, Growth), Reason> {
    let raised = |expansion: &Expansion| match expansion.lead() {
        Some(lead) if expansion.sign() == Ordering::Greater => Ok(lead.raised(e)),
        _ => because("the bandwidth is not bounded away from 0 by what is known of it"),
    };
    if e.is_zero() {
        let one = Growth::constant(Number::ONE);
        return Ok((one.clone(), one));
    }
    let (low, high) = (raised(&range.low)?, raised(range.top())?);
    Ok(if e.value() > 0.0 {
        (low, high)
    } else {
        (high, low)
    })
}

/// Σ f(k) over βn < k ≤ n.
fn kept(f: &Growth, beta: f64) -> Result<Rate, Reason> {
    let minus_one = Number::integer(-1);
    if beta == 0.0 {
        return Ok(match f.sum()? {
            SumGrowth::Like(growth) => Rate::of(growth),
            SumGrowth::LogLog(c) => Rate {
                log_log: 1,
                ..Rate::of(Growth::constant(Number::inexact(c)))
            },
            SumGrowth::Converges => Rate::without_coefficient(Growth::constant(Number::ONE)),
        });
    }
    if let Some((q, s)) = f.exponentials.first() {
        if order(*q, Number::ZERO)? == Ordering::Greater {
            return Ok(match f.sum()? {
                SumGrowth::Like(growth) => Rate::of(growth),
                _ => Rate::without_coefficient(f.clone()),
            });
        }
        // The first terms that are kept are the largest.
        let mut first = f.clone();
        for (q, s) in &mut first.exponentials {
            *q = q.times(Number::inexact(libm::pow(beta, s.value())));
        }
        if order(*s, Number::ONE)? == Ordering::Less {
            first.power = first.power.plus(Number::ONE.minus(*s));
        }
        return Ok(Rate::without_coefficient(first));
    }
    let a = f.power.plus(Number::ONE);
    if order(f.power, minus_one)? == Ordering::Equal {
        let logarithm = Growth {
            power: Number::ZERO,
            ..f.clone()
        };
        return Ok(Rate::of(logarithm.scaled(-libm::log(beta))));
    }
    let factor = -libm::expm1(a.value() * libm::log(beta)) / a.value();
    Ok(Rate::of(Growth {
        power: a,
        ..f.scaled(factor)
    }))
}

/// Σ f(bʲ) over βn < bʲ ≤ n, at those n at which it is largest.
fn sum_at_powers(f: &Growth, base: u64, beta: f64) -> Result<Rate, Reason> {
    let bounded = Rate::without_coefficient(Growth::constant(Number::ONE));
    let log_base = libm::log(base as f64);
    if let Some((q, _)) = f.exponentials.first() {
        return Ok(match order(*q, Number::ZERO)? {
            // The last term is the sum up to a constant factor.
            Ordering::Greater => Rate::without_coefficient(f.clone()),
            _ => bounded,
        });
    }
    let power = order(f.power, Number::ZERO)?;
    if power == Ordering::Greater && beta == 0.0 {
        let ratio = libm::exp(-f.power.value() * log_base);
        return Ok(Rate::of(f.scaled(1.0 / (1.0 - ratio))));
    }
    if power == Ordering::Greater || beta > 0.0 {
        return Ok(Rate::without_coefficient(f.clone()));
    }
    if power == Ordering::Less {
        return Ok(bounded);
    }
    Ok(match order(f.log, Number::integer(-1))? {
        Ordering::Greater => {
            let log = f.log.plus(Number::ONE);
            Rate::of(Growth {
                log,
                ..f.scaled(1.0 / (log.value() * log_base))
            })
        }
        Ordering::Equal => Rate {
            log_log: 1,
            ..bounded
        },
        Ordering::Less => bounded,
    })
}
