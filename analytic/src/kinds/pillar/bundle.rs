//! The pillar's light as bundles of rays: what its side reflects, and what side and top keep from the floor.
//!
//! A ray of the light meets the side at the angle φ about the axis, between the tangent points ±acos(a/d), and at the height
//! z. Per dφ dz the side takes a I (A - Q)·n/|A - Q|³. Rays that hit the pillar would have reached the floor at
//! A + (Q - A) h/(h - z), in the shadow or under the foot: one ray per dark point.

use core::f64::consts::PI;

use super::Pillar;
use crate::flux::{Bundle, MARGINS, Ray};

/// Which rays of a pillar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PillarPart {
    /// Rays that the side reflects to the floor (LSDE).
    Reflected,
    /// Direct rays that the side stops (negative, LDE).
    StoppedBySide,
    /// Direct rays that the top stops (negative, LDE); none for a light below it.
    StoppedByTop,
}

/// Rays of a point light by a pillar; the parameters are (φ, z) at the side, (φ, r) on the top.
#[derive(Clone, Copy, Debug)]
pub struct PillarRays {
    /// The pillar with its light.
    pub pillar: Pillar<f64>,
    /// Which rays.
    pub part: PillarPart,
    /// Rays may be left out if they go on for more than this in plan after the side [m].
    pub reach: f64,
}

impl PillarRays {
    /// The light from the axis in plan: angle and distance.
    fn light(&self) -> (f64, f64) {
        let p = &self.pillar;
        let (x, y) = (p.light.x - p.x, p.light.y - p.y);
        (libm::atan2(y, x), libm::hypot(x, y))
    }

    /// The ray to the point q at height z stopped there, with its flux.
    fn stopped(&self, (x, y): (f64, f64), z: f64, flux: f64) -> Ray {
        let light = &self.pillar.light;
        let on = light.z / (light.z - z);
        Ray {
            floor: [light.x + (x - light.x) * on, light.y + (y - light.y) * on],
            flux: -flux,
            margins: [1.0; MARGINS],
        }
    }
}

impl Bundle for PillarRays {
    fn domain(&self) -> [[f64; 2]; 2] {
        let p = &self.pillar;
        let (at, d) = self.light();
        if self.part == PillarPart::StoppedByTop {
            let r = if p.light.z > p.height { p.radius } else { 0.0 };
            return [[-PI, PI], [0.0, r]];
        }
        let edge = libm::acos(p.radius / d);
        // From the height h reach/(reach + s1) on, s1 ≥ d - a, the ray goes on for more than the reach.
        let highest = p.light.z * self.reach / (self.reach + d - p.radius);
        [[at - edge, at + edge], [0.0, p.height.min(highest)]]
    }

    fn ray(&self, u: [f64; 2]) -> Ray {
        let p = &self.pillar;
        let (c, s) = (libm::cos(u[0]), libm::sin(u[0]));
        let (h, i) = (p.light.z, p.intensity);
        if self.part == PillarPart::StoppedByTop {
            let q = (p.x + u[1] * c, p.y + u[1] * s);
            let plan = libm::hypot(q.0 - p.light.x, q.1 - p.light.y);
            let distance = libm::hypot(plan, h - p.height);
            let flux = i * (h - p.height) * u[1] / (distance * distance * distance);
            return self.stopped(q, p.height, flux);
        }
        let q = (p.x + p.radius * c, p.y + p.radius * s);
        let (dx, dy) = (q.0 - p.light.x, q.1 - p.light.y);
        let plan = libm::hypot(dx, dy);
        let distance = libm::hypot(plan, h - u[1]);
        // d·n, negative towards the light.
        let approach = dx * c + dy * s;
        let flux = (p.radius * i * -approach / (distance * distance * distance)).max(0.0);
        if self.part == PillarPart::StoppedBySide {
            return self.stopped(q, u[1], flux);
        }
        // The reflected ray comes down over s2 = s1 z/(h - z).
        let on = u[1] / (h - u[1]);
        let (wx, wy) = (dx - 2.0 * approach * c, dy - 2.0 * approach * s);
        Ray {
            floor: [q.0 + on * wx, q.1 + on * wy],
            flux: p.reflectance * flux,
            margins: [1.0; MARGINS],
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        (self.part == PillarPart::Reflected).then_some(self.pillar.reflectance)
    }
}
