//! `nephroid stability`: what rounding does to the closed forms.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::error::Error;
use crate::output::write_text;
use crate::stability::plot::svg;
use crate::stability::{ALLOWED_EXCESS, Outcome, Row, study, sweeps};
use crate::{entry, exit};

/// Measure the relative error of the f32 and f64 formulas against proven enclosures, on the way to every danger.
///
/// Prints, per kind, danger and precision: the worst relative error, the worst conditioning, and the digits lost beyond the
/// conditioning. Exit code 1 if a formula loses more than 4 digits beyond its conditioning, or a value is outside its own
/// error bound.
#[derive(clap::Args)]
pub struct Args {
    /// Only the kind of this scene: a name from `nephroid list`, a TOML file, or a kind. Default: all kinds.
    scene: Option<String>,
    /// Also write a plot.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let kinds: Vec<_> = sweeps::all().iter().map(|s| s.kind).collect();
    let kind = match &args.scene {
        None => None,
        Some(scene) => match kinds.iter().find(|k| *k == scene) {
            Some(kind) => Some((*kind).to_owned()),
            None => {
                let kind = entry::load(scene)?.kind.name();
                Some(sweeps::swept_as(kind).to_owned())
            }
        },
    };
    let rows = study(kind.as_deref());
    if let Some(path) = &args.plot {
        write_text(path, &svg(&rows))?;
    }
    if args.json {
        let rows: Vec<_> = rows.iter().map(as_json).collect();
        let answer = json!({ "schema": "nephroid-stability/1", "allowed_excess": ALLOWED_EXCESS, "rows": rows });
        super::print(&answer.to_string());
    } else {
        print_table(&rows);
    }
    Ok(if rows.is_empty() {
        if !args.json {
            super::print("no sweep for this kind");
        }
        exit::NOTHING_RAN
    } else if rows.iter().all(Row::is_stable) {
        exit::PASS
    } else {
        exit::DIFFERENT
    })
}

fn print_table(rows: &[Row]) {
    super::print(&format!(
        "{:<21} {:<25} {:<4} {:>8} {:>10} {:>13} {:>14}",
        "kind", "danger", "", "compared", "error", "conditioning", "excess digits"
    ));
    for row in rows {
        let note = match (row.is_stable(), row.unbounded()) {
            (true, _) => String::new(),
            (false, 0) => "  unstable".to_owned(),
            (false, n) => format!("  {n} outside their bound"),
        };
        super::print(&format!(
            "{:<21} {:<25} {:<4} {:>5}/{:<2} {:>10.1e} {:>13.1e} {:>14.1}{note}",
            row.kind,
            row.danger,
            row.precision.name(),
            row.compared(),
            row.steps.len(),
            row.worst_error(),
            row.worst_conditioning(),
            row.worst_excess(),
        ));
    }
}

fn as_json(row: &Row) -> Value {
    let steps: Vec<_> = row
        .steps
        .iter()
        .map(|s| match s.outcome {
            Outcome::Compared {
                error,
                conditioning,
                bounded,
            } => json!({
                "t": s.t, "outcome": "compared", "error": error, "conditioning": conditioning,
                "within_bound": bounded,
            }),
            Outcome::Singular => json!({ "t": s.t, "outcome": "singular" }),
            Outcome::Undecided => json!({ "t": s.t, "outcome": "undecided" }),
            Outcome::Outside => json!({ "t": s.t, "outcome": "outside" }),
        })
        .collect();
    json!({
        "kind": row.kind,
        "danger": row.danger,
        "parameter": row.parameter,
        "precision": row.precision.name(),
        "worst_error": row.worst_error(),
        "worst_conditioning": row.worst_conditioning(),
        "worst_excess_digits": row.worst_excess(),
        "stable": row.is_stable(),
        "steps": steps,
    })
}
