//! A vertical wall all around a floor, in the sun: the deep cup.
//!
//! Light comes in over the near rim. With T = tan ε, the ray that first meets the wall at the angle φ and the height z has
//! passed the near rim at z + 2a cos φ T ≥ H, and comes down by 2a cos φ T along every chord: on the floor it has been
//! reflected k times,
//!
//! ```text
//! k - 1 < z/(2a cos φ T) ≤ k,     η/cos φ - 1 ≤ z/(2a cos φ T) ≤ η/cos φ,     η = H/(2aT).
//! ```
//!
//! **The classes are all there is.** All chords of the ray pass the axis at a |sin φ|, so that it lands no nearer. A floor
//! that reaches to ρa from the axis is met by rays with cos φ ≥ √(1 - ρ²) only, hence k ≤ ⌈η/√(1 - ρ²)⌉; and k ≥ ⌊η⌋. Light
//! of more reflections exists, and falls between the floor and the wall: there is no tail to bound.

use libm::{ceil, floor, sqrt, tan};
use serde::{Deserialize, Serialize};

use super::cylinder_lamp::check_wall_beside;
use crate::class::{MAX_CHAIN, PathClass};
use crate::scene::ranges::{Checked, above, invalid, positive};
use crate::scene::{Camera, Closure, DirectionalLight, Family, Floor};

/// A closed circular wall under a directional light, its floor seen from above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClosedCupScene {
    /// The light.
    pub light: DirectionalLight,
    /// The receiver, inside the wall.
    pub floor: Floor,
    /// The mirror.
    pub wall: ClosedWall,
}

/// A vertical wall all around the z axis, standing on the plane of the floor. It reflects on its inner side, absorbs on its
/// outer side and occludes from both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClosedWall {
    /// Radius a [m].
    pub radius: f64,
    /// Height H [m].
    pub height: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// L S^k D E.
const ALL: [PathClass; MAX_CHAIN + 1] = {
    let mut all = [PathClass::LDE; MAX_CHAIN + 1];
    let mut k = 0;
    while k <= MAX_CHAIN {
        all[k] = PathClass::new(k, 0);
        k += 1;
    }
    all
};

/// Largest distance of the floor from the axis, in radii.
const FARTHEST: f64 = 0.99;

impl ClosedCupScene {
    /// Distance of the floor's farthest point from the axis, in radii.
    pub fn extent(&self) -> f64 {
        self.floor.farthest([0.0, 0.0]) / self.wall.radius
    }

    /// Height of the wall by what a ray through the axis comes down from side to side, η = H/(2a tan ε).
    pub fn depth(&self) -> f64 {
        let slope = tan(self.light.elevation_degrees.to_radians());
        self.wall.height / (2.0 * self.wall.radius * slope)
    }

    /// The fewest and the most reflections of light on the floor.
    fn reflections(&self) -> (f64, f64) {
        let (depth, extent) = (self.depth(), self.extent());
        let least = floor(depth).max(0.0);
        (least, ceil(depth / sqrt(1.0 - extent * extent)))
    }
}

impl Family for ClosedCupScene {
    fn name(&self) -> &'static str {
        "closed-cup"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    /// `L S^k D E` for every number k of reflections that light on the floor can have.
    fn classes(&self) -> &'static [PathClass] {
        let (least, most) = self.reflections();
        let last = (most.min(MAX_CHAIN as f64)) as usize;
        ALL.get(least as usize..=last).unwrap_or(&ALL[..1])
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "a vertical wall keeps the sign of the vertical direction, and is not in the frame (checked); light with more reflections exists, but falls between the floor and the wall",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        let wall = &self.wall;
        positive("wall.radius", wall.radius)?;
        positive("wall.height", wall.height)?;
        above("wall.reflectance", wall.reflectance, 0.0, 1.0)?;
        if !(self.extent() <= FARTHEST) {
            return Err(invalid(
                "floor.half_width",
                format!("{:?}", self.floor.half_width),
                &format!(
                    "a floor with no point farther than {} ({FARTHEST} radii) from the wall's axis",
                    FARTHEST * wall.radius
                ),
            ));
        }
        let most = self.reflections().1;
        if !(most <= MAX_CHAIN as f64) {
            return Err(invalid(
                "wall.height",
                wall.height,
                &format!(
                    "a wall so low, for its floor and sun, that light is reflected {MAX_CHAIN} times at most ({most} here)"
                ),
            ));
        }
        check_wall_beside(wall.radius, 180.0, wall.height, camera)
    }
}
