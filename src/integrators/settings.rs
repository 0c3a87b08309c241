//! How an integrator is built: its kernel, and the defect it is given on purpose.

use super::fault::Fault;
use super::kernel::Kernel;

/// How an integrator is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The mollifier of methods that regularize; `None` is the method's default. Ignored by the others.
    pub kernel: Option<Kernel>,
    /// A defect, to test what judges the integrator.
    pub fault: Option<Fault>,
    /// Whether photons are limited to those that can land within the radius of what the camera sees: for studies of small
    /// parts of a scene. Methods without photons and scenes of chains ignore it.
    pub aims_photons: bool,
}
