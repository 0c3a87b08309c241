//! A vertical glass cylinder on the floor, in the sun.

use serde::{Deserialize, Serialize};

use super::pillar::check_standing;
use crate::class::{PathClass, Specular};
use crate::kinds::glass_pillar::GlassPillar;
use crate::scene::ranges::{Checked, above, invalid, positive};
use crate::scene::{Camera, Closure, DirectionalLight, Family, Floor};

/// A glass pillar on the floor under a directional light, outside the frame. The floor under it and its top absorb.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassPillarScene {
    /// The light.
    pub light: DirectionalLight,
    /// The receiver.
    pub floor: Floor,
    /// The glass.
    pub pillar: GlassCylinder,
}

/// By the number of interactions with the side.
const CLASSES: &[PathClass] = &[
    PathClass::LDE,
    PathClass::caustic(&[Specular::Reflection]),
    PathClass::caustic(&[Specular::Transmission, Specular::Transmission]),
    PathClass::caustic(&[
        Specular::Transmission,
        Specular::Reflection,
        Specular::Transmission,
    ]),
    PathClass::caustic(&[
        Specular::Transmission,
        Specular::Reflection,
        Specular::Reflection,
        Specular::Transmission,
    ]),
    PathClass::caustic(&[
        Specular::Transmission,
        Specular::Reflection,
        Specular::Reflection,
        Specular::Reflection,
        Specular::Transmission,
    ]),
];

/// The most interactions that a scene may have.
const MOST: u32 = CLASSES.len() as u32 - 1;

impl Family for GlassPillarScene {
    fn name(&self) -> &'static str {
        "glass-pillar"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    /// As many as the height lets through: every ray goes down, so the series over internal reflections ends.
    fn classes(&self) -> &'static [PathClass] {
        let most = GlassPillar::from_entry(&self.light, &self.pillar).max_interactions();
        &CLASSES[..=most.clamp(1, MOST) as usize]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "vertical sides keep the sign of the vertical direction; after more interactions than these no light is above the floor; the pillar is not in the frame (all checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        let p = &self.pillar;
        positive("pillar.radius", p.radius)?;
        positive("pillar.height", p.height)?;
        above("pillar.index", p.index, 1.0, 10.0)?;
        check_standing(&p.center, p.radius, p.height, camera)?;
        let most = GlassPillar::from_entry(&self.light, p).max_interactions();
        if most <= MOST {
            return Ok(());
        }
        Err(invalid(
            "pillar.height",
            p.height,
            &format!(
                "a pillar so low that light is on the floor after {MOST} interactions with its side"
            ),
        ))
    }
}

/// A circular glass cylinder standing on the floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassCylinder {
    /// Axis (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Radius a [m].
    pub radius: f64,
    /// Height H of the top [m].
    pub height: f64,
    /// Refractive index n of the glass relative to air.
    pub index: f64,
}
