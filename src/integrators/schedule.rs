//! Bandwidths over iterations: fixed, a list, the recursion of progressive photon mapping, or any expression in the iteration's number.

use core::fmt;
use core::str::FromStr;

use libm::{exp, sqrt};
use nephroid_analytic::schedule::{Expression, ParseError};

/// The default of the recursion's parameter.
pub const DEFAULT_REDUCTION: f64 = 2.0 / 3.0;

/// A bandwidth for every iteration, counted from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// The same in every iteration.
    Fixed(f64),
    /// One by one; the last one stays.
    List(Vec<f64>),
    /// r²ᵢ₊₁ = r²ᵢ (i + a)/(i + 1), i = 1, 2, …, with r₁ in iteration 0 [Knaus & Zwicker 2011, eq. 15].
    Progressive {
        /// r₁, a radius [m] or an angle [rad].
        first: f64,
        /// a, in (0, 1).
        reduction: f64,
    },
    /// Its value at n = 1 in iteration 0, at n = 2 in iteration 1, …
    Expression(Expression),
}

/// What can be written, for messages.
pub const ALLOWED: &str = "a number, a list such as 0.3,0.2,0.1 whose last value stays, or an expression in n = 1, 2, … such as \
     0.2*n^(-1/6), ppm(R1, A), geometric(A1, G) or max(a, b)";

impl FromStr for Schedule {
    type Err = ParseError;

    /// Reads what [`fmt::Display`] writes. Numbers must be finite and positive; of an expression only its form is checked here
    /// ([`Schedule::first_unfit`]).
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let items = items(text);
        if items.len() > 1 {
            let values: Result<_, _> = items.into_iter().map(|(at, t)| number(at, t)).collect();
            return values.map(Schedule::List);
        }
        let expression: Expression = text.parse()?;
        if let Some([first, reduction]) = expression.ppm() {
            let [first, reduction] = [first.value(), reduction.value()];
            return Ok(Schedule::Progressive { first, reduction });
        }
        match expression.constant().map(|c| c.value()) {
            Some(value) if value > 0.0 && value.is_finite() => Ok(Schedule::Fixed(value)),
            Some(value) => Err(ParseError {
                column: 1 + text.chars().take_while(|c| c.is_whitespace()).count(),
                found: value.to_string(),
                expected: "a bandwidth greater than 0".to_owned(),
            }),
            None => Ok(Schedule::Expression(expression)),
        }
    }
}

/// The parts of a text between the commas that are in no parentheses, with the columns at which they begin.
fn items(text: &str) -> Vec<(usize, &str)> {
    let (mut items, mut depth, mut start, mut column) = (Vec::new(), 0_i32, 0, 1);
    for (k, (at, c)) in text.char_indices().enumerate() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                items.push((column, &text[start..at]));
                (start, column) = (at + 1, k + 2);
            }
            _ => {}
        }
    }
    items.push((column, &text[start..]));
    items
}

/// An item of a list.
fn number(column: usize, text: &str) -> Result<f64, ParseError> {
    let value = text.trim().parse().ok();
    value
        .filter(|v: &f64| *v > 0.0 && v.is_finite())
        .ok_or_else(|| ParseError {
            column: column + text.chars().take_while(|c| c.is_whitespace()).count(),
            found: match text.trim() {
                "" => "nothing".to_owned(),
                found => format!("`{found}`"),
            },
            expected: "a number greater than 0, in a list".to_owned(),
        })
}

impl fmt::Display for Schedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Schedule::Fixed(value) => write!(f, "{value}"),
            Schedule::List(values) => {
                let values: Vec<_> = values.iter().map(f64::to_string).collect();
                f.write_str(&values.join(","))
            }
            Schedule::Progressive { first, reduction } => write!(f, "ppm({first},{reduction})"),
            Schedule::Expression(expression) => expression.fmt(f),
        }
    }
}

impl Schedule {
    /// The first of so many iterations whose bandwidth does not fit: its number n, counted from 1, and that bandwidth.
    pub fn first_unfit(&self, iterations: u64, fits: impl Fn(f64) -> bool) -> Option<(u64, f64)> {
        let unfit = |&(_, v): &(u64, f64)| !fits(v);
        match self {
            Schedule::Expression(e) => (1..=iterations).map(|n| (n, e.at(n))).find(unfit),
            // None exceeds the first.
            Schedule::Fixed(first) | Schedule::Progressive { first, .. } => {
                Some((1, *first)).filter(unfit)
            }
            Schedule::List(values) => (1..).zip(values.iter().copied()).find(unfit),
        }
    }

    /// The bandwidth of an iteration.
    pub fn bandwidth(&self, iteration: u32) -> f64 {
        match self {
            Schedule::Fixed(value) => *value,
            Schedule::List(values) => {
                let last = values.len().saturating_sub(1);
                values
                    .get((iteration as usize).min(last))
                    .copied()
                    .unwrap_or(0.0)
            }
            Schedule::Progressive { first, reduction } => {
                first * sqrt(progressive_ratio(iteration, *reduction))
            }
            Schedule::Expression(expression) => expression.at(u64::from(iteration) + 1),
        }
    }
}

/// r²/r₁² in an iteration counted from 0: the product of (i + a)/(i + 1), i = 1 … iteration.
pub(super) fn progressive_ratio(iteration: u32, a: f64) -> f64 {
    const PRODUCT: u32 = 4096;
    let product = (1..=iteration.min(PRODUCT))
        .map(f64::from)
        .fold(1.0, |product, i| product * ((i + a) / (i + 1.0)));
    if iteration <= PRODUCT {
        return product;
    }
    // Γ(n + 1 + a)/Γ(n + 2) relative to its value at the end of the product: no loop over a billion iterations.
    let log = |n: f64| lgamma_difference(n, a);
    product * exp(log(f64::from(iteration)) - log(f64::from(PRODUCT)))
}

/// ln Γ(n + 1 + a) - ln Γ(n + 2) for n ≥ 4096, by Stirling's series, in which nothing cancels.
fn lgamma_difference(n: f64, a: f64) -> f64 {
    let (p, q) = (n + 1.0 + a, n + 2.0);
    // (p - ½) ln p - (q - ½) ln q = (p - q) ln p - (q - ½) ln(q/p); p - q = a - 1 exactly enough.
    let d = 1.0 - a;
    let series = |x: f64| (1.0 / 12.0 - 1.0 / (360.0 * x * x)) / x;
    -d * libm::log(p) - (q - 0.5) * libm::log1p(d / p) + d + series(p) - series(q)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recursion_step_by_step() {
        let a = DEFAULT_REDUCTION;
        let schedule = Schedule::Progressive {
            first: 0.2,
            reduction: a,
        };
        let mut square = 0.2 * 0.2;
        for iteration in 0..20_000_u32 {
            let r = schedule.bandwidth(iteration);
            if iteration % 97 == 0 {
                assert!((r * r / square - 1.0).abs() < 1e-11, "{iteration}");
            }
            let i = f64::from(iteration + 1);
            square *= (i + a) / (i + 1.0);
        }
        // r²ₙ ~ r₁² n^(a-1)/Γ(1+a).
        let n = 4.0e9_f64;
        let limit = 0.04 * libm::pow(n, a - 1.0) / libm::tgamma(1.0 + a);
        let r = schedule.bandwidth(4_000_000_000 - 1);
        assert!((r * r / limit - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_written_can_be_read_and_the_rest_is_refused_at_its_column() {
        for text in ["0.2", "0.3,0.2,0.1", "ppm(0.2,0.5)", "geometric(0.3, 0.99)"] {
            assert_eq!(text.parse::<Schedule>().unwrap().to_string(), text);
        }
        for text in [
            "0.2*n^(-1/6)",
            "max(0.1, 0.3/sqrt(n))",
            "0.3/(1+log(n))",
            "at_powers(2, 0.1, 0.3)",
        ] {
            let schedule: Schedule = text.parse().unwrap();
            assert!(matches!(schedule, Schedule::Expression(_)), "{text}");
            let again: Schedule = schedule.to_string().parse().unwrap();
            assert_eq!(again, schedule);
            for iteration in [0, 1, 9, 100_000] {
                assert_eq!(again.bandwidth(iteration), schedule.bandwidth(iteration));
            }
        }
        for (text, column) in [
            ("", 1),
            ("x", 1),
            ("0.2,", 5),
            ("0.2, x,0.1", 6),
            ("0.2,-1", 5),
            ("-1", 1),
            ("0", 1),
            ("inf", 1),
            ("nan", 1),
            ("ppm(0.2)", 8),
            ("ppm(0.2,1)", 9),
            ("ppm(0.2,0.5", 12),
            ("ppm(1,2,3)", 8),
            ("pow(1)", 1),
            ("0.2*m", 5),
        ] {
            let error = text.parse::<Schedule>().unwrap_err();
            assert_eq!(error.column, column, "{text}: {error}");
        }
    }

    #[test]
    fn expressions_start_at_one_and_the_recursion_keeps_its_form() {
        let schedule: Schedule = "0.3*n^(-1/2)".parse().unwrap();
        assert_eq!(schedule.bandwidth(0), 0.3);
        assert!((schedule.bandwidth(3) / 0.15 - 1.0).abs() < 1e-15);
        let ppm: Schedule = "ppm(0.1, 2/3)".parse().unwrap();
        let recursion = Schedule::Progressive {
            first: 0.1,
            reduction: DEFAULT_REDUCTION,
        };
        assert_eq!(ppm, recursion);
        assert_eq!("1/5".parse::<Schedule>().unwrap(), Schedule::Fixed(0.2));
        // log(1) = 0, and what is too wide later on.
        let fits = |v: f64| v > 0.0 && v <= 1.0;
        let unfit = |text: &str| text.parse::<Schedule>().unwrap().first_unfit(100, fits);
        assert_eq!(unfit("log(n)"), Some((1, 0.0)));
        assert_eq!(unfit("0.25*n"), Some((5, 1.25)));
        assert_eq!(unfit("n^(-1/6)"), None);
        assert_eq!(unfit("0.3,2"), Some((2, 2.0)));
    }

    #[test]
    fn a_list_keeps_its_last_value() {
        let list = Schedule::List(vec![0.3, 0.2]);
        let found: Vec<f64> = (0..4).map(|i| list.bandwidth(i)).collect();
        assert_eq!(found, [0.3, 0.2, 0.2, 0.2]);
    }
}
