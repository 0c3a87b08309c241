//! Chains in a wedge of two vertical mirrors, by unfolding.
//!
//! k reflections alternate between the mirrors; the last one, at which the kernel is, may be on either. Seen from there, the end
//! at which the path began is an image, k − 1 sectors of the angle π/m beyond the wedge. In plan the straight line
//! from a point of the last mirror (at the polar angle 0, say) to an image in the sector between (k−1)π/m and kπ/m meets the half-lines
//! at π/m, 2π/m, …, (k−1)π/m in this order and once each, as all these angles are less than π: these are the k − 1 exact
//! reflections. So no leg of the chain can be stopped; k > m is impossible, the image being behind the mirror. The last
//! leg, from the mirror to the other end, is inside the wedge, which is convex.

use libm::{cos, sin};

use super::{UP, direction};
use crate::bandwidth::chart::chain::{Chain, OWN, Subpath, Subpaths};
use crate::kinds::power;
use crate::optics::reflect;
use crate::scene::MirrorWedge;
use crate::vector::{Vec3, vec3};

/// Light after a number of reflections, the one next to the connection on one of the mirrors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wedge {
    /// Angle π/m [rad].
    opening: f64,
    light: Vec3<f64>,
    intensity: f64,
    /// R^k.
    weight: f64,
    /// k ≥ 1.
    reflections: u32,
    /// Horizontal unit vector from the edge along the mirror with the kernel, and its normal into the wedge.
    along: Vec3<f64>,
    normal: Vec3<f64>,
}

impl Wedge {
    /// `last` tells which mirror; `None` for more reflections than there can be.
    pub fn new(
        wedge: &MirrorWedge,
        (light, intensity): (Vec3<f64>, f64),
        reflections: u32,
        last: u32,
    ) -> Option<Self> {
        let opening = core::f64::consts::PI / f64::from(wedge.divisor);
        let (c, s) = (cos(opening), sin(opening));
        let (along, normal) = if last == 0 {
            (vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0))
        } else {
            (vec3(c, s, 0.0), vec3(s, -c, 0.0))
        };
        (reflections <= wedge.divisor).then_some(Wedge {
            opening,
            light,
            intensity,
            weight: power(wedge.reflectance, reflections),
            reflections,
            along,
            normal,
        })
    }

    /// The image of a point by all mirrors but the last.
    fn image(&self, p: Vec3<f64>) -> Vec3<f64> {
        let (x, y) = (p.dot(self.along), p.dot(self.normal));
        let sectors = self.reflections - 1;
        // Rotated by an even number of sectors, or reflected in the half-line in between.
        let (turn, y) = if sectors.is_multiple_of(2) {
            (f64::from(sectors) * self.opening, y)
        } else {
            (f64::from(sectors + 1) * self.opening, -y)
        };
        let (c, s) = (cos(turn), sin(turn));
        self.along * (x * c - y * s) + self.normal * (x * s + y * c) + UP * p.z
    }

    /// Whether a point is between the mirrors.
    fn holds(&self, p: Vec3<f64>) -> bool {
        let (x, y) = (p.dot(self.along), p.dot(self.normal));
        y > 0.0 && x * sin(self.opening) - y * cos(self.opening) > 0.0
    }

    fn paths(&self, p: Vec3<f64>, intensity: Option<f64>) -> Paths<'_> {
        Paths {
            wedge: self,
            origin: self.image(p),
            intensity,
            frame: [self.along, UP, -self.normal],
        }
    }
}

impl Chain for Wedge {
    fn receiver_paths<'a>(&'a self, x: Vec3<f64>) -> Option<Box<dyn Subpaths + 'a>> {
        self.holds(x)
            .then(|| Box::new(self.paths(x, None)) as Box<dyn Subpaths>)
    }

    fn light_paths<'a>(&'a self) -> Box<dyn Subpaths + 'a> {
        Box::new(self.paths(self.light, Some(self.intensity)))
    }

    fn is_mirror(&self) -> bool {
        true
    }
}

/// Straight lines from an image to the last mirror, by their directions.
#[derive(Debug)]
struct Paths<'a> {
    wedge: &'a Wedge,
    origin: Vec3<f64>,
    /// Of the light; `None` for a receiver point, whose paths go up.
    intensity: Option<f64>,
    frame: [Vec3<f64>; 3],
}

impl Subpaths for Paths<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        let lowest = if self.intensity.is_some() { -1.0 } else { 0.0 };
        [[-1.0, 1.0], [lowest, 1.0]]
    }

    fn path(&self, u: [f64; 2]) -> Subpath {
        let normal = self.wedge.normal;
        let (d, solid_angle, _) = direction(&self.frame, u);
        let length = self.origin.dot(normal) / -d.dot(normal);
        let vertex = self.origin + d * length;
        let mut margins = [1.0; OWN];
        // On the mirror's side of the edge, in units of the length.
        margins[0] = vertex.dot(self.wedge.along) / length;
        Subpath {
            vertex,
            normal,
            exact: reflect(d, normal),
            measure: solid_angle * self.intensity.unwrap_or(d.z),
            weight: self.wedge.weight,
            length,
            sheet: if length < 0.0 { -1.0 } else { 1.0 },
            margins,
        }
    }
}
