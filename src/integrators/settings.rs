//! How an integrator is built: its kernel, how it combines techniques, and the defect it is given on purpose.

use super::fault::Fault;
use super::kernel::Kernel;
use super::mis::{Heuristic, Side};

/// How an integrator is built.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// The mollifier of methods that regularize; `None` is the method's default. Ignored by the others.
    pub kernel: Option<Kernel>,
    /// How techniques that build the same paths share them.
    pub heuristic: Heuristic,
    /// The only side on which bidirectional methods connect a mollified vertex; `None` for both.
    pub side: Option<Side>,
    /// A defect, to test what judges the integrator.
    pub fault: Option<Fault>,
}
