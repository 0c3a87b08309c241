//! The camera as a projective map of the floor.
//!
//! With d = x - p the depth W = d·forward and the film point are (u, v) = (U/W, V/W), where U, V and W are linear in the
//! floor point (x, y, 1). So pixel edges are straight lines on the floor, written without a division. The Jacobian of a
//! projective map with the matrix M (rows U, V, W) is det M / W³: that is the film's area per floor area.

use crate::camera::Film;
use crate::scene::Camera;
use crate::vector::{Vec3, vec3};

/// A function linear in the floor point: `a x + b y + c`.
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// Coefficient of x.
    pub a: f64,
    /// Coefficient of y.
    pub b: f64,
    /// Constant.
    pub c: f64,
}

impl Linear {
    /// The value at a floor point.
    #[inline(always)]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        self.a * x + self.b * y + self.c
    }

    fn minus(&self, k: f64, o: &Linear) -> Linear {
        Linear {
            a: self.a - k * o.a,
            b: self.b - k * o.b,
            c: self.c - k * o.c,
        }
    }
}

/// The map from the floor to the film.
#[derive(Clone, Debug)]
pub struct Lens {
    u: Linear,
    v: Linear,
    depth: Linear,
    determinant: f64,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Lens {
    /// Prepares a validated camera.
    pub fn new(camera: &Camera) -> Self {
        let film = Film::new(camera);
        let linear = |g: Vec3<f64>| Linear {
            a: g.x,
            b: g.y,
            c: -film.position.dot(g),
        };
        let axis = |step: Vec3<f64>| {
            let g = step * (1.0 / step.length_squared());
            linear(g - film.forward * film.corner.dot(g))
        };
        let (u, v, depth) = (axis(film.du), axis(film.dv), linear(film.forward));
        let row = |l: Linear| vec3(l.a, l.b, l.c);
        let determinant = row(u).dot(row(v).cross(row(depth)));
        Lens {
            u,
            v,
            depth,
            determinant,
            width: camera.width,
            height: camera.height,
        }
    }

    /// Film coordinates of a floor point.
    #[inline(always)]
    pub fn film(&self, x: f64, y: f64) -> [f64; 2] {
        let w = 1.0 / self.depth.at(x, y);
        [self.u.at(x, y) * w, self.v.at(x, y) * w]
    }

    /// Depth of a floor point [m], negative behind the camera.
    #[inline(always)]
    pub fn depth(&self, x: f64, y: f64) -> f64 {
        self.depth.at(x, y)
    }

    /// Film area per floor area [pixel²/m²].
    #[inline(always)]
    pub fn density(&self, x: f64, y: f64) -> f64 {
        let w = self.depth.at(x, y);
        self.determinant.abs() / (w * w * w)
    }

    /// Whether the map from the floor to the film keeps the sense of rotation in front of the camera: 1, or -1 if not.
    pub fn sense(&self) -> f64 {
        self.determinant.signum()
    }

    /// Positive right of the left edge of column `i`.
    pub fn column(&self, i: i64) -> Linear {
        self.u.minus(i as f64, &self.depth)
    }

    /// Positive below the upper edge of row `j`.
    pub fn row(&self, j: i64) -> Linear {
        self.v.minus(j as f64, &self.depth)
    }

    /// Five functions of which a point in front of the camera and in the frame has none negative.
    pub fn frame(&self) -> [Linear; 5] {
        let reversed = |l: Linear| Linear {
            a: -l.a,
            b: -l.b,
            c: -l.c,
        };
        [
            self.depth,
            self.column(0),
            reversed(self.column(i64::from(self.width))),
            self.row(0),
            reversed(self.row(i64::from(self.height))),
        ]
    }

    /// The floor point where two lines meet.
    pub fn meet(p: &Linear, q: &Linear) -> [f64; 2] {
        let w = p.a * q.b - p.b * q.a;
        [(p.b * q.c - p.c * q.b) / w, (p.c * q.a - p.a * q.c) / w]
    }
}
