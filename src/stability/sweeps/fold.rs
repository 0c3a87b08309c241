//! Towards folds, on their bright sides.

use libm::{asin, cos, sin, tan};

use super::grazing::glass_landing;
use super::scenes::{cup, dome, glass, waves};
use super::{Sweep, caustic, near};

/// The danger, and what the parameter is.
pub(super) const FOLD: (&str, &str) = ("fold", "distance to the fold [m]");

/// The sweeps.
pub(super) fn sweeps() -> Vec<Sweep> {
    vec![
        caustic("cylinder-cup", FOLD, near(), |t| cup(next_to_nephroid(t))),
        caustic("concave-sphere", FOLD, near(), |t| {
            // The fold ring of this dome, from the meridian's turning point.
            let ring = dome_fold();
            let r = ring - t;
            dome(0.3, 0.0)
                .with("z_receiver", &[-0.3])
                .at_point([0.6 * r, 0.8 * r])
        }),
        caustic("glass-sphere", FOLD, near(), |t| glass(glass_fold() - t)),
        caustic("water-waves", FOLD, near(), |t| waves(waves_fold() - t)),
    ]
}

/// A point at distance t from the nephroid, on its bright side, where the ray of φ = 1/2 touches it.
fn next_to_nephroid(t: f64) -> [f64; 2] {
    let phi = 0.5;
    let tau = 0.5 * cos(phi);
    let (x, y) = (
        cos(phi) - tau * cos(2.0 * phi),
        sin(phi) - tau * sin(2.0 * phi),
    );
    [x + t * sin(2.0 * phi), y - t * cos(2.0 * phi)]
}

/// Radius of the dome's fold ring: the turning point of the landing radius of rays that leave the light on the axis.
fn dome_fold() -> f64 {
    // The ray to the mirror point (sin ψ, cos ψ) of the unit circle from (0, 0.3), on to z = -0.3.
    let landing = |psi: f64| {
        let (s, c) = (sin(psi), cos(psi));
        let (dx, dz) = (s, c - 0.3);
        let along = dx * s + dz * c;
        let (rx, rz) = (dx - 2.0 * along * s, dz - 2.0 * along * c);
        s + rx * ((-0.3 - c) / rz)
    };
    let (mut low, mut high) = (0.05, 1.0);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if landing(a).abs() > landing(b).abs() {
            high = b;
        } else {
            low = a;
        }
    }
    landing(0.5 * (low + high)).abs()
}

/// The largest distance from the axis, where the rays turn back: the fold ring. An interval search finds the place of a
/// maximum to half the digits only, but its value to all.
fn glass_fold() -> f64 {
    let (mut low, mut high) = (0.05, 1.2);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if glass_landing(a) > glass_landing(b) {
            high = b;
        } else {
            low = a;
        }
    }
    glass_landing(0.5 * (low + high)).abs()
}

fn waves_landing(u: f64) -> f64 {
    let slope = -0.0625 * 6.0 * sin(6.0 * u);
    let i = libm::atan(slope);
    let deviation = i - asin(sin(i) / 1.333);
    u + (3.0 + 0.0625 * cos(6.0 * u)) * tan(deviation)
}

/// The first maximum of the landing point: a fold.
fn waves_fold() -> f64 {
    let (mut low, mut high) = (-0.5, 0.0);
    for _ in 0..200 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        if waves_landing(a) > waves_landing(b) {
            high = b;
        } else {
            low = a;
        }
    }
    waves_landing(0.5 * (low + high))
}
