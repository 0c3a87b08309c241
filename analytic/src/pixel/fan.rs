//! A footprint swept by vertical planes through the pinhole.
//!
//! A vertical plane stays a plane through a reflection in a vertical wall, and through refraction in flat water, and it is
//! a straight line on the film. So within such a slice everything is one-dimensional: horizontal distance r from the foot of
//! the pinhole. What remains is an integral over the azimuth, analytic between break points.

use libm::{atan2, cos, hypot, sin};

use crate::camera::Bounded;
use crate::pixel::floor_polygon::{Edge, FloorPolygon};
use crate::pixel::line::Line;

/// How a slice's integral behaves on approach to a break point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Singularity {
    /// Analytic up to the break point, from either side.
    Kink = 1,
    /// Like a square root: a slice touches a border, or a fold reaches the border of what is seen.
    Root = 2,
    /// At worst like a logarithm: a slice touches a fold.
    Logarithm = 4,
}

/// An azimuth at which the slice's integral is not analytic.
#[derive(Clone, Copy, Debug)]
pub struct Break {
    /// Azimuth, relative to the fan's axis [rad].
    pub azimuth: f64,
    /// Behaviour there.
    pub kind: Singularity,
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
                    kind: Singularity::Kink,
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
    pub fn add(&mut self, points: &[[f64; 2]], kind: Singularity) {
        let (low, high) = self.range();
        for p in points {
            let azimuth = self.azimuth(*p);
            if azimuth > low && azimuth < high {
                self.breaks.insert(1, Break { azimuth, kind });
            }
        }
    }

    /// The break points in order, neighbours closer than rounding joined.
    pub fn sorted(&self) -> Vec<Break> {
        let mut breaks = self.breaks.clone();
        sort(&mut breaks);
        breaks
    }
}

/// Sorts break points and joins neighbours that rounding cannot tell apart.
pub fn sort(breaks: &mut Vec<Break>) {
    breaks.sort_by(|a, b| a.azimuth.total_cmp(&b.azimuth));
    let range = match (breaks.first(), breaks.last()) {
        (Some(a), Some(b)) => b.azimuth - a.azimuth,
        _ => 0.0,
    };
    breaks.dedup_by(|b, a| {
        let join = b.azimuth - a.azimuth <= 1e-13 * range;
        if join {
            a.kind = a.kind.max(b.kind);
        }
        join
    });
}

/// ∫ f over [a, b]. Towards a singular end θ = a + L u^p takes the singularity away; with two, each has its half.
pub fn integrate_between(
    line: &Line,
    a: Break,
    b: Break,
    tolerance: f64,
    f: &mut impl FnMut(f64) -> Bounded,
) -> Bounded {
    use Singularity::Kink;
    if a.kind == Kink && b.kind == Kink {
        return line.integrate(a.azimuth, b.azimuth, tolerance, f);
    }
    let middle = 0.5 * (a.azimuth + b.azimuth);
    let (to, from) = match (a.kind, b.kind) {
        (_, Kink) => (b.azimuth, b.azimuth),
        (Kink, _) => (a.azimuth, a.azimuth),
        _ => (middle, middle),
    };
    let mut sum = Bounded::default();
    for (end, inner) in [(a, to), (b, from)] {
        let length = inner - end.azimuth;
        if end.kind == Kink || length == 0.0 {
            continue;
        }
        let power = end.kind as i32;
        let part = line.integrate(0.0, 1.0, 0.5 * tolerance, &mut |u| {
            let steep = if power == 2 { u } else { u * u * u };
            let weight = length.abs() * f64::from(power) * steep;
            let y = f(end.azimuth + length * steep * u);
            Bounded {
                value: weight * y.value,
                error: weight * y.error,
            }
        });
        sum.value += part.value;
        sum.error += part.error;
    }
    sum
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
