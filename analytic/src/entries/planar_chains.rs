//! A wedge of two vertical mirrors.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::open_floor::{FloorLight, OpenFloor};
use crate::kinds::planar_chains::Wedge;
use crate::kinds::power;
use crate::scene::{Family, Floor, PlanarChainsScene};

#[derive(Debug)]
struct Corner {
    form: Wedge<f64>,
    light: FloorLight,
    floor: Floor,
    classes: &'static [PathClass],
}

pub(super) fn form(scene: &PlanarChainsScene) -> impl Form + use<> {
    let [x, y, height] = scene.light.position;
    Corner {
        form: Wedge {
            m: scene.wedge.divisor,
            radius: libm::hypot(x, y),
            angle: libm::atan2(y, x),
            height,
            intensity: scene.light.intensity,
            reflectance: scene.wedge.reflectance,
        },
        light: FloorLight::Point {
            position: scene.light.position,
            intensity: scene.light.intensity,
        },
        floor: scene.floor.clone(),
        classes: scene.classes(),
    }
}

impl Form for Corner {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let class = |(bounces, &class): (u32, &PathClass)| {
            let irradiance = match bounces {
                0 => self.form.direct(x, y),
                k => self.form.caustic(x, y, k),
            };
            PointTruth::new(class, irradiance)
        };
        (0..).zip(self.classes).map(class).collect()
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let open = OpenFloor::on(&self.floor, self.light);
        let layer = |bounces: u32| -> Vec<Arc<dyn Bundle>> {
            match bounces {
                0 => vec![Arc::new(open)],
                k => vec![Arc::new(Bounces {
                    form: self.form,
                    floor: open,
                    bounces: k,
                })],
            }
        };
        Some((0..self.classes.len() as u32).map(layer).collect())
    }
}

/// The images of one number of reflections, over the floor: the irradiance is smooth.
#[derive(Debug)]
struct Bounces {
    form: Wedge<f64>,
    floor: OpenFloor,
    bounces: u32,
}

impl Bundle for Bounces {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.floor.region
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let images = self.form.images(u[0], u[1], self.bounces);
        Ray {
            floor: u,
            flux: images.into_iter().flatten().map(|i| i.irradiance).sum(),
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        Some(power(self.form.reflectance, self.bounces))
    }
}
