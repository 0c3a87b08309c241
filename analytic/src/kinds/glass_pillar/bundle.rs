//! The glass pillar's light as bundles of rays: each class, and what side and top keep from the floor.
//!
//! A ray of the beam meets the side at the incidence i and the height z; per di dz the side takes E0 cos ε a cos i. It leaves
//! lower by the chords' drop and lands τ = (height)/tan ε farther. Rays that hit the pillar would have reached the floor
//! z/tan ε behind: one ray per dark point, under the foot or in the shadow.

use core::f64::consts::{FRAC_PI_2, PI};

use super::GlassPillar;
use crate::flux::{Bundle, MARGINS, Ray};

/// Which rays of a glass pillar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlassPart {
    /// Rays that land after this number of interactions ≥ 1 with the side.
    Interactions(u32),
    /// Direct rays that the side stops (negative, LDE).
    StoppedBySide,
    /// Direct rays that the top stops (negative, LDE).
    StoppedByTop,
}

/// Rays of the beam by a glass pillar; the parameters are (i, z) at the side, (φ, r) on the top.
#[derive(Clone, Copy, Debug)]
pub struct GlassRays {
    /// The pillar with its beam.
    pub pillar: GlassPillar<f64>,
    /// Which rays.
    pub part: GlassPart,
}

impl Bundle for GlassRays {
    fn domain(&self) -> [[f64; 2]; 2] {
        match self.part {
            GlassPart::StoppedByTop => [[-PI, PI], [0.0, self.pillar.radius]],
            _ => [[-FRAC_PI_2, FRAC_PI_2], [0.0, self.pillar.height]],
        }
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let g = &self.pillar;
        let a = g.radius;
        let mut margins = [1.0; MARGINS];
        let taken = g.irradiance * g.cos_elevation * a * libm::cos(u[0]);
        let (x, y, flux) = match self.part {
            GlassPart::StoppedByTop => (
                u[1] * libm::cos(u[0]) + g.height / g.slope(),
                u[1] * libm::sin(u[0]),
                -g.irradiance * g.sin_elevation * u[1],
            ),
            GlassPart::StoppedBySide => (
                u[1] / g.slope() - a * libm::cos(u[0]),
                a * libm::sin(u[0]),
                -taken,
            ),
            GlassPart::Interactions(m) => {
                let ray = g.meridian().ray(u[0], m);
                let n = g.effective_index();
                // Plan length in the glass over n'.
                let inside = f64::from(m.max(1) - 1) * 2.0 * a * ray.q / (n * n);
                let tau = u[1] / g.slope() - inside;
                margins[0] = tau;
                let along = a * ray.cos_i + tau;
                let across = a * ray.sin_i;
                (
                    along * ray.cos_d + across * ray.sin_d,
                    across * ray.cos_d - along * ray.sin_d,
                    taken * g.weight(&ray, m),
                )
            }
        };
        Ray {
            floor: [g.x + x, g.y + y],
            flux,
            margins,
        }
    }

    fn weight(&self, u: [f64; 2]) -> Option<f64> {
        let GlassPart::Interactions(m) = self.part else {
            return None;
        };
        let ray = self.pillar.meridian().ray(u[0], m);
        Some(self.pillar.weight(&ray, m))
    }
}
