//! Schedules of bandwidths α₁, α₂, …: a language for them, which are consistent, and at which rate.
//!
//! A schedule is an expression in the sample's number n = 1, 2, …, such as `0.2*n^(-1/6)`. The model: sample k has the
//! expectation L + c αₖᵖ and the variance C αₖ^-d, with the bias order p and the dimension d (2 for one mollified
//! interaction in space, 2k for k of them). Then the plain mean of n samples has
//!
//! ```text
//! bias = c (1/n) Σ αₖᵖ      variance = C (1/n²) Σ αₖ^-d
//! ```
//!
//! and is consistent in mean square exactly if both vanish [Kaplanyan & Dachsbacher 2013; derived here for any positive
//! sequence]. Which they do is decided from the leading behaviour c·exp(Σ q nˢ)·nᵃ·(ln n)ᵇ of the expression,
//! which is exact; the sums at finite n come from the expression itself.

pub mod asymptotics;
pub mod chain;
pub mod classify;
mod combine;
mod evaluate;
pub mod expression;
pub mod growth;
mod number;
mod parse;
pub mod rate;
pub mod sums;
mod token;

pub use classify::{Classification, FiniteRow, Report, Request, Weights, classify};
pub use expression::{Expression, ParseError};
pub use number::Number;
