//! Bandwidths over iterations, in the simple forms: fixed, a list, or the recursion of progressive photon mapping.

use core::fmt;
use core::str::FromStr;

use libm::{exp, sqrt};

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
}

/// What can be written, for messages.
pub const ALLOWED: &str =
    "a number, a list such as 0.3,0.2,0.1, or ppm(R1,A) with A greater than 0, less than 1";

impl FromStr for Schedule {
    type Err = String;

    /// Reads what [`fmt::Display`] writes. Values must be finite and positive.
    fn from_str(text: &str) -> Result<Self, String> {
        let number = |t: &str| {
            t.trim()
                .parse()
                .ok()
                .filter(|v: &f64| *v > 0.0 && v.is_finite())
        };
        let numbers = |t: &str| t.split(',').map(number).collect::<Option<Vec<f64>>>();
        let text = text.trim();
        let inner = text.strip_prefix("ppm(").and_then(|t| t.strip_suffix(')'));
        let schedule = match inner {
            Some(inner) => match numbers(inner).as_deref() {
                Some(&[first, reduction]) if reduction < 1.0 => {
                    Some(Schedule::Progressive { first, reduction })
                }
                _ => None,
            },
            None => match numbers(text) {
                Some(values) if values.len() == 1 => Some(Schedule::Fixed(values[0])),
                values => values.map(Schedule::List),
            },
        };
        schedule.ok_or_else(|| ALLOWED.to_owned())
    }
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
        }
    }
}

impl Schedule {
    /// The bandwidths that are named, of which none is exceeded.
    pub fn values(&self) -> &[f64] {
        match self {
            Schedule::Fixed(value) => core::slice::from_ref(value),
            Schedule::List(values) => values,
            Schedule::Progressive { first, .. } => core::slice::from_ref(first),
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
    fn what_is_written_can_be_read_and_the_rest_is_refused() {
        for text in ["0.2", "0.3,0.2,0.1", "ppm(0.2,0.5)"] {
            assert_eq!(text.parse::<Schedule>().unwrap().to_string(), text);
        }
        for text in [
            "",
            "x",
            "0.2,",
            "-1",
            "0",
            "inf",
            "nan",
            "ppm(0.2)",
            "ppm(0.2,1)",
            "ppm(0.2,0.5",
            "ppm(1,2,3)",
            "pow(1)",
        ] {
            assert_eq!(text.parse::<Schedule>(), Err(ALLOWED.to_owned()), "{text}");
        }
    }

    #[test]
    fn a_list_keeps_its_last_value() {
        let list = Schedule::List(vec![0.3, 0.2]);
        let found: Vec<f64> = (0..4).map(|i| list.bandwidth(i)).collect();
        assert_eq!(found, [0.3, 0.2, 0.2, 0.2]);
    }
}
