//! A footprint swept by vertical planes through the pinhole.
//!
//! A vertical plane stays a plane through a reflection in a vertical wall, and through refraction in flat water, and it is
//! a straight line on the film. So within such a slice everything is one-dimensional: horizontal distance r from the foot of
//! the pinhole. What remains is an integral over the azimuth, analytic between break points.

use core::f64::consts::PI;

use libm::{atan2, cos, hypot, sin};

use crate::camera::Bounded;
use crate::pixel::floor_polygon::{Edge, FloorPolygon};
use crate::pixel::line::Line;

/// An azimuth at which the slice's integral is not analytic.
#[derive(Clone, Copy, Debug)]
pub struct Break {
    /// Azimuth, relative to the fan's axis [rad].
    pub azimuth: f64,
    /// Whether the integral behaves like a square root there (a tangency, or the end of a fold), not just a kink.
    pub root: bool,
}

/// The range of azimuths of a footprint.
#[derive(Clone, Debug)]
pub struct Fan {
    nadir: [f64; 2],
    axis: [f64; 2],
    /// Break points, at least the two ends, ascending after [`Fan::sorted`].
    breaks: Vec<Break>,
}

impl Fan {
    /// The fan from `nadir` over a polygon that does not have it inside (on its border is allowed).
    pub fn new(nadir: [f64; 2], polygon: &FloorPolygon) -> Self {
        let to = [polygon.center[0] - nadir[0], polygon.center[1] - nadir[1]];
        let length = hypot(to[0], to[1]);
        let mut fan = Fan {
            nadir,
            axis: to.map(|c| c / length),
            breaks: Vec::with_capacity(8),
        };
        let far = 1e-12 * (length + polygon.radius);
        for c in &polygon.corners {
            if hypot(c[0] - nadir[0], c[1] - nadir[1]) > far {
                let azimuth = fan.azimuth(*c);
                fan.breaks.push(Break {
                    azimuth,
                    root: false,
                });
            }
        }
        fan.breaks.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth));
        fan
    }

    /// Azimuth of a point.
    pub fn azimuth(&self, x: [f64; 2]) -> f64 {
        let d = [x[0] - self.nadir[0], x[1] - self.nadir[1]];
        let (along, across) = (
            self.axis[0] * d[0] + self.axis[1] * d[1],
            self.axis[0] * d[1] - self.axis[1] * d[0],
        );
        atan2(across, along)
    }

    /// Unit vector of an azimuth.
    #[inline]
    pub fn direction(&self, azimuth: f64) -> [f64; 2] {
        let (s, c) = (sin(azimuth), cos(azimuth));
        let [x, y] = self.axis;
        [c * x - s * y, s * x + c * y]
    }

    /// Smallest and largest azimuth.
    pub fn range(&self) -> (f64, f64) {
        match (self.breaks.first(), self.breaks.last()) {
            (Some(a), Some(b)) => (a.azimuth, b.azimuth),
            _ => (0.0, 0.0),
        }
    }

    /// Adds the azimuths of points where the integral may not be analytic, if they are in range.
    pub fn add(&mut self, points: &[[f64; 2]], root: bool) {
        let (low, high) = self.range();
        for p in points {
            let azimuth = self.azimuth(*p);
            if azimuth > low && azimuth < high {
                self.breaks.insert(1, Break { azimuth, root });
            }
        }
    }

    /// The break points in order, neighbours closer than rounding joined.
    pub fn sorted(&self) -> Vec<Break> {
        let mut breaks = self.breaks.clone();
        breaks.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth));
        let (low, high) = self.range();
        let close = 1e-14 * (high - low);
        breaks.dedup_by(|b, a| {
            let join = b.azimuth - a.azimuth <= close;
            a.root |= join && b.root;
            join
        });
        breaks
    }
}

/// ∫ f over [a, b]; where an end is a square root, θ = m - h cos πt takes it away.
pub fn integrate_between(
    line: &Line,
    a: Break,
    b: Break,
    tolerance: f64,
    f: &mut impl FnMut(f64) -> Bounded,
) -> Bounded {
    if !(a.root || b.root) {
        return line.integrate(a.azimuth, b.azimuth, tolerance, f);
    }
    let (m, h) = (0.5 * (a.azimuth + b.azimuth), 0.5 * (b.azimuth - a.azimuth));
    line.integrate(0.0, 1.0, tolerance, &mut |t| {
        let weight = h * PI * sin(PI * t);
        let y = f(m - h * cos(PI * t));
        Bounded {
            value: weight * y.value,
            error: weight * y.error,
        }
    })
}

/// The points where a circle meets the lines of a polygon's edges, as far as they are near the polygon.
pub fn circle_crossings(
    center: [f64; 2],
    radius: f64,
    polygon: &FloorPolygon,
    points: &mut Vec<[f64; 2]>,
) {
    for Edge { normal, offset } in &polygon.edges {
        let distance = offset - normal[0] * center[0] - normal[1] * center[1];
        let rest = (radius - distance) * (radius + distance);
        if !(rest > 0.0) {
            continue;
        }
        let foot = [
            center[0] + distance * normal[0],
            center[1] + distance * normal[1],
        ];
        for half in [rest.sqrt(), -rest.sqrt()] {
            let p = [foot[0] - half * normal[1], foot[1] + half * normal[0]];
            if polygon.is_near(p, 1e-9 * polygon.radius) {
                points.push(p);
            }
        }
    }
}
