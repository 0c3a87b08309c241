//! `nephroid run`: one integrator, one image.

use std::io::IsTerminal as _;
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use crate::error::Error;
use crate::exr_output::{metadata, write_exr};
use crate::film::Film;
use crate::integrators::accumulate::{accumulate, paths_per_iteration};
use crate::integrators::schedule::ALLOWED;
use crate::integrators::selection::{PILOTS, Selection, Selector, accumulate_selected};
use crate::integrators::{
    Heuristic, Integrator, Kernel, Merging, Mollified, Plan, Schedule, Settings, Side, Statistics,
    Technique, Treatment, by_name,
};
use crate::{entry, exit};

use super::schedule::at_column;

/// The bandwidth where none is given, an angle [rad] or a radius [m].
const DEFAULT_BANDWIDTH: f64 = 0.2;

/// Render a scene with one of the reference integrators.
///
/// The EXR file has a channel `<CLASS>.Y` (f32, W/(m² sr)) for each path class that the integrator samples; the file and
/// the printed means are the same for any number of threads.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The short name of an integrator, such as pt-reg.
    #[arg(long, value_name = "NAME")]
    integrator: String,
    /// Paths over the whole image, such as 3e7. A path of pm and ppm is one photon and one camera path.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths: u64,
    /// Seed of the random numbers.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// Bandwidth of the regularized classes: an angle in radians for pt-reg and bdpt-reg, a radius in metres for pm and vcm;
    /// the first radius for ppm, and the largest for appm. Default: 0.2.
    #[arg(long, value_name = "A", conflicts_with = "schedule")]
    bandwidth: Option<f64>,
    /// Bandwidth per iteration n = 1, 2, …: a number, a list `0.3,0.2,0.1` whose last value stays, or an expression such as
    /// `0.2*n^(-1/6)` or `ppm(R1, A)`, r²ₙ₊₁ = r²ₙ (n + A)/(n + 1), as in `nephroid schedule`.
    #[arg(long, value_name = "EXPR")]
    schedule: Option<String>,
    /// Paths per iteration: what a step of a schedule is. Default: 262144, or four per pixel if that is more.
    #[arg(long, value_name = "N", value_parser = super::count)]
    paths_per_iteration: Option<u64>,
    /// Kernel of the regularized classes: cone, epanechnikov or vmf on the angle (pt-reg, bdpt-reg); disc, epanechnikov,
    /// biweight or cone on the radius (pm, ppm, appm, vcm).
    #[arg(long, value_name = "KERNEL")]
    kernel: Option<Kernel>,
    /// Specular vertices of a chain that pt-reg mollifies: light (the one next to the light), or all, among plane mirrors.
    #[arg(long, value_name = "WHICH", default_value = "light")]
    mollified: Mollified,
    /// How bidirectional methods weight techniques that build the same paths: balance or power.
    #[arg(long, value_name = "H", default_value_t)]
    heuristic: Heuristic,
    /// Connect a mollified vertex on this side only, camera or light, with bdpt-reg. The expectation stays. Default: both.
    #[arg(long, value_name = "SIDE")]
    technique: Option<Side>,
    /// How the radii of ppm shrink: by a sequence, or pixel by pixel with the photons met.
    #[arg(long, value_name = "S", default_value_t)]
    statistics: Statistics,
    /// What vcm merges: full (every class), selective (only what no connection samples) or none.
    #[arg(long, value_name = "M", default_value_t)]
    merging: Merging,
    /// Choose the bandwidth of an iteration from those before it: preview (the smallest at which all paths of a pixel miss with
    /// probability 1e-3 at most) or optimum (of least estimated error). The given bandwidth is the largest.
    #[arg(long, value_name = "WAY", conflicts_with = "schedule")]
    select: Option<Select>,
    /// The EXR file to write.
    #[arg(short, long, value_name = "FILE.exr")]
    output: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let settings = Settings {
        kernel: args.kernel,
        mollified: args.mollified,
        heuristic: args.heuristic,
        side: args.technique,
        statistics: args.statistics,
        merging: args.merging,
        ..Settings::default()
    };
    let integrator = by_name(&args.integrator, &settings)?;
    integrator.supports(&entry).map_err(|reason| {
        refused(
            "integrator",
            integrator.name(),
            &format!("pt or lt on this scene: {reason}"),
        )
    })?;
    let plan = integrator.plan(&entry);
    let mut film = Film::new(
        entry.camera.width,
        entry.camera.height,
        entry.kind.classes(),
    );
    let per_iteration = args
        .paths_per_iteration
        .unwrap_or_else(|| paths_per_iteration(film.pixels()));
    let most = per_iteration.saturating_mul(1 << 32);
    if args.paths > most {
        return Err(refused(
            "paths",
            args.paths,
            &format!("at most {most}: 2^32 iterations"),
        ));
    }
    let iterations = args.paths.div_ceil(per_iteration.max(1));
    let schedule = schedule(args, integrator.as_ref(), &plan, iterations)?;
    if plan.iter().all(|c| c.treatment == Treatment::NotSampled) {
        super::print(&format!(
            "{} samples no path class of {}:",
            integrator.name(),
            entry.name
        ));
        for class in &plan {
            super::print(&format!(
                "  {:<6} {}",
                class.class.to_string(),
                class.reason
            ));
        }
        return Ok(exit::NOTHING_RAN);
    }

    let prepared = integrator.prepare(&entry);
    let schedule = match args.select {
        Some(way) => {
            let mut selector = selector(args, way, integrator.as_ref(), &plan, film.pixels())?;
            let fewest = u64::from(PILOTS) + 1;
            let per_iteration = per_iteration.min(args.paths.div_ceil(fewest));
            let (seed, paths) = (args.seed, args.paths);
            let prepared = prepared.as_ref();
            Schedule::List(accumulate_selected(
                prepared,
                &mut selector,
                seed,
                paths,
                per_iteration,
                &mut film,
            ))
        }
        None => {
            let bar = progress(args.paths);
            accumulate(
                prepared.as_ref(),
                &schedule,
                args.seed,
                args.paths,
                per_iteration,
                &mut film,
                |paths| bar.set_position(paths),
            );
            bar.finish_and_clear();
            schedule
        }
    };
    write(
        args,
        &entry,
        integrator.as_ref(),
        &plan,
        &mut film,
        &schedule,
        per_iteration,
    )?;
    Ok(exit::PASS)
}

/// How a bandwidth is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Select {
    Preview,
    Optimum,
}

/// Probability that a preview misses a pixel.
const MISS: f64 = 1e-3;

/// What chooses the bandwidths, where it has something to choose.
fn selector(
    args: &Args,
    way: Select,
    integrator: &dyn Integrator,
    plan: &Plan,
    pixels: usize,
) -> Result<Selector, Error> {
    let regularized = |t: Treatment| match t {
        Treatment::Regularized(technique) => Some(technique),
        _ => None,
    };
    let layers: Vec<usize> = (0..plan.len())
        .filter(|&k| regularized(plan[k].treatment).is_some())
        .collect();
    let techniques = || plan.iter().filter_map(|c| regularized(c.treatment));
    let name = integrator.name();
    if layers.is_empty() || techniques().any(|t| t == Technique::AdaptiveMerge) {
        let allowed = "nothing where no bandwidth is to be chosen";
        return Err(refused("select", name, allowed));
    }
    let selection = match way {
        Select::Optimum => Selection::Optimum,
        Select::Preview if techniques().all(|t| t == Technique::Camera) => {
            Selection::Preview { miss: MISS }
        }
        Select::Preview => {
            let allowed =
                "preview for methods that connect: a camera path meets many photons at a time";
            return Err(refused("select", name, allowed));
        }
    };
    let given = args.bandwidth.unwrap_or(DEFAULT_BANDWIDTH);
    // A mollified interaction on a surface in space has two dimensions.
    let dimension = 2.0;
    Ok(Selector::new(
        selection, given, dimension, args.paths, pixels, layers,
    ))
}

/// Writes the image of the classes that are sampled, and prints their means.
fn write(
    args: &Args,
    entry: &nephroid_analytic::scene::Entry,
    integrator: &dyn Integrator,
    plan: &Plan,
    film: &mut Film,
    schedule: &Schedule,
    per_iteration: u64,
) -> Result<(), Error> {
    let means = film.class_means();
    let scale = 1.0 / film.paths as f64;
    film.layers.iter_mut().flatten().for_each(|v| *v *= scale);
    let sampled = || {
        plan.iter()
            .enumerate()
            .filter(|(_, c)| c.treatment != Treatment::NotSampled)
    };
    let layers: Vec<_> = sampled()
        .map(|(k, c)| (format!("{}.Y", c.class), film.layers[k].as_slice()))
        .collect();
    let mut attributes = metadata(entry);
    let more = [
        ("integrator", integrator.name().to_owned()),
        ("paths", film.paths.to_string()),
        ("paths-per-iteration", per_iteration.to_string()),
        ("seed", args.seed.to_string()),
        ("schedule", schedule.to_string()),
        (
            "kernel",
            args.kernel.map_or("default".to_owned(), |k| k.to_string()),
        ),
    ];
    attributes.extend(more.map(|(key, value)| (format!("nephroid:{key}"), value)));
    write_exr(&args.output, film.width, film.height, &layers, &attributes)?;
    super::print(&format!(
        "{}: {}×{} pixels, {} paths, mean radiance in W/(m² sr)",
        args.output.display(),
        film.width,
        film.height,
        film.paths
    ));
    for (k, class) in sampled() {
        let how = match class.treatment {
            Treatment::Regularized(_) => format!("regularized, bandwidth {schedule}"),
            _ => "exact".to_owned(),
        };
        super::print(&format!(
            "  {:<6} {:.6e}  {} contributions, {how}",
            class.class.to_string(),
            means[k],
            film.nonzero[k]
        ));
    }
    Ok(())
}

/// The schedule, within the range of what it is a bandwidth of in every iteration.
fn schedule(
    args: &Args,
    integrator: &dyn Integrator,
    plan: &Plan,
    iterations: u64,
) -> Result<Schedule, Error> {
    let (key, schedule) = match &args.schedule {
        Some(text) => {
            let schedule = text
                .parse()
                .map_err(|e| at_column("--schedule", text, &e, Some(ALLOWED)))?;
            ("schedule", schedule)
        }
        None => (
            "bandwidth",
            integrator.schedule(args.bandwidth.unwrap_or(DEFAULT_BANDWIDTH)),
        ),
    };
    let is_angle = plan
        .iter()
        .any(|c| matches!(c.treatment, Treatment::Regularized(t) if t.is_angular()));
    let (most, allowed) = if is_angle {
        (
            core::f64::consts::PI,
            "an angle greater than 0, at most π [rad]",
        )
    } else {
        (1e9, "a radius greater than 0, at most 1e9 [m]")
    };
    match schedule.first_unfit(iterations, |v| v > 0.0 && v <= most) {
        Some((n, bad)) if matches!(schedule, Schedule::Expression(_)) => {
            Err(refused(key, format!("{bad} at n = {n}"), allowed))
        }
        Some((_, bad)) => Err(refused(key, bad, allowed)),
        None => Ok(schedule),
    }
}

fn refused(key: &str, found: impl std::fmt::Display, allowed: &str) -> Error {
    Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{key}"),
        found: found.to_string(),
        allowed: allowed.to_owned(),
    }
}

/// A progress bar, on a terminal only.
fn progress(paths: u64) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(paths);
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar} {percent} % of {len} paths, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}
