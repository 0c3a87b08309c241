//! What a specular surface does to a ray: one trait, so that every integrator is compiled once per kind of surface.

use glam::DVec3;

/// The first meeting of a ray with the specular surface.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// Ray parameter of the meeting; infinite where there is none.
    pub t: f64,
    /// The point met [m]. Meaningless where `t` is infinite.
    pub point: DVec3,
    /// Direction after reflection or refraction, as long as the direction before it.
    pub direction: DVec3,
    /// Reflectance or transmittance; 0 where the surface absorbs (a mirror's back, total internal reflection) and where
    /// nothing is met.
    pub weight: f64,
}

/// A specular surface over the floor.
pub trait Specular: Copy + Send + Sync + 'static {
    /// Whether there is a surface at all.
    const EXISTS: bool = true;
    /// Whether every straight line from the floor to the light or to the camera is interrupted by the surface.
    const SEPARATES: bool = false;

    /// Whether a ray that leaves the surface on its reflecting side can meet it again.
    const MEETS_ITSELF: bool = false;

    /// The first meeting of the ray `origin + t direction`, t > 0.
    fn meet(&self, origin: DVec3, direction: DVec3) -> Meeting;

    /// Whether the surface blocks the ray before `t_end`.
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool;

    /// Points whose convex hull contains the surface [m]; none where the surface is unbounded or absent.
    fn hull(&self) -> Vec<DVec3> {
        Vec::new()
    }

    /// Unit normal of the surface at a meeting, on the side to which the ray goes on.
    fn normal_after(&self, meeting: &Meeting) -> DVec3;

    /// Ray parameter at which a ray that leaves a point of the surface on its reflecting side meets it again; infinite where
    /// it does not.
    fn again(&self, _point: DVec3, _direction: DVec3) -> f64 {
        f64::INFINITY
    }

    /// What radiance is multiplied by, apart from the weight, when it leaves through the surface towards the side of the
    /// camera: 1/n² out of a medium of index n, because L/n² is conserved.
    fn radiance_scale(&self) -> f64 {
        1.0
    }
}

/// No specular surface.
#[derive(Clone, Copy, Debug)]
pub struct Nothing;

impl Specular for Nothing {
    const EXISTS: bool = false;

    #[inline(always)]
    fn meet(&self, origin: DVec3, direction: DVec3) -> Meeting {
        Meeting {
            t: f64::INFINITY,
            point: origin,
            direction,
            weight: 0.0,
        }
    }

    #[inline(always)]
    fn blocks(&self, _: DVec3, _: DVec3, _: f64) -> bool {
        false
    }

    fn normal_after(&self, _: &Meeting) -> DVec3 {
        DVec3::Z
    }
}

/// `direction` mirrored at a plane with unit normal `normal`.
#[inline(always)]
pub fn reflected(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * (2.0 * direction.dot(normal))
}
