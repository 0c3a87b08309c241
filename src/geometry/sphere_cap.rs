//! A spherical cap about +z, above the floor: its inner side reflects, its outer side absorbs, both block.
//!
//! A ray meets the sphere at the roots of |o - c + t d|² = a²; the root at which it leaves the sphere is on the inner side.
//! Light and camera are below the rim, so nothing is in the way between them and the floor.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{ConcaveSphereScene, Family};

use super::chains::{Chains, Leg, Vertex};
use super::specular::reflected;

/// The cap, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct SphereCap {
    center: DVec3,
    radius: f64,
    rim_z: f64,
    reflectance: f64,
    classes: &'static [PathClass],
}

impl SphereCap {
    /// Prepares a validated scene's cap; `reflectance` replaces the scene's own.
    pub fn new(scene: &ConcaveSphereScene, reflectance: f64) -> Self {
        let cap = &scene.cap;
        let angle = cap.half_angle_degrees.to_radians();
        SphereCap {
            center: DVec3::from_array(cap.center),
            radius: cap.radius,
            rim_z: cap.center[2] + cap.radius * libm::cos(angle),
            reflectance,
            classes: scene.classes(),
        }
    }

    /// Ray parameters at which a ray enters and leaves the sphere; NaN where it misses.
    fn crossings(&self, o: DVec3, d: DVec3) -> [f64; 2] {
        let (p, dd) = (o - self.center, d.dot(d));
        let b = p.dot(d) / dd;
        let nearest = p - d * b;
        let root = f64::sqrt((self.radius * self.radius - nearest.dot(nearest)) / dd);
        [-b - root, -b + root]
    }

    /// Ray parameter from a point of the sphere to the sphere again: the root that is not zero.
    fn chord(&self, point: DVec3, direction: DVec3) -> f64 {
        -2.0 * (point - self.center).dot(direction) / direction.dot(direction)
    }

    fn on_cap(&self, o: DVec3, d: DVec3, t: f64) -> bool {
        o.z + d.z * t >= self.rim_z
    }
}

impl Chains for SphereCap {
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let [enters, leaves] = self.crossings(origin, direction);
        let meets = |t: f64| t > 0.0 && self.on_cap(origin, direction, t);
        // What enters through the cap is absorbed on its outer side.
        let stopped = meets(enters);
        if chain == 0 {
            let weight = if stopped || meets(leaves) { 0.0 } else { 1.0 };
            return Leg {
                origin,
                direction,
                weight,
            };
        }
        if stopped || !meets(leaves) {
            return Leg::DARK;
        }
        let point = origin + direction * leaves;
        let direction = reflected(direction, (point - self.center) / self.radius);
        let again = self.chord(point, direction);
        if self.on_cap(point, direction, again) {
            return Leg::DARK;
        }
        Leg {
            origin: point,
            direction,
            weight: self.reflectance,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.crossings(origin, direction)
            .iter()
            .any(|&t| t > 0.0 && t < t_end && self.on_cap(origin, direction, t))
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let [enters, leaves] = self.crossings(origin, direction);
        let meets = |t: f64| t > 0.0 && self.on_cap(origin, direction, t);
        if meets(enters) || !meets(leaves) {
            return None;
        }
        let point = origin + direction * leaves;
        let normal = (self.center - point) / self.radius;
        Some(Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        let t = self.chord(vertex.point, direction);
        if self.on_cap(vertex.point, direction, t) {
            t
        } else {
            f64::INFINITY
        }
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let up = self.rim_z - self.center.z;
        // Below the middle of the sphere the rim is not the widest part.
        let wide = if up > 0.0 {
            f64::sqrt(self.radius * self.radius - up * up)
        } else {
            self.radius
        };
        Some([
            self.center + DVec3::new(-wide, -wide, up),
            self.center + DVec3::new(wide, wide, self.radius),
        ])
    }

    /// The floor, or a box around the cap.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let mut points = Vec::with_capacity(8);
        let low = self.center - DVec3::new(self.radius, self.radius, self.center.z - self.rim_z);
        let high = self.center + DVec3::splat(self.radius);
        for k in 0..8 {
            let pick = |axis: usize| if k >> axis & 1 == 0 { low } else { high };
            points.push(DVec3::new(pick(0).x, pick(1).y, pick(2).z));
        }
        points
    }
}
