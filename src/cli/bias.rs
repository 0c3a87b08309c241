//! `nephroid bias`: the order of the bias in the bandwidth.

use super::rates;
use crate::error::Error;
use crate::rates::bias::{HALF_WIDTH, REPLICATES, Request, study};
use crate::rates::{bias_json, bias_svg, bias_table};

/// Measure the bias of a regularizing integrator at several bandwidths, and its order, against the exact expectation.
///
/// Each path class is measured where the kernel is whole (an interior region of the picture, or --region). The order is
/// fitted to the means of independent replicates and compared with that of the exact expectation at the same bandwidths.
/// Exit codes: 0 consistent with the prediction, 1 different, 2 bad usage, 3 undecided (the table says how many paths
/// would decide), 4 nothing to measure.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    options: rates::Options,
    /// Two to 32 different bandwidths: angles in radians, or radii in metres.
    #[arg(long, value_name = "A,B,...", value_parser = rates::bandwidths)]
    bandwidths: rates::Bandwidths,
    /// Paths of each class, shared among the bandwidths. Default: what takes some seconds.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths: Option<u64>,
    /// Independent repetitions, 16 to 65536.
    #[arg(long, value_name = "R", default_value_t = REPLICATES, value_parser = rates::replicates)]
    replicates: u32,
    /// Decided if the 95 % interval of the order is not wider than this on either side, 0.001 to 10.
    #[arg(long, value_name = "H", default_value_t = HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    half_width: f64,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let options = &args.options;
    let (entry, integrator) = options.load(true)?;
    let request = Request {
        asked: options.asked(&entry, integrator.as_ref(), args.replicates),
        bandwidths: &args.bandwidths.0,
        paths: args.paths,
        half_width: args.half_width,
    };
    let (studies, skipped) = study(&request).map_err(|e| rates::invalid(e, "bandwidths"))?;
    let heading = options.heading(&request.asked, None);
    options.answer(
        || bias_svg(&heading, &studies),
        || bias_json(&heading, &studies, &skipped),
        || bias_table(&heading, &studies, &skipped),
        studies.iter().map(|s| s.state),
    )
}
