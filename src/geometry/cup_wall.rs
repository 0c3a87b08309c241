//! A vertical circular wall about the z axis, over an arc or closed: its inner side reflects, as often as a path class
//! says; its outer side absorbs; both block.
//!
//! In plan a ray o + t d is on the circle where |o + t d|² = a². It comes in at the smaller root, where it meets the outer
//! side, and goes out at the larger one, where it meets the inner side. After a reflection only the larger root is ahead.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::ArcWall;

use super::chains::{Chains, Leg};
use super::specular::reflected;

/// The wall, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct CupWall {
    radius: f64,
    height: f64,
    /// The wall covers |φ| ≤ this [rad]; π where it is closed.
    half_arc: f64,
    reflectance: f64,
    classes: &'static [PathClass],
}

impl CupWall {
    /// Prepares a validated scene's wall and its classes, all seen directly; `reflectance` replaces the wall's own.
    pub fn new(wall: &ArcWall, reflectance: f64, classes: &'static [PathClass]) -> Self {
        CupWall {
            radius: wall.radius,
            height: wall.height,
            half_arc: wall.half_arc_degrees.to_radians(),
            reflectance,
            classes,
        }
    }

    /// The number of reflections of a chain.
    fn bounces(&self, chain: usize) -> usize {
        self.classes.get(chain).map_or(0, |c| c.light.len())
    }

    /// Ray parameters at which a line comes into the circle and out of it; NaN where it does not.
    fn crossings(&self, o: DVec3, d: DVec3) -> [f64; 2] {
        let a = d.x * d.x + d.y * d.y;
        let b = o.x * d.x + o.y * d.y;
        let c = o.x * o.x + o.y * o.y - self.radius * self.radius;
        // The root in which nothing cancels, then the other from their product c/a.
        let q = -(b + f64::copysign(f64::sqrt(b * b - a * c), b));
        let (s, t) = (q / a, c / q);
        if s < t { [s, t] } else { [t, s] }
    }

    /// The point ahead at a ray parameter, if the wall stands there.
    fn on_wall(&self, o: DVec3, d: DVec3, t: f64) -> Option<DVec3> {
        let p = o + d * t;
        let on_arc = f64::abs(libm::atan2(p.y, p.x)) <= self.half_arc;
        ((t > 0.0) & on_arc & (p.z >= 0.0) & (p.z <= self.height)).then_some(p)
    }
}

impl Chains for CupWall {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let bounces = self.bounces(chain);
        let mut leg = Leg {
            origin,
            direction,
            weight: 1.0,
        };
        for n in 0..=bounces {
            let [into, out] = self.crossings(leg.origin, leg.direction);
            // A reflected ray starts on the circle: it comes in where it starts.
            if n == 0 && self.on_wall(leg.origin, leg.direction, into).is_some() {
                return Leg::DARK;
            }
            match self.on_wall(leg.origin, leg.direction, out) {
                Some(point) if n < bounces => {
                    let normal = DVec3::new(point.x, point.y, 0.0) / self.radius;
                    leg = Leg {
                        origin: point,
                        direction: reflected(leg.direction, normal),
                        weight: leg.weight * self.reflectance,
                    };
                }
                None if n == bounces => return leg,
                _ => return Leg::DARK,
            }
        }
        Leg::DARK
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let met = |t: f64| (t < t_end) & self.on_wall(origin, direction, t).is_some();
        self.crossings(origin, direction).into_iter().any(met)
    }

    /// The floor, or the box about the wall.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if self.bounces(chain) == 0 {
            return floor.to_vec();
        }
        let (s, c) = libm::sincos(self.half_arc.min(core::f64::consts::PI));
        let y_max = if c > 0.0 {
            self.radius * s
        } else {
            self.radius
        };
        let mut corners = Vec::with_capacity(8);
        for x in [self.radius * c, self.radius] {
            for y in [-y_max, y_max] {
                corners.extend([0.0, self.height].map(|z| DVec3::new(x, y, z)));
            }
        }
        corners
    }
}
