//! A lamp's light as bundles of rays: what the circular wall reflects, and what it keeps from the floor outside.
//!
//! A ray of the light A meets the wall at Q = a e^{iφ} and the height z. Per dφ dz the wall takes
//! a I (Q - A)·n/|Q - A|³. The reflected ray comes down over s2 = s1 z/(h - z) in plan. For a light higher than twice the
//! wall it lands inside the circle, whatever φ and z (see `scene::families::cylinder_lamp`), so that no ray has a
//! condition to meet. A ray that the wall stops would have reached the floor at A + (Q - A) h/(h - z).

use crate::flux::{Bundle, MARGINS, Ray};

/// Which rays of a lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LampPart {
    /// Rays that the wall reflects to the floor (LSDE).
    Reflected,
    /// Direct rays that the wall stops (negative, LDE).
    Stopped,
}

/// Rays of a point light by a circular wall about the z axis; the parameters are (φ, z) at the wall.
#[derive(Clone, Copy, Debug)]
pub struct LampRays {
    /// Radius a [m].
    pub radius: f64,
    /// Height H of the wall [m].
    pub height: f64,
    /// Half of its arc [rad], at most π.
    pub half_arc: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
    /// Position of the light [m], inside the circle or on it and higher than 2H.
    pub light: [f64; 3],
    /// Radiant intensity I [W/sr].
    pub intensity: f64,
    /// Which rays.
    pub part: LampPart,
}

impl Bundle for LampRays {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.half_arc, self.half_arc], [0.0, self.height]]
    }

    fn ray(&self, [phi, z]: [f64; 2]) -> Ray {
        let (c, s) = (libm::cos(phi), libm::sin(phi));
        let [ax, ay, h] = self.light;
        let (dx, dy) = (self.radius * c - ax, self.radius * s - ay);
        let distance = libm::hypot(libm::hypot(dx, dy), h - z);
        let approach = dx * c + dy * s;
        let taken = self.radius * self.intensity * approach / (distance * distance * distance);
        let (floor, flux) = match self.part {
            LampPart::Stopped => {
                let on = h / (h - z);
                ([ax + dx * on, ay + dy * on], -taken)
            }
            LampPart::Reflected => {
                let on = z / (h - z);
                let turn = 2.0 * approach;
                let (wx, wy) = (dx - turn * c, dy - turn * s);
                let (x, y) = (self.radius * c + wx * on, self.radius * s + wy * on);
                ([x, y], self.reflectance * taken)
            }
        };
        Ray {
            floor,
            flux,
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        (self.part == LampPart::Reflected).then_some(self.reflectance)
    }
}
