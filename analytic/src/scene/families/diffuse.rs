//! A floor under a point light.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::Checked;
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A floor under a point light; no specular surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DiffuseScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
}

impl Family for DiffuseScene {
    fn name(&self) -> &'static str {
        "diffuse"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "a plane does not light itself",
        }
    }

    fn validate(&self, _: &Camera) -> Checked {
        self.light.validate(0.0)
    }
}
