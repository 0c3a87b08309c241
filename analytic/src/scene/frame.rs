//! What a camera does not see: convex bodies beside the frame, and what is above a frame that looks down.
//!
//! The rays of the frame fill a convex cone, so a convex body that no ray meets can be told from it by a plane through
//! the pinhole. Only the four planes by the frame's borders are tried: what they do not tell apart is refused. That is
//! more than needed only for bodies across a corner of the frame.

use crate::camera::Film;
use crate::scene::Camera;
use crate::scene::ranges::{Checked, invalid};
use crate::vector::Vec3;

/// The frame of a camera that has passed its own checks.
pub(super) struct Frame<'a> {
    camera: &'a Camera,
    /// Pinhole, and the inner normals of the planes by the frame's borders.
    eye: Vec3<f64>,
    inward: [Vec3<f64>; 4],
}

impl<'a> Frame<'a> {
    pub fn new(camera: &'a Camera) -> Self {
        let film = Film::new(camera);
        let (w, h) = (f64::from(film.width), f64::from(film.height));
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| film.direction(u, v));
        let inward = core::array::from_fn(|k| {
            let n = corners[k].cross(corners[(k + 1) % 4]).normalized();
            // The axis is inside.
            if n.dot(film.forward) < 0.0 { -n } else { n }
        });
        Frame {
            camera,
            eye: film.position,
            inward,
        }
    }

    /// Checks that no ray of the frame meets a convex body, of which `reach(n)` is the largest n·p over its points.
    pub fn check_beside(&self, body: &str, reach: impl Fn([f64; 3]) -> f64) -> Checked {
        let beside = |n: &Vec3<f64>| reach([n.x, n.y, n.z]) < n.dot(self.eye);
        if self.inward.iter().any(beside) {
            return Ok(());
        }
        Err(invalid(
            "camera.look_at",
            format!("{:?}", self.camera.look_at),
            &format!("a frame beside {body}: wholly on the outer side of one of its borders"),
        ))
    }
}

impl Camera {
    /// Whether every ray of the frame goes down, from a pinhole below `ceiling`: then it sees nothing above the floor that
    /// is above `ceiling`, and such a thing does not hide the floor.
    pub(super) fn check_under(&self, ceiling: f64) -> Checked {
        if !(self.position[2] < ceiling) {
            return Err(invalid(
                "camera.position",
                format!("{:?}", self.position),
                &format!("a camera lower than any optical surface: z less than {ceiling}"),
            ));
        }
        let film = Film::new(self);
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        // The direction is linear in the film: its corners are its extremes.
        let down = [(0.0, 0.0), (w, 0.0), (0.0, h), (w, h)]
            .iter()
            .all(|&(u, v)| film.direction(u, v).z < 0.0);
        if down {
            return Ok(());
        }
        Err(invalid(
            "camera.look_at",
            format!("{:?}", self.look_at),
            "a frame below the horizon, in which there is no optical surface",
        ))
    }
}
