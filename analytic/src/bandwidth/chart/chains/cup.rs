//! Chains in a closed circular mirror wall in parallel light.
//!
//! All chords of a ray in plan have the length 2a cos ι, sin ι its signed distance from the axis in radii. As complex numbers: from
//! a direction d the k-th point of the wall is a d (−1)^(k−1) e^{(2k−1)iι}, and the direction afterwards d (−1)^k e^{2kiι}. The height
//! changes by tan e per plan length. The inside is convex: nothing stops a leg but the wall's own height. Light that
//! comes in along the beam to a point n of the wall (unit, outward) at the height z has passed the near rim, a chord 2a n·b before,
//! at z + 2a n·b tan ε ≥ H.

use core::f64::consts::{FRAC_PI_2, PI};

use libm::{atan2, cos, hypot, sin, sincos, sqrt};

use crate::bandwidth::chart::chain::{Chain, OWN, Subpath, Subpaths};
use crate::bandwidth::chart::link::Again;
use crate::kinds::power;
use crate::scene::ClosedWall;
use crate::vector::{Vec3, vec3};

/// Light after a number of reflections.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cup {
    radius: f64,
    height: f64,
    /// k ≥ 1.
    reflections: u32,
    /// R^k.
    weight: f64,
    beam: Vec3<f64>,
    irradiance: f64,
}

impl Cup {
    pub fn new(wall: &ClosedWall, (beam, irradiance): (Vec3<f64>, f64), reflections: u32) -> Self {
        Cup {
            radius: wall.radius,
            height: wall.height,
            reflections,
            weight: power(wall.reflectance, reflections),
            beam,
            irradiance,
        }
    }

    /// tan ε.
    fn slope(&self) -> f64 {
        -self.beam.z / hypot(self.beam.x, self.beam.y)
    }

    /// Outward normal at the k-th point of the wall, and plan direction afterwards, from the azimuth of the direction and ι.
    fn reflected(&self, azimuth: f64, offset: f64) -> [[f64; 2]; 2] {
        let k = f64::from(self.reflections);
        let at = azimuth + (2.0 * k - 1.0) * offset + (k - 1.0) * PI;
        let out = azimuth + 2.0 * k * offset + k * PI;
        [at, out].map(|angle| [cos(angle), sin(angle)])
    }

    /// As many cells as there are turns of the last point.
    fn cells(&self) -> [u32; 2] {
        [4 * self.reflections, 2]
    }
}

impl Chain for Cup {
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>> {
        (hypot(x.x, x.y) < self.radius).then(|| Box::new(FromReceiver { cup: self, x }) as _)
    }

    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a> {
        Box::new(FromLight(self))
    }

    fn is_mirror(&self) -> bool {
        true
    }

    fn again_conditions(&self) -> usize {
        1
    }
}

/// Paths from a floor point by azimuth and the height of the last point on the wall.
#[derive(Debug)]
struct FromReceiver<'a> {
    cup: &'a Cup,
    x: Vec3<f64>,
}

impl Subpaths for FromReceiver<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-PI, PI], [self.x.z, self.cup.height]]
    }

    fn cells(&self) -> [u32; 2] {
        self.cup.cells()
    }

    /// After one more chord, unless the ray is above the wall there.
    fn again(&self, path: &Subpath) -> Option<Again> {
        let out = path.exact;
        let plan = out.x * out.x + out.y * out.y;
        let length = 2.0 * self.cup.radius * out.dot(path.normal) / plan;
        let below = self.cup.height - (path.vertex.z + out.z * length);
        Some(Again {
            length,
            conditions: [below, 1.0, 1.0],
        })
    }

    fn path(&self, [azimuth, z]: [f64; 2]) -> Subpath {
        let (cup, x) = (self.cup, self.x);
        let a = cup.radius;
        let (s, c) = sincos(azimuth);
        let offset = (c * x.y - s * x.x) / a;
        let cosine = sqrt((1.0 - offset) * (1.0 + offset));
        let k = f64::from(cup.reflections);
        let plan = (2.0 * k - 1.0) * a * cosine - (c * x.x + s * x.y);
        let [n, d] = cup.reflected(azimuth, atan2(offset, cosine));
        // With t = tan e, cos θ dω = t/(1 + t²)² dt dψ and dt = dz/plan.
        let t = (z - x.z) / plan;
        let along = 1.0 / hypot(1.0, t);
        let along2 = along * along;
        let before =
            2.0 * a * (n[0] * cup.beam.x + n[1] * cup.beam.y) / hypot(cup.beam.x, cup.beam.y);
        let mut margins = [1.0; OWN];
        margins[0] = z + before * cup.slope() - cup.height;
        Subpath {
            vertex: vec3(a * n[0], a * n[1], z),
            normal: vec3(-n[0], -n[1], 0.0),
            exact: vec3(d[0] * along, d[1] * along, t * along),
            measure: t * along2 * along2 / plan,
            weight: cup.weight,
            length: 0.0,
            sheet: 1.0,
            margins,
        }
    }
}

/// Rays of the beam by their incidence at the first point of the wall, and by how much of a chord's descent that is below the
/// rim.
#[derive(Debug)]
struct FromLight<'a>(&'a Cup);

impl Subpaths for FromLight<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [0.0, 1.0]]
    }

    fn cells(&self) -> [u32; 2] {
        self.0.cells()
    }

    fn path(&self, [incidence, below]: [f64; 2]) -> Subpath {
        let cup = self.0;
        let (a, k) = (cup.radius, f64::from(cup.reflections));
        let chord = 2.0 * a * cos(incidence);
        let z = cup.height - (k - 1.0 + below) * chord * cup.slope();
        let [n, d] = cup.reflected(atan2(cup.beam.y, cup.beam.x), incidence);
        let along = hypot(cup.beam.x, cup.beam.y);
        Subpath {
            vertex: vec3(a * n[0], a * n[1], z),
            normal: vec3(-n[0], -n[1], 0.0),
            exact: vec3(d[0] * along, d[1] * along, cup.beam.z),
            // E₀ cos ε · a cos φ dφ dz.
            measure: -cup.irradiance * cup.beam.z * 0.5 * chord * chord,
            weight: cup.weight,
            length: 0.0,
            sheet: 1.0,
            margins: [1.0; OWN],
        }
    }
}
