//! What a camera ray sees in the wall: the floor point it reaches after its reflections.
//!
//! In plan the ray keeps its offset from the centre; every chord is 2√(a² - L²), and the slope is constant. A ray that
//! first meets the outer side of the wall, passes over the rim or reaches the floor before the wall sees nothing by
//! reflection.

use super::{CylinderCup, MAX_BOUNCES};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// A floor point seen in the wall.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Number of reflections between the eye and the floor.
    pub bounces: u32,
    /// Where the ray first meets the wall [m].
    pub first_hit: Vec3<S>,
    /// x of the floor point [m].
    pub x: S,
    /// y of the floor point [m].
    pub y: S,
    /// Bound of the rounding error of x and y [m].
    pub error: S,
}

impl<S: Scalar> CylinderCup<S> {
    /// The floor point that the ray from `camera` through the point `aim` reaches after 1 to `max_bounces` reflections
    /// at the inner side of the wall; `None` if there is no such point.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>, max_bounces: u32) -> Option<Seen<S>> {
        let a = self.wall.radius;
        let ray = aim - camera;
        let plan = ray.x.hypot(ray.y);
        let slope = ray.z / plan;
        let (mut dx, mut dy) = (ray.x / plan, ray.y / plan);
        let across = camera.x * dy - camera.y * dx;
        let ahead = camera.x * dx + camera.y * dy;
        if !(slope < S::ZERO && across.abs() < a) {
            return None;
        }
        let half = ((a - across) * (a + across)).sqrt();
        let (enter, exit) = (-ahead - half, half - ahead);
        // From outside, the ray must come in through the opening or over the rim.
        if enter > S::ZERO {
            let z = camera.z + slope * enter;
            let cos_phi = (camera.x + enter * dx) / a;
            if z < S::ZERO || (self.wall.covers(cos_phi) && self.wall.reaches(z)) {
                return None;
            }
        }
        let hit = vec3(
            camera.x + exit * dx,
            camera.y + exit * dy,
            camera.z + slope * exit,
        );
        let met = exit > S::ZERO
            && hit.z >= S::ZERO
            && self.wall.covers(hit.x / a)
            && self.wall.reaches(hit.z);
        if !met {
            return None;
        }
        let chord = S::TWO * half;
        let (mut px, mut py, mut rest) = (hit.x, hit.y, -hit.z / slope);
        for bounces in 1..=max_bounces.min(MAX_BOUNCES) {
            let (nx, ny) = (px / a, py / a);
            let normal = S::TWO * (dx * nx + dy * ny);
            (dx, dy) = (dx - normal * nx, dy - normal * ny);
            let (end_x, end_y) = (px + chord * dx, py + chord * dy);
            if rest <= chord || !self.wall.covers(end_x / a) {
                let size = camera.length() + aim.length() + rest + a;
                let ratio = size / ray.length() * (S::ONE + (S::ONE / slope).abs());
                let turns = S::from_f64(f64::from(16 * bounces));
                return Some(Seen {
                    bounces,
                    first_hit: hit,
                    x: px + rest * dx,
                    y: py + rest * dy,
                    error: turns * S::EPSILON * size * ratio * (S::ONE + a / half),
                });
            }
            (px, py, rest) = (end_x, end_y, rest - chord);
        }
        None
    }
}
