//! A glass pillar in the sun, seen beside it.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::Bundle;
use crate::kinds::glass_pillar::GlassPillar;
use crate::kinds::glass_pillar::bundle::{GlassPart, GlassRays};
use crate::kinds::open_floor::{FloorLight, OpenFloor};
use crate::kinds::singularity::Singularity;
use crate::scene::{Family, Floor, GlassPillarScene};

#[derive(Debug)]
struct Pillar {
    form: GlassPillar<f64>,
    floor: Floor,
    classes: &'static [PathClass],
}

pub(super) fn form(scene: &GlassPillarScene) -> impl Form + use<> {
    Pillar {
        form: GlassPillar::from_entry(&scene.light, &scene.pillar),
        floor: scene.floor.clone(),
        classes: scene.classes(),
    }
}

impl Form for Pillar {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let form = &self.form;
        let class = |(interactions, &class): (u32, &PathClass)| match interactions {
            0 => PointTruth::new(class, form.direct(x, y)),
            m => PointTruth::new(class, form.caustic(x, y, m)),
        };
        (0..).zip(self.classes).map(class).collect()
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        match index {
            0 => None,
            m if m < self.classes.len() => self.form.singularity(x, y, m as u32),
            _ => None,
        }
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        let pillar = self.form;
        let rays = |part| -> Arc<dyn Bundle> { Arc::new(GlassRays { pillar, part }) };
        let light = FloorLight::Beam {
            irradiance: pillar.irradiance * pillar.sin_elevation,
        };
        let layer = |interactions: u32| match interactions {
            0 => vec![
                Arc::new(OpenFloor::on(&self.floor, light)) as Arc<dyn Bundle>,
                rays(GlassPart::StoppedBySide),
                rays(GlassPart::StoppedByTop),
            ],
            m => vec![rays(GlassPart::Interactions(m))],
        };
        Some((0..self.classes.len() as u32).map(layer).collect())
    }
}
