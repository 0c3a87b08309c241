//! What the museum shows.

mod camera;
mod combinations;
mod kernels;
mod light;
mod manifold;
mod numbers;

use crate::entry;
use crate::error::Error;
use crate::integrators::Fault;
use nephroid_analytic::scene::Entry;

/// What should notice a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// The verdict of `nephroid verify`, at effort `standard`.
    Verify,
    /// Replicates with different seeds are different.
    Repeats,
}

impl Check {
    /// The word, as in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            Check::Verify => "verify",
            Check::Repeats => "repeats",
        }
    }
}

/// Where a fault must be noticed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stand {
    /// The integrator that has it.
    pub integrator: &'static str,
    /// A name of the catalogue, or of [`SCENES`].
    pub scene: &'static str,
    /// Angle [rad] or radius [m]; of no effect where nothing is regularized.
    pub bandwidth: f64,
    /// What notices it.
    pub check: Check,
}

impl Stand {
    /// `pt on floor`.
    pub fn title(&self) -> String {
        format!("{} on {}", self.integrator, self.scene)
    }
}

/// A deliberate fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exhibit {
    /// A short name, unique.
    pub id: &'static str,
    /// The defect.
    pub fault: Fault,
    /// One sentence on what is wrong.
    pub description: &'static str,
    /// The public thread or file that it is modelled on.
    pub source: &'static str,
    /// Where it is injected.
    pub injection: &'static str,
    /// Where it must be noticed.
    pub stands: &'static [Stand],
    /// Why no finite test of means can notice it, for those that none can.
    pub unkillable: Option<&'static str>,
}

impl Exhibit {
    const fn new(
        id: &'static str,
        fault: Fault,
        description: &'static str,
        source: &'static str,
        injection: &'static str,
        stands: &'static [Stand],
    ) -> Self {
        Exhibit {
            id,
            fault,
            description,
            source,
            injection,
            stands,
            unkillable: None,
        }
    }

    const fn unkillable(self, reason: &'static str) -> Self {
        Exhibit {
            unkillable: Some(reason),
            ..self
        }
    }
}

/// At the usual bandwidth.
const fn on(integrator: &'static str, scene: &'static str) -> Stand {
    at(integrator, scene, crate::verify::effort::BANDWIDTH)
}

/// At a bandwidth of its own.
const fn at(integrator: &'static str, scene: &'static str, bandwidth: f64) -> Stand {
    Stand {
        integrator,
        scene,
        bandwidth,
        check: Check::Verify,
    }
}

/// Noticed by replicates that repeat.
const fn repeats(integrator: &'static str, scene: &'static str) -> Stand {
    Stand {
        check: Check::Repeats,
        ..on(integrator, scene)
    }
}

/// All exhibits.
pub fn all() -> impl Iterator<Item = &'static Exhibit> {
    light::EXHIBITS
        .iter()
        .chain(camera::EXHIBITS)
        .chain(kernels::EXHIBITS)
        .chain(numbers::EXHIBITS)
        .chain(manifold::EXHIBITS)
        .chain(combinations::EXHIBITS)
}

/// Scenes of the museum alone: name and TOML.
pub const SCENES: [(&str, &str); 1] = [("museum-wall", include_str!("../scenes/museum-wall.toml"))];

/// The scene of a stand.
///
/// # Errors
/// What [`entry::load`] says of a name that is neither the museum's nor the catalogue's.
pub fn scene(name: &str) -> Result<Entry, Error> {
    match SCENES.iter().find(|(own, _)| *own == name) {
        Some((_, text)) => entry::from_toml(&format!("{name}.toml"), text),
        None => entry::load(name),
    }
}
