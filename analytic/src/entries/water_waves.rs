//! Rippled water, seen from below its surface.

use std::sync::{Arc, OnceLock};

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::singularity::Singularity;
use crate::kinds::water_waves::ripples::Ripples;
use crate::kinds::water_waves::ripples::fold::FoldNetwork;
use crate::scene::{Floor, WaterWavesScene};

#[derive(Clone, Debug)]
struct Pool {
    form: Ripples<f64>,
    floor: Floor,
    /// Made at the first question for a singularity.
    folds: OnceLock<FoldNetwork<f64>>,
}

pub(super) fn form(scene: &WaterWavesScene) -> impl Form + use<> {
    let form = match scene.ripples() {
        Ok(form) => form,
        Err(e) => panic!("the entry has not been validated: {e}"),
    };
    Pool {
        form,
        floor: scene.floor.clone(),
        folds: OnceLock::new(),
    }
}

impl Form for Pool {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        vec![PointTruth::new(PathClass::LSDE, self.form.caustic(x, y))]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let folds = self.folds.get_or_init(|| {
            let region = [0, 1].map(|k| {
                let (center, half) = (self.floor.center[k], self.floor.half_width[k]);
                [center - half, center + half]
            });
            FoldNetwork::new(&self.form, region)
        });
        (index == 0).then(|| folds.nearest([x, y]))?
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        Some(vec![vec![Arc::new(self.clone())]])
    }
}

/// The parameters are where a ray enters the water: smooth through folds and cusps.
impl Bundle for Pool {
    fn domain(&self) -> [[f64; 2]; 2] {
        let reach = self.form.reach();
        [0, 1].map(|k| {
            let (center, half) = (self.floor.center[k], self.floor.half_width[k]);
            [center - half - reach, center + half + reach]
        })
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let ray = self.form.ray(u);
        Ray {
            floor: ray.floor,
            flux: self.form.flux(&ray),
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, u: [f64; 2]) -> Option<f64> {
        Some(self.form.ray(u).transmittance)
    }
}
