//! `nephroid verify`: run integrators against exact truths and print verdicts.

use std::path::PathBuf;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::ranges::{bandwidth, level, margin};
use crate::error::Error;
use crate::integrators::{Heuristic, Integrator, Kernel, NAMES, Settings, by_name};
use crate::judge::hypotheses::LEVEL;
use crate::mask::Mask;
use crate::verify::effort::{BANDWIDTH, Effort};
use crate::verify::expected::Truths;
use crate::verify::pictures;
use crate::verify::run::{self, Request};
use crate::verify::suite::{Coverage, LeftOut, Subject};
use crate::{entry, exit};

use super::answer::Outputs;

/// Judge the reference integrators against exact truths.
///
/// Each pair of scene and integrator is run as independent replicates; the mean radiance of each path class over the
/// image is compared with its closed form, or with the exact expectation at the bandwidth where the integrator
/// regularizes. "equivalent": within the margin. "different": a bias is established. "undecided": neither.
///
/// Without --scene and --integrator, `--effort quick` runs a covering subset and the others run everything; with one of
/// them, exactly what it names is run. Exit codes: 0 all equivalent, 1 something is different, 2 bad usage, 3 something is
/// undecided, 4 nothing was judged.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file. May be repeated.
    #[arg(long = "scene", value_name = "SCENE")]
    scenes: Vec<String>,
    /// The short name of an integrator. May be repeated.
    #[arg(long = "integrator", value_name = "NAME")]
    integrators: Vec<String>,
    /// Seed: the same seed gives the same verdicts, on any number of threads.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// How much to do: quick (margin 2 %), standard (1 %) or thorough (0.5 %, no time limit).
    #[arg(long, default_value_t = Effort::Quick)]
    effort: Effort,
    /// Equivalence margin relative to the truth, 1e-4 to 0.5. Default: the effort's.
    #[arg(long, value_name = "M", value_parser = margin, allow_negative_numbers = true)]
    margin: Option<f64>,
    /// Probability that all of it together gives any false "different", 1e-15 to 0.1.
    #[arg(long, value_name = "P", default_value_t = LEVEL, value_parser = level, allow_negative_numbers = true)]
    level: f64,
    /// Angle [rad] or radius [m] of the mollifiers of regularizing integrators.
    #[arg(long, value_name = "A", default_value_t = BANDWIDTH, value_parser = bandwidth, allow_negative_numbers = true)]
    bandwidth: f64,
    /// Mollifier: cone, epanechnikov or vmf for an angle, disc, epanechnikov, biweight or cone
    /// for a radius. Default: cone, disc.
    #[arg(long, value_name = "K")]
    kernel: Option<Kernel>,
    /// How bidirectional methods weight techniques that build the same paths: balance or power.
    #[arg(long, value_name = "H", default_value_t)]
    heuristic: Heuristic,
    /// The most paths of one scene and integrator; what is undecided then is said to be. Default: the effort's.
    #[arg(long, value_name = "PATHS", value_parser = super::count)]
    budget: Option<u64>,
    /// Also run each integrator on changed scenes, of which the change of the image is known: scaled, moved, brighter,
    /// finer, cropped, with more and fewer paths. Always from standard on, if nothing is named.
    #[arg(long)]
    variations: bool,
    /// Judge only the pixels that are brighter than half in this PNG, which has the size of the image; not with
    /// --variations.
    #[arg(long, value_name = "FILE.png", conflicts_with = "variations")]
    mask: Option<PathBuf>,
    /// Share the error probabilities among at least this many checks. Only the commands that reproduce a verdict need
    /// it.
    #[arg(long, value_name = "N", value_parser = super::count)]
    checks: Option<u64>,
    #[command(flatten)]
    outputs: Outputs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let request = request(args)?;
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{spinner} {pos}/{len} {msg} ({elapsed})") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let mut truths = Truths::for_margin(request.margin);
    let outcome = run::run(&request, &mut truths, &|position, of, scene, integrator| {
        bar.set_length(of as u64);
        bar.set_position(position as u64);
        bar.set_message(format!("{scene} {integrator}"));
    });
    bar.finish_and_clear();
    let outcome = outcome?;
    let drawn = match args.outputs.report {
        Some(_) => pictures::draw(&request, &outcome, &mut truths)?,
        None => Vec::new(),
    };
    args.outputs.write(&outcome, &drawn)?;
    if outcome.verdicts.is_empty() {
        return Ok(exit::NOTHING_RAN);
    }
    Ok(outcome.exit_code())
}

fn request(args: &Args) -> Result<Request, Error> {
    let explicit = !args.scenes.is_empty() || !args.integrators.is_empty();
    let scenes = match args.scenes.as_slice() {
        [] => entry::names().map(str::to_owned).collect(),
        named => once_each(named),
    };
    let subject = |argument: String| {
        let entry = entry::load(&argument)?;
        Ok(Subject { argument, entry })
    };
    let scenes: Vec<Subject> = scenes.into_iter().map(subject).collect::<Result<_, _>>()?;
    let (integrators, left_out) = integrators(args)?;
    let mask = args.mask.as_deref().map(Mask::read).transpose()?;
    if let Some(mask) = &mask {
        scenes.iter().try_for_each(|s| mask.fits(&s.entry))?;
    }
    Ok(Request {
        scenes,
        integrators,
        left_out,
        effort: args.effort,
        coverage: match args.effort {
            _ if explicit => Coverage::Everything,
            Effort::Quick => Coverage::Covering,
            Effort::Standard => Coverage::Affordable,
            Effort::Thorough => Coverage::Everything,
        },
        margin: args.margin.unwrap_or(args.effort.margin()),
        level: args.level,
        checks: args.checks,
        most_paths: args.budget.unwrap_or(args.effort.most_paths()),
        variations: args.variations
            || (!explicit && args.effort != Effort::Quick && mask.is_none()),
        seed: args.seed,
        bandwidth: args.bandwidth,
        kernel: args.kernel,
        mask,
    })
}

type Integrators = Vec<Box<dyn Integrator>>;

/// Those named; or all, without those that do not take the kernel.
fn integrators(args: &Args) -> Result<(Integrators, Vec<LeftOut>), Error> {
    let settings = Settings {
        kernel: args.kernel,
        heuristic: args.heuristic,
        ..Settings::default()
    };
    let named = once_each(&args.integrators);
    if !named.is_empty() {
        let integrators = named.iter().map(|name| by_name(name, &settings));
        return Ok((integrators.collect::<Result<_, _>>()?, Vec::new()));
    }
    let (mut integrators, mut left_out) = (Vec::new(), Vec::new());
    for name in NAMES {
        match by_name(name, &settings) {
            Ok(integrator) => integrators.push(integrator),
            Err(error) => left_out.push(LeftOut {
                integrator: name.to_owned(),
                reason: error.to_string(),
            }),
        }
    }
    Ok((integrators, left_out))
}

fn once_each(names: &[String]) -> Vec<String> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(name) {
            seen.push(name.clone());
        }
    }
    seen
}
