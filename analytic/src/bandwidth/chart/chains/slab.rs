//! Chains through a glass slab: both sides of it, and an even number of reflections inside.
//!
//! A path from one end, at the height h over (or under) the slab, meets its far side for the last time at the plan distance
//! h p/q + (2k+1) t p/q', p = sin θ in air, q = cos θ, q' = √(n² − p²), and leaves parallel to itself. Planes are unbounded and
//! both ends are in air: nothing is in the way, and no critical angle is met.

use libm::sqrt;

use super::{UP, direction};
use crate::bandwidth::chart::chain::{Chain, OWN, Subpath, Subpaths};
use crate::kinds::power;
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scene;
use crate::vector::{Vec3, vec3};

/// Light after two refractions and `inside` reflections between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slab {
    bottom: f64,
    top: f64,
    index: f64,
    inside: u32,
    light: Vec3<f64>,
    intensity: f64,
}

impl Slab {
    pub fn new(
        slab: &scene::Slab,
        (light, intensity): (Vec3<f64>, f64),
        interactions: u32,
    ) -> Self {
        Slab {
            bottom: slab.bottom,
            top: slab.top,
            index: slab.index,
            inside: interactions.saturating_sub(2),
            light,
            intensity,
        }
    }
}

impl Chain for Slab {
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>> {
        Some(Box::new(Paths {
            slab: self,
            origin: x,
            up: UP,
            gap: self.bottom - x.z,
            exit: self.top,
            intensity: None,
        }))
    }

    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a> {
        Box::new(Paths {
            slab: self,
            origin: self.light,
            up: -UP,
            gap: self.light.z - self.top,
            exit: self.bottom,
            intensity: Some(self.intensity),
        })
    }

    fn is_mirror(&self) -> bool {
        false
    }
}

/// Paths to the far side by their directions.
#[derive(Debug)]
struct Paths<'a> {
    slab: &'a Slab,
    origin: Vec3<f64>,
    /// Unit vector towards the slab.
    up: Vec3<f64>,
    /// Air before the slab [m].
    gap: f64,
    /// Height of the far side [m].
    exit: f64,
    /// Of the light; `None` for a receiver point.
    intensity: Option<f64>,
}

impl Subpaths for Paths<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-1.0, 1.0]; 2]
    }

    fn path(&self, u: [f64; 2]) -> Subpath {
        let slab = self.slab;
        let frame = [vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), self.up];
        let (d, solid_angle, _) = direction(&frame, u);
        let n = slab.index;
        let q = d.dot(self.up);
        let inner = sqrt((n - 1.0) * (n + 1.0) + q * q);
        let glass = f64::from(slab.inside + 1) * (slab.top - slab.bottom);
        let on = self.gap / q + glass / inner;
        let t = fresnel_transmittance(1.0, q, n, inner);
        let f = fresnel_reflectance(1.0, q, n, inner);
        Subpath {
            vertex: vec3(
                self.origin.x + d.x * on,
                self.origin.y + d.y * on,
                self.exit,
            ),
            normal: self.up,
            exact: d,
            measure: solid_angle * self.intensity.unwrap_or(q),
            weight: t * t * power(f, slab.inside),
            // Index times length would be optical; this is the way in metres.
            length: self.gap / q + glass * n / inner,
            sheet: if q < 0.0 { -1.0 } else { 1.0 },
            margins: [1.0; OWN],
        }
    }
}
