//! A lens with its focus near the floor.

use core::f64::consts::TAU;
use std::sync::Arc;

use libm::{cos, hypot, sin};

use super::{Form, PointTruth};
use crate::class::PathClass;
use crate::flux::{Bundle, MARGINS, Ray};
use crate::kinds::singularity::Singularity;
use crate::kinds::stigmatic_refractors::{Front, StigmaticRefractor};
use crate::kinds::{Estimate, rounding_error};
use crate::scene::StigmaticRefractorsScene;

#[derive(Clone, Debug)]
struct Lens {
    form: StigmaticRefractor<f64>,
    axis: [f64; 2],
    /// Tangent of the aperture's half angle, seen from the focus.
    aperture: f64,
}

pub(super) fn form(scene: &StigmaticRefractorsScene) -> impl Form + use<> {
    let lens = &scene.lens;
    Lens {
        form: StigmaticRefractor {
            index: lens.index,
            front: Front::Ellipsoid {
                semi_axis: lens.semi_axis,
                irradiance: scene.light.irradiance,
            },
            defocus: lens.defocus,
        },
        axis: lens.center,
        aperture: lens.aperture(),
    }
}

impl Form for Lens {
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        let (dx, dy) = (x - self.axis[0], y - self.axis[1]);
        let (plan, edge) = (hypot(dx, dy), self.form.defocus.abs() * self.aperture);
        let size = x.abs() + y.abs() + self.axis[0].abs() + self.axis[1].abs();
        let light = self.form.caustic(dx, dy);
        // Coordinates are differences: what they are known to, relative to the distance from the focus.
        let distance = hypot(plan, self.form.defocus);
        let relative = if distance > 0.0 {
            f64::EPSILON * size / distance
        } else {
            0.0
        };
        let mut sum = if plan <= edge {
            light.displaced(relative)
        } else {
            Estimate::NONE
        };
        if f64::abs(plan - edge) <= rounding_error(size + edge, 0.0) && light.value.is_finite() {
            sum.error += light.value;
        }
        vec![PointTruth::new(PathClass::LSDE, sum)]
    }

    fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        let (dx, dy) = (x - self.axis[0], y - self.axis[1]);
        (index == 0).then(|| self.form.singularity(dx, dy))?
    }

    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        Some(vec![vec![Arc::new(self.clone())]])
    }
}

/// Rays by the tangent of their angle from the vertical and by azimuth: smooth through the focus, and even in it.
impl Bundle for Lens {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, self.aperture], [0.0, TAU]]
    }

    fn ray(&self, [tangent, azimuth]: [f64; 2]) -> Ray {
        // A ray from the azimuth has crossed the axis when it is below the focus.
        let shift = -self.form.defocus * tangent;
        let cosine = 1.0 / hypot(1.0, tangent);
        // dΩ = sin t dt dφ with dt = cos² t d(tan t).
        let solid_angle = cosine * cosine * cosine * tangent;
        Ray {
            floor: [
                self.axis[0] + shift * cos(azimuth),
                self.axis[1] + shift * sin(azimuth),
            ],
            flux: self.form.intensity(tangent) * solid_angle,
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, [tangent, _]: [f64; 2]) -> Option<f64> {
        Some(self.form.transmittance(tangent))
    }
}
