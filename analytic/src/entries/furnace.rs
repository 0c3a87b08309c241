//! A closed diffuse sphere with a point light inside.

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::kinds::Estimate;
use crate::kinds::diffuse::Sphere;
use crate::scene::{Entry, Family, FurnaceScene, Kind};
use crate::vector::Vec3;

/// The closed form of a furnace's wall.
#[derive(Clone, Debug)]
pub struct WallTruth {
    sphere: Sphere<f64>,
    centre: Vec3<f64>,
    /// From the centre to the light [m].
    light: Vec3<f64>,
    classes: &'static [PathClass],
}

impl WallTruth {
    /// The closed form of an entry that has passed [`Entry::validate`]; `None` for other kinds.
    pub fn new(entry: &Entry) -> Option<Self> {
        match &entry.kind {
            Kind::Furnace(scene) => Some(Self::from(scene)),
            _ => None,
        }
    }

    fn from(scene: &FurnaceScene) -> Self {
        let centre = Vec3::from_f64(scene.wall.center);
        let light = Vec3::from_f64(scene.light.position) - centre;
        WallTruth {
            sphere: Sphere {
                radius: scene.wall.radius,
                offset: light.length(),
                intensity: scene.light.intensity,
                albedo: scene.wall.albedo,
            },
            centre,
            light,
            classes: scene.classes(),
        }
    }

    /// Albedo ρ of the wall: radiance is ρ E/π.
    pub fn albedo(&self) -> f64 {
        self.sphere.albedo
    }

    /// Whether direct light, too, is the same everywhere.
    pub(crate) fn is_centred(&self) -> bool {
        self.sphere.offset == 0.0
    }

    /// The centre [m].
    pub(crate) fn centre(&self) -> Vec3<f64> {
        self.centre
    }

    /// The radius [m].
    pub(crate) fn radius(&self) -> f64 {
        self.sphere.radius
    }

    /// Direct irradiance of the wall point in a direction (of any length) from the centre [W/m²].
    pub(crate) fn direct(&self, direction: Vec3<f64>) -> Estimate<f64> {
        let cosine = if self.is_centred() {
            1.0
        } else {
            // Both factors round: the cosine must not leave [-1, 1].
            let c = direction.normalized().dot(self.light) / self.sphere.offset;
            c.clamp(-1.0, 1.0)
        };
        self.sphere.direct(cosine)
    }

    /// The light at the wall point in a direction (of any length) from the centre, per class.
    pub fn at(&self, direction: Vec3<f64>) -> Vec<PointTruth> {
        let light = |(k, &class): (u32, &PathClass)| {
            let irradiance = if k == 0 {
                self.direct(direction)
            } else {
                self.sphere.bounce(k)
            };
            PointTruth::new(class, irradiance)
        };
        (0..).zip(self.classes).map(light).collect()
    }
}

#[derive(Debug)]
struct NoFloor;

pub(super) fn form(_: &FurnaceScene) -> impl Form + use<> {
    NoFloor
}

impl Form for NoFloor {
    /// No floor, no light there: [`WallTruth`] answers for the wall.
    fn at(&self, _: f64, _: f64) -> Vec<PointTruth> {
        Vec::new()
    }
}
