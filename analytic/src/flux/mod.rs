//! Exact pixels by conservation of flux, for any light that ends on the floor z = 0 seen directly.
//!
//! Light of one path class is a two-parameter family of rays (`theory/scenes.md`, 0.1): a ray carries flux and lands
//! somewhere. A pixel's radiance is the flux of the rays that land in it, times the film's area per floor area. In the
//! parameters that is the integral of a smooth function even where the irradiance has a fold, a cusp or a focus; what is
//! left to be exact about is the region of integration.

pub mod direct;

use core::fmt::Debug;
use std::sync::Arc;

use crate::camera::Bounded;
use crate::scene::{Camera, Floor};

/// Number of margins of a ray.
pub const MARGINS: usize = 8;

/// Where a ray of a bundle lands, and what it carries there.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Floor point (x, y) [m].
    pub floor: [f64; 2],
    /// Flux that lands per unit of parameter area [W per unit of u0 u1], ≥ 0 (negative only in a bundle that stands for a
    /// shadow which is subtracted), specular weights included; smooth.
    pub flux: f64,
    /// The ray exists where every margin is ≥ 0; each is a smooth function of the parameters that changes sign where its
    /// condition does. Unused ones are 1.
    pub margins: [f64; MARGINS],
}

/// Light of one path class as a two-parameter family of rays.
pub trait Bundle: Debug + Send + Sync {
    /// Rectangle of the parameters, [[low, high]; 2].
    fn domain(&self) -> [[f64; 2]; 2];
    /// The ray of a parameter pair inside the domain. Where a margin is negative the floor point and the flux may be
    /// anything finite or NaN.
    fn ray(&self, u: [f64; 2]) -> Ray;
}

/// The image: one layer per path class, each the sum of several bundles (also shadows with negative flux).
#[derive(Clone, Debug)]
pub struct FluxImage {
    layers: Vec<Vec<Arc<dyn Bundle>>>,
}

impl FluxImage {
    /// Prepares the image of a validated camera and floor.
    pub fn new(_camera: &Camera, _floor: &Floor, layers: Vec<Vec<Arc<dyn Bundle>>>) -> Self {
        FluxImage { layers }
    }

    /// Row `j`, `[class][column]`: the mean radiance over the pixel [W m⁻² sr⁻¹] with its error estimate, to a relative
    /// tolerance.
    pub fn row(&self, _j: u32, _tolerance: f64, row: &mut [Vec<Bounded>]) {
        for (_, out) in self.layers.iter().zip(row) {
            out.fill(Bounded::default());
        }
    }
}
