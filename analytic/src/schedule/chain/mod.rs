//! Markov chains under a shrinking bandwidth, propagated exactly: no step is sampled.
//!
//! The toy target has the mass 1 - m on regular paths and m in a specular lobe, uniform over a cone of the relative
//! volume α^d. Shrinking the cone throws the states in its outer part to the regular ones. What the published condition
//! γⁿ ≪ αₙ ≪ 1 [Kaplanyan & Dachsbacher 2013, section 5] needs is that γ does not depend on α.

pub mod blind;
pub(super) mod classify;
pub mod matrix;
pub mod refresh;
pub mod shells;
