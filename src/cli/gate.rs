//! `nephroid gate`: judge the images of any renderer.

use std::path::PathBuf;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::ranges::{bandwidth, in_range, level, margin};
use crate::entry;
use crate::error::Error;
use crate::foreign::names::is_one_of;
use crate::gate::command::Command;
use crate::gate::exported::Exported;
use crate::gate::request::{LEVEL, MARGIN};
use crate::gate::truths::{FARTHEST, Regularization, is_offset};
use crate::gate::{self, Images, Request};
use crate::mask::Mask;

use super::answer::Outputs;

/// Judge the images of any renderer against the exact image of a scene.
///
/// Give 8 to 16 files with different seeds (OpenEXR or PFM, linear radiance), or --command to make them. Layers of path
/// classes (`LSDE.Y`, light path expressions, names of Mitsuba, pbrt, LuxCore and Cycles) are judged class by class, an image of
/// all light by its sum and by the factor of each class in it. A difference is told with what it looks like: a unit, a move, a
/// flip, a class that is missing. Exit codes: 0 all equivalent, 1 something is different, 2 bad usage or unreadable
/// files, 3 something is undecided, 4 nothing was judged.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// Images of the renderer, one for each seed.
    #[arg(
        value_name = "IMAGE",
        required_unless_present = "command",
        conflicts_with = "command"
    )]
    images: Vec<PathBuf>,
    /// Make the images with this command, in a clean directory. {seed} and {out} are replaced, and {scene} and {dir} (where
    /// nephroid was started); no shell reads it.
    #[arg(long, value_name = "COMMAND")]
    command: Option<String>,
    /// Let `sh -c` read the command.
    #[arg(long)]
    shell: bool,
    /// Seconds that one run of the command may take, 0.01 to 1e6.
    #[arg(long, value_name = "S", default_value_t = 600.0, value_parser = seconds, allow_negative_numbers = true)]
    timeout: f64,
    /// The most images that the command makes.
    #[arg(long, value_name = "N", default_value = "64", value_parser = budget)]
    budget: u64,
    /// Seed of the seeds that the command gets.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// What the renderer is called in reports. Default: `images`, or the command's program.
    #[arg(long, value_name = "NAME", value_parser = name)]
    name: Option<String>,
    /// Equivalence margin relative to the truth, 1e-4 to 0.5.
    #[arg(long, value_name = "M", default_value_t = MARGIN, value_parser = margin, allow_negative_numbers = true)]
    margin: f64,
    /// Probability that all of it together gives any false "different", 1e-15 to 0.1.
    #[arg(long, value_name = "P", default_value_t = LEVEL, value_parser = level, allow_negative_numbers = true)]
    level: f64,
    /// A path class that the renderer cannot sample: it is left out of what is expected. May be repeated.
    #[arg(long, value_name = "CLASS")]
    cannot: Vec<String>,
    /// Judge a regularizing renderer at its own bandwidth: camera, light, symmetric, merge or linked.
    #[arg(long, value_name = "T", requires = "bandwidth")]
    technique: Option<Technique>,
    /// Its angle [rad] or radius [m].
    #[arg(long, value_name = "A", requires = "technique", value_parser = bandwidth, allow_negative_numbers = true)]
    bandwidth: Option<f64>,
    /// Its mollifier. Default: cone, or disc for merge.
    #[arg(long, value_name = "K", requires = "technique")]
    kernel: Option<Kernel>,
    /// The renderer's values are G times radiance in W/(m² sr): they are divided by it.
    #[arg(long, value_name = "G", default_value_t = 1.0, value_parser = gain, allow_negative_numbers = true)]
    gain: f64,
    /// The renderer's image is moved by X columns to the right and Y rows down: quarters of a pixel, at most 8.
    #[arg(long, value_name = "X,Y", default_value = "0,0", value_parser = offset, allow_hyphen_values = true)]
    offset: Offset,
    /// The directory of `nephroid export` from which the images were made: what its meshes do to a pixel is added to the truth's bound.
    #[arg(long, value_name = "DIR")]
    exported: Option<PathBuf>,
    /// Samples in a pixel, for files that tell the variance, or the second moment, of one sample.
    #[arg(long, value_name = "N", value_parser = super::count)]
    spp: Option<u64>,
    /// Judge only the pixels that are brighter than half in this PNG, which has the size of the image.
    #[arg(long, value_name = "FILE.png")]
    mask: Option<PathBuf>,
    #[command(flatten)]
    outputs: Outputs,
}

/// Columns to the right and rows down.
#[derive(Clone, Copy, Debug)]
struct Offset([f64; 2]);

fn seconds(text: &str) -> Result<f64, String> {
    in_range(text, 0.01, 1e6)
}

fn gain(text: &str) -> Result<f64, String> {
    in_range(text, 1e-12, 1e12)
}

fn budget(text: &str) -> Result<u64, String> {
    const MOST: u64 = 4096;
    super::count(text)
        .ok()
        .filter(|n| *n <= MOST)
        .ok_or_else(|| format!("expected a whole number from 1 to {MOST}"))
}

fn offset(text: &str) -> Result<Offset, String> {
    let one = |t: &str| t.trim().parse().ok().filter(|o: &f64| is_offset(*o));
    text.split_once(',')
        .and_then(|(x, y)| Some(Offset([one(x)?, one(y)?])))
        .ok_or_else(|| {
            format!("expected X,Y: two multiples of 0.25 from -{FARTHEST} to {FARTHEST}")
        })
}

fn name(text: &str) -> Result<String, String> {
    let is_plain = !text.is_empty() && text.chars().all(|c| c.is_ascii_graphic());
    is_plain
        .then(|| text.to_owned())
        .ok_or_else(|| "expected printable characters without blanks".to_owned())
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let request = request(args)?;
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{spinner} image {pos}/{len} ({elapsed})") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let progress = |position, of| {
        bar.set_length(of);
        bar.set_position(position);
    };
    let judged = match args.outputs.report {
        Some(_) => gate::run_and_draw(&request, &progress),
        None => gate::run(&request, &progress).map(|outcome| (outcome, Vec::new())),
    };
    bar.finish_and_clear();
    let (outcome, drawn) = judged?;
    args.outputs.write(&outcome, &drawn)?;
    Ok(outcome.exit_code())
}

fn request(args: &Args) -> Result<Request, Error> {
    let entry = entry::load(&args.scene)?;
    let mut cannot = Vec::new();
    for name in &args.cannot {
        cannot.extend(positions(name, &entry)?);
    }
    cannot.sort_unstable();
    cannot.dedup();
    let mask = args.mask.as_deref().map(Mask::read).transpose()?;
    if let Some(mask) = &mask {
        mask.fits(&entry)?;
    }
    let exported = args
        .exported
        .as_deref()
        .map(|dir| Exported::read(dir, &entry))
        .transpose()?;
    let regularization = match (args.technique, args.bandwidth) {
        (Some(technique), Some(bandwidth)) => Some(Regularization {
            technique,
            kernel: args.kernel.unwrap_or(technique.default_kernel()),
            bandwidth,
        }),
        _ => None,
    };
    let offset = args.offset.0;
    if regularization.is_some() && offset != [0.0; 2] {
        return Err(Error::Parameter {
            file: "command line".to_owned(),
            key: "--offset".to_owned(),
            found: format!("{},{}", offset[0], offset[1]),
            allowed: "0,0 with --technique: its expectations are known in the scene's frame only"
                .to_owned(),
        });
    }
    if args.shell && args.command.is_none() {
        return Err(Error::Parameter {
            file: "command line".to_owned(),
            key: "--shell".to_owned(),
            found: "given without --command".to_owned(),
            allowed: "with --command only".to_owned(),
        });
    }
    let images = match &args.command {
        Some(text) => {
            let timeout = Duration::from_secs_f64(args.timeout);
            Images::Command(
                Command::new(text, &args.scene, timeout, args.shell)?,
                args.budget,
            )
        }
        None => Images::Files(args.images.clone()),
    };
    let name = match (&args.name, &images) {
        (Some(name), _) => name.clone(),
        (None, Images::Command(command, _)) => command.program(),
        (None, Images::Files(_)) => "images".to_owned(),
    };
    Ok(Request {
        argument: args.scene.clone(),
        entry,
        images,
        name,
        margin: args.margin,
        level: args.level,
        cannot,
        regularization,
        gain: args.gain,
        offset,
        mask,
        samples: args.spp.map(|n| n as f64),
        exported,
        seed: args.seed,
    })
}

/// The positions of the classes that a name stands for.
fn positions(name: &str, entry: &Entry) -> Result<Vec<usize>, Error> {
    let classes = entry.kind.classes();
    let class: Option<PathClass> = name.parse().ok();
    let is_meant = |k: &usize| class.is_some_and(|c| is_one_of(&classes[*k], &c));
    let found: Vec<usize> = (0..classes.len()).filter(is_meant).collect();
    if found.is_empty() {
        let known: Vec<_> = classes.iter().map(ToString::to_string).collect();
        return Err(Error::UnknownName {
            what: "path class of this scene",
            found: name.to_owned(),
            allowed: known.join(", "),
        });
    }
    Ok(found)
}
