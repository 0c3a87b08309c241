//! A vertical circular wall in the sun.

use libm::{acos, cos, hypot, tan};
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, above, invalid, positive};
use crate::scene::{ArcWall, Camera, Closure, DirectionalLight, Family, Floor};

/// A vertical circular wall on the floor, under a directional light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderCupScene {
    /// The light.
    pub light: DirectionalLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub wall: ArcWall,
}

impl Family for CylinderCupScene {
    fn name(&self) -> &'static str {
        "cylinder-cup"
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
        Closure {
            longest: None,
            reason: "a vertical wall keeps the sign of the vertical direction; light and camera meet it once at most (checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        self.wall.validate(&self.light)?;
        self.wall.check_camera(camera)
    }
}

impl ArcWall {
    fn validate(&self, light: &DirectionalLight) -> Checked {
        positive("wall.radius", self.radius)?;
        positive("wall.height", self.height)?;
        above("wall.half_arc_degrees", self.half_arc_degrees, 0.0, 60.0)?;
        above("wall.reflectance", self.reflectance, 0.0, 1.0)?;
        let highest = self.radius * tan(light.elevation_degrees.to_radians());
        if self.height <= highest {
            return Ok(());
        }
        Err(invalid(
            "wall.height",
            self.height,
            &format!(
                "at most {highest} (radius × tan elevation), so that light meets the wall once"
            ),
        ))
    }

    /// Sufficient condition that no camera ray meets the wall twice, and that the wall hides no part of its own inner
    /// side: the camera is outside the circle on the open side, and the ray reflected anywhere on the wall reaches the
    /// floor before it comes back to the circle.
    fn check_camera(&self, camera: &Camera) -> Checked {
        let [cx, cy, cz] = camera.position;
        let half_arc = self.half_arc_degrees.to_radians();
        let refuse = |why: &str| {
            Err(invalid(
                "camera.position",
                format!("{:?}", camera.position),
                why,
            ))
        };
        if !(cx < self.radius * cos(half_arc)) || !(hypot(cx, cy) > self.radius) {
            return refuse(
                "a point outside the wall's circle, with x less than radius × cos(half arc)",
            );
        }
        if !(cz > self.height) {
            return refuse("a point higher than the wall");
        }
        // A ray that meets the wall at angle φ and height z has slope (cz - z)/s₁ and reaches the floor after a
        // horizontal length s₂ = z s₁/(cz - z); the chord is 2a cos i. The worst case is the upper rim, z = height.
        let steps = 2048;
        for k in 0..=steps {
            let phi = half_arc * (2.0 * f64::from(k) / f64::from(steps) - 1.0);
            let (nx, ny) = (cos(phi), libm::sin(phi));
            let (dx, dy) = (self.radius * nx - cx, self.radius * ny - cy);
            let s1 = hypot(dx, dy);
            let cos_i = (dx * nx + dy * ny) / s1;
            if !(cos_i > 0.0) {
                return refuse("a point from which the whole inner side of the wall is visible");
            }
            let s2 = self.height * s1 / (cz - self.height);
            let chord = 2.0 * self.radius * cos_i;
            // Where the chord ends: beyond the arc there is no wall to meet.
            let incidence = acos(cos_i.min(1.0));
            let turned = if dx * ny - dy * nx > 0.0 { -1.0 } else { 1.0 };
            let end = phi + turned * (core::f64::consts::PI - 2.0 * incidence);
            let end = libm::atan2(libm::sin(end), cos(end));
            if s2 >= chord && end.abs() <= half_arc * (1.0 + 1e-9) {
                return refuse(
                    "a point of which no ray meets the wall twice (LDSSE would belong to the closure)",
                );
            }
        }
        Ok(())
    }
}
