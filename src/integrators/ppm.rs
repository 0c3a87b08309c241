//! `ppm`: progressive photon mapping, probabilistic [Knaus & Zwicker 2011]: independent iterations of photon mapping
//! whose radius shrinks by r²ᵢ₊₁ = r²ᵢ (i + a)/(i + 1), a = 2/3. See `photon_mapping.rs` for an iteration, which
//! is given its radius; the sequence is in [`Integrator::schedule`]. As an option it keeps statistics of each pixel
//! (`pixel_statistics.rs`).

use nephroid_analytic::scene::Entry;

use super::photon_mapping::{adaptive_plan, kernel_of, merging_plan, prepare};
use super::pixel_statistics::{PixelProgressive, Statistics};
use super::schedule::{DEFAULT_REDUCTION, Schedule};
use super::settings::Settings;
use super::{Integrator, Plan, Prepared, Unsupported, regularizes};

/// Progressive photon mapping.
pub struct Ppm {
    settings: Settings,
}

impl Ppm {
    /// The method, with a disc unless the settings name another kernel on the distance.
    pub fn new(settings: Settings) -> Self {
        Ppm { settings }
    }
}

impl Integrator for Ppm {
    fn name(&self) -> &'static str {
        "ppm"
    }

    fn title(&self) -> &'static str {
        "progressive photon mapping: the radius shrinks from iteration to iteration"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        match self.settings.statistics {
            Statistics::Sequence => merging_plan(entry, kernel_of(&self.settings)),
            Statistics::Pixel => adaptive_plan(
                entry,
                "merged within the radius of each pixel, which shrinks with the photons that it has met: consistent, its \
                 expectation is not known",
            ),
        }
    }

    fn schedule(&self, bandwidth: f64) -> Schedule {
        Schedule::Progressive {
            first: bandwidth,
            reduction: DEFAULT_REDUCTION,
        }
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        regularizes(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        match self.settings.statistics {
            Statistics::Sequence => prepare(entry, &self.settings),
            Statistics::Pixel => match PixelProgressive::new(entry, &self.settings) {
                Some(prepared) => Box::new(prepared),
                None => Box::new(Unsupported),
            },
        }
    }
}
