//! Forward tracing of the light's rays off the implicit surface, with vectors in three dimensions.

use std::f64::consts::PI;

use libm::{atan2, cos, hypot, sin};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::vector::vec3;

use crate::forward::{Cases, V, add, dot, jacobian, land, unit};

/// The angle at which the curve ends or closes.
pub fn farthest(e: f64) -> f64 {
    if e < 1.0 { PI } else { libm::acos(-1.0 / e) }
}

/// A wall with its light somewhere on the inner side.
pub fn draw(cases: &mut Cases, e: f64, closed: bool) -> ConicWall<f64> {
    let p = cases.uniform(0.4, 2.0);
    let turn = cases.uniform(-PI, PI);
    let (x, y) = (cases.uniform(-2.0, 2.0), cases.uniform(-2.0, 2.0));
    let at = cases.uniform(-0.9, 0.9) * farthest(e);
    let r = (p / (1.0 + e * cos(at))).min(4.0 * p) * cases.uniform(0.0, 0.9);
    let h = cases.uniform(0.3, 3.0);
    let mut wall = ConicWall {
        x,
        y,
        axis: (cos(turn), sin(turn)),
        parameter: p,
        eccentricity: e,
        half_arc: (!closed).then(|| cases.uniform(0.2, 0.85) * farthest(e)),
        height: h * cases.uniform(0.3, 1.3),
        reflectance: cases.uniform(0.3, 1.0),
        light: vec3(x, y, h),
        intensity: cases.uniform(0.5, 3.0),
    };
    let light = place(&wall, r * cos(at), r * sin(at));
    wall.light = vec3(light.0, light.1, h);
    wall
}

/// From coordinates about focus and axis.
pub fn place(w: &ConicWall<f64>, x: f64, y: f64) -> (f64, f64) {
    let (c, s) = w.axis;
    (w.x + c * x - s * y, w.y + s * x + c * y)
}

/// To coordinates about focus and axis.
pub fn about(w: &ConicWall<f64>, q: [f64; 2]) -> (f64, f64) {
    let (dx, dy) = (q[0] - w.x, q[1] - w.y);
    (dx * w.axis.0 + dy * w.axis.1, dy * w.axis.0 - dx * w.axis.1)
}

pub fn level(w: &ConicWall<f64>, q: [f64; 2]) -> f64 {
    let (x, y) = about(w, q);
    hypot(x, y) + w.eccentricity * x - w.parameter
}

/// Unit inner normal: minus the gradient of the level function.
pub fn normal(w: &ConicWall<f64>, q: V) -> V {
    let (x, y) = about(w, [q[0], q[1]]);
    let r = hypot(x, y);
    let (gx, gy) = (x / r + w.eccentricity, y / r);
    let (c, s) = w.axis;
    unit([-(c * gx - s * gy), -(s * gx + c * gy), 0.0])
}

pub fn light(w: &ConicWall<f64>) -> V {
    [w.light.x, w.light.y, w.light.z]
}

/// The wall at θ and z, the light's ray to it, and the reflected one.
pub fn reflect_at(w: &ConicWall<f64>, theta: f64, z: f64) -> (V, V, V) {
    let r = w.parameter / (1.0 + w.eccentricity * cos(theta));
    let (x, y) = place(w, r * cos(theta), r * sin(theta));
    let q = [x, y, z];
    let d = unit(add(q, light(w), -1.0));
    let n = normal(w, q);
    (q, d, add(d, n, -2.0 * dot(d, n)))
}

/// Flux per angle θ and height.
pub fn density(w: &ConicWall<f64>, theta: f64, z: f64) -> f64 {
    let (q, d, _) = reflect_at(w, theta, z);
    let to = add(q, light(w), -1.0);
    // Length of the plan curve per angle.
    let r = w.parameter / (1.0 + w.eccentricity * cos(theta));
    let dr = r * r / w.parameter * w.eccentricity * sin(theta);
    w.intensity * w.reflectance * -dot(d, normal(w, q)) / dot(to, to) * hypot(r, dr)
}

/// Whether the segment from `from` to `to`, its ends left out, meets the wall.
pub fn blocked(w: &ConicWall<f64>, from: V, to: V) -> bool {
    let steps = 400;
    let at = |t: f64| add(from, add(to, from, -1.0), t);
    let f = |t: f64| {
        let q = at(t);
        level(w, [q[0], q[1]])
    };
    let t = |n: i32| 1e-7 + (1.0 - 2e-7) * f64::from(n) / f64::from(steps);
    (1..=steps).any(|n| {
        let (mut a, mut b) = (t(n - 1), t(n));
        let sign = f(a) < 0.0;
        if sign == (f(b) < 0.0) {
            return false;
        }
        for _ in 0..50 {
            let m = 0.5 * (a + b);
            if (f(m) < 0.0) == sign { a = m } else { b = m }
        }
        let q = at(a);
        let (x, y) = about(w, [q[0], q[1]]);
        // r + e x = p with r = p - e x > 0 is this branch.
        let on_arc = w.half_arc.is_none_or(|half| atan2(y, x).abs() <= half);
        on_arc && q[2] <= w.height
    })
}

/// E at (x, y) by a dense scan and finite differences, the number of lit roots, and the smallest Jacobian.
pub fn traced(w: &ConicWall<f64>, x: f64, y: f64, shaded: &mut u32) -> (f64, u32, f64) {
    let half = w.half_arc.unwrap_or(PI);
    let steps = 6000;
    let offset = |theta: f64| {
        let (q, _, d) = reflect_at(w, theta, 0.0);
        (x - q[0]) * d[1] - (y - q[1]) * d[0]
    };
    let (mut total, mut count, mut smallest) = (0.0, 0, f64::INFINITY);
    for n in 1..=steps {
        let at = |n: i32| half * (2.0 * f64::from(n) / f64::from(steps) - 1.0);
        let (mut a, mut b) = (at(n - 1), at(n));
        let sign = offset(a) < 0.0;
        if sign == (offset(b) < 0.0) {
            continue;
        }
        for _ in 0..60 {
            let m = 0.5 * (a + b);
            if (offset(m) < 0.0) == sign {
                a = m;
            } else {
                b = m;
            }
        }
        let theta = 0.5 * (a + b);
        let (q, _, d) = reflect_at(w, theta, 0.0);
        let along = ((x - q[0]) * d[0] + (y - q[1]) * d[1]) / hypot(d[0], d[1]);
        let first = hypot(q[0] - w.light.x, q[1] - w.light.y);
        let z = w.light.z * along / (first + along);
        if !(along > 0.0 && z <= w.height) {
            continue;
        }
        let hit = [q[0], q[1], z];
        if blocked(w, light(w), hit) || blocked(w, hit, [x, y, 0.0]) {
            *shaded += 1;
            continue;
        }
        let map = |theta: f64, z: f64| {
            let (q, _, d) = reflect_at(w, theta, z);
            Some(land((q, d)))
        };
        let step = 1e-5 * z.min(w.light.z - z).min(1.0);
        let det = jacobian(map, theta, z, [1e-5, step]).expect("lands");
        let radius = hypot(q[0] - w.x, q[1] - w.y);
        smallest = smallest.min(det * (w.light.z - z) / (radius * (first + along)));
        total += density(w, theta, z) / det;
        count += 1;
    }
    (total, count, smallest)
}
