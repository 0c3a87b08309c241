//! A chain that mixes at a rate independent of α: with the probability ε it is drawn afresh at the current bandwidth.
//!
//! P(x, ·) ≥ ε π(·), so the second eigenvalue and Dobrushin's coefficient are at most 1 - ε. A step from αₙ₋₁ to αₙ throws
//! the share 1 - (αₙ/αₙ₋₁)^d of the lobe out, then the kernel acts:
//!
//! ```text
//! uₙ = (1 - ε) (αₙ/αₙ₋₁)^d uₙ₋₁ + ε m
//! ```
//!
//! Any decay that is slower than every geometric one is followed. A geometric one loses a share for ever.

use super::matrix::Transition;

/// The kernel at any fixed bandwidth, on regular paths (state 0) and the lobe (state 1).
pub fn transition(mass: f64, refresh: f64) -> Transition<2> {
    Transition::identity().mixed(&Transition::refresh(&[1.0 - mass, mass]), refresh)
}

/// What shrinking does: the states in the outer part of the cone, a share 1 - `kept`, become regular.
pub fn shrink(kept: f64) -> Transition<2> {
    Transition {
        rows: Box::new([[1.0, 0.0], [1.0 - kept, kept]]),
    }
}

/// Occupancy after the last step and its average over all steps; `kept(n)` is (αₙ/αₙ₋₁)^d, and the start stationary.
pub fn occupancy(mass: f64, refresh: f64, kept: impl Fn(u64) -> f64, steps: u64) -> (f64, f64) {
    let kernel = transition(mass, refresh);
    let (mut distribution, mut sum) = ([1.0 - mass, mass], 0.0);
    for n in 1..=steps {
        distribution = kernel.step(&shrink(kept(n)).step(&distribution));
        sum += distribution[1];
    }
    (distribution[1], sum / steps as f64)
}

/// The share of the lobe that is lost for ever under αₙ = gⁿ: (1 - ε)(1 - g^d)/(1 - (1 - ε) g^d), 0 < ε ≤ 1.
pub fn lost_share(refresh: f64, ratio: f64, dimension: f64) -> f64 {
    let kept = libm::pow(ratio, dimension);
    (1.0 - refresh) * (1.0 - kept) / (1.0 - (1.0 - refresh) * kept)
}

/// γ* = γ^(1/d): a geometric schedule at this rate loses about half of the lobe, 1 - 1/(2 - ε).
pub fn critical_ratio(chain_rate: f64, dimension: f64) -> f64 {
    libm::pow(chain_rate, 1.0 / dimension)
}
