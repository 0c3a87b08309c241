//! Smooth specular surfaces on which Newton's method can walk: points to start from, how the surface bends, and a step along
//! it.
//!
//! An interface that knows no coordinates: at each point a walk uses the tangent plane there, in which the surface is
//! p + a t₁ + b t₂ + ½ (a, b) K (a, b)ᵀ n + …; K is the second fundamental form. No surface has a pole, and none needs a
//! parametrisation that is good everywhere.

mod build;
mod patch;
mod quadric;
mod waves;

use glam::DVec3;

pub use build::{Surface, surface};

/// The surface at a point.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Orthonormal tangents, and the unit normal, on either side.
    pub tangents: [DVec3; 2],
    /// The normal.
    pub normal: DVec3,
    /// K₁₁, K₁₂, K₂₂: the second derivatives of the surface along the normal [1/m].
    pub bends: [f64; 3],
}

/// A surface to walk on. It may go on where the specular part ends: what is met there is found out by tracing a ray.
pub trait Manifold: Send + Sync {
    /// A point on it from two uniforms. Its density is not zero on any part that light reaches the floor point `x` from.
    fn start(&self, x: DVec3, u: f64, v: f64) -> DVec3;

    /// The surface at one of its points.
    fn frame(&self, point: DVec3) -> Frame;

    /// The point of it next to `point` + `tangent`; `None` if there is none.
    fn step(&self, point: DVec3, tangent: DVec3) -> Option<DVec3>;
}

/// Two unit vectors that make an orthonormal frame with a unit vector.
pub(crate) fn tangents(normal: DVec3) -> [DVec3; 2] {
    let aside = if f64::abs(normal.z) < 0.6 {
        DVec3::Z
    } else {
        DVec3::X
    };
    let first = super::scene::unit(aside.cross(normal));
    [first, normal.cross(first)]
}
