//! A schedule as a tree: what can be written, and how it is written back.

use core::fmt;
use core::str::FromStr;

use super::number::Number;
use super::parse::parse;

/// A text that is no expression: where, what stands there, and what was expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// Column of the first wrong character, from 1.
    pub column: usize,
    /// What stands there.
    pub found: String,
    /// What could stand there.
    pub expected: String,
}

impl ParseError {
    pub(super) fn new(column: usize, found: String, expected: &str) -> Self {
        Self {
            column,
            found,
            expected: expected.to_owned(),
        }
    }
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            column,
            found,
            expected,
        } = self;
        write!(f, "column {column}: found {found}, expected {expected}")
    }
}

impl core::error::Error for ParseError {}

/// An expression in n = 1, 2, …
#[derive(Clone, Debug)]
pub struct Expression {
    pub(super) root: Node,
}

/// A part of an expression.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Where it stands, from 1.
    pub(super) column: usize,
    pub(super) term: Term,
}

#[derive(Clone, Debug)]
pub(super) enum Term {
    Constant(Number),
    Index,
    Negated(Box<Node>),
    Binary(Operation, Box<Node>, Box<Node>),
    Call(Function, Vec<Node>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operation {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Operation {
    fn sign(self) -> char {
        match self {
            Self::Add => '+',
            Self::Subtract => '-',
            Self::Multiply => '*',
            Self::Divide => '/',
            Self::Power => '^',
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Max,
    Min,
    Sqrt,
    Log,
    Exp,
    Sin,
    Cos,
    /// r₁ √(Γ(n + a)/(Γ(1 + a) Γ(n + 1))): r²ₙ₊₁ = r²ₙ (n + a)/(n + 1).
    Ppm,
    /// α₁ gⁿ⁻¹.
    Geometric,
    /// The second argument where n is a power of the first one, the third one elsewhere.
    AtPowers,
}

const FUNCTIONS: [(&str, Function); 11] = [
    ("max", Function::Max),
    ("min", Function::Min),
    ("sqrt", Function::Sqrt),
    ("log", Function::Log),
    ("ln", Function::Log),
    ("exp", Function::Exp),
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("ppm", Function::Ppm),
    ("geometric", Function::Geometric),
    ("at_powers", Function::AtPowers),
];

impl Function {
    pub(super) fn named(name: &str) -> Option<Self> {
        let found = FUNCTIONS.iter().find(|f| f.0 == name);
        found.map(|f| f.1)
    }

    pub(super) fn names() -> String {
        FUNCTIONS.map(|f| f.0).join(", ")
    }

    fn name(self) -> &'static str {
        let found = FUNCTIONS.iter().find(|f| f.1 == self);
        found.map_or("", |f| f.0)
    }

    /// The least and the largest number of arguments.
    pub(super) fn arguments(self) -> (usize, usize) {
        match self {
            Self::Max | Self::Min => (2, 16),
            Self::Sqrt | Self::Log | Self::Exp | Self::Sin | Self::Cos => (1, 1),
            Self::Ppm | Self::Geometric => (2, 2),
            Self::AtPowers => (3, 3),
        }
    }

    /// How it is written.
    pub(super) fn usage(self) -> &'static str {
        match self {
            Self::Max => "max(a, b, …), 2 to 16 arguments",
            Self::Min => "min(a, b, …), 2 to 16 arguments",
            Self::Sqrt => "sqrt(a)",
            Self::Log => "log(a), the natural logarithm",
            Self::Exp => "exp(a)",
            Self::Sin => "sin(a)",
            Self::Cos => "cos(a)",
            Self::Ppm => "ppm(R1, A), the radius R1 > 0 of n = 1 and 0 < A < 1",
            Self::Geometric => "geometric(A1, G), A1 > 0 at n = 1 and 0 < G <= 1",
            Self::AtPowers => {
                "at_powers(B, x, y): x where n = B^j, y elsewhere, B a whole number from 2 to 1000"
            }
        }
    }

    /// Refuses constants out of range, at their columns.
    pub(super) fn check(self, arguments: &[Node]) -> Result<(), ParseError> {
        let within = |i: usize, allowed: fn(f64) -> bool| {
            let node = &arguments[i];
            match node.constant() {
                Some(number) if allowed(number.value()) => Ok(()),
                Some(number) => Err(ParseError::new(
                    node.first_column(),
                    number.to_string(),
                    self.usage(),
                )),
                None => Err(ParseError::new(
                    node.first_column(),
                    "an expression in n".to_owned(),
                    &format!("a constant: {}", self.usage()),
                )),
            }
        };
        match self {
            Self::Ppm => {
                within(0, |r| r > 0.0 && r.is_finite())?;
                within(1, |a| a > 0.0 && a < 1.0)
            }
            Self::Geometric => {
                within(0, |a| a > 0.0 && a.is_finite())?;
                within(1, |g| g > 0.0 && g <= 1.0)
            }
            Self::AtPowers => within(0, |b| (2.0..=1000.0).contains(&b) && b == libm::floor(b)),
            _ => Ok(()),
        }
    }
}

impl Node {
    /// The column at which the part begins: that of an operator is in its middle.
    pub(super) fn first_column(&self) -> usize {
        match &self.term {
            Term::Binary(_, left, _) => left.first_column(),
            _ => self.column,
        }
    }

    /// Its value, if n does not occur in it.
    pub(super) fn constant(&self) -> Option<Number> {
        match &self.term {
            Term::Constant(number) => Some(*number),
            Term::Index => None,
            Term::Negated(inner) => Some(inner.constant()?.negated()),
            Term::Binary(operation, left, right) => {
                let (a, b) = (left.constant()?, right.constant()?);
                Some(match operation {
                    Operation::Add => a.plus(b),
                    Operation::Subtract => a.minus(b),
                    Operation::Multiply => a.times(b),
                    Operation::Divide => a.over(b),
                    Operation::Power => a.power(b),
                })
            }
            Term::Call(function, arguments) => {
                let values: Option<Vec<_>> = arguments.iter().map(Self::constant).collect();
                let values = values?;
                let pick = |want| {
                    values.iter().copied().reduce(|a, b| match b.compare(a) {
                        Some(order) if order == want => b,
                        _ => a,
                    })
                };
                let first = values.first()?;
                match function {
                    Function::Max => pick(core::cmp::Ordering::Greater),
                    Function::Min => pick(core::cmp::Ordering::Less),
                    Function::Sqrt => Some(first.power(Number::ONE.over(Number::integer(2)))),
                    Function::Log => Some(Number::inexact(libm::log(first.value()))),
                    Function::Exp => Some(Number::inexact(libm::exp(first.value()))),
                    Function::Sin => Some(Number::inexact(libm::sin(first.value()))),
                    Function::Cos => Some(Number::inexact(libm::cos(first.value()))),
                    // These depend on n although it is not written.
                    Function::Ppm | Function::Geometric | Function::AtPowers => None,
                }
            }
        }
    }
}

impl FromStr for Expression {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        parse(text).map(|root| Self { root })
    }
}

impl Expression {
    /// Its value, if n does not occur in it.
    pub fn constant(&self) -> Option<Number> {
        self.root.constant()
    }

    /// R1 and A of an expression that is `ppm(R1, A)` and nothing else.
    pub fn ppm(&self) -> Option<[Number; 2]> {
        let Term::Call(Function::Ppm, arguments) = &self.root.term else {
            return None;
        };
        let [first, reduction] = arguments.as_slice() else {
            return None;
        };
        Some([first.constant()?, reduction.constant()?])
    }
}

impl PartialEq for Expression {
    /// The same way of writing it.
    fn eq(&self, other: &Self) -> bool {
        self.to_string() == other.to_string()
    }
}

impl fmt::Display for Expression {
    /// With all parentheses, so that it shows how the text was read.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.root.fmt(f)
    }
}

impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(number) = self.constant().filter(|n| n.is_exact()) {
            let text = number.to_string();
            return match text.contains(['/', '-']) {
                true => write!(f, "({text})"),
                false => f.write_str(&text),
            };
        }
        match &self.term {
            Term::Constant(number) => write!(f, "{}", number.value()),
            Term::Index => f.write_str("n"),
            Term::Negated(inner) => write!(f, "(-{inner})"),
            Term::Binary(operation, left, right) => {
                write!(f, "({left} {} {right})", operation.sign())
            }
            Term::Call(function, arguments) => {
                write!(f, "{}(", function.name())?;
                for (i, argument) in arguments.iter().enumerate() {
                    let comma = if i > 0 { ", " } else { "" };
                    write!(f, "{comma}{argument}")?;
                }
                f.write_str(")")
            }
        }
    }
}
