//! Rates: how bias and variance of an integrator depend on its bandwidth and on the number of its iterations.
//!
//! A rate is measured on replicates and compared with what the *exact* expectations and second moments give at the same
//! bandwidths and the same finite n, never with an asymptotic power: at finite n the two differ by more than the
//! intervals. Bias and variance are fitted separately, since schedules that are wrong in opposite ways share a rate of the
//! mean squared error (exponents 1/12 and 1/3: `theory/consistency.md`).

pub mod allocation;
pub mod bias;
mod bias_report;
pub mod classes;
pub mod converge;
mod converge_report;
pub mod counts;
mod events;
pub mod expected;
mod law;
mod options;
pub mod outcome;
mod plot;
pub mod power_law;
pub mod region;
mod report;
pub mod runs;
pub mod variance;

pub use bias_report::{bias_json, bias_table};
pub use converge_report::{converge_json, converge_table};
pub use plot::{bias_svg, converge_svg};
pub use report::Heading;
