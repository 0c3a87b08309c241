//! Direct light on the floor z = 0, with nothing in its way, as a bundle over a rectangle of the floor.
//!
//! What stands in the way is subtracted by the bundles of negative flux of each kind: the rays that an occluder stops, at
//! the floor points they would have reached.

use crate::flux::{Bundle, MARGINS, Ray};
use crate::scene::Floor;

/// A light above the floor.
#[derive(Clone, Copy, Debug)]
pub enum FloorLight {
    /// A point light.
    Point {
        /// Position above the floor [m].
        position: [f64; 3],
        /// Radiant intensity [W/sr].
        intensity: f64,
    },
    /// Parallel light.
    Beam {
        /// Irradiance of the floor, E0 sin ε [W/m²].
        irradiance: f64,
    },
}

/// A rectangle of the floor under a light; its parameters are the floor coordinates.
#[derive(Clone, Copy, Debug)]
pub struct OpenFloor {
    /// Range of x and of y [m].
    pub region: [[f64; 2]; 2],
    /// The light.
    pub light: FloorLight,
}

impl OpenFloor {
    /// All of a floor.
    pub fn on(floor: &Floor, light: FloorLight) -> Self {
        let ([cx, cy], [wx, wy]) = (floor.center, floor.half_width);
        OpenFloor {
            region: [[cx - wx, cx + wx], [cy - wy, cy + wy]],
            light,
        }
    }
}

impl Bundle for OpenFloor {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.region
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let flux = match self.light {
            FloorLight::Point {
                position: [x, y, h],
                intensity,
            } => {
                let distance = libm::hypot(libm::hypot(x - u[0], y - u[1]), h);
                intensity * h / (distance * distance * distance)
            }
            FloorLight::Beam { irradiance } => irradiance,
        };
        Ray {
            floor: u,
            flux,
            margins: [1.0; MARGINS],
        }
    }
}
