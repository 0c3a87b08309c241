//! A conic wall under a point light, seen beside it.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::Bundle;
use crate::kinds::conic_wall::ConicWall;
use crate::kinds::conic_wall::bundle::{ConicPart, ConicRays};
use crate::kinds::open_floor::{FloorLight, OpenFloor};
use crate::kinds::singularity::Singularity;
use crate::scene::{ConicWallScene, Floor};
use crate::vector::Vec3;

#[derive(Debug)]
struct Wall {
    form: ConicWall<f64>,
    floor: Floor,
}

pub(super) fn form(scene: &ConicWallScene) -> impl Form + use<> {
    let wall = &scene.wall;
    Wall {
        form: ConicWall {
            x: wall.focus[0],
            y: wall.focus[1],
            axis: wall.axis(),
            parameter: wall.parameter,
            eccentricity: wall.eccentricity,
            half_arc: wall.half_arc(),
            height: wall.height,
            reflectance: wall.reflectance,
            light: Vec3::from_f64(scene.light.position),
            intensity: scene.light.intensity,
        },
        floor: scene.floor.clone(),
    }
}

impl Form for Wall {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![
            PointTruth::new(PathClass::LDE, self.form.direct(x, y)),
            PointTruth::new(PathClass::LSDE, self.form.caustic(x, y)),
        ]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        (index == 1).then(|| self.form.singularity(x, y))?
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let wall = self.form;
        // No point of the wall is farther from the focus than the end of its arc.
        let end = wall.half_arc.unwrap_or(core::f64::consts::PI);
        let farthest = wall.parameter / (1.0 + wall.eccentricity * libm::cos(end));
        let reach = self.floor.farthest([wall.x, wall.y]) + farthest;
        let rays = |part| -> Arc<dyn Bundle> { Arc::new(ConicRays { wall, part, reach }) };
        let light = FloorLight::Point {
            position: [wall.light.x, wall.light.y, wall.light.z],
            intensity: wall.intensity,
        };
        Some(vec![
            vec![
                Arc::new(OpenFloor::on(&self.floor, light)),
                rays(ConicPart::Stopped),
            ],
            vec![rays(ConicPart::Inside), rays(ConicPart::Outside)],
        ])
    }
}
