//! Two vertical mirrors that meet at the z axis: a ray between them is reflected by whichever it comes to first.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, PlanarChainsScene};

use super::chains::{Chains, Leg, Vertex};
use super::floor::Floor;
use super::specular::reflected;

/// The wedge, ready for rays that start in it.
#[derive(Clone, Copy, Debug)]
pub struct Wedge {
    /// Unit normals of the mirrors' planes, which both contain the z axis, to the inside.
    normals: [DVec3; 2],
    reflectance: f64,
    classes: &'static [PathClass],
}

impl Wedge {
    /// Prepares a validated scene's mirrors; `reflectance` replaces their own.
    pub fn new(scene: &PlanarChainsScene, reflectance: f64) -> Self {
        let angle = core::f64::consts::PI / f64::from(scene.wedge.divisor);
        Wedge {
            normals: [
                DVec3::Y,
                DVec3::new(libm::sin(angle), -libm::cos(angle), 0.0),
            ],
            reflectance,
            classes: scene.classes(),
        }
    }

    /// The first mirror that a ray comes to, and where: its position and the ray parameter, infinite if there is none.
    fn first(&self, origin: DVec3, direction: DVec3) -> (usize, f64) {
        let meet = |n: DVec3| {
            let towards = direction.dot(n);
            if towards < 0.0 {
                -origin.dot(n) / towards
            } else {
                f64::INFINITY
            }
        };
        let [s, t] = self.normals.map(meet);
        if s < t { (0, s) } else { (1, t) }
    }
}

impl Chains for Wedge {
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let (mut origin, mut direction, mut weight) = (origin, direction, 1.0);
        for _ in 0..chain {
            let (mirror, t) = self.first(origin, direction);
            if !(t < Floor::meet(origin, direction)) {
                return Leg::DARK;
            }
            origin += direction * t;
            direction = reflected(direction, self.normals[mirror]);
            weight *= self.reflectance;
        }
        let free = Floor::meet(origin, direction) < self.first(origin, direction).1;
        Leg {
            origin,
            direction,
            weight: if free { weight } else { 0.0 },
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.first(origin, direction).1 < t_end
    }

    /// Between the mirrors nothing is in the way: the wedge is convex.
    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let (mut point, mut direction, mut weight) = (origin, direction, 1.0);
        let mut normal = None;
        for _ in 0..chain {
            let (mirror, t) = self.first(point, direction);
            if !(t < Floor::meet(point, direction)) {
                return None;
            }
            point += direction * t;
            normal = Some(self.normals[mirror]);
            direction = reflected(direction, self.normals[mirror]);
            weight *= self.reflectance;
        }
        Some(Vertex {
            point,
            direction,
            normal: normal?,
            weight,
        })
    }

    fn reflection(&self, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        self.strike(1, origin, direction)
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        self.first(vertex.point, direction).1
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// The floor and its images: a chain of reflections is a straight line to one of them.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let mut corners = Vec::with_capacity(2 * floor.len());
        let mut images = floor.to_vec();
        // The images by as many reflections, beginning with either mirror.
        for first in 0..2 {
            images.copy_from_slice(floor);
            for k in 0..chain {
                let normal = self.normals[(first + k) % 2];
                for p in &mut images {
                    *p = reflected(*p, normal);
                }
            }
            corners.extend_from_slice(&images);
        }
        corners
    }
}
