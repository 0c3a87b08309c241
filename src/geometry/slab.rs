//! A parallel slab of smooth dielectric over the floor, unbounded.
//!
//! A ray that meets the upper surface passes, is reflected 2k times inside, and leaves below in its first direction. Chain
//! k has 2k + 2 interactions. Fresnel factors are computed from the two cosines at an interface.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, GlassSlabScene};

use super::chains::{Chains, Leg, Vertex};
use super::dielectric::reflectance;

/// The slab, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    bottom: f64,
    top: f64,
    index: f64,
    classes: &'static [PathClass],
}

impl Slab {
    /// Prepares a validated scene's slab.
    pub fn new(scene: &GlassSlabScene) -> Self {
        Slab {
            bottom: scene.slab.bottom,
            top: scene.slab.top,
            index: scene.slab.index,
            classes: scene.classes(),
        }
    }

    /// Where a ray with a unit direction, from either side, leaves the slab by a chain, and its weight there.
    fn through(&self, chain: usize, origin: DVec3, d: DVec3) -> (DVec3, f64) {
        let (near, far) = if d.z < 0.0 {
            (self.top, self.bottom)
        } else {
            (self.bottom, self.top)
        };
        let inside = d.x * d.x + d.y * d.y;
        let cosine = f64::sqrt(1.0 - inside / (self.index * self.index));
        let f = reflectance(f64::abs(d.z), cosine, self.index);
        // Across, 2k reflections, across again: thickness × (2k + 1) at the slope inside.
        let passes = 2.0 * chain as f64 + 1.0;
        let entry = origin + d * ((near - origin.z) / d.z);
        let slope = 1.0 / (self.index * cosine);
        let shift = passes * (self.top - self.bottom) * slope;
        let weight = (0..2 * chain).fold((1.0 - f) * (1.0 - f), |w, _| w * f);
        (
            DVec3::new(entry.x + d.x * shift, entry.y + d.y * shift, far),
            weight,
        )
    }
}

impl Chains for Slab {
    const REFRACTS: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let d = direction / f64::sqrt(direction.dot(direction));
        if !(d.z < 0.0) {
            return Leg::DARK;
        }
        let (origin, weight) = self.through(chain, origin, d);
        Leg {
            origin,
            direction: d,
            weight,
        }
    }

    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        if !(f64::abs(direction.z) > 0.0) {
            return None;
        }
        let (point, weight) = self.through(chain, origin, direction);
        let normal = DVec3::new(0.0, 0.0, f64::copysign(1.0, direction.z));
        Some(Vertex {
            point,
            direction,
            normal,
            weight,
        })
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let t = (self.bottom - origin.z) / direction.z;
        (t > 0.0) & (t < t_end)
    }

    /// In the slab a ray is steeper than in air: what is raised by the thickness is seen at least as far from the
    /// vertical.
    fn targets(&self, _: usize, floor: &[DVec3]) -> Vec<DVec3> {
        let raised = DVec3::new(0.0, 0.0, self.top - self.bottom);
        floor.iter().map(|&corner| corner + raised).collect()
    }
}
