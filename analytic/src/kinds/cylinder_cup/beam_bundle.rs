//! The sun's light in a closed circular wall as bundles of rays, by the number k of reflections.
//!
//! A ray first meets the wall at a e^{iφ}; the last of its chords 2C = 2a cos φ is cut by the floor at t·2C, 0 ≤ t ≤ 1. So it
//! was at the height z = (t + k - 1) 2C T on its first meeting, T = tan ε, where the wall takes E0 cos ε C per dφ dz:
//!
//! ```text
//! x = a e^{iφ_k} + 2C t e^{iθ_k},   φ_k = (2k-1)φ + (k-1)π,   θ_k = 2kφ + kπ,   flux E0 sin ε R^k 2C² per dφ dt.
//! ```
//!
//! It is there if it met the wall below the far rim and came in over the near one: with η = H/(2aT),
//! (t + k - 1) cos φ ≤ η ≤ (t + k) cos φ.

use core::f64::consts::PI;

use crate::flux::{Bundle, MARGINS, Ray};

/// Rays of parallel light along +x that are reflected k ≥ 1 times; the parameters are (φ, t).
#[derive(Clone, Copy, Debug)]
pub struct BeamRays {
    /// Radius a [m].
    pub radius: f64,
    /// η = H/(2a tan ε).
    pub depth: f64,
    /// Irradiance of the floor by the light after its reflections, E0 sin ε R^k [W/m²].
    pub irradiance: f64,
    /// R^k.
    pub weight: f64,
    /// Number of reflections k.
    pub bounces: u32,
    /// Rays may be left out that come no nearer to the axis than this many radii, below 1.
    pub extent: f64,
}

impl Bundle for BeamRays {
    fn domain(&self) -> [[f64; 2]; 2] {
        // A chord passes the axis at a |sin φ|.
        let widest = libm::asin(self.extent);
        // η ≤ η/cos φ ≤ η/cos(widest) in the conditions of the rims.
        let k = f64::from(self.bounces);
        let first = (self.depth - k).clamp(0.0, 1.0);
        let last = (self.depth / libm::cos(widest) - k + 1.0).clamp(first, 1.0);
        [[-widest, widest], [first, last]]
    }

    fn ray(&self, [phi, t]: [f64; 2]) -> Ray {
        let k = f64::from(self.bounces);
        let cosine = libm::cos(phi);
        let chord = 2.0 * self.radius * cosine;
        let at = (2.0 * k - 1.0) * phi + (k - 1.0) * PI;
        let towards = 2.0 * k * phi + k * PI;
        let leg = t * chord;
        let mut margins = [1.0; MARGINS];
        margins[0] = self.depth - (t + k - 1.0) * cosine;
        margins[1] = (t + k) * cosine - self.depth;
        Ray {
            floor: [
                self.radius * libm::cos(at) + leg * libm::cos(towards),
                self.radius * libm::sin(at) + leg * libm::sin(towards),
            ],
            flux: self.irradiance * 0.5 * chord * chord,
            margins,
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        Some(self.weight)
    }
}
