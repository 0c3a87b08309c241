//! Closed forms of each kind of scene, at points.
//!
//! Every kind offers, per path class, the irradiance with an error bound, the specular roots behind it and the distance
//! to the nearest singularity. Formulas are generic over [`Scalar`]; nothing here allocates unless it says so.

pub mod conic_mirrors;
pub mod conic_wall;
pub mod cylinder_cup;
pub mod diffuse;
pub mod flat_interface;
pub mod glass_pillar;
pub mod glass_slab;
pub mod glass_sphere;
pub mod open_floor;
pub mod paraboloid;
pub mod pillar;
mod plan_caustic;
pub mod planar_chains;
pub mod planar_mirror;
pub mod singularity;
pub mod sphere_mirror;
pub mod stigmatic_refractors;
pub mod water_waves;

use crate::scalar::Scalar;

/// The sum over all roots of one path class at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<S> {
    /// Irradiance [W/m²].
    pub value: S,
    /// Bound of |value - truth|: rounding of the inputs and of the arithmetic, times the conditioning. Infinite on a
    /// fold.
    pub error: S,
    /// Number of specular roots.
    pub roots: u32,
}

/// Units of rounding that are allowed per unit of conditioning. The conditioning adds up the moduli of all partial
/// derivatives, so that it already exceeds what independent rounding errors reach; the tables stay below a tenth of the
/// bound.
const ROUNDINGS: f64 = 4.0;

impl<S: Scalar> Estimate<S> {
    /// No light at all, exactly.
    pub const NONE: Self = Estimate {
        value: S::ZERO,
        error: S::ZERO,
        roots: 0,
    };

    /// Adds a root. `conditioning` is (an upper bound of) the relative change of `irradiance` per relative change of
    /// the lengths that it comes from.
    #[inline(always)]
    pub fn add(&mut self, irradiance: S, conditioning: S) {
        let error = rounding_error(irradiance, conditioning);
        self.value += irradiance;
        self.roots += 1;
        // On a fold or cusp the irradiance is infinite: no bound.
        self.error += if error.is_finite() {
            error
        } else {
            S::ONE / S::ZERO
        };
    }

    /// The estimate at a point that is itself known only to `relative` of the lengths in the conditioning.
    pub fn displaced(mut self, relative: S) -> Self {
        if self.value > S::ZERO {
            self.error += self.value * self.conditioning() * relative;
        }
        self
    }

    /// Relative change of the value per relative change of the inputs; 0 for no light.
    pub fn conditioning(&self) -> S {
        if self.value > S::ZERO {
            self.error / (self.value * S::EPSILON * S::from_f64(ROUNDINGS))
        } else {
            S::ZERO
        }
    }
}

/// Error bound of a value with the given conditioning: 4 units of rounding per unit of four plus the conditioning.
#[inline(always)]
pub fn rounding_error<S: Scalar>(value: S, conditioning: S) -> S {
    value.abs() * (S::from_f64(4.0) + conditioning) * (S::EPSILON * S::from_f64(ROUNDINGS))
}

/// `base^exponent` by repeated squaring.
pub(crate) fn power<S: Scalar>(base: S, mut exponent: u32) -> S {
    let (mut result, mut square) = (S::ONE, base);
    while exponent > 0 {
        if exponent % 2 == 1 {
            result = result * square;
        }
        square = square.squared();
        exponent /= 2;
    }
    result
}
