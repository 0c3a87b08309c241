//! Flat water, seen from above.

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::kinds::flat_interface::FlatInterface;
use crate::scene::FlatInterfaceScene;

pub(super) fn form(scene: &FlatInterfaceScene) -> impl Form + use<> {
    FlatInterface::from_entry(&scene.light, &scene.water)
}

impl Form for FlatInterface<f64> {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![PointTruth::new(PathClass::LSDE, self.caustic(x, y))]
    }
}
