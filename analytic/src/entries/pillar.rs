//! A mirror pillar under a point light, seen beside it.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::Bundle;
use crate::kinds::open_floor::{FloorLight, OpenFloor};
use crate::kinds::pillar::Pillar;
use crate::kinds::pillar::bundle::{PillarPart, PillarRays};
use crate::scene::{Floor, PillarScene};
use crate::vector::Vec3;

#[derive(Debug)]
struct MirrorPillar {
    form: Pillar<f64>,
    floor: Floor,
}

pub(super) fn form(scene: &PillarScene) -> impl Form + use<> {
    let [x, y] = scene.pillar.center;
    MirrorPillar {
        form: Pillar {
            x,
            y,
            radius: scene.pillar.radius,
            height: scene.pillar.height,
            reflectance: scene.pillar.reflectance,
            light: Vec3::from_f64(scene.light.position),
            intensity: scene.light.intensity,
        },
        floor: scene.floor.clone(),
    }
}

impl Form for MirrorPillar {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![
            PointTruth::new(PathClass::LDE, self.form.direct(x, y)),
            PointTruth::new(PathClass::LSDE, self.form.caustic(x, y)),
        ]
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let pillar = self.form;
        let rays = |part| -> Arc<dyn Bundle> {
            Arc::new(PillarRays {
                pillar,
                part,
                reach: self.floor.farthest([pillar.x, pillar.y]) + pillar.radius,
            })
        };
        let light = FloorLight::Point {
            position: [pillar.light.x, pillar.light.y, pillar.light.z],
            intensity: pillar.intensity,
        };
        let mut direct: Vec<Arc<dyn Bundle>> = vec![
            Arc::new(OpenFloor::on(&self.floor, light)),
            rays(PillarPart::StoppedBySide),
        ];
        if pillar.light.z > pillar.height {
            direct.push(rays(PillarPart::StoppedByTop));
        }
        Some(vec![direct, vec![rays(PillarPart::Reflected)]])
    }
}
