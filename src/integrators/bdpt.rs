//! `bdpt` and `bdpt-reg`: bidirectional path tracing, without and with selective regularization.
//!
//! All techniques (s, t) of every class, combined by multiple importance sampling [Veach & Guibas 1995]. `bdpt-reg`
//! mollifies what none of them can build, and that alone [Kaplanyan & Dachsbacher 2013]: whether a path is irregular is a
//! property of the full path, known only after both subpaths.

use nephroid_analytic::scene::Entry;

use crate::geometry::tracer::{Traceable, traceable};

use super::bidirectional::Bidirectional;
use super::bidirectional_walks::BidirectionalWalks;
use super::defect::Defect;
use super::kernel::Kernel;
use super::mis::Heuristic;
use super::plan::{bidirectional_plan, plan_of};
use super::sampleable::Family;
use super::settings::Settings;
use super::{Integrator, Plan, Prepared, regularizes};

/// Bidirectional path tracing.
pub struct Bdpt {
    regularize: bool,
    settings: Settings,
}

impl Bdpt {
    /// Without regularization: what no technique can build is not sampled. The kernel is ignored.
    pub fn plain(settings: Settings) -> Self {
        Bdpt {
            regularize: false,
            settings,
        }
    }

    /// With selective regularization, by a cone unless the settings name another kernel on the angle.
    pub fn regularized(settings: Settings) -> Self {
        Bdpt {
            regularize: true,
            settings,
        }
    }
}

impl Integrator for Bdpt {
    fn name(&self) -> &'static str {
        if self.regularize { "bdpt-reg" } else { "bdpt" }
    }

    fn title(&self) -> &'static str {
        if self.regularize {
            "bidirectional path tracing, regularized only where no technique can build the path"
        } else {
            "bidirectional path tracing"
        }
    }

    fn plan(&self, entry: &Entry) -> Plan {
        let kernel = self.settings.kernel.unwrap_or(Kernel::Cone);
        let kernel = self.regularize.then_some(kernel);
        plan_of(entry, |class| {
            bidirectional_plan(class, kernel, &self.settings)
        })
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        if self.regularize {
            regularizes(entry)
        } else {
            Ok(())
        }
    }

    fn options(&self) -> String {
        match self.settings.heuristic {
            Heuristic::Balance => String::new(),
            heuristic => format!(" --heuristic {heuristic}"),
        }
    }

    fn family(&self) -> Family {
        Family::Bidirectional
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        let overrides = Defect::new(self.settings.fault).overrides();
        match traceable(entry, overrides) {
            Traceable::Floor(tracer) => Box::new(Bidirectional::new(
                tracer,
                entry.kind.classes(),
                self.regularize,
                self.settings,
            )),
            Traceable::Furnace(furnace) => {
                Box::new(BidirectionalWalks::new(furnace, self.settings))
            }
        }
    }
}
