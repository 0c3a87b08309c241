//! `nephroid converge`: variance and bias of the running mean under a schedule.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::Technique;
use nephroid_analytic::class::PathClass;

use super::rates;
use crate::error::Error;
use crate::exit;
use crate::integrators::{Kernel, Schedule, Settings, by_name};
use crate::output::write_text;
use crate::rates::bias::LEVEL;
use crate::rates::converge::{
    BIAS_HALF_WIDTH, ITERATIONS, REPLICATES, Request, VARIANCE_HALF_WIDTH, study,
};
use crate::rates::{converge_json, converge_svg, converge_table};

/// Measure how variance and squared bias of an integrator fall with the number of iterations, against exact sums.
///
/// Each replicate is a running mean over iterations, each at its bandwidth of the schedule. Variance and bias are fitted
/// separately and compared with the sums of exact variances and expectations at the same bandwidths; so are the numbers of
/// contributions, which show what no expectation shows. Exit codes: 0 consistent with the prediction, 1 different,
/// 2 bad usage, 3 undecided, 4 nothing to measure.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The short name of an integrator.
    #[arg(long, value_name = "NAME")]
    integrator: String,
    /// Bandwidth per iteration: a number, a list `0.3,0.2,0.1` whose last value stays, or `ppm(R1,A)`:
    /// r²ᵢ₊₁ = r²ᵢ (i + A)/(i + 1). Methods without bias take any.
    #[arg(long, value_name = "EXPR", value_parser = str::parse::<Schedule>)]
    schedule: Schedule,
    /// Measure these pixels, x0 <= column < x1 and y0 <= row < y1. Default: a close-up of an interior part, or the whole
    /// image for a class without bias.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = rates::corners)]
    region: Option<rates::Corners>,
    /// Only this path class, such as LSDE.
    #[arg(long, value_name = "CLASS")]
    class: Option<PathClass>,
    /// Iterations: a power of two from 4 to 65536.
    #[arg(long, value_name = "N", default_value_t = ITERATIONS, value_parser = iterations)]
    iterations: u32,
    /// Paths of each iteration. Default: what takes some seconds.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths_per_iteration: Option<u64>,
    /// Independent repetitions, 16 to 65536.
    #[arg(long, value_name = "R", default_value_t = REPLICATES, value_parser = rates::replicates)]
    replicates: u32,
    /// Seed: the same seed gives the same numbers, on any number of threads.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// Mollifier: cone, epanechnikov or vmf for an angle, disc or epanechnikov for a radius. Default: cone, disc.
    #[arg(long, value_name = "KERNEL")]
    kernel: Option<Kernel>,
    /// The technique whose expectation is the prediction. Default: the one that the integrator's plan names.
    #[arg(long, value_name = "T")]
    technique: Option<Technique>,
    /// Probability that a correct integrator is called different, 1e-15 to 0.1.
    #[arg(long, value_name = "P", default_value_t = LEVEL, value_parser = rates::level, allow_negative_numbers = true)]
    level: f64,
    /// Decided if the 95 % interval of the variance's slope is not wider than this on either side, 0.001 to 10.
    #[arg(long, value_name = "H", default_value_t = VARIANCE_HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    half_width: f64,
    /// The same for the slope of the squared bias.
    #[arg(long, value_name = "H", default_value_t = BIAS_HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    bias_half_width: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Also write a plot.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

fn iterations(text: &str) -> Result<u32, String> {
    let value = super::count(text).ok().and_then(|n| u32::try_from(n).ok());
    value
        .filter(|n| n.is_power_of_two() && (4..=65_536).contains(n))
        .ok_or_else(|| "expected a power of two from 4 to 65536".to_owned())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = crate::entry::load(&args.scene)?;
    let settings = Settings {
        kernel: args.kernel,
        fault: None,
    };
    let integrator = by_name(&args.integrator, &settings)?;
    rates::supported(&entry, integrator.as_ref())?;
    rates::class_exists(&entry, args.class)?;
    let request = Request {
        entry: &entry,
        integrator: integrator.as_ref(),
        kernel: rates::truth_kernel(args.kernel),
        technique: args.technique,
        schedule: &args.schedule,
        predicted_schedule: None,
        class: args.class,
        region: args.region.map(|c| c.0),
        iterations: args.iterations,
        paths_per_iteration: args.paths_per_iteration,
        replicates: args.replicates,
        seed: args.seed,
        level: args.level,
        half_widths: [args.half_width, args.bias_half_width],
    };
    let (studies, skipped) = study(&request).map_err(|e| rates::invalid(e, "schedule"))?;
    let (scene, name) = (&entry.name, integrator.name());
    let schedule = args.schedule.to_string();
    if let Some(path) = &args.plot {
        write_text(path, &converge_svg(scene, name, &studies))?;
    }
    super::print(&if args.json {
        let (seed, level) = (args.seed, args.level);
        converge_json(scene, name, &schedule, seed, level, &studies, &skipped).to_string()
    } else {
        converge_table(scene, name, &schedule, &studies, &skipped)
    });
    let codes = studies.iter().map(|s| s.state.exit_code());
    Ok(codes.reduce(exit::combine).unwrap_or(exit::NOTHING_RAN))
}
