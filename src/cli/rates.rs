//! What `bias` and `converge` read and answer alike.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::Technique;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter};

use super::ranges::{in_range, level};
use crate::error::Error;
use crate::exit;
use crate::integrators::{Heuristic, Integrator, Kernel, Settings, by_name};
use crate::output::write_text;
use crate::rates::Heading;
use crate::rates::bias::LEVEL;
use crate::rates::classes::Asked;
use crate::rates::outcome::State;

/// The options of both.
#[derive(clap::Args)]
pub struct Options {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The short name of an integrator.
    #[arg(long, value_name = "NAME")]
    integrator: String,
    /// Measure these pixels, x0 <= column < x1 and y0 <= row < y1. Default: a close-up of an interior part; the whole
    /// image for a class without bias.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = corners)]
    region: Option<Corners>,
    /// Only this path class, such as LSDE.
    #[arg(long, value_name = "CLASS")]
    class: Option<PathClass>,
    /// Seed: the same seed gives the same numbers, on any number of threads.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// Mollifier: cone, epanechnikov or vmf for an angle, disc, epanechnikov, biweight or cone
    /// for a radius. Default: cone, disc.
    #[arg(long, value_name = "KERNEL")]
    kernel: Option<Kernel>,
    /// How bidirectional methods weight techniques that build the same paths: balance or power.
    #[arg(long, value_name = "H", default_value_t)]
    heuristic: Heuristic,
    /// The technique whose expectation is the prediction. Default: the one that the integrator's plan names.
    #[arg(long, value_name = "T")]
    technique: Option<Technique>,
    /// Probability that a correct integrator is called different, 1e-15 to 0.1.
    #[arg(long, value_name = "P", default_value_t = LEVEL, value_parser = level, allow_negative_numbers = true)]
    level: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Also write a plot.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
}

impl Options {
    /// The scene and the integrator, which fit each other. Photons that are aimed tell a small bias from fewer paths, but hide how
    /// the variance of the method grows as its bandwidth falls.
    pub fn load(&self, aims_photons: bool) -> Result<(Entry, Box<dyn Integrator>), Error> {
        let entry = crate::entry::load(&self.scene)?;
        let settings = Settings {
            kernel: self.kernel,
            aims_photons,
            heuristic: self.heuristic,
            ..Settings::default()
        };
        let integrator = by_name(&self.integrator, &settings)?;
        supported(&entry, integrator.as_ref())?;
        class_exists(&entry, self.class)?;
        Ok((entry, integrator))
    }

    /// What is asked of a study.
    pub fn asked<'a>(
        &self,
        entry: &'a Entry,
        integrator: &'a dyn Integrator,
        replicates: u32,
    ) -> Asked<'a> {
        Asked {
            entry,
            integrator,
            kernel: self.kernel.and_then(|k| k.to_string().parse().ok()),
            technique: self.technique,
            class: self.class,
            region: self.region.map(|c| c.0),
            replicates,
            seed: self.seed,
            level: self.level,
        }
    }

    /// What a report is about.
    pub fn heading<'a>(&self, asked: &Asked<'a>, schedule: Option<&'a str>) -> Heading<'a> {
        Heading {
            scene: &asked.entry.name,
            integrator: asked.integrator.name(),
            schedule,
            seed: self.seed,
            level: self.level,
        }
    }

    /// Writes the plot and prints the answer, if they are asked for; the exit code.
    pub fn answer(
        &self,
        plot: impl FnOnce() -> String,
        json: impl FnOnce() -> serde_json::Value,
        table: impl FnOnce() -> String,
        states: impl IntoIterator<Item = State>,
    ) -> Result<u8, Error> {
        if let Some(path) = &self.plot {
            write_text(path, &plot())?;
        }
        super::print(&if self.json {
            json().to_string()
        } else {
            table()
        });
        let codes = states.into_iter().map(State::exit_code);
        Ok(codes.reduce(exit::combine).unwrap_or(exit::NOTHING_RAN))
    }
}

/// A list of bandwidths.
#[derive(Clone, Debug)]
pub struct Bandwidths(pub Vec<f64>);

/// Reads two to 32 different positive numbers.
pub fn bandwidths(text: &str) -> Result<Bandwidths, String> {
    let allowed = || "expected 2 to 32 different positive numbers, such as 0.3,0.1,0.03".to_owned();
    let values = text.split(',').map(|t| t.trim().parse().ok());
    let values: Vec<f64> = values.collect::<Option<_>>().ok_or_else(allowed)?;
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let fits = (2..=32).contains(&values.len())
        && sorted.len() == values.len()
        && values.iter().all(|v| *v > 0.0 && v.is_finite());
    if fits {
        Ok(Bandwidths(values))
    } else {
        Err(allowed())
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug)]
pub struct Corners(pub [u32; 4]);

/// Reads `x0,y0,x1,y1`.
fn corners(text: &str) -> Result<Corners, String> {
    let allowed = "expected four whole numbers x0,y0,x1,y1 with x0 < x1 and y0 < y1 (pixels)";
    let values: Option<Vec<u32>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
    match values.as_deref() {
        Some(&[x0, y0, x1, y1]) if x0 < x1 && y0 < y1 => Ok(Corners([x0, y0, x1, y1])),
        _ => Err(allowed.to_owned()),
    }
}

/// Half of the width of an interval of an exponent.
pub fn half_width(text: &str) -> Result<f64, String> {
    in_range(text, 1e-3, 10.0)
}

/// A number of replicates.
pub fn replicates(text: &str) -> Result<u32, String> {
    let range = 16..=65_536;
    let value = super::count(text).ok().and_then(|n| u32::try_from(n).ok());
    value
        .filter(|n| range.contains(n))
        .ok_or_else(|| "expected a whole number from 16 to 65536".to_owned())
}

/// An option out of range.
fn refused(option: &str, found: impl ToString, allowed: &str) -> Error {
    Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{option}"),
        found: found.to_string(),
        allowed: allowed.to_owned(),
    }
}

/// What the truth finds wrong, as an option; `bandwidths` is the one that bandwidths came from.
pub fn invalid(e: InvalidParameter, bandwidths: &str) -> Error {
    let option = if e.key == "bandwidth" {
        bandwidths.to_owned()
    } else {
        e.key
    };
    refused(&option, e.found, &e.allowed)
}

/// Refuses a scene that the integrator cannot be prepared for.
fn supported(entry: &Entry, integrator: &dyn Integrator) -> Result<(), Error> {
    integrator.supports(entry).map_err(|reason| {
        let allowed = format!("an integrator that supports {}: {reason}", entry.name);
        refused("integrator", integrator.name(), &allowed)
    })
}

/// Refuses a class that the scene does not have.
fn class_exists(entry: &Entry, class: Option<PathClass>) -> Result<(), Error> {
    let classes = entry.kind.classes();
    match class {
        Some(c) if !classes.contains(&c) => {
            let names: Vec<_> = classes.iter().map(PathClass::to_string).collect();
            Err(refused("class", c, &names.join(", ")))
        }
        _ => Ok(()),
    }
}
