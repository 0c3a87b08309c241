//! Reference integrators: what is judged.
//!
//! They know the scene's geometry and nothing of the closed forms. An integrator is first asked for its [`Plan`]: which
//! path classes it samples, with which technique, and which are irregular for it and thus regularized. Then it is
//! prepared for the scene once, and an iteration adds the contributions of N paths at one bandwidth to a film.

pub mod accumulate;
mod adaptive_radius;
mod aim_of_photons;
pub mod appm;
mod bdpt;
mod bidirectional;
mod bidirectional_walks;
mod camera_paths;
mod chains;
mod connection;
mod defect;
pub mod details;
mod deviation;
mod eye_block;
mod fault;
#[cfg(test)]
mod full_paths;
mod furnace;
pub mod kernel;
pub mod learning;
mod lt;
mod manifold_defect;
mod manifold_walk;
mod merged_chains;
mod mis;
mod mollified_vertex;
mod photon_grid;
mod photon_mapping;
mod photon_maps;
pub mod pixel_statistics;
mod plan;
mod pm;
mod ppm;
pub mod probes;
mod pt;
mod pt_reg;
mod regularized_chains;
pub mod sampleable;
pub mod schedule;
pub mod selection;
mod settings;
mod shared_connections;
mod sms;
mod stage;
pub mod vcm;

pub use appm::Appm;
pub use bdpt::Bdpt;
pub use fault::Fault;
pub use kernel::Kernel;
pub use learning::{Learner, Run};
pub use lt::Lt;
pub use mis::{Heuristic, Side};
pub use pixel_statistics::Statistics;
pub use pm::Pm;
pub use ppm::Ppm;
pub use pt::Pt;
pub use pt_reg::PtReg;
pub use schedule::Schedule;
pub use settings::{Mollified, Settings};
pub use sms::Sms;
pub use stage::Sight;
pub use vcm::{Merging, Vcm};

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::film::Film;

/// What an integrator does about one path class.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassPlan {
    /// The class.
    pub class: PathClass,
    /// How it is sampled.
    pub treatment: Treatment,
    /// Why, in one sentence for a person.
    pub reason: String,
}

/// How an integrator treats a path class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Treatment {
    /// Sampled without bias: judged against the closed form.
    Exact(Technique),
    /// Every edge touches a singularity: sampled with a mollified delta at the bandwidth, judged against the exact
    /// expectation at that bandwidth. So is a class that [`Technique::ConnectionAndMerging`] merges without need.
    Regularized(Technique),
    /// The method cannot build such a path.
    NotSampled,
}

/// The sampling technique that builds a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Next event estimation at the diffuse vertex.
    NextEvent,
    /// Light path connected to the pinhole.
    LightTracing,
    /// All techniques that can build the path, combined.
    Bidirectional,
    /// Regularized connection from the camera side.
    Camera,
    /// The same with every specular vertex of a chain mollified.
    CameraEveryVertex,
    /// Regularized connections from both sides, of one symmetric value, combined.
    Symmetric,
    /// Merging with photons within a radius.
    Merge,
    /// Newton's method on the specular constraint, from random points of the surface.
    ManifoldSampling,
    /// Merging within a radius that depends on the photons of earlier iterations: its expectation is known only given the radii.
    AdaptiveMerge,
    /// Next event estimation and light tracing, those of them that can build the path, combined.
    Connection,
    /// The same, and merging.
    ConnectionAndMerging,
}

impl Technique {
    /// Whether it regularizes, with a kernel on an angle.
    pub const fn is_angular(self) -> bool {
        matches!(self, Technique::Camera | Technique::Symmetric)
    }
}

/// Per class, in the order of the film's layers.
pub type Plan = Vec<ClassPlan>;

/// A bandwidth of zero or below, for methods that need none.
pub const NO_BANDWIDTH: f64 = 0.0;

/// A light transport method.
pub trait Integrator: Send + Sync {
    /// The short name: `pt-reg`.
    fn name(&self) -> &'static str;

    /// One line on what the method is.
    fn title(&self) -> &'static str;

    /// What the method does about each class of the scene.
    fn plan(&self, entry: &Entry) -> Plan;

    /// The options of the command line, beside the kernel, that differ from their defaults: ` --heuristic power`, or nothing.
    fn options(&self) -> String {
        String::new()
    }

    /// Which of all techniques (s, t) the method has, merging apart. Next event estimation alone unless the method says
    /// otherwise.
    fn family(&self) -> sampleable::Family {
        sampleable::Family::NextEvent
    }

    /// The bandwidths that the method uses, iteration by iteration, when it is given one: that one unless it says
    /// otherwise. [`Prepared::iterate`] is given the bandwidth of its iteration.
    fn schedule(&self, bandwidth: f64) -> Schedule {
        Schedule::Fixed(bandwidth)
    }

    /// Whether the method can be prepared for the scene.
    ///
    /// # Errors
    /// Why not, for a person.
    fn supports(&self, _entry: &Entry) -> Result<(), String> {
        Ok(())
    }

    /// Whether the variance of a pixel that a fold crosses is infinite: true for methods that reach the light of a caustic
    /// point by point without bias. Such pixels are left out of verdicts.
    fn has_infinite_variance_at_folds(&self) -> bool {
        false
    }

    /// Whether a path takes many times as long on the scene as one of another method.
    fn is_dear(&self, _entry: &Entry) -> bool {
        false
    }

    /// Compiles a validated scene that the method supports into what it must do on it and no more.
    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared>;
}

/// A method made ready for a scene.
pub trait Prepared: Send + Sync {
    /// Adds the contributions of `paths` paths to the film. The same (seed, iteration, paths, bandwidth) gives the same
    /// bits. `bandwidth` is an angle [rad] or a radius [m], ignored by methods that regularize nothing.
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film);

    /// The part of the light's emission that photons are drawn from at a bandwidth, by flux: what the second moment of a
    /// photon's contribution is multiplied by. 1 unless photons are aimed ([`Settings::aims_photons`]).
    fn share_of_emission(&self, _bandwidth: f64) -> f64 {
        1.0
    }

    /// A run whose iterations learn from those before them; `None` for methods of which each iteration stands alone.
    /// See [`Run`].
    fn learner(&self) -> Option<Box<dyn Learner + '_>> {
        None
    }
}

/// Whether the regularizing methods know the kind of the scene: those with a floor.
fn regularizes(entry: &Entry) -> Result<(), String> {
    if entry.kind.floor().is_some() {
        return Ok(());
    }
    let kind = entry.kind.name();
    Err(format!(
        "nothing to regularize in the kind {kind}, which has no floor and no specular surface"
    ))
}

/// A method on a scene that it does not support: it samples nothing.
struct Unsupported;

impl Prepared for Unsupported {
    fn iterate(&self, _: u64, _: u32, paths: u64, _: f64, film: &mut Film) {
        film.paths += paths;
    }
}

/// Every method, with default settings.
pub fn all() -> Vec<Box<dyn Integrator>> {
    NAMES
        .iter()
        .filter_map(|name| by_name(name, &Settings::default()).ok())
        .collect()
}

/// The names of the methods, in the order in which they are listed.
pub const NAMES: [&str; 10] = [
    "pt", "pt-reg", "lt", "pm", "ppm", "appm", "vcm", "bdpt", "bdpt-reg", "sms",
];

/// The names of kernels on a distance, for messages.
const PLANAR: &str = "disc, epanechnikov, biweight, cone";

/// The method of a name.
///
/// # Errors
/// [`Error::UnknownName`] if there is none, or if the method does not take the kernel.
pub fn by_name(name: &str, settings: &Settings) -> Result<Box<dyn Integrator>, Error> {
    let settings = *settings;
    let takes = |allowed: fn(Kernel) -> bool, names: &str| match settings.kernel {
        Some(kernel) if !allowed(kernel) => Err(Error::UnknownName {
            what: "kernel of this integrator",
            found: kernel.to_string(),
            allowed: names.to_owned(),
        }),
        _ => Ok(()),
    };
    Ok(match name {
        "pt" => Box::new(Pt::new(settings)),
        "lt" => Box::new(Lt::new(settings)),
        "sms" => Box::new(Sms::new(settings)),
        "pt-reg" => {
            takes(Kernel::is_angular, "cone, epanechnikov, vmf")?;
            Box::new(PtReg::new(settings))
        }
        "bdpt" => Box::new(Bdpt::plain(settings)),
        "bdpt-reg" => {
            takes(Kernel::is_angular, "cone, epanechnikov, vmf")?;
            Box::new(Bdpt::regularized(settings))
        }
        "pm" => {
            takes(Kernel::is_planar, PLANAR)?;
            Box::new(Pm::new(settings))
        }
        "ppm" => {
            takes(Kernel::is_planar, PLANAR)?;
            if settings.statistics == Statistics::Pixel {
                takes(|k| k == Kernel::Disc, "disc (with statistics of pixels)")?;
            }
            Box::new(Ppm::new(settings))
        }
        "appm" => {
            takes(Kernel::is_planar, PLANAR)?;
            Box::new(Appm::new(settings))
        }
        "vcm" => {
            takes(Kernel::is_planar, PLANAR)?;
            Box::new(Vcm::new(settings))
        }
        _ => {
            return Err(Error::UnknownName {
                what: "integrator",
                found: name.to_owned(),
                allowed: NAMES.join(", "),
            });
        }
    })
}
