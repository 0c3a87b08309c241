//! Where a camera looks.

use crate::camera::Film;
use crate::scene::Camera;
use crate::scene::ranges::{Checked, invalid};
use crate::vector::Vec3;

impl Camera {
    /// Whether every ray of the frame goes down, from a pinhole below `ceiling`: then it sees nothing above the floor that
    /// is above `ceiling`, and such a thing does not hide the floor.
    pub(super) fn check_under(&self, ceiling: f64) -> Checked {
        if !(self.position[2] < ceiling) {
            return Err(invalid(
                "camera.position",
                format!("{:?}", self.position),
                &format!("a camera lower than the mirror: z less than {ceiling}"),
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
            "a frame below the horizon, in which there is no mirror",
        ))
    }
    /// Whether a ball is outside the pyramid of the frame's rays, by one of its four sides. Then it neither is in the frame
    /// nor hides what is. (Near an edge of the pyramid the check is stricter than need be.)
    pub(super) fn check_without_ball(&self, key: &str, center: &[f64; 3], radius: f64) -> Checked {
        let film = Film::new(self);
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let corners = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(u, v)| film.direction(u, v));
        let towards = Vec3::from_f64(*center) - film.position;
        let outside = (0..4).any(|k| {
            let normal = corners[k].cross(corners[(k + 1) % 4]).normalized();
            // The middle of the frame is on the inner side.
            let inwards = if normal.dot(film.forward) > 0.0 {
                1.0
            } else {
                -1.0
            };
            -inwards * normal.dot(towards) > radius
        });
        if outside {
            return Ok(());
        }
        Err(invalid(
            key,
            format!("{:?}", self.look_at),
            "a frame that does not show the ball",
        ))
    }
}
