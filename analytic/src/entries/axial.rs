//! Direct light from a point on the axis of a mirror that opens downward: a disc, where the rim is below the light.

use std::sync::Arc;

use libm::hypot;

use super::PointTruth;
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS};
use crate::kinds::{diffuse, rounding_error};
use crate::scene::Floor;
use crate::vector::vec3;

/// A light above the floor point `axis`, in a mirror with that axis whose inside is convex.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxialLight {
    pub(super) axis: [f64; 2],
    pub(super) light_z: f64,
    pub(super) intensity: f64,
    /// Radius of the floor that the rim leaves lit [m]; infinite for a rim above the light.
    lit: f64,
}

impl AxialLight {
    /// The light, and the rim's radius and height.
    pub(super) fn new(axis: [f64; 2], light_z: f64, intensity: f64, rim: (f64, f64)) -> Self {
        let below = light_z - rim.1;
        AxialLight {
            axis,
            light_z,
            intensity,
            lit: if below > 0.0 {
                rim.0 * light_z / below
            } else {
                f64::INFINITY
            },
        }
    }

    pub(super) fn at(&self, x: f64, y: f64) -> PointTruth {
        let (x, y) = (x - self.axis[0], y - self.axis[1]);
        let mut e = diffuse::direct(
            vec3(0.0, 0.0, self.light_z),
            self.intensity,
            vec3(x, y, 0.0),
        );
        let outside = hypot(x, y) - self.lit;
        // Rounding decides on the edge of the disc.
        let marginal = self.lit < f64::INFINITY && outside.abs() <= rounding_error(self.lit, 4.0);
        let lost = e.value;
        if outside > 0.0 {
            e = crate::kinds::Estimate::NONE;
        }
        if marginal {
            e.error += lost;
        }
        PointTruth::new(PathClass::LDE, e)
    }

    pub(super) fn bundle(&self, floor: &Floor) -> Arc<dyn Bundle> {
        let light = *self;
        Arc::new(FloorLight::new(floor, move |x, y| {
            let (x, y) = (x - light.axis[0], y - light.axis[1]);
            let z = light.light_z;
            let square = x * x + y * y;
            let d2 = square + z * z;
            let mut margins = [1.0; MARGINS];
            if light.lit < f64::INFINITY {
                margins[0] = light.lit * light.lit - square;
            }
            (light.intensity * z / (d2 * libm::sqrt(d2)), margins)
        }))
    }
}
