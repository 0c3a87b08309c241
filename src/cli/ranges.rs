//! Ranges of options that several commands have.

use nephroid_analytic::bandwidth::SMALLEST_BANDWIDTH;

/// A number from `low` to `high`.
pub(super) fn in_range(text: &str, low: f64, high: f64) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|v| (low..=high).contains(v))
        .ok_or_else(|| format!("expected a number from {low:e} to {high:e}"))
}

/// An equivalence margin relative to the truth.
pub(super) fn margin(text: &str) -> Result<f64, String> {
    in_range(text, 1e-4, 0.5)
}

/// A probability of error.
pub(super) fn level(text: &str) -> Result<f64, String> {
    in_range(text, 1e-15, 0.1)
}

/// An angle [rad] or a radius [m].
pub(super) fn bandwidth(text: &str) -> Result<f64, String> {
    in_range(text, SMALLEST_BANDWIDTH, 1e6)
}
