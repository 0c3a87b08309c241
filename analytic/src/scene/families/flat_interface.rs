//! Flat water, light and camera above it.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, LARGEST, above};
use crate::scene::{Camera, Closure, Family, Floor, InvalidParameter, PointLight, Water};

/// A flat water surface over the floor, light and camera above it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlatInterfaceScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The interface.
    pub water: Water,
}

impl Family for FlatInterfaceScene {
    fn name(&self) -> &'static str {
        "flat-interface"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LSDSE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(5),
            reason: "light from the floor may be reflected back to it by the surface: LTDRDTE has six edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.water.validate()?;
        self.light.validate(self.water.surface_z)?;
        above(
            "camera.position",
            camera.position[2],
            self.water.surface_z,
            LARGEST,
        )
        .map_err(|e| InvalidParameter {
            allowed: format!("a camera above the water: z {}", e.allowed),
            ..e
        })
    }
}
