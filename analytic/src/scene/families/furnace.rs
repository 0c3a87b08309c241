//! A closed diffuse sphere with a point light inside.

use libm::hypot;
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A closed diffuse sphere with a point light and the camera inside; there is no floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FurnaceScene {
    /// The light.
    pub light: PointLight,
    /// The wall.
    pub wall: SphereWall,
}

/// A closed sphere, Lambertian inside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereWall {
    /// Centre [m].
    pub center: [f64; 3],
    /// Radius a [m].
    pub radius: f64,
    /// Albedo ρ < 1.
    pub albedo: f64,
}

impl SphereWall {
    fn check_inside(&self, key: &str, point: &[f64; 3]) -> Checked {
        let [x, y, z]: [f64; 3] = core::array::from_fn(|i| point[i] - self.center[i]);
        let largest = 0.99 * self.radius;
        if hypot(hypot(x, y), z) <= largest {
            return Ok(());
        }
        Err(invalid(
            key,
            format!("{point:?}"),
            &format!("a point inside the wall, at most {largest} (0.99 radius) from wall.center"),
        ))
    }
}

const fn bounces(count: u8) -> PathClass {
    PathClass {
        diffuse: count,
        ..PathClass::LDE
    }
}

const CLASSES: &[PathClass] = &[PathClass::LDE, bounces(2), bounces(3), bounces(4)];

impl FurnaceScene {
    /// Irradiance by all light that takes longer paths than the listed classes [W/m²]: ρ⁴/(1 - ρ) I/a², the same
    /// everywhere.
    pub fn remainder(&self) -> f64 {
        let (a, albedo) = (self.wall.radius, self.wall.albedo);
        let first = self.light.intensity / (a * a);
        CLASSES.iter().fold(first, |e, _| e * albedo) / (1.0 - albedo)
    }
}

impl Family for FurnaceScene {
    fn name(&self) -> &'static str {
        "furnace"
    }

    fn floor(&self) -> Option<&Floor> {
        None
    }

    fn classes(&self) -> &'static [PathClass] {
        CLASSES
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(5),
            reason: "a closed wall reflects any number of times: paths of six edges and more add albedo^4/(1 - albedo) I/a^2 to the irradiance everywhere",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        coordinates("wall.center", &self.wall.center)?;
        positive("wall.radius", self.wall.radius)?;
        above("wall.albedo", self.wall.albedo, 0.0, 1.0)?;
        // The series over all bounces must have a sum.
        within("wall.albedo", self.wall.albedo, 0.0, 0.999_999)?;
        coordinates("light.position", &self.light.position)?;
        positive("light.intensity", self.light.intensity)?;
        self.wall
            .check_inside("light.position", &self.light.position)?;
        self.wall.check_inside("camera.position", &camera.position)
    }
}
