//! How an integrator is built: its kernel, how it combines techniques, and the defect it is given on purpose.

use core::str::FromStr;

use super::fault::Fault;
use super::kernel::Kernel;
use super::mis::{Heuristic, Side};
use super::pixel_statistics::Statistics;
use super::vcm::Merging;

/// How an integrator is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The mollifier of methods that regularize; `None` is the method's default. Ignored by the others.
    pub kernel: Option<Kernel>,
    /// Which specular vertices of a chain `pt-reg` mollifies. Ignored by the others.
    pub mollified: Mollified,
    /// How techniques that build the same paths share them.
    pub heuristic: Heuristic,
    /// The only side on which bidirectional methods connect a mollified vertex; `None` for both.
    pub side: Option<Side>,
    /// How the radii of progressive photon mapping shrink.
    pub statistics: Statistics,
    /// What vertex connection and merging merges.
    pub merging: Merging,
    /// A defect, to test what judges the integrator.
    pub fault: Option<Fault>,
    /// Whether photons are limited to those that can land within the radius of what the camera sees: for studies of small
    /// parts of a scene. Methods without photons and scenes of chains ignore it.
    pub aims_photons: bool,
}

/// Which specular vertices of a chain are mollified.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mollified {
    /// The one next to the light; all others are exact.
    #[default]
    NextToLight,
    /// Each of them, independently: d = 2k for k vertices. Chains of two or more only among plane mirrors.
    Every,
}

impl FromStr for Mollified {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "light" => Ok(Mollified::NextToLight),
            "all" => Ok(Mollified::Every),
            _ => Err("expected light or all".to_owned()),
        }
    }
}
