//! Flat water, seen from below its surface: the floor itself, without a second refraction.

use std::sync::Arc;

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::flat_interface::FlatInterface;
use crate::scene::{Floor, UnderwaterScene};

#[derive(Clone, Debug)]
struct Underwater {
    form: FlatInterface<f64>,
    floor: Floor,
}

pub(super) fn form(scene: &UnderwaterScene) -> impl Form + use<> {
    Underwater {
        form: FlatInterface::from_entry(&scene.light, &scene.water),
        floor: scene.floor.clone(),
    }
}

impl Form for Underwater {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let caustic = self.form.caustic(x, y);
        vec![PointTruth::new(PathClass::LSDE, caustic)]
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        Some(vec![vec![Arc::new(self.clone())]])
    }
}

/// The parameter is the floor point itself: one root, and a smooth irradiance.
impl Bundle for Underwater {
    fn domain(&self) -> [[f64; 2]; 2] {
        let ([cx, cy], [wx, wy]) = (self.floor.center, self.floor.half_width);
        [[cx - wx, cx + wx], [cy - wy, cy + wy]]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        Ray {
            floor: u,
            flux: self.form.root(u[0], u[1]).irradiance,
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, u: [f64; 2]) -> Option<f64> {
        Some(self.form.root(u[0], u[1]).weight)
    }
}
