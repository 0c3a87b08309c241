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

/// A specular vertex at which a path can be mollified: the path is traced exactly up to it.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Where it is [m].
    pub point: DVec3,
    /// Unit direction in which the exact path goes on.
    pub direction: DVec3,
    /// Unit normal on the side to which the path goes on.
    pub normal: DVec3,
    /// Product of the reflectances and transmittances on the way and at the vertex, at the angles of the traced ray.
    pub weight: f64,
}

/// Specular surfaces over the floor, none of which is between the camera and the floor that it sees.
pub trait Chains: Copy + Send + Sync + 'static {
    /// Whether an interaction of unspecified kind, `S`, next to the light is a refraction.
    const REFRACTS: bool = false;

    /// Whether a ray that leaves a vertex on the side of its normal can meet a surface again.
    const MEETS_ITSELF: bool = false;

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

    /// Follows a ray of light along a chain up to its last interaction, whatever is in the way after that; `None` where the
    /// ray does not take the chain, or no light is left. Directions are unit vectors.
    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex>;

    /// Follows a ray from the floor backwards along a chain up to the interaction next to the light, whatever is in the way
    /// after that. Surfaces that treat a ray from below as one from above have this for nothing.
    fn trace_back(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        self.strike(chain, origin, direction)
    }

    /// The first reflection of a ray, whatever comes after it: what a chain of vertices that are all mollified is made of.
    /// `None` where there is none, and for surfaces that are not plane mirrors.
    fn reflection(&self, _origin: DVec3, _direction: DVec3) -> Option<Vertex> {
        None
    }

    /// Ray parameter at which a ray that leaves a vertex on the side of its normal meets a surface again; infinite where it
    /// does not.
    fn again(&self, _vertex: &Vertex, _direction: DVec3) -> f64 {
        f64::INFINITY
    }

    /// The smallest axis-parallel box about the surfaces: its low and its high corner [m]. `None` if they are unbounded.
    fn bounds(&self) -> Option<[DVec3; 2]>;

    /// What radiance is multiplied by between the light and the floor, apart from the weights: n² into a medium of index n,
    /// because L/n² is conserved.
    fn radiance_gain(&self) -> f64 {
        1.0
    }

    /// Points whose convex hull contains every first vertex of parallel light that a kernel of angle `alpha` can send to the
    /// floor point `x`. `None` if that is no bounded part of the surfaces.
    fn exposed(&self, _x: DVec3, _alpha: f64) -> Option<Vec<DVec3>> {
        self.bounds().map(corners)
    }
}

/// The corners of a box.
pub fn corners([low, high]: [DVec3; 2]) -> Vec<DVec3> {
    let corner = |k: usize| {
        let pick = |axis: usize| if k >> axis & 1 == 0 { low } else { high };
        DVec3::new(pick(0).x, pick(1).y, pick(2).z)
    };
    (0..8).map(corner).collect()
}

/// The smallest axis-parallel box about points; `None` without a point.
pub fn bounding_box(points: &[DVec3]) -> Option<[DVec3; 2]> {
    let first = *points.first()?;
    let around = |[low, high]: [DVec3; 2], &p: &DVec3| [low.min(p), high.max(p)];
    Some(points.iter().fold([first; 2], around))
}
