//! A convex vertical mirror on the floor, under a point light.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::frame::Frame;
use crate::scene::ranges::{Checked, above, coordinates, invalid, positive};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A mirror pillar on the floor under a point light, outside the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PillarScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub pillar: MirrorPillar,
}

impl Family for PillarScene {
    fn name(&self) -> &'static str {
        "pillar"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "a convex wall is met once at most, and a vertical one keeps the sign of the vertical direction; the pillar is not in the frame (checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate(0.0)?;
        let p = &self.pillar;
        positive("pillar.radius", p.radius)?;
        positive("pillar.height", p.height)?;
        above("pillar.reflectance", p.reflectance, 0.0, 1.0)?;
        check_standing(&p.center, p.radius, p.height, camera)?;
        let [x, y, _] = self.light.position;
        let distance = libm::hypot(x - p.center[0], y - p.center[1]);
        if distance > p.radius * (1.0 + 1e-9) {
            return Ok(());
        }
        Err(invalid(
            "light.position",
            format!("{:?}", self.light.position),
            &format!(
                "a point farther than {} (the radius) from the pillar's axis",
                p.radius
            ),
        ))
    }
}

/// A circular pillar standing on the floor. Its side reflects, its top absorbs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MirrorPillar {
    /// Axis (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Radius a [m].
    pub radius: f64,
    /// Height H of the top [m].
    pub height: f64,
    /// Specular reflectance R of the side.
    pub reflectance: f64,
}

/// Checks where a pillar stands, and that no ray of the frame meets it.
pub(super) fn check_standing(
    center: &[f64; 2],
    radius: f64,
    height: f64,
    camera: &Camera,
) -> Checked {
    coordinates("pillar.center", center)?;
    let [x, y] = *center;
    let reach = |n: [f64; 3]| {
        n[0] * x + n[1] * y + radius * libm::hypot(n[0], n[1]) + (n[2] * height).max(0.0)
    };
    Frame::new(camera).check_beside("the pillar", reach)
}
