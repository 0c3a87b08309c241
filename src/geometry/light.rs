//! Lights: what next event estimation and a regularized connection ask of them.

use glam::DVec3;

use super::emission::{Beam, Cap, Cone, Emitter};
use super::tracer::Emission;

/// A light that illuminates a point from one direction.
pub trait Light: Copy + Send + Sync + 'static {
    /// Whether its light is parallel.
    const IS_DISTANT: bool;
    /// How photons start.
    type Emitter: Emitter + Into<Emission>;
    /// How photons start that are aimed at one thing.
    type Narrow: Emitter + Into<Emission>;

    /// Photons over everything that can reach the convex hull of `targets`, and little else.
    fn aimed(&self, targets: &[DVec3]) -> Self::Emitter;

    /// Photons over the smallest cone (or beam) about the convex hull of `targets`; nothing that is to stand in their way is
    /// higher than `highest` [m].
    fn narrow(&self, targets: &[DVec3], highest: f64) -> Self::Narrow;

    /// Photons with the density of the tables of expectations: over the whole sphere from a point light; over a
    /// cross-section that covers the targets from a directional one.
    fn unaimed(&self, targets: &[DVec3]) -> Self::Emitter;

    /// The same where nothing that stands in the photons' way is higher than `highest` [m].
    fn spread(&self, targets: &[DVec3], highest: f64) -> Self::Emitter;

    /// Photons over everything below a point light, or a cross-section of a directional one that covers the targets: for a
    /// surface without bounds.
    fn downwards(&self, targets: &[DVec3]) -> Self::Emitter;

    /// Direction from a point towards the light (not normalised) and the ray parameter of the light along it.
    fn towards(&self, point: DVec3) -> (DVec3, f64);

    /// Where it is [m]; `None` if its light is parallel.
    fn position(&self) -> Option<DVec3>;

    /// Irradiance on a plane perpendicular to the light's direction, at a point from which `towards` gave `direction`
    /// [W/m²]: I/d² or E₀.
    fn normal_irradiance(&self, direction: DVec3) -> f64;
}

/// An isotropic point light.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Position [m].
    pub position: DVec3,
    /// Radiant intensity [W/sr].
    pub intensity: f64,
}

impl Light for Point {
    const IS_DISTANT: bool = false;
    type Emitter = Cap;
    type Narrow = Cone;

    fn position(&self) -> Option<DVec3> {
        Some(self.position)
    }

    fn aimed(&self, targets: &[DVec3]) -> Cap {
        self.towards_hull(targets)
    }

    fn narrow(&self, targets: &[DVec3], _: f64) -> Cone {
        self.cone(targets)
    }

    fn unaimed(&self, _: &[DVec3]) -> Cap {
        self.everywhere()
    }

    fn spread(&self, _: &[DVec3], _: f64) -> Cap {
        self.everywhere()
    }

    fn downwards(&self, _: &[DVec3]) -> Cap {
        self.lower_hemisphere()
    }

    #[inline(always)]
    fn towards(&self, point: DVec3) -> (DVec3, f64) {
        (self.position - point, 1.0)
    }

    #[inline(always)]
    fn normal_irradiance(&self, direction: DVec3) -> f64 {
        self.intensity / direction.dot(direction)
    }
}

/// A directional light.
#[derive(Clone, Copy, Debug)]
pub struct Directional {
    /// Unit direction in which the light travels.
    pub travel: DVec3,
    /// Irradiance on a plane perpendicular to the beam [W/m²].
    pub irradiance: f64,
}

impl Light for Directional {
    const IS_DISTANT: bool = true;
    type Emitter = Beam;
    type Narrow = Beam;

    fn position(&self) -> Option<DVec3> {
        None
    }

    fn aimed(&self, targets: &[DVec3]) -> Beam {
        self.towards_hull(targets)
    }

    fn narrow(&self, targets: &[DVec3], highest: f64) -> Beam {
        self.beam(targets, highest)
    }

    fn unaimed(&self, targets: &[DVec3]) -> Beam {
        self.towards_hull(targets)
    }

    fn spread(&self, targets: &[DVec3], highest: f64) -> Beam {
        self.beam(targets, highest)
    }

    fn downwards(&self, targets: &[DVec3]) -> Beam {
        self.towards_hull(targets)
    }

    #[inline(always)]
    fn towards(&self, _: DVec3) -> (DVec3, f64) {
        (-self.travel, f64::INFINITY)
    }

    #[inline(always)]
    fn normal_irradiance(&self, _: DVec3) -> f64 {
        self.irradiance
    }
}
