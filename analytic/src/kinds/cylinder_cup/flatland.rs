//! The cup in two dimensions (d = 1): a half circle of mirror, a beam of width 2a, and a receiver line x = const.
//!
//! The fluence is the ray density Σ E0 R a cos φ/|a cos φ - 2τ| [W/m] of one bounce; the line with normal ±x receives
//! E = Σ f |cos θ| (theory block G: light from either side of the line counts).

use super::{Beam, CylinderCup, Light, Root, Wall};
use crate::kinds::Estimate;
use crate::scalar::Scalar;

/// The flatland cup: the half circle x > 0, a beam along +x.
#[derive(Clone, Copy, Debug)]
pub struct Flatland<S> {
    cup: CylinderCup<S>,
}

impl<S: Scalar> Flatland<S> {
    /// `radius` a [m], `irradiance` E0 of the beam [W/m], reflectance R.
    pub fn new(radius: S, irradiance: S, reflectance: S) -> Self {
        Flatland {
            cup: CylinderCup {
                wall: Wall {
                    radius,
                    height: None,
                    cos_half_arc: Some(S::ZERO),
                },
                reflectance,
                // Seen from above: the density on the plane itself.
                light: Light::Beam(Beam {
                    irradiance,
                    sin_elevation: S::ONE,
                    cos_elevation: S::ONE,
                }),
            },
        }
    }

    /// Visits the rays through (x, y) with their fluence [W/m] (`irradiance` of the root) and the irradiance of the line
    /// x = const there [W/m].
    pub fn for_each_root(&self, x: S, y: S, mut visit: impl FnMut(Root<S>, S)) {
        self.cup.for_each_lit_root(x, y, 1, |root| {
            visit(root, root.irradiance * root.cos_theta.abs())
        });
    }

    /// Fluence and irradiance of the line x = const at (x, y) [W/m].
    pub fn caustic(&self, x: S, y: S) -> (Estimate<S>, Estimate<S>) {
        let (mut fluence, mut line) = (Estimate::NONE, Estimate::NONE);
        let scale = self.cup.wall.radius.max(x.hypot(y));
        self.for_each_root(x, y, |root, e| {
            let conditioning = self.cup.conditioning(x, y, 1, &root);
            // θ = 2φ + π turns by 2/J per length.
            let turn = S::from_f64(6.0) * scale / root.spread.abs();
            let cosine = turn * (root.sin_theta / root.cos_theta).abs();
            fluence.add(root.irradiance, conditioning);
            line.add(e, conditioning + cosine);
            if root.touching {
                fluence.error = S::ONE / S::ZERO;
                line.error = S::ONE / S::ZERO;
            }
        });
        (fluence, line)
    }
}

impl Flatland<f64> {
    /// Distance [m] from (x, y) to the caustic.
    pub fn distance_to_fold(&self, x: f64, y: f64) -> Option<f64> {
        self.cup.distance_to_fold(x, y, 1)
    }
}
