//! `nephroid converge`: variance and bias of the running mean under a schedule.

use super::rates;
use crate::error::Error;
use crate::integrators::Schedule;
use crate::integrators::schedule::ALLOWED;
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
    #[command(flatten)]
    options: rates::Options,
    /// Bandwidth per iteration n = 1, 2, …: a number, a list `0.3,0.2,0.1` whose last value stays, or an expression such as
    /// `0.2*n^(-1/6)` or `ppm(R1, A)`, as in `nephroid schedule`. Methods without bias take any.
    #[arg(long, value_name = "EXPR", value_parser = schedule)]
    schedule: Schedule,
    /// Iterations: a power of two from 4 to 65536.
    #[arg(long, value_name = "N", default_value_t = ITERATIONS, value_parser = iterations)]
    iterations: u32,
    /// Paths of each iteration. Default: what takes some seconds.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths_per_iteration: Option<u64>,
    /// Independent repetitions, 16 to 65536.
    #[arg(long, value_name = "R", default_value_t = REPLICATES, value_parser = rates::replicates)]
    replicates: u32,
    /// Decided if the 95 % interval of the variance's slope is not wider than this on either side, 0.001 to 10.
    #[arg(long, value_name = "H", default_value_t = VARIANCE_HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    half_width: f64,
    /// The same for the slope of the squared bias.
    #[arg(long, value_name = "H", default_value_t = BIAS_HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    bias_half_width: f64,
}

fn schedule(text: &str) -> Result<Schedule, String> {
    text.parse()
        .map_err(|error| format!("{error}; allowed: {ALLOWED}"))
}

fn iterations(text: &str) -> Result<u32, String> {
    let value = super::count(text).ok().and_then(|n| u32::try_from(n).ok());
    value
        .filter(|n| n.is_power_of_two() && (4..=65_536).contains(n))
        .ok_or_else(|| "expected a power of two from 4 to 65536".to_owned())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let options = &args.options;
    let (entry, integrator) = options.load(false)?;
    let request = Request {
        asked: options.asked(&entry, integrator.as_ref(), args.replicates),
        schedule: &args.schedule,
        predicted_schedule: None,
        iterations: args.iterations,
        paths_per_iteration: args.paths_per_iteration,
        half_widths: [args.half_width, args.bias_half_width],
    };
    let (studies, skipped) = study(&request).map_err(|e| rates::invalid(e, "schedule"))?;
    let schedule = args.schedule.to_string();
    let heading = options.heading(&request.asked, Some(&schedule));
    options.answer(
        || converge_svg(&heading, &studies),
        || converge_json(&heading, &studies, &skipped),
        || converge_table(&heading, &studies, &skipped),
        studies.iter().map(|s| s.state),
    )
}
