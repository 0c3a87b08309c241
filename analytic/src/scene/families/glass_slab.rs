//! A glass slab over the floor, camera below it.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, LARGEST, above, positive};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A parallel glass slab between a point light and the floor, camera below it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassSlabScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The glass.
    pub slab: Slab,
}

impl Family for GlassSlabScene {
    fn name(&self) -> &'static str {
        "glass-slab"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        CLASSES
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(5),
            reason: "light from the floor may be reflected back to it by the slab: LTTDRDE has six edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.slab.validate()?;
        self.light.validate(self.slab.top)?;
        camera.check_under(self.slab.bottom)
    }
}

/// Two, four, six and eight interactions: the rest carries less than 1e-6 of the light for n up to 1.6.
const CLASSES: &[PathClass] = &[
    PathClass::new(2, 0),
    PathClass::new(4, 0),
    PathClass::new(6, 0),
    PathClass::new(8, 0),
];

/// An unbounded parallel slab of smooth dielectric in air.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Slab {
    /// Height of the lower surface [m].
    pub bottom: f64,
    /// Height of the upper surface [m].
    pub top: f64,
    /// Refractive index n relative to air.
    pub index: f64,
}

impl Slab {
    fn validate(&self) -> Checked {
        positive("slab.bottom", self.bottom)?;
        above("slab.top", self.top, self.bottom, LARGEST)?;
        above("slab.index", self.index, 1.0, 10.0)
    }
}
