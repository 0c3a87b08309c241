//! Surfaces that several kinds of scene share, or that are told in a few numbers.

use serde::{Deserialize, Serialize};

/// The Lambertian floor z = 0, clipped to |x - cx| ≤ wx, |y - cy| ≤ wy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floor {
    /// Centre (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Half widths along x and y [m].
    pub half_width: [f64; 2],
    /// Albedo ρ.
    pub albedo: f64,
}

impl Floor {
    /// Distance to the farthest point of the floor from (x, y) [m].
    pub fn farthest(&self, from: [f64; 2]) -> f64 {
        let [dx, dy] = [0, 1].map(|k| f64::abs(from[k] - self.center[k]) + self.half_width[k]);
        libm::hypot(dx, dy)
    }
}

/// A flat rectangular mirror: reflects on its front, absorbs on its back, occludes from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RectangleMirror {
    /// Centre [m].
    pub center: [f64; 3],
    /// Direction of the front, of any length.
    pub normal: [f64; 3],
    /// Direction of one edge, perpendicular to `normal`, of any length.
    pub edge: [f64; 3],
    /// Half of the extent along `edge` [m].
    pub half_width: f64,
    /// Half of the extent along `normal` × `edge` [m].
    pub half_height: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// A vertical arc of a circular cylinder about the z axis, standing on the floor: the points (a cos φ, a sin φ, z) with
/// |φ| ≤ half arc, 0 ≤ z ≤ height. It reflects on its inner side, absorbs on its outer side and occludes from both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcWall {
    /// Radius a [m].
    pub radius: f64,
    /// Height [m].
    pub height: f64,
    /// Half of the arc [degrees]: the wall covers |φ| ≤ this.
    pub half_arc_degrees: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// An unbounded flat water surface, air above and water below; smooth dielectric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height of the surface above the floor [m].
    pub surface_z: f64,
    /// Refractive index n of the water relative to air.
    pub index: f64,
}
