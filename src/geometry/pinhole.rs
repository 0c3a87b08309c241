//! The pinhole camera: film points to rays for paths from the eye, floor points to pixels for paths from the light.
//!
//! The film is the plane at depth 1; a pixel is a square of side p = 2 tan(fov/2)/height on it, row 0 at the top. A patch
//! dA of the floor (normal up, seen from height h) at depth d covers the film area h dA/d³: the patch subtends
//! cos θ dA/D² with cos θ = h/D, and a solid angle at the angle β = acos(d/D) from the axis covers 1/cos³β on the film.

use glam::DVec3;
use nephroid_analytic::scene::Camera;

use super::scene::unit;

/// The camera, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Pinhole {
    /// Position [m].
    pub position: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Side of a pixel on the film plane at depth 1.
    pixel: f64,
    /// Columns and rows.
    columns: f64,
    rows: f64,
}

impl Pinhole {
    /// Prepares a validated camera.
    pub fn new(camera: &Camera) -> Self {
        let position = DVec3::from_array(camera.position);
        let forward = unit(DVec3::from_array(camera.look_at) - position);
        let right = unit(forward.cross(DVec3::from_array(camera.up)));
        let rows = f64::from(camera.height);
        Pinhole {
            position,
            forward,
            right,
            up: right.cross(forward),
            pixel: 2.0 * libm::tan(0.5 * camera.field_of_view_degrees.to_radians()) / rows,
            columns: f64::from(camera.width),
            rows,
        }
    }

    /// Side of a pixel on the film plane at depth 1.
    pub fn pixel_side(&self) -> f64 {
        self.pixel
    }

    /// Number of pixels.
    pub fn pixels(&self) -> f64 {
        self.columns * self.rows
    }

    /// Columns and rows, as film coordinates count them.
    #[inline(always)]
    pub fn size(&self) -> (f64, f64) {
        (self.columns, self.rows)
    }

    /// Direction of the ray through column `u`, row `v` (pixels, from the top left corner), with depth 1.
    #[inline(always)]
    pub fn direction(&self, u: f64, v: f64) -> DVec3 {
        let across = (u - 0.5 * self.columns) * self.pixel;
        let upwards = (0.5 * self.rows - v) * self.pixel;
        self.forward + self.right * across + self.up * upwards
    }

    /// Column and row of a floor point, and pixels covered per unit of floor area there [1/m²], 0 where the point is
    /// behind the camera or outside its film.
    #[inline(always)]
    pub fn project_floor(&self, point: DVec3) -> (f64, f64, f64) {
        self.projected(point, self.position.z)
    }

    /// The same for a point of a surface with this unit normal, and per unit of its area; 0 if it faces away.
    pub fn project(&self, point: DVec3, normal: DVec3) -> (f64, f64, f64) {
        self.projected(point, normal.dot(self.position - point))
    }

    /// Column, row and density of a point whose tangent plane is `height` below the camera.
    #[inline(always)]
    fn projected(&self, point: DVec3, height: f64) -> (f64, f64, f64) {
        let d = point - self.position;
        let depth = d.dot(self.forward);
        let scale = 1.0 / (depth * self.pixel);
        let u = 0.5 * self.columns + d.dot(self.right) * scale;
        let v = 0.5 * self.rows - d.dot(self.up) * scale;
        let seen = (depth > 0.0) & (u >= 0.0) & (u < self.columns) & (v >= 0.0) & (v < self.rows);
        let density = height * scale * scale / depth;
        (u, v, if seen { density } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera {
            position: [0.3, -2.0, 1.7],
            look_at: [-0.4, 0.9, 0.2],
            up: [0.1, -0.2, 2.0],
            field_of_view_degrees: 63.0,
            width: 90,
            height: 50,
        }
    }

    #[test]
    fn projecting_undoes_the_ray_and_the_density_is_the_jacobian() {
        let c = Pinhole::new(&camera());
        for (u, v) in [(3.0, 45.0), (50.5, 30.25), (89.0, 49.5)] {
            let floor_of = |u: f64, v: f64| {
                let d = c.direction(u, v);
                c.position + d * (-c.position.z / d.z)
            };
            let x = floor_of(u, v);
            let (pu, pv, density) = c.project_floor(x);
            assert!((pu - u).abs() < 1e-11 && (pv - v).abs() < 1e-11);
            // Floor area of a small square of the film, by central differences.
            let h = 1e-4;
            let a = (floor_of(u + h, v) - floor_of(u - h, v)) / (2.0 * h);
            let b = (floor_of(u, v + h) - floor_of(u, v - h)) / (2.0 * h);
            let area = (a.x * b.y - a.y * b.x).abs();
            assert!((density * area - 1.0).abs() < 1e-6, "{}", density * area);
        }
    }

    #[test]
    fn what_is_not_on_the_film_has_no_density() {
        let c = Pinhole::new(&camera());
        for p in [
            DVec3::new(0.0, -30.0, 0.0),
            DVec3::new(100.0, 0.0, 0.0),
            DVec3::new(0.3, -2.0, 0.0),
            DVec3::new(0.2, -1.5, 0.0),
        ] {
            assert_eq!(c.project_floor(p).2, 0.0);
        }
    }

    #[test]
    fn the_image_centre_looks_at_the_point_and_row_zero_is_the_top() {
        let c = Pinhole::new(&camera());
        let d = c.direction(45.0, 25.0);
        let aim = unit(DVec3::new(-0.7, 2.9, -1.5));
        assert!(d.dot(d) < 1.0 + 1e-14 && (unit(d) - aim).length() < 1e-14);
        assert!(c.direction(45.0, 0.0).z > c.direction(45.0, 50.0).z);
        assert!(c.direction(90.0, 25.0).x > c.direction(0.0, 25.0).x);
    }
}
