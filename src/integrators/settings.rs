//! How an integrator is built: its kernel, and the defect it is given on purpose.

use super::fault::Fault;
use super::kernel::Kernel;
use super::pixel_statistics::Statistics;
use super::vcm::Merging;

/// How an integrator is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The mollifier of methods that regularize; `None` is the method's default. Ignored by the others.
    pub kernel: Option<Kernel>,
    /// How the radii of progressive photon mapping shrink.
    pub statistics: Statistics,
    /// What vertex connection and merging merges.
    pub merging: Merging,
    /// A defect, to test what judges the integrator.
    pub fault: Option<Fault>,
}
