//! `nephroid evaluate`: truth at the points of a reference file.

use std::path::PathBuf;

use serde_json::{Map, Value, json};

use crate::error::Error;
use crate::evaluate::{self, Placed, Report, Row};
use crate::exit;

/// Evaluate closed forms, or exact expectations at finite bandwidth, at the points of a reference file, and compare.
///
/// Prints every value with its error bound, the expected value's relative difference and, near a singularity, the
/// difference that the conditioning allows; the worst difference last. Expected values are optional, one by one.
#[derive(clap::Args)]
pub struct Args {
    /// File of schema nephroid-theory-reference/1 or nephroid-theory-bandwidth/1.
    #[arg(value_name = "FILE.json")]
    file: PathBuf,
    /// Exit with 1 if any relative difference is larger than this or, near a singularity, than its conditioning allows.
    #[arg(long, value_name = "T", value_parser = tolerance)]
    tolerance: Option<f64>,
    /// Add to every value of a reference file an interval that provably contains the true one, from the decimals in the
    /// file, and whether the number of rays behind it is proven.
    #[arg(long)]
    certify: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(t) if (0.0..=1.0).contains(&t) => Ok(t),
        _ => Err("expected a number from 0 to 1, such as 1e-12".to_owned()),
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let file = args.file.display().to_string();
    let text = std::fs::read_to_string(&args.file).map_err(|e| Error::read(&file, e))?;
    let report = if args.certify {
        evaluate::evaluate_certified(&file, &text)?
    } else {
        evaluate::evaluate(&file, &text)?
    };
    let passed = args
        .tolerance
        .map(|t| report.rows().all(|p| p.row.passes(t)));
    let shown = if args.json {
        as_json(&report, args, passed).to_string()
    } else {
        as_text(&report, args, passed)
    };
    super::print(&shown);
    Ok(match passed {
        Some(false) => exit::DIFFERENT,
        _ => exit::PASS,
    })
}

/// A number, or null where it is not finite: JSON has no infinity.
fn finite(value: f64) -> Value {
    if value.is_finite() {
        json!(value)
    } else {
        Value::Null
    }
}

fn row_json(row: &Row, args: &Args) -> Value {
    let mut object = Map::new();
    object.insert("value".into(), finite(row.value));
    object.insert("error_bound".into(), finite(row.error_bound));
    object.insert("conditioning".into(), finite(row.conditioning));
    object.insert("near_singularity".into(), json!(row.near_singularity));
    object.insert("expected".into(), row.expected.map_or(Value::Null, finite));
    let difference = row.relative_difference.map_or(Value::Null, finite);
    object.insert("relative_difference".into(), difference);
    let allowed = row.allowed(args.tolerance.unwrap_or(DEFAULT_TOLERANCE));
    object.insert("allowed".into(), finite(allowed));
    if args.certify {
        let ends = row
            .certificate
            .map_or(Value::Null, |c| json!([finite(c.low), finite(c.high)]));
        object.insert("enclosure".into(), ends);
        let certified = row.certificate.is_some_and(|c| c.certified);
        object.insert("certified".into(), json!(certified));
    }
    Value::Object(object)
}

/// The tolerance of the column `allowed` where the command line has none.
const DEFAULT_TOLERANCE: f64 = 1e-12;

fn as_json(report: &Report, args: &Args, passed: Option<bool>) -> Value {
    let configurations: Vec<_> = report
        .configurations
        .iter()
        .map(|c| {
            let points: Vec<_> = c
                .items
                .iter()
                .map(|item| {
                    let values: Map<_, _> = item
                        .rows
                        .iter()
                        .map(|r| (r.key.clone(), row_json(r, args)))
                        .collect();
                    let roots: Map<_, _> =
                        item.roots.iter().map(|(c, n)| (c.clone(), json!(n))).collect();
                    let singularity = item.singularity.map_or(Value::Null, finite);
                    json!({ "id": item.id, "singularity": singularity, "roots": roots, "values": values })
                })
                .collect();
            json!({ "id": c.id, "points": points })
        })
        .collect();
    let difference = |regular: bool| {
        let worst = report.worst(regular);
        worst.map_or(Value::Null, |p| {
            finite(p.row.relative_difference.unwrap_or(0.0))
        })
    };
    let worst = report.worst(false).map_or(
        Value::Null,
        |p| json!({ "configuration": p.configuration, "id": p.item, "key": p.row.key }),
    );
    json!({
        "schema": "nephroid-evaluate/1",
        "file_schema": report.schema,
        "scene": report.scene,
        "tolerance": args.tolerance,
        "passed": passed,
        "compared": compared(report),
        "configurations": configurations,
        "worst": worst,
        "worst_relative_difference_away_from_singularities": difference(true),
        "worst_relative_difference": difference(false),
    })
}

fn compared(report: &Report) -> usize {
    report
        .rows()
        .filter(|p| p.row.relative_difference.is_some())
        .count()
}

fn as_text(report: &Report, args: &Args, passed: Option<bool>) -> String {
    let tolerance = args.tolerance;
    let limit = tolerance.unwrap_or(DEFAULT_TOLERANCE);
    let mut lines = vec![format!(
        "{:<12} {:<26} {:>24} {:>9} {:>10} {:>9}",
        "point", "key", "value", "bound", "difference", "allowed"
    )];
    for Placed { item, row, .. } in report.rows() {
        let difference = row
            .relative_difference
            .map_or("-".to_owned(), |d| format!("{d:.1e}"));
        let mut line = format!(
            "{item:<12} {:<26} {:>24} {:>9.1e} {difference:>10} {:>9.1e}",
            row.key,
            format!("{:e}", row.value),
            row.error_bound,
            row.allowed(limit),
        );
        if args.certify {
            line += &match row.certificate {
                Some(c) if c.certified => format!("  [{:e}, {:e}]", c.low, c.high),
                Some(c) => format!("  [{:e}, {:e}] undecided", c.low, c.high),
                None => "  not certified".to_owned(),
            };
        }
        if row.near_singularity {
            line += &format!(
                "  near a singularity, conditioning {:.1e}",
                row.conditioning
            );
        }
        if tolerance.is_some() && !row.passes(limit) {
            line += "  WORSE THAN ALLOWED";
        }
        lines.push(line);
    }
    match (report.worst(true), report.worst(false)) {
        (regular, Some(worst)) => {
            let failed = report.rows().filter(|p| !p.row.passes(limit)).count();
            lines.push(format!("{} values compared", compared(report)));
            if passed.is_some() {
                lines.push(format!(
                    "{failed} worse than allowed at tolerance {limit:e}"
                ));
            }
            if let Some(regular) = regular {
                lines.push(summary(
                    "worst relative difference away from singularities",
                    regular,
                ));
            }
            lines.push(summary("worst relative difference", worst));
        }
        _ => lines.push("no expected values to compare with".to_owned()),
    }
    if args.certify {
        lines.push(certified(report));
    }
    lines.join("\n")
}

/// How many values are certified, and the widest of the intervals.
fn certified(report: &Report) -> String {
    let all: Vec<_> = report.rows().collect();
    let proven: Vec<_> = all
        .iter()
        .filter_map(|p| Some((p, p.row.certificate.filter(|c| c.certified)?)))
        .collect();
    let mut line = format!("{} of {} values certified", proven.len(), all.len());
    let widest = proven
        .iter()
        .filter(|(p, _)| !p.row.near_singularity)
        .map(|(p, c)| (p, relative_width(c.low, c.high)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((place, width)) = widest {
        line += &format!(
            ", the widest interval away from singularities {width:.1e} relative ({} {})",
            place.item, place.row.key
        );
    }
    line
}

/// Width over the smaller modulus; 0 for a single number.
fn relative_width(low: f64, high: f64) -> f64 {
    if low == high {
        0.0
    } else {
        (high - low) / f64::abs(low).min(f64::abs(high))
    }
}

fn summary(what: &str, worst: Placed<'_>) -> String {
    format!(
        "{what}: {:.2e} ({} {})",
        worst.row.relative_difference.unwrap_or(0.0),
        worst.item,
        worst.row.key
    )
}
