//! Light of a known irradiance, as a bundle whose parameters are the floor point.

use core::fmt::{self, Debug, Formatter};

use crate::flux::{Bundle, MARGINS, Ray};
use crate::scene::Floor;

/// A bundle from an irradiance.
pub struct FloorLight<F> {
    domain: [[f64; 2]; 2],
    irradiance: F,
    weight: Option<f64>,
}

impl<F> FloorLight<F>
where
    F: Fn(f64, f64) -> (f64, [f64; MARGINS]) + Send + Sync,
{
    /// Light with the irradiance [W/m²] at (x, y) and the margins of being lit; see [`Ray::margins`].
    pub fn new(floor: &Floor, irradiance: F) -> Self {
        FloorLight {
            domain: [0, 1].map(|k| {
                let (center, half) = (floor.center[k], floor.half_width[k]);
                [center - half, center + half]
            }),
            irradiance,
            weight: None,
        }
    }

    /// The same light, known to have lost all but this part of its flux on the way.
    pub fn with_weight(self, weight: f64) -> Self {
        FloorLight {
            weight: Some(weight),
            ..self
        }
    }
}

impl<F> Debug for FloorLight<F> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("FloorLight")
            .field("domain", &self.domain)
            .finish_non_exhaustive()
    }
}

impl<F> Bundle for FloorLight<F>
where
    F: Fn(f64, f64) -> (f64, [f64; MARGINS]) + Send + Sync,
{
    fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let (flux, margins) = (self.irradiance)(u[0], u[1]);
        Ray {
            floor: u,
            flux,
            margins,
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        self.weight
    }
}
