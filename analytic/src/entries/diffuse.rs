//! A floor under a point light.

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::kinds::diffuse;
use crate::scene::DiffuseScene;
use crate::vector::{Vec3, vec3};

#[derive(Debug)]
struct Direct {
    light: Vec3<f64>,
    intensity: f64,
}

pub(super) fn form(scene: &DiffuseScene) -> impl Form + use<> {
    Direct {
        light: Vec3::from_f64(scene.light.position),
        intensity: scene.light.intensity,
    }
}

impl Form for Direct {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let direct = diffuse::direct(self.light, self.intensity, vec3(x, y, 0.0));
        vec![PointTruth::new(PathClass::LDE, direct)]
    }
}
