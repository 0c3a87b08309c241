//! What the study sweeps: for every kind the dangers that it has.
//!
//! Rippled water in two dimensions (the catalogue's `ripple-pool`) is not swept: its rays are isolated by a search over the
//! plane of which there is no enclosure, so that nothing could be said of its errors that the form does not say itself.
//! Waves along one direction are.

mod bandwidth;
mod focus;
mod fold;
mod grazing;
mod scenes;
mod size;
mod walls;

use super::inputs::Inputs;
use super::quantity::Quantity;

/// A path through the parameters of a kind, towards a danger.
pub struct Sweep {
    /// The kind, as the reference tables call it.
    pub kind: &'static str,
    /// What is approached.
    pub danger: &'static str,
    /// What the parameter t is, with its unit.
    pub parameter: &'static str,
    /// What is computed.
    pub quantity: Quantity,
    /// The values of t.
    pub values: Vec<f64>,
    /// The numbers at t.
    pub at: fn(f64) -> Inputs,
}

/// A sweep of the caustic irradiance.
fn caustic(
    kind: &'static str,
    (danger, parameter): (&'static str, &'static str),
    values: Vec<f64>,
    at: fn(f64) -> Inputs,
) -> Sweep {
    Sweep {
        kind,
        danger,
        parameter,
        quantity: Quantity::Caustic,
        values,
        at,
    }
}

/// 10^first, 10^(first - 1), … 10^last.
fn decades(first: i32, last: i32) -> Vec<f64> {
    let step = if last < first { -1 } else { 1 };
    (0..=(last - first).abs())
        .map(|k| libm::pow(10.0, f64::from(first + step * k)))
        .collect()
}

/// Distances to a singularity.
fn near() -> Vec<f64> {
    decades(-1, -12)
}

/// Angles to a surface.
fn graze() -> Vec<f64> {
    decades(-1, -8)
}

/// Factors of all lengths.
fn scale() -> Vec<f64> {
    decades(-6, 6)
}

/// Offsets.
fn far() -> Vec<f64> {
    decades(0, 4)
}

/// All sweeps.
pub fn all() -> Vec<Sweep> {
    [
        fold::sweeps(),
        grazing::sweeps(),
        focus::sweeps(),
        size::sweeps(),
        walls::sweeps(),
        bandwidth::sweeps(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The kind of which the sweeps stand for a kind of the catalogue: the forms are the same.
pub fn swept_as(kind: &str) -> &str {
    match kind {
        "cylinder-lamp" | "closed-cup" => "cylinder-cup",
        "underwater" => "flat-interface",
        _ => kind,
    }
}
