//! A flat, unbounded water surface: air above, water of index n below, the floor under water.
//!
//! Refraction is Snell's law in vector form; the weight is the unpolarised Fresnel transmittance, in amplitudes:
//! with cosines c₁, c₂ on the two sides of indices n₁, n₂, T = 1 - (r_s² + r_p²)/2, r_s = (n₁c₁ - n₂c₂)/(n₁c₁ + n₂c₂),
//! r_p = (n₂c₁ - n₁c₂)/(n₂c₁ + n₁c₂). What is reflected is dropped: below the water it would stay there (no path class
//! of the closure), above it never reaches the floor. At total internal reflection the weight is 0.

use glam::DVec3;
use nephroid_analytic::scene::Water as WaterData;

use super::specular::{Meeting, Specular};

/// The interface, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Water {
    surface_z: f64,
    index: f64,
}

impl Water {
    /// Prepares a validated interface.
    pub fn new(water: &WaterData) -> Self {
        Water {
            surface_z: water.surface_z,
            index: water.index,
        }
    }
}

impl Specular for Water {
    const SEPARATES: bool = true;

    #[inline(always)]
    fn meet(&self, origin: DVec3, direction: DVec3) -> Meeting {
        let t = (self.surface_z - origin.z) / direction.z;
        let met = (t > 0.0) & (t < f64::INFINITY);
        let downwards = direction.z < 0.0;
        let (n1, n2) = if downwards {
            (1.0, self.index)
        } else {
            (self.index, 1.0)
        };
        let length = f64::sqrt(direction.dot(direction));
        let ratio = n1 / n2;
        let c1 = f64::abs(direction.z) / length;
        let c2_squared = 1.0 - ratio * ratio * (1.0 - c1 * c1);
        let passes = c2_squared > 0.0;
        let c2 = f64::sqrt(if passes { c2_squared } else { 0.0 });
        let rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
        let rp = (n2 * c1 - n1 * c2) / (n2 * c1 + n1 * c2);
        let transmittance = 1.0 - 0.5 * (rs * rs + rp * rp);
        // The horizontal part shrinks by n₁/n₂; the vertical part makes up the length.
        let z = if downwards { -c2 } else { c2 } * length;
        let point = origin + direction * t;
        Meeting {
            t: if met { t } else { f64::INFINITY },
            point: DVec3::new(point.x, point.y, self.surface_z),
            direction: DVec3::new(direction.x * ratio, direction.y * ratio, z),
            weight: if met & passes { transmittance } else { 0.0 },
        }
    }

    #[inline(always)]
    fn blocks(&self, _: DVec3, _: DVec3, _: f64) -> bool {
        true
    }

    fn radiance_scale(&self) -> f64 {
        1.0 / (self.index * self.index)
    }
}
