//! A circular wall under a light inside its circle or on it, seen beside it.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::Bundle;
use crate::kinds::cylinder_cup::CylinderCup;
use crate::kinds::cylinder_cup::bundle::{LampPart, LampRays};
use crate::kinds::open_floor::{FloorLight, OpenFloor};
use crate::kinds::singularity::Singularity;
use crate::scene::{CylinderLampScene, Floor};

#[derive(Debug)]
struct CylinderLamp {
    cup: CylinderCup<f64>,
    rays: LampRays,
    floor: Floor,
}

pub(super) fn form(scene: &CylinderLampScene) -> impl Form + use<> {
    let wall = &scene.wall;
    CylinderLamp {
        cup: CylinderCup::with_lamp(scene),
        rays: LampRays {
            radius: wall.radius,
            height: wall.height,
            half_arc: wall.half_arc_degrees.to_radians(),
            reflectance: wall.reflectance,
            light: scene.light.position(wall.radius),
            intensity: scene.light.intensity,
            part: LampPart::Reflected,
        },
        floor: scene.floor.clone(),
    }
}

impl Form for CylinderLamp {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![
            PointTruth::new(PathClass::LDE, self.cup.direct(x, y)),
            PointTruth::new(PathClass::LSDE, self.cup.caustic(x, y, 1)),
        ]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        (index == 1).then(|| self.cup.singularity(x, y, 1))?
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let rays = |part| -> Arc<dyn Bundle> { Arc::new(LampRays { part, ..self.rays }) };
        let light = FloorLight::Point {
            position: self.rays.light,
            intensity: self.rays.intensity,
        };
        Some(vec![
            vec![
                Arc::new(OpenFloor::on(&self.floor, light)),
                rays(LampPart::Stopped),
            ],
            vec![rays(LampPart::Reflected)],
        ])
    }
}
