//! `pm`: photon mapping at a fixed radius. See `photon_mapping.rs` for an iteration.

use nephroid_analytic::scene::Entry;

use super::photon_mapping::{kernel_of, merging_plan, prepare};
use super::settings::Settings;
use super::{Integrator, Plan, Prepared, regularizes};

/// Photon mapping.
pub struct Pm {
    settings: Settings,
}

impl Pm {
    /// The method, with a disc unless the settings name another kernel on the distance.
    pub fn new(settings: Settings) -> Self {
        Pm { settings }
    }
}

impl Integrator for Pm {
    fn name(&self) -> &'static str {
        "pm"
    }

    fn title(&self) -> &'static str {
        "photon mapping at a fixed radius; direct light by next event estimation"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        merging_plan(entry, kernel_of(&self.settings))
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        regularizes(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        prepare(entry, &self.settings)
    }
}
