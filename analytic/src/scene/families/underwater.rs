//! Flat water, light above it, camera below it.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::Checked;
use crate::scene::{Camera, Closure, Family, Floor, PointLight, Water};

/// A flat water surface over the floor, light above it and camera below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnderwaterScene {
    /// The light, in the air.
    pub light: PointLight,
    /// The receiver, under water.
    pub floor: Floor,
    /// The interface.
    pub water: Water,
}

impl Family for UnderwaterScene {
    fn name(&self) -> &'static str {
        "underwater"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(4),
            reason: "light from the floor may be reflected back to it by the surface: LTDRDE has five edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.water.validate()?;
        self.light.validate(self.water.surface_z)?;
        camera.check_under(self.water.surface_z)
    }
}
