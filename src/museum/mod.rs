//! The bug museum: deliberate faults modelled on real ones, and what notices them.
//!
//! A judge that is never seen to find anything proves nothing. Each [`Exhibit`] is a fault of
//! [`crate::integrators::Fault`], the public thread or file that it is modelled on, and the stands at which it must be
//! noticed: an integrator, a scene, a bandwidth and a check. [`trial`] runs one stand, [`matrix`] all of them after the same
//! stands without a fault; [`baselines`] puts the acceptance rules of other renderers' tests beside them.

pub mod baselines;
pub mod exhibits;
pub mod matrix;
pub mod report;
pub mod trial;

pub use exhibits::{Check, Exhibit, Stand, all};
