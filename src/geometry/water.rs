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
    /// a + b T is the weight, of the transmittance T: 0 and 1.
    weight: [f64; 2],
}

impl Water {
    /// Prepares a validated interface.
    pub fn new(water: &WaterData) -> Self {
        Water {
            surface_z: water.surface_z,
            index: water.index,
            weight: [0.0, 1.0],
        }
    }

    /// The same with a + b T in place of the transmittance T.
    pub fn with_weight(self, weight: [f64; 2]) -> Self {
        Water { weight, ..self }
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
            weight: if met & passes {
                self.weight[0] + self.weight[1] * transmittance
            } else {
                0.0
            },
        }
    }

    #[inline(always)]
    fn blocks(&self, _: DVec3, _: DVec3, _: f64) -> bool {
        true
    }

    fn normal_after(&self, meeting: &Meeting) -> DVec3 {
        DVec3::new(0.0, 0.0, f64::copysign(1.0, meeting.direction.z))
    }

    fn radiance_scale(&self) -> f64 {
        1.0 / (self.index * self.index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn water() -> Water {
        Water::new(&WaterData {
            surface_z: 1.1,
            index: 1.333,
        })
    }

    #[test]
    fn refraction_keeps_the_plane_and_snells_law() {
        let o = DVec3::new(0.2, -0.3, 2.0);
        for d in [
            DVec3::new(0.3, 0.4, -0.9),
            DVec3::new(0.0, 0.0, -1.0),
            DVec3::new(9.0, 1.0, -0.1),
        ] {
            let m = water().meet(o, d);
            assert!(
                (m.point.z - 1.1).abs() < 1e-15
                    && (m.direction.length() / d.length() - 1.0).abs() < 1e-14
            );
            // n sin θ, horizontal part over length.
            let sine = |v: DVec3| DVec3::new(v.x, v.y, 0.0) / v.length();
            assert!((sine(m.direction) * 1.333 - sine(d)).length() < 1e-14);
            assert!(m.direction.z < 0.0);
            // Back the same way, with the same transmittance.
            let from = m.point + m.direction;
            let back = water().meet(from, -m.direction);
            assert!((back.direction + d).length() < 1e-12 * d.length());
            assert!((back.weight - m.weight).abs() < 1e-13);
        }
    }

    #[test]
    fn transmittance_at_known_angles() {
        let o = DVec3::new(0.0, 0.0, 2.0);
        let normal = water().meet(o, DVec3::new(0.0, 0.0, -1.0)).weight;
        let r = 0.333 / 2.333;
        assert!((normal - (1.0 - r * r)).abs() < 1e-15);
        // At Brewster's angle, tan θ = n, only the s polarisation is reflected: r_s = (1 - n²)/(1 + n²).
        let n2 = 1.333 * 1.333;
        let brewster = water().meet(o, DVec3::new(1.333, 0.0, -1.0)).weight;
        let rs = (1.0 - n2) / (1.0 + n2);
        assert!((brewster - (1.0 - 0.5 * rs * rs)).abs() < 1e-14);
    }

    #[test]
    fn beyond_the_critical_angle_nothing_passes() {
        let o = DVec3::new(0.0, 0.0, 0.1);
        let critical = libm::asin(1.0 / 1.333);
        for (angle, passes) in [
            (critical + 1e-9, false),
            (critical - 1e-9, true),
            (1.57, false),
        ] {
            let m = water().meet(o, DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)));
            assert_eq!(m.weight > 0.0, passes);
            assert!(m.direction.is_finite());
        }
    }
}
