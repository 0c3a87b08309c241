//! Judgement: from replicates and a truth to a verdict with known error probabilities.
//!
//! Knows neither integrators nor closed forms: only numbers from both. Inference is at replicate level, so whatever
//! correlates the pixels of one replicate (a photon map, a Markov chain) is harmless.

pub mod distributions;
pub mod evidence;
pub mod hypotheses;
pub mod power;
pub mod verdict;
