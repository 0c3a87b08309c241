//! The class in which schedules are decided: c·exp(Σ qᵢ n^sᵢ)·nᵃ·(ln n)ᵇ, with its order and its sums.

use core::cmp::Ordering;
use core::fmt;

use super::number::{Number, significant};

/// A growth c·exp(Σ qᵢ n^sᵢ)·nᵃ·(ln n)ᵇ with c ≠ 0.
#[derive(Clone, Debug)]
pub struct Growth {
    /// c.
    pub coefficient: Number,
    /// (q, s) with q ≠ 0, s > 0, in descending order of s.
    pub exponentials: Vec<(Number, Number)>,
    /// a.
    pub power: Number,
    /// b.
    pub log: Number,
}

/// Two numbers that are not known exactly and too close to tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooClose;

/// How Σ_{k ≤ n} f(k) grows.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "lives for one match only")]
pub enum SumGrowth {
    /// Like this.
    Like(Growth),
    /// Like c ln ln n.
    LogLog(f64),
    /// To a limit.
    Converges,
}

/// The order of two numbers, if it is known.
pub(super) fn order(a: Number, b: Number) -> Result<Ordering, TooClose> {
    a.compare(b).ok_or(TooClose)
}

impl Growth {
    /// A constant.
    pub fn constant(coefficient: Number) -> Self {
        Self {
            coefficient,
            exponentials: Vec::new(),
            power: Number::ZERO,
            log: Number::ZERO,
        }
    }

    /// c nᵃ (ln n)ᵇ.
    pub fn power_log(coefficient: Number, power: Number, log: Number) -> Self {
        Self {
            power,
            log,
            ..Self::constant(coefficient)
        }
    }

    /// Which of two moduli is larger for all large n; equal if their quotient has a limit other than 0.
    pub fn order(&self, o: &Self) -> Result<Ordering, TooClose> {
        let (mut a, mut b) = (self.exponentials.iter(), o.exponentials.iter());
        let (mut x, mut y) = (a.next(), b.next());
        loop {
            let sign = |q: Number| order(q, Number::ZERO);
            match (x, y) {
                (None, None) => break,
                (Some((q, _)), None) => return sign(*q),
                (None, Some((q, _))) => return Ok(sign(*q)?.reverse()),
                (Some((q, s)), Some((r, t))) => match order(*s, *t)? {
                    Ordering::Greater => return sign(*q),
                    Ordering::Less => return Ok(sign(*r)?.reverse()),
                    Ordering::Equal => match order(*q, *r)? {
                        Ordering::Equal => (x, y) = (a.next(), b.next()),
                        different => return Ok(different),
                    },
                },
            }
        }
        Ok(order(self.power, o.power)?.then(order(self.log, o.log)?))
    }

    /// `Less` if it tends to 0, `Equal` if to a limit, `Greater` if its modulus grows without bound.
    pub fn trend(&self) -> Result<Ordering, TooClose> {
        self.order(&Self::constant(Number::ONE))
    }

    /// Product.
    pub fn times(&self, o: &Self) -> Result<Self, TooClose> {
        let mut exponentials = self.exponentials.clone();
        for (q, s) in &o.exponentials {
            merge(&mut exponentials, *q, *s)?;
        }
        Ok(Self {
            coefficient: self.coefficient.times(o.coefficient),
            exponentials,
            power: self.power.plus(o.power),
            log: self.log.plus(o.log),
        })
    }

    /// A power with a constant exponent ≠ 0; the coefficient must be positive or the exponent whole.
    pub fn raised(&self, e: Number) -> Self {
        Self {
            coefficient: self.coefficient.power(e),
            exponentials: self
                .exponentials
                .iter()
                .map(|(q, s)| (q.times(e), *s))
                .collect(),
            power: self.power.times(e),
            log: self.log.times(e),
        }
    }

    /// The same growth with another coefficient.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            coefficient: self.coefficient.times(Number::inexact(factor)),
            ..self.clone()
        }
    }

    /// How the sums of this grow, by comparison with the integral.
    pub fn sum(&self) -> Result<SumGrowth, TooClose> {
        use Ordering::{Equal, Greater, Less};
        if let Some((q, s)) = self.exponentials.first() {
            if order(*q, Number::ZERO)? == Less {
                return Ok(SumGrowth::Converges);
            }
            return Ok(SumGrowth::Like(match order(*s, Number::ONE)? {
                // The last terms, of which about n^(1-s)/(q s) are as large as the very last one.
                Less => {
                    let width = q.times(*s);
                    let grown = Growth::power_log(Number::ONE, Number::ONE.minus(*s), Number::ZERO);
                    self.times(&grown)?.scaled(1.0 / width.value())
                }
                // A geometric series from its end.
                Equal => self.scaled(-1.0 / libm::expm1(-q.value())),
                Greater => self.clone(),
            }));
        }
        let minus_one = Number::integer(-1);
        Ok(match order(self.power, minus_one)? {
            Greater => {
                let power = self.power.plus(Number::ONE);
                SumGrowth::Like(Self {
                    coefficient: self.coefficient.over(power),
                    power,
                    ..self.clone()
                })
            }
            Less => SumGrowth::Converges,
            Equal => match order(self.log, minus_one)? {
                Greater => {
                    let log = self.log.plus(Number::ONE);
                    SumGrowth::Like(Self::power_log(
                        self.coefficient.over(log),
                        Number::ZERO,
                        log,
                    ))
                }
                Equal => SumGrowth::LogLog(self.coefficient.value()),
                Less => SumGrowth::Converges,
            },
        })
    }
}

/// Adds q n^s to a sorted exponent.
pub(super) fn merge(
    into: &mut Vec<(Number, Number)>,
    q: Number,
    s: Number,
) -> Result<(), TooClose> {
    for i in 0..into.len() {
        match order(into[i].1, s)? {
            Ordering::Greater => {}
            Ordering::Less => {
                into.insert(i, (q, s));
                return Ok(());
            }
            Ordering::Equal => {
                let sum = into[i].0.plus(q);
                if order(into[i].0, q.negated())? == Ordering::Equal {
                    into.remove(i);
                } else {
                    into[i].0 = sum;
                }
                return Ok(());
            }
        }
    }
    into.push((q, s));
    Ok(())
}

impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shape = self.shape();
        let coefficient = self.coefficient;
        if shape.is_empty() {
            return f.write_str(&significant(coefficient.value()));
        }
        if coefficient.value() == 1.0 {
            return f.write_str(&shape);
        }
        write!(f, "{} {shape}", significant(coefficient.value()))
    }
}

impl Growth {
    /// The growth without its coefficient, such as `n^(-1/3) ln(n)`; empty for a constant.
    pub fn shape(&self) -> String {
        let mut parts: Vec<String> = Vec::new();
        for (q, s) in &self.exponentials {
            parts.push(match s.value() == 1.0 {
                true => format!("{}^n", significant(libm::exp(q.value()))),
                false => format!("exp({} n^({s}))", significant(q.value())),
            });
        }
        let factor = |name: &str, e: Number| match e.value() {
            0.0 => None,
            1.0 => Some(name.to_owned()),
            _ => Some(format!("{name}^({e})")),
        };
        parts.extend(factor("n", self.power));
        parts.extend(factor("ln(n)", self.log));
        parts.join(" ")
    }
}
