//! `nephroid schedule`: is a schedule of bandwidths consistent, why, and how fast.

use nephroid_analytic::schedule::classify::{FiniteRow, optimal_decay};
use nephroid_analytic::schedule::rate::Rate;
use nephroid_analytic::schedule::{
    Classification, Expression, Number, ParseError, Report, Request, Weights, classify,
};
use serde_json::{Value, json};

use crate::error::Error;
use crate::exit;

/// Decide whether a schedule of bandwidths is consistent, with the reason and the rates of bias, variance and MSE.
///
/// EXPR gives the bandwidth of sample n = 1, 2, …: numbers, n, e, pi, + - * / ^, parentheses, sqrt, log, exp, sin, cos,
/// max, min, ppm(R1, A) with r²ₙ₊₁ = r²ₙ (n + A)/(n + 1), geometric(A1, G) = A1 G^(n-1), and at_powers(B, x, y): x where n
/// is a power of B, y elsewhere. `^` binds more strongly than a sign or a division: write n^(-1/6). Exit codes:
/// 0 consistent, 1 bias or variance persists, 2 bad usage, 3 unknown.
#[derive(clap::Args)]
pub struct Args {
    /// The schedule, such as `0.2*n^(-1/6)`.
    #[arg(value_name = "EXPR", allow_hyphen_values = true)]
    schedule: String,
    /// The variance of a sample is C alpha^-D: 2 for each mollified interaction in space. A number or a fraction.
    #[arg(long, value_name = "D", allow_hyphen_values = true)]
    dimension: String,
    /// The bias of a sample is c alpha^P: 2 where radiance is smooth, 1 at a kink. A number or a fraction.
    #[arg(
        long,
        value_name = "P",
        default_value = "2",
        allow_hyphen_values = true
    )]
    bias_order: String,
    /// For a Markov chain whose mixing does not depend on the bandwidth: its distance to a fixed target falls by this
    /// factor per step, 0 <= G < 1.
    #[arg(long, value_name = "G", value_parser = rate, allow_negative_numbers = true)]
    chain_rate: Option<f64>,
    /// Weight of a sample in the mean.
    #[arg(long, value_name = "W", default_value = "uniform")]
    weights: WeightsName,
    /// Drop this fraction of the samples, from the first one: 0 <= B < 1.
    #[arg(long, value_name = "B", default_value = "0", value_parser = fraction, allow_negative_numbers = true)]
    discard: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum WeightsName {
    /// The plain mean.
    Uniform,
    /// alpha^D: the inverse of the variance.
    InverseVariance,
}

fn rate(text: &str) -> Result<f64, String> {
    below_one(text).ok_or_else(|| {
        "expected a number from 0 to less than 1; a chain that slows down with the bandwidth has no rate, and needs what \
         independent samples need: leave the option out"
            .to_owned()
    })
}

fn fraction(text: &str) -> Result<f64, String> {
    below_one(text).ok_or_else(|| "expected a number from 0 to less than 1".to_owned())
}

fn below_one(text: &str) -> Option<f64> {
    let value: f64 = text.parse().ok()?;
    Some(value).filter(|v| (0.0..1.0).contains(v))
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let schedule = expression("schedule", &args.schedule)?;
    let dimension = constant("--dimension", &args.dimension, "from 0.01 to 100", |d| {
        (0.01..=100.0).contains(&d)
    })?;
    let bias_order = constant("--bias-order", &args.bias_order, "from -100 to 100", |p| {
        (-100.0..=100.0).contains(&p)
    })?;
    let request = Request {
        dimension,
        bias_order,
        weights: match args.weights {
            WeightsName::Uniform => Weights::Uniform,
            WeightsName::InverseVariance => Weights::InverseVariance,
        },
        discarded: args.discard,
        chain_rate: args.chain_rate,
    };
    let report = classify(&schedule, &request).map_err(|error| Error::Content {
        file: "schedule".to_owned(),
        message: format!("`{}`: {error}", args.schedule),
        help: "every bandwidth must be positive and finite".to_owned(),
    })?;
    super::print(&if args.json {
        as_json(&schedule, &request, &report).to_string()
    } else {
        as_text(&schedule, &request, &report)
    });
    Ok(match report.classification {
        Classification::Consistent => exit::PASS,
        Classification::BiasPersists | Classification::VariancePersists => exit::DIFFERENT,
        Classification::Unknown => exit::UNDECIDED,
    })
}

/// Reads an expression; an error shows the column in the text.
fn expression(what: &str, text: &str) -> Result<Expression, Error> {
    text.parse()
        .map_err(|error| at_column(what, text, &error, None))
}

/// What is wrong with an expression, with a mark at its column.
pub(super) fn at_column(
    what: &str,
    text: &str,
    error: &ParseError,
    allowed: Option<&str>,
) -> Error {
    // Control characters would move the mark.
    let shown: String = text
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    let mark = " ".repeat(error.column.saturating_sub(1));
    let allowed = allowed.map_or(String::new(), |a| format!("\nallowed: {a}"));
    Error::Content {
        file: what.to_owned(),
        message: format!("column {}: found {}", error.column, error.found),
        help: format!("expected {}\n{shown}\n{mark}^{allowed}", error.expected),
    }
}

/// A number or a constant expression such as `1/2`, within a range.
fn constant(
    key: &str,
    text: &str,
    range: &str,
    allowed: impl Fn(f64) -> bool,
) -> Result<Number, Error> {
    let number = expression(key, text)?.constant();
    number
        .filter(|n| allowed(n.value()))
        .ok_or_else(|| Error::Parameter {
            file: "command line".to_owned(),
            key: key.to_owned(),
            found: text.to_owned(),
            allowed: format!("a number or a fraction {range}"),
        })
}

fn as_text(schedule: &Expression, request: &Request, report: &Report) -> String {
    let mut lines = vec![
        format!(
            "{}: alpha(n) = {schedule}",
            report.classification.name().replace('_', " ")
        ),
        format!(
            "dimension {}, bias order {}",
            request.dimension, request.bias_order
        ),
    ];
    if let Some(alpha) = &report.alpha {
        lines.push(format!("alpha ~ {alpha}"));
    }
    lines.extend(report.argument.iter().map(|step| format!("- {step}")));
    let rates = [
        ("bias", &report.bias),
        ("variance", &report.variance),
        ("MSE", &report.mse),
    ];
    let rates: Vec<_> = rates
        .iter()
        .filter_map(|(name, rate)| Some(format!("{name} ~ {}", rate.as_ref()?)))
        .collect();
    if !rates.is_empty() {
        lines.push(format!("rates, in units of c and C: {}", rates.join(", ")));
    }
    lines.push(format!(
        "{:>14} {:>12} {:>12} {:>12}",
        "n", "alpha", "bias/c", "variance/C"
    ));
    for row in &report.finite {
        let number = |v: Option<f64>| v.map_or("-".to_owned(), |v| format!("{v:.5e}"));
        lines.push(format!(
            "{:>14} {:>12} {:>12} {:>12}",
            row.n,
            number(Some(row.alpha)),
            number(row.bias),
            number(row.variance)
        ));
    }
    if request.chain_rate.is_some() {
        lines.push("the sums are those of independent samples".to_owned());
    }
    if report.missing() > 0 {
        lines.push(
            "- a sum that leaves the range of f64, or takes too many terms because the bandwidth oscillates"
                .to_owned(),
        );
    }
    lines.join("\n")
}

fn as_json(schedule: &Expression, request: &Request, report: &Report) -> Value {
    let rate = |rate: &Option<Rate>| {
        rate.as_ref().map(|r| {
            json!({
                "text": r.to_string(),
                "coefficient": r.coefficient(),
                "power": r.growth.power.value(),
                "log_power": r.growth.log.value(),
                "log_log_power": r.log_log,
                "exponentials": r.growth.exponentials.iter()
                    .map(|(q, s)| json!({ "factor": q.value(), "power": s.value() }))
                    .collect::<Vec<_>>(),
            })
        })
    };
    let row = |r: &FiniteRow| json!({ "n": r.n, "alpha": r.alpha, "bias_over_c": r.bias, "variance_over_C": r.variance });
    let (d, p) = (request.dimension, request.bias_order);
    json!({
        "schema": "nephroid-schedule/1",
        "expression": schedule.to_string(),
        "dimension": d.value(),
        "bias_order": p.value(),
        "weights": match request.weights {
            Weights::Uniform => "uniform",
            Weights::InverseVariance => "inverse_variance",
        },
        "discarded": request.discarded,
        "chain_rate": request.chain_rate,
        "classification": report.classification.name(),
        "argument": report.argument,
        "alpha": report.alpha,
        "bias": rate(&report.bias),
        "variance": rate(&report.variance),
        "mse": rate(&report.mse),
        "optimal_lambda": (p.value() > 0.0).then(|| optimal_decay(d, p).value()),
        "independent_classification": report.independent.name(),
        "lost_share": report.lost_share,
        "finite": report.finite.iter().map(row).collect::<Vec<_>>(),
    })
}
