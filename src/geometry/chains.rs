//! Surfaces with several chains of specular interactions between light and floor: one trait, so that light tracing and next
//! event estimation are compiled once per kind of surface.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

/// The last leg of a light path, on its way to the floor.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// Where it starts: the light, or the last specular point [m].
    pub origin: DVec3,
    /// Direction, of any length.
    pub direction: DVec3,
    /// Product of the reflectances and transmittances on the way; 0 where the ray does not take the chain, or is stopped
    /// between its last interaction and the plane z = 0.
    pub weight: f64,
}

impl Leg {
    /// No light.
    pub const DARK: Self = Leg {
        origin: DVec3::ZERO,
        direction: DVec3::NEG_Z,
        weight: 0.0,
    };
}

/// Specular surfaces over the floor, none of which is between the camera and the floor that it sees.
pub trait Chains: Copy + Send + Sync + 'static {
    /// The classes of the light that reaches the floor, one for each chain: direct light too, where it exists.
    fn classes(&self) -> &'static [PathClass];

    /// Follows a ray of light along a chain, by its position in [`Chains::classes`]. Fresnel factors are weights: a ray
    /// takes every chain that it can.
    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg;

    /// Whether a surface is in the way of the ray `origin + t direction`, 0 < t < `t_end`.
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool;

    /// Points whose convex hull, seen from the light, contains every direction (or, for parallel light, every ray) that
    /// reaches a part of the floor by a chain; `floor` are the corners of that part.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3>;
}
