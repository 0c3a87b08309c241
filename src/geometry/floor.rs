//! The Lambertian floor z = 0, clipped to a rectangle, lit and seen from above.

use glam::DVec3;
use nephroid_analytic::scene::Floor as FloorData;

/// The floor, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    center: [f64; 2],
    half_width: [f64; 2],
    /// The BSDF, albedo/π [1/sr].
    pub bsdf: f64,
}

impl Floor {
    /// Prepares a validated floor.
    pub fn new(floor: &FloorData) -> Self {
        Floor {
            center: floor.center,
            half_width: floor.half_width,
            bsdf: floor.albedo / core::f64::consts::PI,
        }
    }

    /// Ray parameter where a ray that comes from above meets the plane z = 0; infinite where it does not.
    #[inline(always)]
    pub fn meet(origin: DVec3, direction: DVec3) -> f64 {
        let t = -origin.z / direction.z;
        if (direction.z < 0.0) & (t > 0.0) {
            t
        } else {
            f64::INFINITY
        }
    }

    /// Whether (x, y) is on the floor, its border included.
    #[inline(always)]
    pub fn contains(&self, x: f64, y: f64) -> bool {
        (f64::abs(x - self.center[0]) <= self.half_width[0])
            & (f64::abs(y - self.center[1]) <= self.half_width[1])
    }

    /// The four corners [m].
    pub fn hull(&self) -> Vec<DVec3> {
        let ([cx, cy], [wx, wy]) = (self.center, self.half_width);
        let corner = |sx: f64, sy: f64| DVec3::new(cx + sx * wx, cy + sy * wy, 0.0);
        vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(-1.0, 1.0),
            corner(1.0, 1.0),
        ]
    }
}
