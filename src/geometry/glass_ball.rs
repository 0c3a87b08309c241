//! A sphere of smooth dielectric over the floor: reflected outside, or refracted, reflected inside any number of times,
//! and refracted again.
//!
//! A ray meets the sphere at the smaller root of |o + t d - c|² = a²; inside, the chord from a point with outward normal
//! N runs for -2a d·N. The sphere is convex: no ray that has left it meets it again.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, GlassSphereScene};

use super::chains::{Chains, Leg, Vertex};
use super::dielectric::refract;
use super::scene::unit;
use super::specular::reflected;

/// The sphere, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct GlassBall {
    center: DVec3,
    radius: f64,
    index: f64,
    classes: &'static [PathClass],
}

impl GlassBall {
    /// Prepares a validated scene's ball.
    pub fn new(scene: &GlassSphereScene) -> Self {
        GlassBall {
            center: DVec3::from_array(scene.glass.center),
            radius: scene.glass.radius,
            index: scene.glass.index,
            classes: scene.classes(),
        }
    }

    /// The number of interactions of a chain.
    fn interactions(&self, chain: usize) -> usize {
        self.classes.get(chain).map_or(0, |class| class.light.len())
    }

    /// Length along the unit direction to the first point of the sphere, from outside; infinite where it is not met.
    fn meet(&self, origin: DVec3, d: DVec3) -> f64 {
        let o = origin - self.center;
        let b = o.dot(d);
        // The squared distance of the line from the centre, as that of a vector: nothing cancels far away.
        let miss = o - d * b;
        let t = -b - f64::sqrt(self.radius * self.radius - miss.dot(miss));
        if t > 0.0 { t } else { f64::INFINITY }
    }
}

impl Chains for GlassBall {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let d = unit(direction);
        let t = self.meet(origin, d);
        let met = t < f64::INFINITY;
        if self.interactions(chain) == 0 {
            let weight = if met { 0.0 } else { 1.0 };
            return Leg {
                origin,
                direction,
                weight,
            };
        }
        match self.strike(chain, origin, d) {
            Some(Vertex {
                point,
                direction,
                weight,
                ..
            }) => Leg {
                origin: point,
                direction,
                weight,
            },
            None => Leg::DARK,
        }
    }

    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let t = self.meet(origin, direction);
        if !(t < f64::INFINITY) {
            return None;
        }
        let mut point = origin + direction * t;
        let mut normal = (point - self.center) / self.radius;
        let (mut inside, f) = refract(direction, normal, self.index);
        let interactions = self.interactions(chain);
        if interactions == 1 {
            return Some(Vertex {
                point,
                direction: reflected(direction, normal),
                normal,
                weight: f,
            });
        }
        let mut weight = 1.0 - f;
        for left in (0..interactions.saturating_sub(1)).rev() {
            point += inside * (-2.0 * self.radius * inside.dot(normal));
            normal = (point - self.center) / self.radius;
            let (out, f) = refract(inside, -normal, 1.0 / self.index);
            if left == 0 {
                return Some(Vertex {
                    point,
                    direction: out,
                    normal,
                    weight: weight * (1.0 - f),
                });
            }
            weight *= f;
            inside = reflected(inside, normal);
        }
        None
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let half = DVec3::splat(self.radius);
        Some([self.center - half, self.center + half])
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let length = f64::sqrt(direction.dot(direction));
        self.meet(origin, direction / length) < t_end * length
    }

    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let corner = |k: usize| {
            let sign = |bit: usize| {
                if k & bit == 0 {
                    -self.radius
                } else {
                    self.radius
                }
            };
            self.center + DVec3::new(sign(1), sign(2), sign(4))
        };
        (0..8).map(corner).collect()
    }
}
