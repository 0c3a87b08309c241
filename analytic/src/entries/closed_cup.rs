//! A closed circular wall in the sun, its floor seen from above.

use std::sync::Arc;

use libm::{sin, tan};

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::direct::FloorLight;
use crate::flux::{Bundle, MARGINS};
use crate::kinds::cylinder_cup::CylinderCup;
use crate::kinds::cylinder_cup::beam_bundle::BeamRays;
use crate::kinds::singularity::Singularity;
use crate::scene::{ClosedCupScene, Family, Floor};

#[derive(Debug)]
struct ClosedCup {
    cup: CylinderCup<f64>,
    classes: &'static [PathClass],
    /// Of light without a reflection.
    rays: BeamRays,
    /// Plan length along which light comes down from the rim to the floor, H/tan ε [m].
    descent: f64,
    floor: Floor,
}

pub(super) fn form(scene: &ClosedCupScene) -> impl Form + use<> {
    let elevation = scene.light.elevation_degrees.to_radians();
    ClosedCup {
        cup: CylinderCup::closed(&scene.light, &scene.wall),
        classes: scene.classes(),
        rays: BeamRays {
            radius: scene.wall.radius,
            depth: scene.depth(),
            irradiance: scene.light.irradiance * sin(elevation),
            weight: 1.0,
            bounces: 0,
            extent: scene.extent(),
        },
        descent: scene.wall.height / tan(elevation),
        floor: scene.floor.clone(),
    }
}

impl ClosedCup {
    /// Direct light: inside the near rim's shadow curve, which is the circle displaced along the beam.
    fn direct(&self) -> Arc<dyn Bundle> {
        let (a, shift, irradiance) = (self.rays.radius, self.descent, self.rays.irradiance);
        Arc::new(FloorLight::new(&self.floor, move |x, y| {
            let mut margins = [1.0; MARGINS];
            margins[0] = 1.0 - ((x - shift) * (x - shift) + y * y) / (a * a);
            (irradiance, margins)
        }))
    }
}

impl Form for ClosedCup {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let point = |&class: &PathClass| match class.light.len() as u32 {
            0 => PointTruth::new(class, self.cup.direct(x, y)),
            k => PointTruth::new(class, self.cup.caustic(x, y, k)),
        };
        self.classes.iter().map(point).collect()
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        match self.classes.get(index)?.light.len() as u32 {
            0 => None,
            k => self.cup.singularity(x, y, k),
        }
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let light = |class: &PathClass| -> Vec<Arc<dyn Bundle>> {
            let bounces = class.light.len() as u32;
            if bounces == 0 {
                return vec![self.direct()];
            }
            let weight = (0..bounces).fold(1.0, |w, _| w * self.cup.reflectance);
            vec![Arc::new(BeamRays {
                irradiance: self.rays.irradiance * weight,
                weight,
                bounces,
                ..self.rays
            })]
        };
        Some(self.classes.iter().map(light).collect())
    }
}
