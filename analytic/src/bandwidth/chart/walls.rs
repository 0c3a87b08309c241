//! Vertical walls as two-parameter families of points, by the place in plan and the height.

use libm::{cos, sin, sqrt};

use super::link::Again;
use super::surfaces::{Legs, Surface, Vertex, any};
use crate::vector::{Vec3, vec3};

/// A vertical wall over an arc of a circle, or part of it, by azimuth and height.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Cylinder {
    /// Axis (x, y) [m].
    pub center: [f64; 2],
    pub radius: f64,
    /// −1 where the light is inside, 1 where it is outside.
    pub side: f64,
    /// Range of azimuths [rad].
    pub azimuth: [f64; 2],
    pub height: f64,
    /// Whether what leaves the inner side meets the wall again only over |azimuth| ≤ this; 0 where it never does.
    pub half_arc: f64,
}

impl Surface for Cylinder {
    fn domain(&self) -> [[f64; 2]; 2] {
        [self.azimuth, [0.0, self.height]]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let n = vec3(cos(u[0]), sin(u[0]), 0.0);
        Vertex {
            point: vec3(
                self.center[0] + self.radius * n.x,
                self.center[1] + self.radius * n.y,
                u[1],
            ),
            normal: n * self.side,
            area: self.radius,
            margins: [1.0; 3],
        }
    }

    fn free(&self, s: &Vec3<f64>, normal: &Vec3<f64>, legs: &Legs) -> [f64; 2] {
        if self.side > 0.0 || self.half_arc == 0.0 {
            return [1.0; 2];
        }
        let edge = cos(self.half_arc);
        legs.map(|d, length| {
            let plan = d.x * d.x + d.y * d.y;
            // Ray parameter of the second meeting with the circle, and the height there.
            let t = 2.0 * self.radius * (d.x * normal.x + d.y * normal.y) / plan;
            let along = (s.x + d.x * t - self.center[0]) / self.radius;
            any(&[edge - along, s.z + d.z * t - self.height, t - length])
        })
    }

    fn again_conditions(&self) -> usize {
        if self.side < 0.0 && self.half_arc > 0.0 {
            2
        } else {
            0
        }
    }

    fn again(&self, s: &Vec3<f64>, normal: &Vec3<f64>, out: &Vec3<f64>) -> Option<Again> {
        let plan = out.x * out.x + out.y * out.y;
        let length = 2.0 * self.radius * (out.x * normal.x + out.y * normal.y) / plan;
        let along = (s.x + out.x * length - self.center[0]) / self.radius;
        let below = self.height - (s.z + out.z * length);
        Some(Again {
            length,
            conditions: [along - cos(self.half_arc), below, 1.0],
        })
    }
}

/// A vertical wall over the arc r = p/(1 + e cos θ), |θ| ≤ half arc, about a focus, lit from inside; by θ and height.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct ConicWall {
    pub focus: [f64; 2],
    /// Unit vector towards θ = 0.
    pub axis: [f64; 2],
    pub parameter: f64,
    pub eccentricity: f64,
    pub half_arc: f64,
    pub height: f64,
}

impl Surface for ConicWall {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-self.half_arc, self.half_arc], [0.0, self.height]]
    }

    fn vertex(&self, u: [f64; 2]) -> Vertex {
        let ([ax, ay], e) = (self.axis, self.eccentricity);
        let (c, s) = (cos(u[0]), sin(u[0]));
        let (dx, dy) = (ax * c - ay * s, ay * c + ax * s);
        let slope = 1.0 + e * c;
        let r = self.parameter / slope;
        let (gx, gy) = (dx + e * ax, dy + e * ay);
        let norm = sqrt(gx * gx + gy * gy);
        Vertex {
            point: vec3(self.focus[0] + dx * r, self.focus[1] + dy * r, u[1]),
            normal: vec3(-gx / norm, -gy / norm, 0.0),
            area: r * norm / slope,
            margins: [1.0; 3],
        }
    }

    fn free(&self, s: &Vec3<f64>, _: &Vec3<f64>, legs: &Legs) -> [f64; 2] {
        let ([ax, ay], e) = (self.axis, self.eccentricity);
        let p = [s.x - self.focus[0], s.y - self.focus[1]];
        let r = libm::hypot(p[0], p[1]);
        let end = cos(self.half_arc);
        legs.map(|d, length| {
            let plan = d.x * d.x + d.y * d.y;
            let along = e * (d.x * ax + d.y * ay);
            // The second meeting of the line with the conic in plan; both are on the same branch if t > 0.
            let t = -2.0 * (p[0] * d.x + p[1] * d.y + r * along) / (plan - along * along);
            let (x, y) = (p[0] + d.x * t, p[1] + d.y * t);
            let off = end * libm::hypot(x, y) - (x * ax + y * ay);
            any(&[off, s.z + d.z * t - self.height, t - length, -t])
        })
    }

    fn again_conditions(&self) -> usize {
        // On a parabola or a hyperbola a ray may go out between the arms.
        if self.eccentricity < 1.0 { 2 } else { 3 }
    }

    fn again(&self, s: &Vec3<f64>, _: &Vec3<f64>, out: &Vec3<f64>) -> Option<Again> {
        let ([ax, ay], e) = (self.axis, self.eccentricity);
        let p = [s.x - self.focus[0], s.y - self.focus[1]];
        let plan = out.x * out.x + out.y * out.y;
        let along = e * (out.x * ax + out.y * ay);
        let way = p[0] * out.x + p[1] * out.y + libm::hypot(p[0], p[1]) * along;
        let rest = plan - along * along;
        let length = -2.0 * way / rest;
        let (x, y) = (p[0] + out.x * length, p[1] + out.y * length);
        let on = (x * ax + y * ay) / libm::hypot(x, y) - cos(self.half_arc);
        let below = self.height - (s.z + out.z * length);
        let below = below / libm::hypot(1.0, below);
        let conditions = if e < 1.0 {
            [on, below, 1.0]
        } else {
            // The same sign as the length, and no pole.
            [-way * rest, on, below]
        };
        Some(Again { length, conditions })
    }
}
