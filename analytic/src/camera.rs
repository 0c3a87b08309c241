//! The pinhole camera as the truth sees it: film coordinates to rays, linear in the film.
//!
//! Film coordinates (u, v) count pixels: pixel (i, j) covers [i, i+1] × [j, j+1], v grows downwards. The (unnormalised)
//! ray direction is linear in (u, v), so a straight line in space is a straight line on the film.

use libm::tan;

use crate::scene::Camera;
use crate::vector::Vec3;

/// A camera, ready for use: `direction(u, v) = corner + u du + v dv`.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// Pinhole [m].
    pub position: Vec3<f64>,
    /// Unit direction of the image centre.
    pub forward: Vec3<f64>,
    /// Direction at (0, 0), the top left corner; its component along `forward` is 1.
    pub corner: Vec3<f64>,
    /// Change of the direction per column.
    pub du: Vec3<f64>,
    /// Change of the direction per row.
    pub dv: Vec3<f64>,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Film {
    /// Prepares a camera that has passed [`crate::scene::Entry::validate`].
    pub fn new(camera: &Camera) -> Self {
        let position = Vec3::from_f64(camera.position);
        let forward = (Vec3::from_f64(camera.look_at) - position).normalized();
        let right = forward.cross(Vec3::from_f64(camera.up)).normalized();
        let up = right.cross(forward);
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let half = tan(0.5 * camera.field_of_view_degrees.to_radians());
        // Square pixels: the same scale along both axes.
        let pixel = 2.0 * half / h;
        Film {
            position,
            forward,
            corner: forward - right * (half * w / h) + up * half,
            du: right * pixel,
            dv: -(up * pixel),
            width: camera.width,
            height: camera.height,
        }
    }

    /// Direction of the ray through film point (u, v), not normalised.
    #[inline(always)]
    pub fn direction(&self, u: f64, v: f64) -> Vec3<f64> {
        self.corner + self.du * u + self.dv * v
    }

    /// Film coordinates of a point in front of the camera; `None` behind it.
    pub fn project(&self, point: Vec3<f64>) -> Option<(f64, f64)> {
        let d = point - self.position;
        let depth = d.dot(self.forward);
        if !(depth > 0.0) {
            return None;
        }
        let d = d * (1.0 / depth) - self.corner;
        Some((
            d.dot(self.du) / self.du.length_squared(),
            d.dot(self.dv) / self.dv.length_squared(),
        ))
    }
}

/// An approximate value and how far the truth can be from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// Absolute error bound, never negative.
    pub error: f64,
}
