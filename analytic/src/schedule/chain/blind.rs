//! A chain that must find the lobe by chance: its spectral gap shrinks like α^d.
//!
//! Independent uniform proposals hit the lobe with the probability α^d and leave it with α^d (1 - m)/m: Metropolis–Hastings,
//! exact for α^d ≤ m. The gap α^d/m tends to 0 with α, so γⁿ ≪ αₙ holds for no γ, and the window λ < 1/d of independent
//! samples returns.

use super::matrix::Transition;

/// The transition between regular paths (state 0) and the lobe (state 1), for the lobe's mass 0 < m < 1 and 0 < α^d ≤ m.
pub fn transition(mass: f64, volume: f64) -> Transition<2> {
    let (enter, leave) = (volume, volume * (1.0 - mass) / mass);
    Transition {
        rows: Box::new([[1.0 - enter, enter], [leave, 1.0 - leave]]),
    }
}

/// Occupancy of the lobe after the last step and its average over all steps, from a start outside the lobe.
pub fn cold_start(mass: f64, volume: impl Fn(u64) -> f64, steps: u64) -> (f64, f64) {
    let (mut distribution, mut sum) = ([1.0, 0.0], 0.0);
    for k in 1..=steps {
        distribution = transition(mass, volume(k)).step(&distribution);
        sum += distribution[1];
    }
    (distribution[1], sum / steps as f64)
}

/// Variance of the time-averaged occupancy from a stationary start.
///
/// Step k links states k - 1 and k with the correlation 1 - g, g = min(1, α^d/m); shrinking throws nothing out. With
/// Cⱼ = Σ_{i<j} Π (1 - g), the variance is m (1 - m) (1/n²) Σ (1 + 2 Cⱼ).
pub fn variance(mass: f64, volume: impl Fn(u64) -> f64, steps: u64) -> f64 {
    let (mut linked, mut sum) = (0.0, 0.0);
    for k in 1..=steps {
        let gap = f64::min(1.0, volume(k) / mass);
        linked = if k == 1 {
            0.0
        } else {
            (1.0 - gap) * (1.0 + linked)
        };
        sum += 1.0 + 2.0 * linked;
    }
    let n = steps as f64;
    mass * (1.0 - mass) * sum / (n * n)
}
