//! `nephroid render`: the exact image.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::{self, Kernel, Technique, UnknownName};
use nephroid_analytic::scene::InvalidParameter;

use crate::error::Error;
use crate::exr_output::{metadata, write_exr};
use crate::png_output::{DISPLAY_TRANSFORM, write_png};
use crate::truth::{self, DEFAULT_TOLERANCE};
use crate::{entry, exit, expectation};

/// Compute the exact image of a scene: the mean radiance over every pixel, one layer per path class.
///
/// The EXR file has a channel `<CLASS>.Y` per path class (f32, W/(m² sr)) and `error.Y`, a bound on the error of the sum
/// of the layers as stored, f32 rounding included. Attributes: `nephroid:version`, `nephroid:scene`,
/// `nephroid:parameters`. The same bytes every time.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The EXR file to write.
    #[arg(short, long, value_name = "FILE.exr")]
    output: PathBuf,
    /// Columns × rows, 1 to 8192 each; the vertical field of view stays. Default: as the scene says.
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(u32, u32)>,
    /// Relative tolerance of a pixel's value, 1e-12 to 0.1.
    #[arg(long, value_name = "T", default_value_t = DEFAULT_TOLERANCE, allow_negative_numbers = true, value_parser = tolerance)]
    tolerance: f64,
    /// The image that a regularized estimator converges to at its bandwidth instead: camera, light, symmetric or merge. Errors are
    /// estimates, of about a percent of a pixel.
    #[arg(long, value_name = "T", requires = "bandwidth")]
    technique: Option<String>,
    /// Its bandwidth: an angle [rad], or a radius [m] for merge.
    #[arg(
        long,
        value_name = "A",
        requires = "technique",
        allow_negative_numbers = true
    )]
    bandwidth: Option<f64>,
    /// Its kernel: cone, epanechnikov or vmf on the angle, disc, epanechnikov, biweight or cone on the radius.
    #[arg(long, value_name = "K", requires = "technique")]
    kernel: Option<String>,
    #[arg(long, help = format!(
        "Also write a PNG of the sum beside it. Fixed exposure: {DISPLAY_TRANSFORM}"
    ))]
    png: bool,
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |s: &str| s.parse().ok().filter(|n| (1..=8192).contains(n));
    text.split_once(['x', 'X', '×'])
        .and_then(|(w, h)| Some((side(w)?, side(h)?)))
        .ok_or_else(|| "expected WxH with whole numbers from 1 to 8192, such as 256x256".to_owned())
}

fn tolerance(text: &str) -> Result<f64, String> {
    let allowed = |t: &f64| (1e-12..=0.1).contains(t);
    text.parse()
        .ok()
        .filter(allowed)
        .ok_or_else(|| "expected a number from 1e-12 to 0.1".to_owned())
}

/// The estimator of `--technique`, `--kernel` and `--bandwidth`.
fn estimator(args: &Args) -> Result<Option<(Technique, Kernel, f64)>, Error> {
    let (Some(name), Some(bandwidth)) = (&args.technique, args.bandwidth) else {
        return Ok(None);
    };
    let unknown = |what, e: UnknownName| Error::UnknownName {
        what,
        found: e.found,
        allowed: e.allowed,
    };
    let option = |e: InvalidParameter| Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{}", e.key.replace('_', "-")),
        found: e.found,
        allowed: e.allowed,
    };
    let technique: Technique = name.parse().map_err(|e| unknown("technique", e))?;
    if technique == Technique::Linked {
        return Err(option(InvalidParameter {
            key: "technique".to_owned(),
            found: name.clone(),
            allowed: "camera, light, symmetric or merge: linked paths have no image here"
                .to_owned(),
        }));
    }
    let kernel = match &args.kernel {
        Some(name) => name.parse().map_err(|e| unknown("kernel", e))?,
        None => technique.default_kernel(),
    };
    bandwidth::check(technique, kernel, &[bandwidth]).map_err(option)?;
    Ok(Some((technique, kernel, bandwidth)))
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let mut entry = entry::load(&args.scene)?;
    if let Some((width, height)) = args.size {
        entry.camera.width = width;
        entry.camera.height = height;
        // Another shape of the frame may show what the scene's own does not.
        entry.validate().map_err(|e| Error::Parameter {
            file: format!("{} --size {width}x{height}", args.scene),
            key: e.key,
            found: e.found,
            allowed: e.allowed,
        })?;
    }
    let png = args.output.with_extension("png");
    if args.png && png == args.output {
        return Err(Error::Parameter {
            file: "--output".to_owned(),
            key: "output".to_owned(),
            found: args.output.display().to_string(),
            allowed: "a name that does not end in .png: the PNG goes beside it".to_owned(),
        });
    }
    let mut attributes = metadata(&entry);
    let image = match estimator(args)? {
        None => truth::image(&entry, args.tolerance),
        Some((technique, kernel, bandwidth)) => {
            attributes.push(("nephroid:technique".to_owned(), technique.to_string()));
            attributes.push(("nephroid:kernel".to_owned(), kernel.to_string()));
            attributes.push(("nephroid:bandwidth".to_owned(), bandwidth.to_string()));
            expectation::image(&entry, technique, kernel, bandwidth, args.tolerance).map_err(
                |e| Error::Parameter {
                    file: args.scene.clone(),
                    key: e.key,
                    found: e.found,
                    allowed: e.allowed,
                },
            )?
        }
    };
    let channels = image.channels();
    let layers: Vec<_> = channels
        .iter()
        .map(|(name, values)| (name.clone(), values.as_slice()))
        .collect();
    write_exr(
        &args.output,
        image.width,
        image.height,
        &layers,
        &attributes,
    )?;
    if args.png {
        write_png(&png, image.width, image.height, &image.total().0)?;
    }
    super::print(&format!(
        "{}: {}×{} pixels, mean radiance in W/(m² sr)",
        args.output.display(),
        image.width,
        image.height
    ));
    for (class, mean) in image.classes.iter().zip(image.class_means()) {
        super::print(&format!(
            "  {:<6} {:.9e} ± {:.1e}",
            class.to_string(),
            mean.value,
            mean.error
        ));
    }
    Ok(exit::PASS)
}
