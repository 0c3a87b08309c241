//! A flat mirror over the floor.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::Checked;
use crate::scene::{Camera, Closure, Family, Floor, PointLight, RectangleMirror};

/// A flat mirror over the floor, under a point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanarMirrorScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub mirror: RectangleMirror,
}

impl Family for PlanarMirrorScene {
    fn name(&self) -> &'static str {
        "planar-mirror"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[
            PathClass::LDE,
            PathClass::LSDE,
            PathClass::LDSE,
            PathClass::LSDSE,
        ]
    }

    fn closure(&self) -> Closure {
        let vertical = f64::abs(self.mirror.normal[2]) <= 1e-12;
        if vertical {
            Closure {
                longest: None,
                reason: "a vertical mirror keeps the sign of the vertical direction: no light goes from the floor back to the floor",
            }
        } else {
            Closure {
                longest: Some(3),
                reason: "light may go from the floor by the mirror back to the floor: LDSDE has four edges",
            }
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate(0.0)?;
        self.mirror.validate()?;
        self.mirror
            .check_in_front("light.position", &self.light.position)?;
        self.mirror
            .check_in_front("camera.position", &camera.position)
    }
}
