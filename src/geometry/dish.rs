//! A paraboloid z = v - r²/(4f) between two radii, above the floor: its lower side reflects, its upper side absorbs, both
//! block.
//!
//! A ray meets it where r² + 4f (z - v), a quadratic of its parameter, is zero; where that grows the ray comes from inside,
//! the reflecting side. The light is inside, and what passes the silvered part does not come back.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, ParaboloidScene};

use super::chains::{Chains, Leg, Vertex};
use super::quadratic::zeros;
use super::scene::unit;
use super::specular::reflected;

/// The mirror, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Dish {
    vertex: DVec3,
    /// 4f.
    latus: f64,
    inner: f64,
    outer: f64,
    reflectance: f64,
    classes: &'static [PathClass],
}

impl Dish {
    /// Prepares a validated scene's mirror; `reflectance` replaces the scene's own.
    pub fn new(scene: &ParaboloidScene, reflectance: f64) -> Self {
        let dish = &scene.dish;
        Dish {
            vertex: DVec3::new(dish.center[0], dish.center[1], dish.vertex_z),
            latus: 4.0 * dish.focal_length,
            inner: dish.inner_radius,
            outer: dish.outer_radius,
            reflectance,
            classes: scene.classes(),
        }
    }

    /// Coefficients of r² + 4f (z - v) along a ray: of t², of 2t, and the value at its origin.
    fn quadratic(&self, o: DVec3, d: DVec3) -> [f64; 3] {
        let p = o - self.vertex;
        [
            d.x * d.x + d.y * d.y,
            p.x * d.x + p.y * d.y + 0.5 * self.latus * d.z,
            p.x * p.x + p.y * p.y + self.latus * p.z,
        ]
    }

    fn is_silvered(&self, o: DVec3, d: DVec3, t: f64) -> bool {
        let p = o + d * t - self.vertex;
        let square = p.x * p.x + p.y * p.y;
        square >= self.inner * self.inner && square <= self.outer * self.outer
    }

    /// Ray parameter at which a ray from inside meets the silvered part.
    fn meet(&self, o: DVec3, d: DVec3) -> Option<f64> {
        let [a, b, c] = self.quadratic(o, d);
        zeros(a, b, c)
            .into_iter()
            .find(|&t| t > 0.0 && a * t + b > 0.0 && self.is_silvered(o, d, t))
    }
}

impl Chains for Dish {
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        match (chain, self.meet(origin, direction)) {
            (0, None) => Leg {
                origin,
                direction,
                weight: 1.0,
            },
            (1, Some(t)) => {
                let point = origin + direction * t;
                let p = point - self.vertex;
                let gradient = DVec3::new(p.x, p.y, 0.5 * self.latus);
                let normal = gradient / f64::sqrt(gradient.dot(gradient));
                Leg {
                    origin: point,
                    direction: reflected(direction, normal),
                    weight: self.reflectance,
                }
            }
            _ => Leg::DARK,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let [a, b, c] = self.quadratic(origin, direction);
        zeros(a, b, c)
            .into_iter()
            .any(|t| t > 0.0 && t < t_end && self.is_silvered(origin, direction, t))
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let [a, b, c] = self.quadratic(origin, direction);
        let met = zeros(a, b, c)
            .into_iter()
            .filter(|&t| t > 0.0 && self.is_silvered(origin, direction, t));
        let t = met.min_by(f64::total_cmp)?;
        let point = origin + direction * t;
        let p = point - self.vertex;
        let normal = -unit(DVec3::new(p.x, p.y, 0.5 * self.latus));
        // What comes from outside is absorbed.
        (direction.dot(normal) < 0.0).then(|| Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        // The zero that is not the vertex itself.
        let [a, b, _] = self.quadratic(vertex.point, direction);
        let t = -2.0 * b / a;
        if t > 0.0 && self.is_silvered(vertex.point, direction, t) {
            t
        } else {
            f64::INFINITY
        }
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let z = |r: f64| -r * r / self.latus;
        Some([
            self.vertex + DVec3::new(-self.outer, -self.outer, z(self.outer)),
            self.vertex + DVec3::new(self.outer, self.outer, z(self.inner)),
        ])
    }

    /// The floor, or a box around the mirror.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let mut points = Vec::with_capacity(8);
        let low = -self.outer * self.outer / self.latus;
        for z in [low, 0.0] {
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
                points.push(self.vertex + DVec3::new(x * self.outer, y * self.outer, z));
            }
        }
        points
    }
}
