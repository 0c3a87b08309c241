//! The value of an expression at n.

use super::expression::{Expression, Function, Node, Operation, Term};

/// Where an expression is evaluated.
#[derive(Clone, Copy)]
struct At {
    x: f64,
    /// The number, where exceptions at powers count; none for the expression between the numbers.
    exact: Option<u64>,
}

impl Expression {
    /// αₙ at a number n ≥ 1. May be 0, negative or no number where the expression is; [`super::classify`] refuses that.
    pub fn at(&self, n: u64) -> f64 {
        self.root.at(At {
            x: n as f64,
            exact: Some(n),
        })
    }

    /// α at a real x ≥ 1, without the exceptions of `at_powers`.
    pub fn between(&self, x: f64) -> f64 {
        self.root.at(At { x, exact: None })
    }

    /// The bases of `at_powers`, in ascending order.
    pub(super) fn bases(&self) -> Vec<u64> {
        let mut bases = Vec::new();
        self.root.bases(&mut bases);
        bases.sort_unstable();
        bases.dedup();
        bases
    }
}

impl Node {
    fn at(&self, n: At) -> f64 {
        match &self.term {
            Term::Constant(number) => number.value(),
            Term::Index => n.x,
            Term::Negated(inner) => -inner.at(n),
            Term::Binary(operation, left, right) => {
                let (a, b) = (left.at(n), right.at(n));
                match operation {
                    Operation::Add => a + b,
                    Operation::Subtract => a - b,
                    Operation::Multiply => a * b,
                    Operation::Divide => a / b,
                    Operation::Power => libm::pow(a, b),
                }
            }
            Term::Call(function, arguments) => call(*function, arguments, n),
        }
    }

    fn bases(&self, into: &mut Vec<u64>) {
        match &self.term {
            Term::Constant(_) | Term::Index => {}
            Term::Negated(inner) => inner.bases(into),
            Term::Binary(_, left, right) => {
                left.bases(into);
                right.bases(into);
            }
            Term::Call(function, arguments) => {
                if *function == Function::AtPowers {
                    into.extend(arguments[0].constant().map(|b| b.value() as u64));
                }
                arguments.iter().for_each(|a| a.bases(into));
            }
        }
    }
}

fn call(function: Function, arguments: &[Node], n: At) -> f64 {
    let value = |i: usize| arguments.get(i).map_or(f64::NAN, |a: &Node| a.at(n));
    match function {
        // A value that is no number must not be swallowed by max and min.
        Function::Max | Function::Min => {
            arguments.iter().map(|a| a.at(n)).fold(value(0), |a, b| {
                let better = if function == Function::Max {
                    b > a
                } else {
                    b < a
                };
                if better || b.is_nan() { b } else { a }
            })
        }
        Function::Sqrt => f64::sqrt(value(0)),
        Function::Log => libm::log(value(0)),
        Function::Exp => libm::exp(value(0)),
        Function::Sin => libm::sin(value(0)),
        Function::Cos => libm::cos(value(0)),
        Function::Ppm => {
            let a = value(1);
            value(0) * f64::sqrt(gamma_ratio(n.x, a) / libm::tgamma(1.0 + a))
        }
        Function::Geometric => value(0) * libm::pow(value(1), n.x - 1.0),
        Function::AtPowers => match n.exact {
            Some(k) if is_power(k, value(0) as u64) => value(1),
            _ => value(2),
        },
    }
}

/// Whether k = bʲ, j ≥ 0, for b ≥ 2.
pub(super) fn is_power(mut k: u64, b: u64) -> bool {
    while k > 1 && b > 1 && k.is_multiple_of(b) {
        k /= b;
    }
    k == 1
}

/// Γ(x + a)/Γ(x + 1) for x ≥ 1 and 0 < a < 1.
///
/// **Accuracy**: 1e-14, relative.
fn gamma_ratio(x: f64, a: f64) -> f64 {
    const STIRLING: f64 = 32.0;
    let (mut x, mut factor) = (x, 1.0);
    while x < STIRLING {
        factor *= (x + 1.0) / (x + a);
        x += 1.0;
    }
    // With q = p + d, ln Γ(p) - ln Γ(q) = -d ln p - (q - ½) ln(q/p) + d + S(p) - S(q): nothing large cancels.
    let (p, q, d) = (x + a, x + 1.0, 1.0 - a);
    let series = |x: f64| {
        let s = 1.0 / (x * x);
        (1.0 / 12.0 - s * (1.0 / 360.0 - s * (1.0 / 1260.0 - s / 1680.0))) / x
    };
    let small = d - (q - 0.5) * libm::log1p(d / p) + (series(p) - series(q));
    factor * libm::pow(p, -d) * libm::exp(small)
}
