//! The suite: integrators against truths, from the choice of what to run to the list of verdicts.

pub mod effort;
pub mod excluded;
pub mod expected;
pub mod gather;
pub mod metamorphic;
pub mod pictures;
pub mod replicates;
pub mod run;
pub mod sizing;
pub mod suite;
pub mod verdicts;
