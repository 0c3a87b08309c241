//! A vertical wall over an arc of a conic: its inner side, which contains the focus, reflects; its outer side absorbs.
//!
//! About focus and axis the conic is where |q| = p - e x. A line o + t d meets it where |o + t d|² = (p - e (o_x + t d_x))²
//! and the right-hand root is positive: on the branch that goes round the focus. The gradient of |q| + e x is the outer
//! normal.

use glam::{DVec2, DVec3};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::ConicWallScene;

use super::chains::{Chains, Leg, Vertex, bounding_box};
use super::specular::reflected;

/// The wall, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct ConicWall {
    focus: DVec2,
    /// Unit vector of the axis.
    axis: DVec2,
    parameter: f64,
    eccentricity: f64,
    half_arc: f64,
    height: f64,
    reflectance: f64,
}

impl ConicWall {
    /// Prepares a validated scene's wall; `reflectance` replaces its own.
    pub fn new(scene: &ConicWallScene, reflectance: f64) -> Self {
        let wall = &scene.wall;
        let axis = DVec2::from_array(wall.direction);
        ConicWall {
            focus: DVec2::from_array(wall.focus),
            axis: axis / f64::sqrt(axis.dot(axis)),
            parameter: wall.parameter,
            eccentricity: wall.eccentricity,
            half_arc: wall.half_arc_degrees.to_radians(),
            height: wall.height,
            reflectance,
        }
    }

    /// Components along the axis and across it.
    fn turned(&self, v: DVec2) -> DVec2 {
        DVec2::new(v.dot(self.axis), self.axis.perp_dot(v))
    }

    /// Both ray parameters at which a line meets the quadric, in no order; NaN where it does not.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> [f64; 2] {
        let o = self.turned(origin.truncate() - self.focus);
        let d = self.turned(direction.truncate());
        let e = self.eccentricity;
        let gap = self.parameter - e * o.x;
        let a = d.dot(d) - e * e * d.x * d.x;
        let b = o.dot(d) + gap * e * d.x;
        let c = o.dot(o) - gap * gap;
        let q = -(b + f64::copysign(f64::sqrt(b * b - a * c), b));
        [q / a, c / q]
    }

    /// The point at a ray parameter, if the wall stands there.
    fn on_wall(&self, origin: DVec3, direction: DVec3, t: f64) -> Option<DVec3> {
        let point = origin + direction * t;
        let q = self.turned(point.truncate() - self.focus);
        let near_branch = self.parameter - self.eccentricity * q.x > 0.0;
        let on_arc = f64::abs(libm::atan2(q.y, q.x)) <= self.half_arc;
        let stands = near_branch & on_arc & (point.z >= 0.0) & (point.z <= self.height);
        stands.then_some(point)
    }

    /// The outer unit normal at a point of the wall.
    fn normal(&self, point: DVec3) -> DVec3 {
        let q = point.truncate() - self.focus;
        let gradient = q / f64::sqrt(q.dot(q)) + self.axis * self.eccentricity;
        (gradient / f64::sqrt(gradient.dot(gradient))).extend(0.0)
    }
}

impl Chains for ConicWall {
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let meets = |origin: DVec3, direction: DVec3, t: f64| {
            (t > 0.0)
                .then(|| self.on_wall(origin, direction, t))
                .flatten()
        };
        let [s, t] = self.crossings(origin, direction);
        let (near, far) = if s < t { (s, t) } else { (t, s) };
        let first = meets(origin, direction, near).or_else(|| meets(origin, direction, far));
        let Some(point) = first else {
            return Leg {
                origin,
                direction,
                weight: if chain == 0 { 1.0 } else { 0.0 },
            };
        };
        let normal = self.normal(point);
        if chain == 0 || direction.dot(normal) <= 0.0 {
            return Leg::DARK;
        }
        let on = reflected(direction, normal);
        // Of the line's two points one is the point itself.
        let [s, t] = self.crossings(point, on);
        let again = if f64::abs(s) > f64::abs(t) { s } else { t };
        let free = meets(point, on, again).is_none();
        Leg {
            origin: point,
            direction: on,
            weight: if free { self.reflectance } else { 0.0 },
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.crossings(origin, direction)
            .into_iter()
            .any(|t| (t > 0.0) & (t < t_end) && self.on_wall(origin, direction, t).is_some())
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let meets = |t: f64| {
            (t > 0.0)
                .then(|| self.on_wall(origin, direction, t))
                .flatten()
        };
        let [s, t] = self.crossings(origin, direction);
        let (near, far) = if s < t { (s, t) } else { (t, s) };
        let point = meets(near).or_else(|| meets(far))?;
        let normal = -self.normal(point);
        (direction.dot(normal) < 0.0).then(|| Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        // Of the line's two points one is the vertex itself.
        let [s, t] = self.crossings(vertex.point, direction);
        let other = if f64::abs(s) > f64::abs(t) { s } else { t };
        let met = (other > 0.0) && self.on_wall(vertex.point, direction, other).is_some();
        if met { other } else { f64::INFINITY }
    }

    /// The ends of the arc, and where its tangent is along x or y: the tangent at θ is across (e + cos θ, sin θ).
    fn bounds(&self) -> Option<[DVec3; 2]> {
        let mut angles = vec![-self.half_arc, self.half_arc];
        for axis in [DVec2::X, DVec2::Y] {
            // A direction u is extreme where it is along the normal: u_x sin θ - u_y cos θ = u_y e, that is
            // sin(θ - δ) = u_y e with δ the angle of u.
            let u = self.turned(axis);
            let sine = u.y * self.eccentricity;
            if f64::abs(sine) <= 1.0 {
                let (tilt, turn) = (libm::asin(sine), libm::atan2(u.y, u.x));
                angles.extend([turn + tilt, turn + core::f64::consts::PI - tilt]);
            }
        }
        let point = |angle: f64| {
            let (s, c) = libm::sincos(angle);
            let theta = libm::atan2(s, c);
            let length = self.parameter / (1.0 + self.eccentricity * c);
            let margin = 1e-12;
            let on_arc = f64::abs(theta) <= self.half_arc + margin && length > 0.0;
            on_arc.then(|| self.focus + (self.axis * c + self.axis.perp() * s) * length)
        };
        let points: Vec<_> = angles
            .into_iter()
            .filter_map(point)
            .flat_map(|p| [p.extend(0.0), p.extend(self.height)])
            .collect();
        bounding_box(&points)
    }

    /// The floor, or the corners of a polygon of tangents about the arc.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        const PIECES: u32 = 16;
        let step = 2.0 * self.half_arc / f64::from(PIECES);
        // The tangent at θ is (e + cos θ, sin θ)·q = p.
        let tangent = |k: u32| {
            let (s, c) = libm::sincos(step * f64::from(k) - self.half_arc);
            DVec2::new(self.eccentricity + c, s)
        };
        let end = |k: u32| {
            let (s, c) = libm::sincos(step * f64::from(k) - self.half_arc);
            DVec2::new(c, s) * (self.parameter / (1.0 + self.eccentricity * c))
        };
        let meet = |k: u32| {
            let (m, n) = (tangent(k), tangent(k + 1));
            DVec2::new(n.y - m.y, m.x - n.x) * (self.parameter / m.perp_dot(n))
        };
        let mut corners = Vec::new();
        let polygon = (0..PIECES).map(meet).chain([end(0), end(PIECES)]);
        for q in polygon {
            let plan = self.focus + self.axis * q.x + self.axis.perp() * q.y;
            corners.extend([0.0, self.height].map(|z| plan.extend(z)));
        }
        corners
    }
}
