//! A flat mirror over the floor.

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::kinds::planar_mirror::PlanarMirror;
use crate::scene::PlanarMirrorScene;
use crate::vector::vec3;

pub(super) fn form(scene: &PlanarMirrorScene) -> impl Form + use<> {
    PlanarMirror::from_entry(&scene.light, &scene.mirror)
}

impl Form for PlanarMirror<f64> {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let point = vec3(x, y, 0.0);
        vec![
            PointTruth::new(PathClass::LDE, self.direct(point)),
            PointTruth::new(PathClass::LSDE, self.caustic(point)),
        ]
    }
}
