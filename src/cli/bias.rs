//! `nephroid bias`: the order of the bias in the bandwidth.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::Technique;
use nephroid_analytic::class::PathClass;

use super::rates;
use crate::error::Error;
use crate::exit;
use crate::integrators::{Kernel, Settings, by_name};
use crate::output::write_text;
use crate::rates::bias::{HALF_WIDTH, LEVEL, REPLICATES, Request, study};
use crate::rates::{bias_json, bias_svg, bias_table};

/// Measure the bias of a regularizing integrator at several bandwidths, and its order, against the exact expectation.
///
/// Each path class is measured where the kernel is whole (an interior region of the picture, or --region). The order is
/// fitted to the means of independent replicates and compared with that of the exact expectation at the same bandwidths.
/// Exit codes: 0 consistent with the prediction, 1 different, 2 bad usage, 3 undecided (the table says how many paths
/// would decide), 4 nothing to measure.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The short name of an integrator.
    #[arg(long, value_name = "NAME")]
    integrator: String,
    /// Two to 32 different bandwidths: angles in radians, or radii in metres.
    #[arg(long, value_name = "A,B,...", value_parser = rates::bandwidths)]
    bandwidths: rates::Bandwidths,
    /// Measure these pixels, x0 <= column < x1 and y0 <= row < y1. Default: a close-up of an interior part.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = rates::corners)]
    region: Option<rates::Corners>,
    /// Only this path class, such as LSDE.
    #[arg(long, value_name = "CLASS")]
    class: Option<PathClass>,
    /// Paths of each class, shared among the bandwidths. Default: what takes some seconds.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths: Option<u64>,
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
    /// Decided if the 95 % interval of the order is not wider than this on either side, 0.001 to 10.
    #[arg(long, value_name = "H", default_value_t = HALF_WIDTH, value_parser = rates::half_width, allow_negative_numbers = true)]
    half_width: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Also write a plot.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
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
        bandwidths: &args.bandwidths.0,
        class: args.class,
        region: args.region.map(|c| c.0),
        paths: args.paths,
        replicates: args.replicates,
        seed: args.seed,
        level: args.level,
        half_width: args.half_width,
    };
    let (studies, skipped) = study(&request).map_err(|e| rates::invalid(e, "bandwidths"))?;
    if let Some(path) = &args.plot {
        write_text(path, &bias_svg(&entry.name, integrator.name(), &studies))?;
    }
    super::print(&if args.json {
        let (seed, level) = (args.seed, args.level);
        bias_json(
            &entry.name,
            integrator.name(),
            seed,
            level,
            &studies,
            &skipped,
        )
        .to_string()
    } else {
        bias_table(&entry.name, integrator.name(), &studies, &skipped)
    });
    let codes = studies.iter().map(|s| s.state.exit_code());
    Ok(codes.reduce(exit::combine).unwrap_or(exit::NOTHING_RAN))
}
