//! Where in the picture a floor point is seen: the way of [`Eye::look`] the other way round.

use libm::{acos, hypot, sincos, sqrt};

use super::eye::{Eye, Standing, Way};
use crate::kinds::cylinder_cup::CylinderCup;
use crate::vector::{Vec3, vec3};

/// A film point that shows a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sight {
    /// Film coordinates.
    pub film: [f64; 2],
    /// The weight on the way.
    pub weight: f64,
    /// Film area per floor area [m⁻²].
    pub density: f64,
}

/// Steps of the search for a zero, at most.
const STEPS: usize = 60;
/// Intervals of a wall's arc in which one reflection each is looked for.
const INTERVALS: usize = 48;
/// A floor point is the one that is shown if it is as near as this [m].
const SAME: f64 = 1e-6;
/// Step of the differences along the film, in pixels.
const STEP: f64 = 1e-4;

/// The zero of a function between two places with values of different signs: false position, of which the end that stays is halved
/// (Illinois).
fn zero([mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let enough = 1e-14 * (f64::abs(a) + f64::abs(b));
    for _ in 0..STEPS {
        if f64::abs(b - a) <= enough || fa == fb {
            break;
        }
        let c = (a * fb - b * fa) / (fb - fa);
        let fc = f(c);
        if fc == 0.0 {
            return c;
        }
        if (fc < 0.0) == (fb < 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        let step = f64::abs(c - b);
        (b, fb) = (c, fc);
        if step <= enough {
            break;
        }
    }
    b
}

/// The least value of a function that dips once between two places, and where: golden sections, until it is below zero.
fn least([mut a, mut b]: [f64; 2], f: impl Fn(f64) -> f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const SECTIONS: usize = 40;
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut fc, mut fd) = (f(c), f(d));
    for _ in 0..SECTIONS {
        if fc < 0.0 || fd < 0.0 {
            break;
        }
        if fc < fd {
            (b, d, fd) = (d, c, fc);
            c = b - GOLDEN * (b - a);
            fc = f(c);
        } else {
            (a, c, fc) = (c, d, fd);
            d = a + GOLDEN * (b - a);
            fd = f(d);
        }
    }
    if fc < fd { (c, fc) } else { (d, fd) }
}

impl Eye {
    /// Calls back with every film point inside the frame that shows the floor point.
    pub fn sights(&self, x: [f64; 2], mut found: impl FnMut(Sight)) {
        let floor = vec3(x[0], x[1], 0.0);
        match &self.way {
            Way::Direct(_) => self.sight(x, floor, &mut found),
            Way::Water { height, index } => {
                self.sight(x, self.above_water(floor, *height, *index), &mut found);
            }
            Way::Mirror(Standing::Plane(mirror)) => self.sight(x, mirror.image(floor), &mut found),
            Way::Mirror(Standing::Wall(cup)) => {
                for at in self.reflections(cup, floor).into_iter().flatten() {
                    self.sight(x, at, &mut found);
                }
            }
        }
    }

    /// The film point in whose direction a point is, if the scene has its path.
    fn sight(&self, x: [f64; 2], at: Vec3<f64>, found: &mut impl FnMut(Sight)) {
        let Some((u, v)) = self.film.project(at) else {
            return;
        };
        let (width, height) = (f64::from(self.film.width), f64::from(self.film.height));
        if !(u >= 0.0 && u < width && v >= 0.0 && v < height && self.sees(u, v)) {
            return;
        }
        // Behind a wall or a mirror there are floor points with the same plan that the way does not lead to.
        let (shown, weight) = self.look(u, v);
        let is_x = |k: usize| f64::abs(shown[k] - x[k]) < SAME * (1.0 + f64::abs(x[k]));
        if !(is_x(0) && is_x(1)) {
            return;
        }
        let difference = |a: [f64; 2], b: [f64; 2]| {
            let (x, y) = (self.look(a[0], a[1]).0, self.look(b[0], b[1]).0);
            [0, 1].map(|k| (x[k] - y[k]) / (2.0 * STEP))
        };
        let along = difference([u + STEP, v], [u - STEP, v]);
        let down = difference([u, v + STEP], [u, v - STEP]);
        let floor_area = f64::abs(along[0] * down[1] - along[1] * down[0]);
        found(Sight {
            film: [u, v],
            weight,
            density: 1.0 / floor_area,
        });
    }

    /// The point of the water's surface through which a floor point is seen: where n times the sine below is the sine above.
    fn above_water(&self, floor: Vec3<f64>, height: f64, index: f64) -> Vec3<f64> {
        let eye = self.film.position;
        let (dx, dy) = (floor.x - eye.x, floor.y - eye.y);
        let way = hypot(dx, dy);
        let (above, below) = (eye.z - height, height - floor.z);
        let excess = |p: f64| p / hypot(p, above) - index * (way - p) / hypot(way - p, below);
        // The excess grows with p.
        let p = zero([0.0, way], [excess(0.0), excess(way)], excess);
        let part = if way > 0.0 { p / way } else { 0.0 };
        vec3(eye.x + dx * part, eye.y + dy * part, height)
    }

    /// The points of a circular wall in which the eye sees a floor point, if the wall had no rim: in plan the normal halves the
    /// angle between the ways to both.
    fn reflections(&self, cup: &CylinderCup<f64>, floor: Vec3<f64>) -> [Option<Vec3<f64>>; 4] {
        let (eye, a) = (self.film.position, cup.wall.radius);
        let half = cup.wall.cos_half_arc.map_or(core::f64::consts::PI, acos);
        let leg = |p: Vec3<f64>, c: f64, s: f64| {
            let (x, y) = (p.x - a * c, p.y - a * s);
            (x, y, sqrt(x * x + y * y))
        };
        let tilt = |c: f64, s: f64| {
            let ((ex, ey, e), (fx, fy, f)) = (leg(eye, c, s), leg(floor, c, s));
            (ex / e + fx / f) * s - (ey / e + fy / f) * c
        };
        let of = |phi: f64| {
            let (s, c) = sincos(phi);
            tilt(c, s)
        };
        let mut points = [None; 4];
        let mut count = 0;
        let mut add = |ends: [f64; 2], values: [f64; 2]| {
            if (values[0] < 0.0) == (values[1] < 0.0) || count == points.len() {
                return;
            }
            let (s, c) = sincos(zero(ends, values, of));
            let (e, f) = (leg(eye, c, s).2, leg(floor, c, s).2);
            points[count] = Some(vec3(
                a * c,
                a * s,
                floor.z + (eye.z - floor.z) * f / (e + f),
            ));
            count += 1;
        };
        let width = 2.0 * half / INTERVALS as f64;
        let at = |k: usize| -half + k as f64 * width;
        let (turn_s, turn_c) = sincos(width);
        let (mut s, mut c) = sincos(-half);
        let mut values = [0.0; INTERVALS + 1];
        for value in &mut values {
            *value = tilt(c, s);
            (c, s) = (c * turn_c - s * turn_s, s * turn_c + c * turn_s);
        }
        for k in 0..INTERVALS {
            let ends = [values[k], values[k + 1]];
            add([at(k), at(k + 1)], ends);
            // Two zeros that are about to merge may both be inside an interval or two.
            let [low, middle, high] = [values[k.saturating_sub(1)], ends[0], ends[1]];
            let sign = if middle < 0.0 { -1.0 } else { 1.0 };
            let dips = k > 0 && sign * low >= sign * middle && sign * high > sign * middle;
            if dips && sign * low > 0.0 && sign * high > 0.0 {
                let (between, value) = least([at(k - 1), at(k + 1)], |phi| sign * of(phi));
                if value < 0.0 {
                    add([at(k - 1), between], [low, sign * value]);
                    add([between, at(k + 1)], [sign * value, high]);
                }
            }
        }
        points
    }
}
