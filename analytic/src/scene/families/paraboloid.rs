//! A paraboloid mirror above the floor, opening downward, with the light at its focus.

use libm::sqrt;
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, LARGEST, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, FocalLight};

/// A paraboloid mirror that sends the light at its focus straight down on the floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParaboloidScene {
    /// The light, at the focus.
    pub light: FocalLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub dish: Dish,
}

/// The surface z = vertex_z - r²/(4f) between two radii about a vertical axis. It reflects on its inner (lower) side,
/// absorbs on its outer side and occludes from both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dish {
    /// Where the axis meets the floor, (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Height of the vertex above the floor [m].
    pub vertex_z: f64,
    /// Focal length f [m]: the focus is this far below the vertex.
    pub focal_length: f64,
    /// Radius of the hole in the middle [m].
    pub inner_radius: f64,
    /// Radius of the rim [m].
    pub outer_radius: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

impl Dish {
    /// Height of the rim, the lowest part of the mirror [m].
    pub fn rim_z(&self) -> f64 {
        self.vertex_z - self.outer_radius * self.outer_radius / (4.0 * self.focal_length)
    }

    /// Height of the focus, where the light is [m].
    pub fn focus_z(&self) -> f64 {
        self.vertex_z - self.focal_length
    }

    fn validate(&self) -> Checked {
        coordinates("dish.center", &self.center)?;
        positive("dish.vertex_z", self.vertex_z)?;
        positive("dish.focal_length", self.focal_length)?;
        within("dish.inner_radius", self.inner_radius, 0.0, LARGEST)?;
        above(
            "dish.outer_radius",
            self.outer_radius,
            self.inner_radius,
            LARGEST,
        )?;
        above("dish.reflectance", self.reflectance, 0.0, 1.0)?;
        if !(self.focus_z() > 0.0) {
            return Err(invalid(
                "dish.focal_length",
                self.focal_length,
                "less than vertex_z, so that the focus is above the floor",
            ));
        }
        if self.rim_z() > 0.0 {
            return Ok(());
        }
        let largest = 2.0 * sqrt(self.focal_length * self.vertex_z);
        Err(invalid(
            "dish.outer_radius",
            self.outer_radius,
            &format!("less than {largest}, so that the rim is above the floor"),
        ))
    }
}

impl Family for ParaboloidScene {
    fn name(&self) -> &'static str {
        "paraboloid"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(3),
            reason: "light may go from the floor by the dish back to the floor: LDSDE has four edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        positive("light.intensity", self.light.intensity)?;
        self.dish.validate()?;
        camera.check_under(self.dish.rim_z())
    }
}
