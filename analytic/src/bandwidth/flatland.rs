//! Flatland: a plane mirror between a receiver and a light on one of its normals, one dimension per mollified direction.
//!
//! θ is the angle at the receiver between the normal and the mirror point, θ' that at the light, p tan θ = q tan θ'; the
//! deflection there is g = θ + θ'. With c = cos θ, c' = cos θ', r₁ = p/c, r₂ = q/c' (densities: camera cos/2, light 1/2π):
//!
//! ```text
//! camera E = R I ∫ φ c/r₂ dθ          f = 2 R I φ/r₂       light E = R I ∫ φ c'/r₂ dθ     f = 2π R I φ c/r₁
//! merge  E = R I atan(r/(p+q))/r      f = 2π R I/(2r)      symmetric: c → √(cc') in the integral, f = 2 R I φ √(c'/c)/r₂
//! ```
//!
//! Source: `theory/bandwidth.md` section 3; E₀ = R I/(p + q).

use core::f64::consts::PI;

use libm::{atan, atan2, cos, sqrt, tan};

use super::quadrature::bracketed_root;
use super::{Bounded, Moments, Technique};
use crate::pixel::rule::Rule;

/// A mirror, a receiver and a light on one normal.
#[derive(Clone, Copy, Debug)]
pub struct FlatlandMirror {
    /// Distance p of the receiver from the mirror [m].
    pub receiver: f64,
    /// Distance q of the light [m].
    pub light: f64,
    /// R I [W/rad].
    pub strength: f64,
}

impl FlatlandMirror {
    /// Moments of the irradiance [W/m, (W/m)²] with the kernel 1/(2α) on the angle [rad] up to π, or 1/(2r) on the distance [m] for
    /// `Merge`; `None` for `Linked`, which is not defined in flatland.
    ///
    /// **Accuracy**: Gauss's rule of order 40 against that of order 26.
    pub fn expectation(&self, technique: Technique, bandwidth: f64) -> Option<Moments> {
        let (p, q, strength) = (self.receiver, self.light, self.strength);
        let exact = |value: f64| Bounded {
            value,
            error: 8.0 * f64::EPSILON * value,
        };
        if technique == Technique::Linked {
            return None;
        }
        if technique == Technique::Merge {
            let mean = strength * atan(bandwidth / (p + q)) / bandwidth;
            return Some(Moments {
                mean: exact(mean),
                second_moment: exact(mean * PI * strength / bandwidth),
            });
        }
        let other = |t: f64| atan(p * tan(t) / q);
        let mut missing = |t: f64| t + other(t) - bandwidth;
        let right_angle = 0.5 * PI;
        let end = if bandwidth < PI {
            bracketed_root(0.0, right_angle, -bandwidth, PI - bandwidth, &mut missing)
        } else {
            right_angle
        };
        let phi = 0.5 / bandwidth;
        let at = |t: f64| {
            let (c, o) = (cos(t), atan2(p * libm::sin(t), q * cos(t)));
            let c2 = cos(o);
            let (r1, r2) = (p / c, q / c2);
            let (cosine, sample) = match technique {
                Technique::Camera => (c, 2.0 * strength * phi / r2),
                Technique::Symmetric => (sqrt(c * c2), 2.0 * strength * phi * sqrt(c2 / c) / r2),
                _ => (c2, 2.0 * PI * strength * phi * c / r1),
            };
            let mean = strength * phi * cosine / r2;
            [mean, mean * sample]
        };
        // Both sides of the normal are alike.
        let integral = |order: usize| {
            let mut sum = [0.0; 2];
            for (x, w) in Rule::gauss(order).iter() {
                let v = at(end * x);
                sum = [sum[0] + 2.0 * end * w * v[0], sum[1] + 2.0 * end * w * v[1]];
            }
            sum
        };
        let (rough, fine) = (integral(26), integral(40));
        let bounded = |k: usize| Bounded {
            value: fine[k],
            error: f64::abs(fine[k] - rough[k]) + 16.0 * f64::EPSILON * fine[k],
        };
        Some(Moments {
            mean: bounded(0),
            second_moment: bounded(1),
        })
    }
}
