//! A vertical circular wall about the z axis, over an arc or closed: its inner side reflects, as often as a path class
//! says; its outer side absorbs; both block.
//!
//! In plan a ray o + t d is on the circle where |o + t d|² = a². It comes in at the smaller root, where it meets the outer
//! side, and goes out at the larger one, where it meets the inner side. After a reflection only the larger root is ahead.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::ArcWall;

use super::chains::{Chains, Leg, Vertex, corners};
use super::specular::reflected;

/// The wall, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct CupWall {
    radius: f64,
    height: f64,
    /// The wall covers |φ| ≤ this [rad]; π where it is closed.
    half_arc: f64,
    /// It stands where x is at least this [m], as far as a point on the circle can tell.
    x_min: f64,
    reflectance: f64,
    classes: &'static [PathClass],
    /// Direction of parallel light that comes in over the rim of a closed wall.
    travel: Option<DVec3>,
}

impl CupWall {
    /// Prepares a validated scene's wall and its classes, all seen directly; `reflectance` replaces the wall's own.
    pub fn new(wall: &ArcWall, reflectance: f64, classes: &'static [PathClass]) -> Self {
        CupWall {
            radius: wall.radius,
            height: wall.height,
            half_arc: wall.half_arc_degrees.to_radians(),
            x_min: first_x(wall.radius, wall.half_arc_degrees.to_radians()),
            reflectance,
            classes,
            travel: None,
        }
    }

    /// The same wall, closed, in parallel light of this direction.
    pub fn in_beam(self, travel: DVec3) -> Self {
        CupWall {
            half_arc: core::f64::consts::PI,
            x_min: f64::NEG_INFINITY,
            travel: Some(travel),
            ..self
        }
    }

    /// Corners of a rectangle of the opening through which all parallel light comes that is reflected k ≥ 1 times on its way
    /// to points no farther than `reach` from the axis.
    ///
    /// A ray keeps its distance y from the axis, so |y| ≤ `reach`: half of every chord is C ≥ √(a² - `reach`²). It
    /// comes in at -C ≤ x ≤ C along the beam, and goes C - x + (k - 1) 2C + τ, 0 ≤ τ ≤ 2C, down to the floor.
    fn opening(&self, travel: DVec3, k: usize, reach: f64) -> Vec<DVec3> {
        let a = self.radius;
        let plan = DVec3::new(travel.x, travel.y, 0.0);
        let speed = f64::sqrt(plan.dot(plan));
        let (ahead, length) = (plan / speed, self.height * speed / -travel.z);
        let y = if reach < a { reach } else { a };
        let shortest = f64::sqrt((a - y) * (a + y));
        let k = k as f64;
        let first = (shortest * (2.0 * k - 1.0) - length).max(-a);
        let last = (a * (2.0 * k + 1.0) - length).min(a);
        let aside = DVec3::new(-ahead.y, ahead.x, 0.0);
        let corner = |x: f64, y: f64| ahead * x + aside * y + DVec3::new(0.0, 0.0, self.height);
        // Rounding at the border: a margin far above it.
        let (y, margin) = (y + 1e-9 * a, 1e-9 * a);
        let (first, last) = (first - margin, last.max(first) + margin);
        vec![
            corner(first, -y),
            corner(first, y),
            corner(last, -y),
            corner(last, y),
        ]
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
        ((t > 0.0) & (p.x >= self.x_min) & (p.z >= 0.0) & (p.z <= self.height)).then_some(p)
    }
}

/// The least x of an arc; none where it is the whole circle, whose points may lie outside of it within rounding.
fn first_x(radius: f64, half_arc: f64) -> f64 {
    if half_arc < core::f64::consts::PI {
        radius * libm::cos(half_arc)
    } else {
        f64::NEG_INFINITY
    }
}

impl Chains for CupWall {
    const MEETS_ITSELF: bool = true;

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

    fn strike(&self, chain: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let (mut point, mut direction, mut weight) = (origin, direction, 1.0);
        let mut normal = None;
        for n in 0..self.bounces(chain) {
            let [into, out] = self.crossings(point, direction);
            if n == 0 && self.on_wall(point, direction, into).is_some() {
                return None;
            }
            point = self.on_wall(point, direction, out)?;
            let inward = DVec3::new(-point.x, -point.y, 0.0) / self.radius;
            normal = Some(inward);
            direction = reflected(direction, inward);
            weight *= self.reflectance;
        }
        Some(Vertex {
            point,
            direction,
            normal: normal?,
            weight,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        // The ray comes in where it starts.
        let [_, out] = self.crossings(vertex.point, direction);
        match self.on_wall(vertex.point, direction, out) {
            Some(_) => out,
            None => f64::INFINITY,
        }
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let (s, c) = libm::sincos(self.half_arc.min(core::f64::consts::PI));
        let wide = if c > 0.0 {
            self.radius * s
        } else {
            self.radius
        };
        Some([
            DVec3::new(self.radius * c, -wide, 0.0),
            DVec3::new(self.radius, wide, self.height),
        ])
    }

    /// The floor, or the box about the wall, or a part of its opening.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if self.bounces(chain) == 0 {
            return floor.to_vec();
        }
        if let Some(travel) = self.travel {
            let far = |c: &DVec3| f64::sqrt(c.x * c.x + c.y * c.y);
            let reach = floor.iter().map(far).fold(0.0, f64::max);
            return self.opening(travel, self.bounces(chain), reach);
        }
        self.bounds().map_or_else(Vec::new, corners)
    }
}
