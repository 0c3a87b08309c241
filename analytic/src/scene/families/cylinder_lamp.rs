//! A vertical circular wall under a point light inside its circle, or on it.
//!
//! **One reflection.** A ray that the wall reflects at the height z ≤ H goes on for s2 = s1 z/(h - z) in plan before it is
//! on the floor. The line of the ray cuts the circle in a chord 2a cos i of which s1 is a part, for a light inside the
//! circle, and the reflected ray has a chord of the same length before it. So h > 2H, hence s2 < s1 ≤ 2a cos i, is enough
//! for any arc: the light is on the floor before it meets the circle again, and it lands inside.

use libm::{cos, sin};
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::frame::Frame;
use crate::scene::ranges::{Checked, LARGEST, above, positive, within};
use crate::scene::{ArcWall, Camera, Closure, Family, Floor};

/// A vertical circular wall on the floor under a point light, outside the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CylinderLampScene {
    /// The light, inside the wall's circle or on it.
    pub light: CircleLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror; its half arc may be up to 180 degrees, a closed wall.
    pub wall: ArcWall,
}

/// An isotropic point light inside a wall's circle or on it, placed from the circle: only so is it on it exactly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CircleLight {
    /// Angle about the axis from +x [degrees].
    pub azimuth_degrees: f64,
    /// Distance from the circle towards the axis [m]: 0 on the circle, or from a hundredth of the radius up to all of it.
    #[serde(default)]
    pub inset: f64,
    /// Height above the floor [m].
    pub height: f64,
    /// Radiant intensity [W/sr], the same in every direction.
    pub intensity: f64,
}

impl CircleLight {
    /// Position, for a circle of a radius [m] about the z axis.
    pub fn position(&self, radius: f64) -> [f64; 3] {
        let azimuth = self.azimuth_degrees.to_radians();
        let r = radius - self.inset;
        [r * cos(azimuth), r * sin(azimuth), self.height]
    }
}

/// Smallest distance from the circle that is not 0, in radii: next to a wall the truth has no bound.
const NEAREST: f64 = 0.01;

impl Family for CylinderLampScene {
    fn name(&self) -> &'static str {
        "cylinder-lamp"
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
            reason: "a vertical wall keeps the sign of the vertical direction; light meets it once at most, and it is not in the frame (both checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        let (light, wall) = (&self.light, &self.wall);
        positive("wall.radius", wall.radius)?;
        positive("wall.height", wall.height)?;
        above("wall.half_arc_degrees", wall.half_arc_degrees, 0.0, 180.0)?;
        above("wall.reflectance", wall.reflectance, 0.0, 1.0)?;
        positive("light.intensity", light.intensity)?;
        within(
            "light.azimuth_degrees",
            light.azimuth_degrees,
            -360.0,
            360.0,
        )?;
        if light.inset != 0.0 {
            within(
                "light.inset",
                light.inset,
                NEAREST * wall.radius,
                wall.radius,
            )?;
        }
        above("light.height", light.height, 2.0 * wall.height, LARGEST).map_err(|e| {
            crate::scene::InvalidParameter {
                allowed: format!(
                    "{}: more than twice the wall's, so that light meets the wall once",
                    e.allowed
                ),
                ..e
            }
        })?;
        check_wall_beside(wall.radius, wall.half_arc_degrees, wall.height, camera)
    }
}

/// Pieces of the arc that are each beside the frame.
const PIECES: u32 = 48;

/// Checks that no ray of the frame meets the wall over the arc |φ| ≤ half arc of a circle about the z axis.
pub(super) fn check_wall_beside(
    radius: f64,
    half_arc_degrees: f64,
    height: f64,
    camera: &Camera,
) -> Checked {
    let frame = Frame::new(camera);
    let step = 2.0 * half_arc_degrees.to_radians() / f64::from(PIECES);
    for k in 0..PIECES {
        // The piece is in the convex hull of its ends and of the point where the tangents there meet.
        let middle = step * (f64::from(k) + 0.5 - 0.5 * f64::from(PIECES));
        let tip = radius / cos(0.5 * step);
        let corners = [(-0.5, radius), (0.5, radius), (0.0, tip)].map(|(side, r)| {
            let angle = middle + side * step;
            [r * cos(angle), r * sin(angle)]
        });
        frame.check_beside("the wall", |n| {
            let plan = corners.map(|[x, y]| n[0] * x + n[1] * y);
            plan.into_iter().fold(f64::NEG_INFINITY, f64::max) + (n[2] * height).max(0.0)
        })?;
    }
    Ok(())
}
