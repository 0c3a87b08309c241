//! The conic wall's light as bundles of rays: what it reflects, and what it keeps from the floor outside.
//!
//! A ray of the light meets the wall at θ and the height z. Per dθ dz the wall takes I V_A p/(δ² |A - Q|³) (the curve's
//! length per angle is p m/δ²). With T = 2 (p/δ)(N·w) and b = 1 - e² w_x², the reflected ray stays inside while
//! T - b s2 ≥ 0; beyond, it exists only if the wall does not cover the second meeting, X = b Q_x + T w_x:
//! cos Θ (p b - e X) - X ≥ 0. Rays that the wall stops would have reached the floor at A + (Q - A) h/(h - z).

use super::ConicWall;
use crate::flux::{Bundle, MARGINS, Ray};

/// Which rays of a conic wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConicPart {
    /// Reflected rays that land on the inner side (LSDE).
    Inside,
    /// Reflected rays that leave the inner side where there is no wall (LSDE); none for a closed wall.
    Outside,
    /// Direct rays that the wall stops (negative, LDE).
    Stopped,
}

/// Rays of a point light by a conic wall; the parameters are (θ, z) at the wall.
#[derive(Clone, Copy, Debug)]
pub struct ConicRays {
    /// The wall with its light.
    pub wall: ConicWall<f64>,
    /// Which rays.
    pub part: ConicPart,
    /// Rays may be left out if they go on for more than this in plan after the wall [m].
    pub reach: f64,
}

impl Bundle for ConicRays {
    fn domain(&self) -> [[f64; 2]; 2] {
        let w = &self.wall;
        let end = w.arc().min(core::f64::consts::PI);
        // r + e x grows by at most 1 + e per length: no point of the wall is nearer to the light.
        let nearest = w.inside(w.light.x, w.light.y).max(0.0) / (1.0 + w.eccentricity);
        let highest = w.light.z * self.reach / (self.reach + nearest);
        [[-end, end], [0.0, w.height.min(highest)]]
    }

    fn ray(&self, [theta, z]: [f64; 2]) -> Ray {
        let wall = &self.wall;
        let (conic, a, h) = (wall.conic(), wall.lamp(), wall.light.z);
        let q = conic.point(theta);
        let (dx, dy) = (q.at.0 - a.0, q.at.1 - a.1);
        let first = libm::hypot(dx, dy);
        let distance = libm::hypot(first, h - z);
        let front = conic.front(&q, a);
        let (p, e) = (conic.parameter, conic.eccentricity);
        let taken =
            wall.intensity * front * p / (q.delta * q.delta * distance * distance * distance);
        let mut margins = [1.0; MARGINS];
        // s2/s1.
        let on = z / (h - z);
        let turn = if self.part == ConicPart::Stopped {
            0.0
        } else {
            2.0 * front / q.norm
        };
        // s1 w.
        let (wx, wy) = (dx + turn * q.normal.0, dy + turn * q.normal.1);
        let flux = if self.part == ConicPart::Stopped {
            -taken
        } else {
            let ahead = (q.normal.0 * wx + q.normal.1 * wy) / first;
            let t = 2.0 * p / q.delta * ahead;
            let cosine = wx / first;
            let b = 1.0 - e * e * cosine * cosine;
            let inner = t - b * on * first;
            let x = b * q.at.0 + t * cosine;
            let end = libm::cos(wall.arc().min(core::f64::consts::PI));
            if self.part == ConicPart::Inside {
                margins[0] = inner;
            } else {
                margins[0] = -inner;
                margins[1] = end * (p * b - e * x) - x;
                if wall.half_arc.is_none() {
                    margins[1] = -1.0;
                }
            }
            wall.reflectance * taken
        };
        let (x, y) = (q.at.0 + on * wx, q.at.1 + on * wy);
        let (c, s) = wall.axis;
        Ray {
            floor: [wall.x + c * x - s * y, wall.y + s * x + c * y],
            flux,
            margins,
        }
    }

    fn weight(&self, _: [f64; 2]) -> Option<f64> {
        (self.part != ConicPart::Stopped).then_some(self.wall.reflectance)
    }
}
