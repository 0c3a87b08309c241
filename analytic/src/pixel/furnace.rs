//! Pixels of a closed diffuse sphere seen from inside.
//!
//! Bounced light is the same everywhere and so is a pixel. Direct light of a light off the centre is an analytic function
//! of the film point, without an edge: Gauss rules over the pixel.

use core::f64::consts::PI;

use crate::camera::{Bounded, Film};
use crate::entries::WallTruth;
use crate::pixel::polygon::{Ladder, Polygon};
use crate::scene::Entry;
use crate::vector::Vec3;

/// The exact image of a furnace.
#[derive(Clone, Debug)]
pub struct FurnaceImage {
    wall: WallTruth,
    film: Film,
    ladder: Ladder,
    /// Radiance of every class in some direction: of the constant ones, in all.
    constant: Vec<Bounded>,
}

impl FurnaceImage {
    /// Prepares a validated entry; `None` if its kind is not a furnace.
    pub fn new(entry: &Entry) -> Option<Self> {
        let wall = WallTruth::new(entry)?;
        let film = Film::new(&entry.camera);
        let scale = wall.albedo() / PI;
        let constant = wall.at(film.forward).into_iter().map(|t| Bounded {
            value: scale * t.irradiance.value,
            error: scale * t.irradiance.error,
        });
        Some(FurnaceImage {
            constant: constant.collect(),
            film,
            ladder: Ladder::default(),
            wall,
        })
    }

    /// From the centre to the wall point seen at a film point.
    fn seen(&self, u: f64, v: f64) -> Vec3<f64> {
        let (p, d) = (
            self.film.position - self.wall.centre(),
            self.film.direction(u, v),
        );
        let a = self.wall.radius();
        let (dd, pd) = (d.length_squared(), p.dot(d));
        let rest = a * a - p.length_squared();
        let root = libm::sqrt(pd * pd + dd * rest);
        // The positive zero of |p + t d|² = a², without cancellation.
        let t = if pd > 0.0 {
            rest / (root + pd)
        } else {
            (root - pd) / dd
        };
        p + d * t
    }

    /// Row `j`, `[class][column]`: the mean radiance over the pixel.
    pub fn row(&self, j: u32, tolerance: f64, row: &mut [Vec<Bounded>]) {
        for (c, (out, constant)) in row.iter_mut().zip(&self.constant).enumerate() {
            out.fill(*constant);
            if c > 0 || self.wall.is_centred() {
                continue;
            }
            let scale = self.wall.albedo() / PI;
            let radiance = |u: f64, v: f64| scale * self.wall.direct(self.seen(u, v)).value;
            for (i, out) in (0..).zip(out.iter_mut()) {
                let pixel = Polygon::pixel(i, j);
                *out = self.ladder.integrate(&pixel, tolerance, 0.0, &radiance);
            }
        }
    }
}
