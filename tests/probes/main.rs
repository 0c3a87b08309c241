//! Probes: against the closed form on every kind, against sums over the mirror that share no code with integrators or truth,
//! and what they promise about their random numbers.

mod bidirectional;
mod closed_forms;
mod contract;
mod films;
mod interfaces;
mod mirrors;
mod reversal;
mod sums;
