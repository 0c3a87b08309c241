//! Photon density estimation: the convolution of the true caustic irradiance with the kernel, in the receiver's plane.
//!
//! ```text
//! E_r(x) = ∫ k(|X − x|) E(X) dX,   E(X) = R I (y' − X)·n / |y' − X|³ where the mirror lights X, 0 elsewhere
//! m₂ = 4πRI ∫ k² E dX              one photon, uniform over the sphere
//! ```
//!
//! Photons exist on the receiver's rectangle only and land in front of the mirror only; the kernel is not renormalised at
//! either edge, and no visibility is asked between X and x, so a point just behind the mirror's plane still gathers. The lit
//! set is convex: a point X in front of the mirror is lit if X is inside the pyramid from y' through the mirror's edges.

use super::clip::Domain;
use super::polar::Chart;
use super::setting::PlanarSetting;
use crate::vector::{Vec3, vec3};

/// The lit part of the receiver's plane in polar coordinates about x.
#[derive(Clone, Debug)]
pub(super) struct Landing {
    /// Height of y' above the receiver's plane.
    height: f64,
    /// |x − y'|² and the components of x − y' along the two axes of the receiver's plane.
    distance_squared: f64,
    offset: [f64; 2],
    strength: f64,
    domain: Domain,
}

impl Landing {
    /// With or without the receiver's edges. `None` if the image of the light is not above the receiver's plane.
    pub fn new(setting: &PlanarSetting, x: Vec3<f64>, with_edges: bool) -> Option<Self> {
        let m = setting.receiver_normal;
        let image = setting.image();
        let height = (image - x).dot(m);
        if !(height > 0.0) {
            return None;
        }
        let least = if m.x.abs() < 0.6 {
            vec3(1.0, 0.0, 0.0)
        } else {
            vec3(0.0, 1.0, 0.0)
        };
        let e1 = (least - m * least.dot(m)).normalized();
        let e2 = m.cross(e1);
        let mut domain = Domain::default();
        let mut cut =
            |normal: Vec3<f64>, room: f64| domain.cut([normal.dot(e1), normal.dot(e2)], room);
        // In front of the mirror.
        cut(-setting.mirror_normal, setting.mirror_height(x));
        for e in setting.receiver_edges.iter().filter(|_| with_edges) {
            cut(e.normal, e.offset - e.normal.dot(x));
        }
        // An edge N·s ≤ o of the mirror, seen from y': with u = o − N·y' and s = y' + (X − y') h/(h − h_X), h = h(y') < 0
        // the height above the mirror, h_X > 0:  N·(X − y') h ≥ u (h − h_X), linear in X.
        let h = setting.mirror_height(image);
        for e in &setting.mirror_edges {
            let u = e.offset - e.normal.dot(image);
            let normal = e.normal * -h - setting.mirror_normal * u;
            let at_x = (x - image).dot(e.normal) * -h + u * (h - setting.mirror_height(x));
            cut(normal, -at_x);
        }
        let from = x - image;
        Some(Landing {
            height,
            distance_squared: from.length_squared(),
            offset: [from.dot(e1), from.dot(e2)],
            strength: setting.strength,
            domain,
        })
    }

    /// The irradiance at x itself: that of an unbounded mirror if x is in front of it and inside the lit set, else 0.
    pub fn sharp(&self) -> f64 {
        if self.domain.room() > 0.0 {
            let d2 = self.distance_squared;
            self.strength * self.height / (d2 * libm::sqrt(d2))
        } else {
            0.0
        }
    }

    /// Whether x itself is on the border of the lit set, to a distance.
    pub fn is_on_border(&self, distance: f64) -> bool {
        let room = self.domain.room();
        room.abs() <= distance
    }
}

impl Chart for Landing {
    type Line = f64;

    fn line(&self, c: f64, s: f64) -> f64 {
        2.0 * (self.offset[0] * c + self.offset[1] * s)
    }

    fn level(&self, _: &f64, rho: f64) -> f64 {
        rho
    }

    #[inline(always)]
    fn density(&self, line: &f64, rho: f64) -> [f64; 2] {
        let d2 = self.distance_squared + rho * (line + rho);
        let e = self.strength * self.height / (d2 * libm::sqrt(d2));
        let mean = rho * e;
        [mean, mean * (4.0 * core::f64::consts::PI * self.strength)]
    }

    fn farthest(&self, level: f64) -> f64 {
        level
    }

    fn domain(&self) -> &Domain {
        &self.domain
    }
}
