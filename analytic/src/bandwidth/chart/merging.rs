//! Photon density estimation: the true irradiance averaged over the kernel, E_r(x) = (k * E)(x), for any class that is known
//! as bundles of rays, folds and any number of bounces included.

use std::sync::Arc;

use libm::sqrt;

use super::connection::Plane;
use super::link::Receiver;
use super::{Integrand, MARGINS, Node};
use crate::bandwidth::kernel::Profile;
use crate::flux::Bundle;

/// The light of a bundle about a floor point.
pub(in crate::bandwidth) struct Merging<'a> {
    bundle: &'a Arc<dyn Bundle>,
    receiver: Receiver,
    x: [f64; 2],
    profile: &'a Profile,
    plane: Plane,
    photons: f64,
}

impl<'a> Merging<'a> {
    pub fn new(
        bundle: &'a Arc<dyn Bundle>,
        receiver: Receiver,
        x: [f64; 2],
        profile: &'a Profile,
        photons: f64,
    ) -> Self {
        Merging {
            bundle,
            receiver,
            x,
            profile,
            plane: Plane::new(profile, receiver.scale()),
            photons,
        }
    }
}

impl Merging<'_> {
    /// Whether the bundle tells the weights of its rays, without which the second moment is not known.
    pub fn is_weighted(&self) -> bool {
        let middle = self.bundle.domain().map(|[a, b]| 0.5 * (a + b));
        self.bundle.weight(middle).is_some()
    }
}

impl Integrand for Merging<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.bundle.domain()
    }

    fn edges(&self) -> &[f64] {
        &self.plane.edges
    }

    fn spans(&self) -> &[f64] {
        &self.plane.spans
    }

    fn rounding(&self) -> f64 {
        let size = f64::abs(self.x[0]) + f64::abs(self.x[1]) + 1.0;
        8.0 * f64::EPSILON * (1.0 + size / self.profile.end)
    }

    fn node(&self, u: [f64; 2]) -> Node {
        let ray = self.bundle.ray(u);
        let mut margins = [1.0; MARGINS];
        margins[..crate::flux::MARGINS].copy_from_slice(&ray.margins);
        for k in 0..2 {
            let half = self.receiver.half_width[k];
            let s = (ray.floor[k] - self.receiver.center[k]) / half;
            // Negative on both sides, and smooth through infinity.
            margins[crate::flux::MARGINS + k] = if s.abs() > 1e8 {
                -1.0
            } else {
                (1.0 - s) * (1.0 + s) / (1.0 + s * s)
            };
        }
        let (level, deflection) = self
            .plane
            .level([ray.floor[0] - self.x[0], ray.floor[1] - self.x[1]]);
        let sample = self.photons * self.bundle.weight(u).unwrap_or(0.0);
        Node {
            level,
            least: f64::NAN,
            deflection,
            density: [ray.flux, ray.flux * sample],
            distance: 0.0,
            margins,
        }
    }

    fn kernel(&self, ring: usize, node: &Node) -> [f64; 2] {
        self.profile.in_ring(ring, sqrt(node.square()))
    }
}
