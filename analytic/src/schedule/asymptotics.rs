//! The leading behaviour of an expression for n → ∞, by exact rules; between two bounds where it oscillates.

use core::cmp::Ordering;
use core::fmt;

use super::combine::{
    absolute_bound, exponential, extreme, logarithm, multiply, power_of, product_bounds,
};
use super::expression::{Expression, Function, Node, Operation, Term};
use super::growth::{Growth, TooClose};
use super::number::Number;

/// A sum of growths in descending order: exactly, for all n, or only its leading term. No term stands for exactly 0.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// The terms; exactly one if the expansion is not exact.
    pub terms: Vec<Growth>,
    /// Whether nothing was left out.
    pub exact: bool,
}

/// Bounds for large n: low (1 + o(1)) ≤ f ≤ high (1 + o(1)); both the same if there is a leading term.
#[derive(Clone, Debug)]
pub struct Range {
    /// From below.
    pub low: Expansion,
    /// From above; none if it is the same.
    pub high: Option<Expansion>,
}

/// What is known of an expression for large n.
#[derive(Clone, Debug)]
pub struct Behaviour {
    /// For all n that are no power of the base.
    pub usual: Range,
    /// For n = bʲ, j = 0, 1, …
    pub rare: Option<(u64, Range)>,
}

/// Why the behaviour is not known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Obstacle {
    /// Where in the text, from 1.
    pub column: usize,
    /// Why.
    pub reason: String,
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "column {}: {}", self.column, self.reason)
    }
}

/// A reason without a place.
#[derive(Clone, Debug)]
pub(super) struct Reason(pub(super) String);

impl From<TooClose> for Reason {
    fn from(_: TooClose) -> Self {
        Self("two numbers that are not known exactly are too close to tell apart".to_owned())
    }
}

pub(super) fn because<T>(reason: &str) -> Result<T, Reason> {
    Err(Reason(reason.to_owned()))
}

impl Expansion {
    pub(super) fn exactly(growth: Growth) -> Self {
        let terms = if growth.coefficient.is_zero() {
            Vec::new()
        } else {
            vec![growth]
        };
        Self { terms, exact: true }
    }

    pub(super) fn leading(growth: Growth) -> Self {
        Self {
            terms: vec![growth],
            exact: false,
        }
    }

    /// The leading term; none for 0.
    pub fn lead(&self) -> Option<&Growth> {
        self.terms.first()
    }

    /// The sign for all large n.
    pub fn sign(&self) -> Ordering {
        self.lead()
            .map_or(Ordering::Equal, |g| g.coefficient.value().total_cmp(&0.0))
    }

    /// The single term of which an exact expansion consists.
    pub(super) fn monomial(&self) -> Option<&Growth> {
        match self.terms.as_slice() {
            [one] if self.exact => Some(one),
            _ => None,
        }
    }

    pub(super) fn negated(&self) -> Self {
        let mut negated = self.clone();
        for term in &mut negated.terms {
            term.coefficient = term.coefficient.negated();
        }
        negated
    }

    pub(super) fn plus(&self, o: &Self) -> Result<Self, Reason> {
        if !self.exact || !o.exact {
            let (Some(a), Some(b)) = (self.lead(), o.lead()) else {
                return Ok(if self.lead().is_some() { self } else { o }.clone());
            };
            return Ok(Self::leading(match a.order(b)? {
                Ordering::Greater => a.clone(),
                Ordering::Less => b.clone(),
                Ordering::Equal => {
                    let sum = a.coefficient.plus(b.coefficient);
                    let size = f64::abs(a.coefficient.value());
                    if f64::abs(sum.value()) <= 1e-12 * size {
                        return because("the leading terms cancel");
                    }
                    Growth {
                        coefficient: sum,
                        ..a.clone()
                    }
                }
            }));
        }
        let mut terms = self.terms.clone();
        for term in &o.terms {
            add(&mut terms, term)?;
        }
        Ok(Self { terms, exact: true })
    }

    /// Order for all large n; `Equal` if the leading terms are the same.
    pub(super) fn order(&self, o: &Self) -> Result<Ordering, Reason> {
        let (Some(a), Some(b)) = (self.lead(), o.lead()) else {
            return Ok(self.sign().cmp(&o.sign()));
        };
        if self.sign() != o.sign() {
            return Ok(self.sign().cmp(&o.sign()));
        }
        let larger = a.order(b)?;
        let larger = if self.sign() == Ordering::Less {
            larger.reverse()
        } else {
            larger
        };
        let by_coefficient = match a.coefficient.compare(b.coefficient) {
            Some(order) => order,
            // Two inexact coefficients that agree to rounding: the same leading term.
            None => Ordering::Equal,
        };
        Ok(larger.then(by_coefficient))
    }
}

/// Adds a term to a sorted sum.
fn add(terms: &mut Vec<Growth>, term: &Growth) -> Result<(), Reason> {
    const MOST: usize = 16;
    for i in 0..terms.len() {
        match terms[i].order(term)? {
            Ordering::Greater => {}
            Ordering::Less => {
                terms.insert(i, term.clone());
                return if terms.len() > MOST {
                    because("more than 16 terms")
                } else {
                    Ok(())
                };
            }
            Ordering::Equal => {
                let (a, b) = (terms[i].coefficient, term.coefficient);
                match a.compare(b.negated()) {
                    Some(Ordering::Equal) => {
                        terms.remove(i);
                    }
                    Some(_) => terms[i].coefficient = a.plus(b),
                    None => return because("the leading terms cancel"),
                }
                return Ok(());
            }
        }
    }
    terms.push(term.clone());
    Ok(())
}

impl Range {
    pub(super) fn one(expansion: Expansion) -> Self {
        Self {
            low: expansion,
            high: None,
        }
    }

    /// The upper bound.
    pub fn top(&self) -> &Expansion {
        self.high.as_ref().unwrap_or(&self.low)
    }

    pub(super) fn map(
        &self,
        f: impl Fn(&Expansion) -> Result<Expansion, Reason>,
    ) -> Result<Self, Reason> {
        Ok(Self {
            low: f(&self.low)?,
            high: self.high.as_ref().map(f).transpose()?,
        })
    }

    pub(super) fn reversed(self) -> Self {
        match self.high {
            Some(high) => Self {
                low: high,
                high: Some(self.low),
            },
            None => self,
        }
    }

    fn zip(
        &self,
        o: &Self,
        f: impl Fn(&Expansion, &Expansion) -> Result<Expansion, Reason>,
    ) -> Result<Self, Reason> {
        let high = if self.high.is_some() || o.high.is_some() {
            Some(f(self.top(), o.top())?)
        } else {
            None
        };
        Ok(Self {
            low: f(&self.low, &o.low)?,
            high,
        })
    }
}

impl Behaviour {
    fn one(range: Range) -> Self {
        Self {
            usual: range,
            rare: None,
        }
    }

    fn combine(
        parts: &[Self],
        f: impl Fn(&[&Range]) -> Result<Range, Reason>,
    ) -> Result<Self, Reason> {
        let usual: Vec<_> = parts.iter().map(|p| &p.usual).collect();
        let mut bases = parts.iter().filter_map(|p| p.rare.as_ref().map(|r| r.0));
        let rare = match bases.next() {
            None => None,
            Some(base) if bases.all(|b| b == base) => {
                let ranges: Vec<_> = parts
                    .iter()
                    .map(|p| p.rare.as_ref().map_or(&p.usual, |r| &r.1))
                    .collect();
                Some((base, f(&ranges)?))
            }
            Some(_) => return because("at_powers with two different bases"),
        };
        Ok(Self {
            usual: f(&usual)?,
            rare,
        })
    }
}

impl Expression {
    /// The behaviour for n → ∞, or where and why it is not known.
    pub fn behaviour(&self) -> Result<Behaviour, Obstacle> {
        behaviour(&self.root)
    }
}

fn behaviour(node: &Node) -> Result<Behaviour, Obstacle> {
    if let Some(number) = node.constant() {
        let growth = Growth::constant(number);
        return Ok(Behaviour::one(Range::one(Expansion::exactly(growth))));
    }
    let parts = match &node.term {
        Term::Constant(_) | Term::Index => Vec::new(),
        Term::Negated(inner) => vec![behaviour(inner)?],
        Term::Binary(_, left, right) => vec![behaviour(left)?, behaviour(right)?],
        // The arguments of these are constants.
        Term::Call(Function::Ppm | Function::Geometric, _) => Vec::new(),
        Term::Call(Function::AtPowers, arguments) => {
            vec![behaviour(&arguments[1])?, behaviour(&arguments[2])?]
        }
        Term::Call(_, arguments) => arguments.iter().map(behaviour).collect::<Result<_, _>>()?,
    };
    rule(&node.term, &parts).map_err(|Reason(reason)| Obstacle {
        column: node.column,
        reason,
    })
}

fn rule(term: &Term, parts: &[Behaviour]) -> Result<Behaviour, Reason> {
    let exactly = |g| Ok(Behaviour::one(Range::one(Expansion::exactly(g))));
    let constant = |node: &Node| node.constant().unwrap_or(Number::inexact(f64::NAN));
    match term {
        Term::Constant(number) => exactly(Growth::constant(*number)),
        Term::Index => exactly(Growth::power_log(Number::ONE, Number::ONE, Number::ZERO)),
        Term::Negated(_) => {
            Behaviour::combine(parts, |r| Ok(r[0].map(|e| Ok(e.negated()))?.reversed()))
        }
        Term::Binary(operation, ..) => Behaviour::combine(parts, |r| match operation {
            Operation::Add => r[0].zip(r[1], Expansion::plus),
            Operation::Subtract => {
                let minus = r[1].map(|e| Ok(e.negated()))?.reversed();
                r[0].zip(&minus, Expansion::plus)
            }
            Operation::Multiply => product_bounds(r[0], r[1]),
            Operation::Divide => product_bounds(r[0], &power_of(r[1], Number::integer(-1))?),
            Operation::Power => raise(r[0], r[1]),
        }),
        Term::Call(Function::Ppm, arguments) => {
            let (first, a) = (constant(&arguments[0]), constant(&arguments[1]));
            let factor = 1.0 / f64::sqrt(libm::tgamma(1.0 + a.value()));
            let power = a.minus(Number::ONE).over(Number::integer(2));
            let growth =
                Growth::power_log(first.times(Number::inexact(factor)), power, Number::ZERO);
            Ok(Behaviour::one(Range::one(Expansion::leading(growth))))
        }
        Term::Call(Function::Geometric, arguments) => {
            let (first, ratio) = (constant(&arguments[0]), constant(&arguments[1]));
            if ratio.value() == 1.0 {
                return exactly(Growth::constant(first));
            }
            let mut growth = Growth::constant(first.over(ratio));
            growth.exponentials = vec![(Number::inexact(libm::log(ratio.value())), Number::ONE)];
            exactly(growth)
        }
        Term::Call(Function::AtPowers, arguments) => {
            let base = constant(&arguments[0]).value() as u64;
            let inner = |p: &Behaviour| p.rare.as_ref().is_some_and(|r| r.0 != base);
            if parts.iter().any(inner) {
                return because("at_powers with two different bases");
            }
            let at = parts[0].rare.as_ref().map_or(&parts[0].usual, |r| &r.1);
            Ok(Behaviour {
                usual: parts[1].usual.clone(),
                rare: Some((base, at.clone())),
            })
        }
        Term::Call(function, _) => Behaviour::combine(parts, |r| called(*function, r)),
    }
}

fn called(function: Function, r: &[&Range]) -> Result<Range, Reason> {
    match function {
        Function::Max | Function::Min => {
            let want = if function == Function::Max {
                Ordering::Greater
            } else {
                Ordering::Less
            };
            let mut all = r[0].clone();
            for next in &r[1..] {
                all = all.zip(next, |a, b| extreme(a, b, want))?;
            }
            Ok(all)
        }
        Function::Sqrt => power_of(r[0], Number::ONE.over(Number::integer(2))),
        Function::Log => r[0].map(logarithm),
        Function::Exp => r[0].map(exponential),
        _ => absolute_bound(r[0], function == Function::Sin),
    }
}

/// f^g: a constant exponent, or exp(g ln f).
fn raise(base: &Range, exponent: &Range) -> Result<Range, Reason> {
    if let (Some(e), None) = (exponent.low.monomial(), &exponent.high)
        && e.shape().is_empty()
    {
        return power_of(base, e.coefficient);
    }
    if exponent.low.terms.is_empty() && exponent.high.is_none() {
        return Ok(Range::one(Expansion::exactly(Growth::constant(
            Number::ONE,
        ))));
    }
    if base.high.is_some() || exponent.high.is_some() {
        return because("an oscillating power");
    }
    let log = logarithm(&base.low)?;
    Ok(Range::one(exponential(&multiply(&exponent.low, &log)?)?))
}
