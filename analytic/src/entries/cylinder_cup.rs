//! A vertical circular wall in the sun.

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::kinds::cylinder_cup::CylinderCup;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::scene::CylinderCupScene;

pub(super) fn form(scene: &CylinderCupScene) -> impl Form + use<> {
    CylinderCup::from_entry(&scene.light, &scene.wall)
}

impl Form for CylinderCup<f64> {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![
            PointTruth::new(PathClass::LDE, self.direct(x, y)),
            PointTruth::new(PathClass::LSDE, self.caustic(x, y, 1)),
        ]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let fold = |distance| Singularity {
            kind: SingularityKind::Fold,
            distance,
        };
        (index == 1).then(|| self.distance_to_fold(x, y, 1).map(fold))?
    }
}
