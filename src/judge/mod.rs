//! Judgement: from replicates and a truth to a verdict with known error probabilities.
//!
//! Knows neither integrators nor closed forms: only numbers from both. Inference is at replicate level, so whatever
//! correlates the pixels of one replicate (a photon map, a Markov chain) is harmless.
//!
//! From the bottom up: [`crate::regions`] and [`evidence`] reduce films to samples; [`tails`] says how likely a mean is;
//! [`hypotheses`] asks the two questions; [`spending`] lets them be asked again as the sample grows, [`family`] lets many
//! be asked; [`verdict`] puts the answers together; [`power`] says what could have been seen. [`betting`] and [`heavy`]
//! need less than finite variance.

pub mod betting;
pub mod distributions;
pub mod evidence;
pub mod family;
pub mod finding;
pub mod heavy;
pub mod hypotheses;
pub mod power;
pub mod spending;
pub mod tails;
pub mod verdict;
