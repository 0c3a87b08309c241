//! `nephroid faults`: the bug museum and its kill matrix.

use std::path::PathBuf;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::error::Error;
use crate::integrators::NAMES;
use crate::museum::matrix::{Tour, run as take};
use crate::museum::{all, report};
use crate::output::write_text;

/// Run deliberately wrong integrators and show what notices them.
///
/// Every fault is tried at each of its stands (an integrator on a scene at a bandwidth), with the verdict of
/// `nephroid verify --effort standard` ended by the first "different"; before that, the same stands without a fault. Exit
/// code 0 if every fault that can be noticed is, with every seed, and nothing is called different without one; else 1.
#[derive(clap::Args)]
pub struct Args {
    /// Only this fault; may be given several times.
    #[arg(long = "id", value_name = "ID")]
    ids: Vec<String>,
    /// Only the stands of this integrator.
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Number of seeds.
    #[arg(long, value_name = "N", value_parser = super::count, default_value = "1")]
    seeds: u64,
    /// The first seed.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u32,
    /// Also try the acceptance rules of other renderers' tests.
    #[arg(long)]
    baselines: bool,
    /// Write a page of documentation.
    #[arg(long, value_name = "FILE.md")]
    markdown: Option<PathBuf>,
    /// Print JSON alone.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let unknown = |what: &'static str, found: &str, allowed: String| Error::UnknownName {
        what,
        found: found.to_owned(),
        allowed,
    };
    if let Some(id) = args
        .ids
        .iter()
        .find(|id| all().all(|e| e.id != id.as_str()))
    {
        let ids: Vec<_> = all().map(|e| e.id).collect();
        return Err(unknown("fault", id, ids.join(", ")));
    }
    if let Some(name) = args.integrator.as_deref()
        && !NAMES.contains(&name)
    {
        return Err(unknown("integrator", name, NAMES.join(", ")));
    }
    let wanted = |id: &str| args.ids.is_empty() || args.ids.iter().any(|i| i == id);
    let tour = Tour {
        exhibits: all().filter(|e| wanted(e.id)).collect(),
        integrator: args.integrator.clone(),
        seeds: args.seeds,
        seed: u64::from(args.seed),
        baselines: args.baselines || args.markdown.is_some(),
    };
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {pos}/{len} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let matrix = take(&tour, &|position, of, title| {
        bar.set_length(of as u64);
        bar.set_position(position as u64);
        bar.set_message(title.to_owned());
    });
    bar.finish_and_clear();
    let matrix = matrix?;
    if let Some(file) = &args.markdown {
        write_text(file, &report::markdown(&matrix, &command(args)))?;
    }
    if args.json {
        super::print(&format!("{:#}", report::json(&matrix)));
    } else {
        super::print(&report::text(&matrix));
    }
    Ok(matrix.exit_code())
}

/// The command as it was given.
fn command(args: &Args) -> String {
    let mut text = "nephroid faults".to_owned();
    for id in &args.ids {
        text.push_str(&format!(" --id {id}"));
    }
    if let Some(name) = &args.integrator {
        text.push_str(&format!(" --integrator {name}"));
    }
    text.push_str(&format!(" --seeds {} --seed {}", args.seeds, args.seed));
    if let Some(file) = &args.markdown {
        text.push_str(&format!(" --markdown {}", file.display()));
    }
    text
}
