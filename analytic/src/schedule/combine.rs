//! Rules for products, powers, exponentials and logarithms of expansions.

use core::cmp::Ordering;

use super::asymptotics::{Expansion, Range, Reason, because};
use super::growth::{Growth, merge, order};
use super::number::Number;

/// Product of two expansions.
pub(super) fn multiply(a: &Expansion, b: &Expansion) -> Result<Expansion, Reason> {
    let (Some(x), Some(y)) = (a.lead(), b.lead()) else {
        return Ok(Expansion {
            terms: Vec::new(),
            exact: true,
        });
    };
    if !a.exact || !b.exact {
        return Ok(Expansion::leading(x.times(y)?));
    }
    let mut sum = Expansion {
        terms: Vec::new(),
        exact: true,
    };
    for x in &a.terms {
        for y in &b.terms {
            sum = sum.plus(&Expansion::exactly(x.times(y)?))?;
        }
    }
    Ok(sum)
}

/// Bounds of a product from the bounds of its factors, whatever their signs.
pub(super) fn product_bounds(a: &Range, b: &Range) -> Result<Range, Reason> {
    if a.high.is_none() && b.high.is_none() {
        return Ok(Range::one(multiply(&a.low, &b.low)?));
    }
    let mut low = multiply(&a.low, &b.low)?;
    let mut high = low.clone();
    for (x, y) in [(&a.low, b.top()), (a.top(), &b.low), (a.top(), b.top())] {
        let product = multiply(x, y)?;
        low = extreme(&low, &product, Ordering::Less)?;
        high = extreme(&high, &product, Ordering::Greater)?;
    }
    Ok(Range {
        low,
        high: Some(high),
    })
}

/// The larger (`Greater`) or the smaller of two expansions for all large n.
pub(super) fn extreme(a: &Expansion, b: &Expansion, want: Ordering) -> Result<Expansion, Reason> {
    Ok(match a.order(b)? {
        Ordering::Equal => match a.lead() {
            // The same leading term; what follows may differ.
            Some(lead) if !(a.monomial().is_some() && b.monomial().is_some()) => {
                Expansion::leading(lead.clone())
            }
            _ => a.clone(),
        },
        found if found == want => a.clone(),
        _ => b.clone(),
    })
}

/// A range to a constant power.
pub(super) fn power_of(base: &Range, e: Number) -> Result<Range, Reason> {
    let one = |f: &Expansion| {
        if e.is_zero() {
            return Ok(Expansion::exactly(Growth::constant(Number::ONE)));
        }
        let Some(lead) = f.lead() else {
            return if e.value() > 0.0 {
                Ok(f.clone())
            } else {
                because("a bound of what is divided by is 0")
            };
        };
        if f.sign() == Ordering::Less && e.whole().is_none() {
            return because("a broken power of what is negative for large n");
        }
        let raised = lead.raised(e);
        Ok(if f.monomial().is_some() {
            Expansion::exactly(raised)
        } else if e.value() == 1.0 {
            f.clone()
        } else {
            Expansion::leading(raised)
        })
    };
    if base.high.is_none() {
        return base.map(one);
    }
    if base.low.sign() == Ordering::Less {
        let whole = e.whole().filter(|k| *k > 0);
        let Some(k) = whole else {
            return because("a broken or negative power of what may be negative");
        };
        let ends = base.map(one)?;
        if k % 2 == 1 || base.top().sign() == Ordering::Less {
            // Odd powers keep the order; even ones of what is negative reverse it.
            return Ok(if k % 2 == 1 { ends } else { ends.reversed() });
        }
        return Ok(Range {
            low: Expansion::exactly(Growth::constant(Number::ZERO)),
            high: Some(extreme(&ends.low, ends.top(), Ordering::Greater)?),
        });
    }
    let raised = base.map(one)?;
    let (low, high) = (raised.low.clone(), raised.top().clone());
    Ok(if e.value() < 0.0 {
        Range {
            low: high,
            high: Some(low),
        }
    } else {
        raised
    })
}

/// ln f.
pub(super) fn logarithm(f: &Expansion) -> Result<Expansion, Reason> {
    let Some(lead) = f.lead().filter(|_| f.sign() == Ordering::Greater) else {
        return because("the logarithm of what is not positive for large n");
    };
    let term =
        |coefficient, power, log| Expansion::exactly(Growth::power_log(coefficient, power, log));
    let c = lead.coefficient;
    let constant = if c.compare(Number::ONE) == Some(Ordering::Equal) {
        Number::ZERO
    } else {
        Number::inexact(libm::log(c.value()))
    };
    let mut sum = term(constant, Number::ZERO, Number::ZERO);
    for (q, s) in &lead.exponentials {
        sum = sum.plus(&term(*q, *s, Number::ZERO))?;
    }
    sum = sum.plus(&term(lead.power, Number::ZERO, Number::ONE))?;
    if f.monomial().is_some() && lead.log.is_zero() {
        return Ok(sum);
    }
    // What was left out is o(1), or ln ln n.
    let grows = match sum.lead() {
        Some(first) => first.trend()? == Ordering::Greater,
        None => false,
    };
    match sum.lead() {
        Some(first) if grows || lead.log.is_zero() => Ok(Expansion::leading(first.clone())),
        Some(_) | None if !lead.log.is_zero() => because("the logarithm of a logarithm"),
        _ => because("the logarithm of what tends to 1"),
    }
}

/// eᶠ.
pub(super) fn exponential(f: &Expansion) -> Result<Expansion, Reason> {
    let mut product = Growth::constant(Number::ONE);
    let mut exact = f.exact;
    for term in &f.terms {
        let c = term.coefficient;
        match term.trend()? {
            // e to the power of what vanishes tends to 1.
            Ordering::Less => exact = false,
            Ordering::Equal => {
                product.coefficient = product
                    .coefficient
                    .times(Number::inexact(libm::exp(c.value())));
            }
            Ordering::Greater if !f.exact => {
                return because("the exponential of what is only known to leading order");
            }
            Ordering::Greater => {
                let positive = order(term.power, Number::ZERO)? == Ordering::Greater;
                let logarithm = term.log.compare(Number::ONE) == Some(Ordering::Equal);
                if !term.exponentials.is_empty() {
                    return because("the exponential of an exponential");
                } else if positive && term.log.is_zero() {
                    merge(&mut product.exponentials, c, term.power)?;
                } else if term.power.is_zero() && logarithm {
                    product.power = product.power.plus(c);
                } else {
                    return because("the exponential of a power with a logarithm");
                }
            }
        }
    }
    let one = Expansion::exactly(product.clone());
    Ok(if exact {
        one
    } else {
        Expansion::leading(product)
    })
}

/// The sine or cosine: of what vanishes exactly, otherwise between -1 and 1.
pub(super) fn absolute_bound(f: &Range, is_sine: bool) -> Result<Range, Reason> {
    let constant = |c| Expansion::exactly(Growth::constant(Number::integer(c)));
    if let (Some(lead), None) = (f.low.lead(), &f.high)
        && lead.trend()? == Ordering::Less
    {
        return Ok(Range::one(if is_sine {
            Expansion::leading(lead.clone())
        } else {
            Expansion::leading(Growth::constant(Number::ONE))
        }));
    }
    Ok(Range {
        low: constant(-1),
        high: Some(constant(1)),
    })
}
