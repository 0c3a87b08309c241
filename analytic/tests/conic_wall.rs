//! The conic wall against second routes that share no code with it: forward tracing with vectors in three dimensions off the implicit
//! surface r + e x = p, with finite differences for the Jacobian; the circular cup; a beam into a parabola; and the flux.

mod forward;

use std::f64::consts::PI;

use forward::{Cases, V, add, dot, jacobian, land, unit};
use libm::{atan2, cos, hypot, sin, sqrt};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{CylinderCup, Light, Wall};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::vector::vec3;

/// The angle at which the curve ends or closes.
fn farthest(e: f64) -> f64 {
    if e < 1.0 { PI } else { libm::acos(-1.0 / e) }
}

/// A wall with its light somewhere on the inner side.
fn draw(cases: &mut Cases, e: f64, closed: bool) -> ConicWall<f64> {
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
fn place(w: &ConicWall<f64>, x: f64, y: f64) -> (f64, f64) {
    let (c, s) = w.axis;
    (w.x + c * x - s * y, w.y + s * x + c * y)
}

/// To coordinates about focus and axis.
fn about(w: &ConicWall<f64>, q: [f64; 2]) -> (f64, f64) {
    let (dx, dy) = (q[0] - w.x, q[1] - w.y);
    (dx * w.axis.0 + dy * w.axis.1, dy * w.axis.0 - dx * w.axis.1)
}

fn level(w: &ConicWall<f64>, q: [f64; 2]) -> f64 {
    let (x, y) = about(w, q);
    hypot(x, y) + w.eccentricity * x - w.parameter
}

/// Unit inner normal: minus the gradient of the level function.
fn normal(w: &ConicWall<f64>, q: V) -> V {
    let (x, y) = about(w, [q[0], q[1]]);
    let r = hypot(x, y);
    let (gx, gy) = (x / r + w.eccentricity, y / r);
    let (c, s) = w.axis;
    unit([-(c * gx - s * gy), -(s * gx + c * gy), 0.0])
}

fn light(w: &ConicWall<f64>) -> V {
    [w.light.x, w.light.y, w.light.z]
}

/// The wall at θ and z, the light's ray to it, and the reflected one.
fn reflect_at(w: &ConicWall<f64>, theta: f64, z: f64) -> (V, V, V) {
    let r = w.parameter / (1.0 + w.eccentricity * cos(theta));
    let (x, y) = place(w, r * cos(theta), r * sin(theta));
    let q = [x, y, z];
    let d = unit(add(q, light(w), -1.0));
    let n = normal(w, q);
    (q, d, add(d, n, -2.0 * dot(d, n)))
}

/// Flux per angle θ and height.
fn density(w: &ConicWall<f64>, theta: f64, z: f64) -> f64 {
    let (q, d, _) = reflect_at(w, theta, z);
    let to = add(q, light(w), -1.0);
    // Length of the plan curve per angle.
    let r = w.parameter / (1.0 + w.eccentricity * cos(theta));
    let dr = r * r / w.parameter * w.eccentricity * sin(theta);
    w.intensity * w.reflectance * -dot(d, normal(w, q)) / dot(to, to) * hypot(r, dr)
}

/// Whether the segment from `from` to `to`, its ends left out, meets the wall.
fn blocked(w: &ConicWall<f64>, from: V, to: V) -> bool {
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
fn traced(w: &ConicWall<f64>, x: f64, y: f64, shaded: &mut u32) -> (f64, u32, f64) {
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

#[test]
fn irradiance_roots_and_visibility() {
    let mut cases = Cases(21);
    let mut roots = [0; 7];
    let mut shaded = 0;
    for case in 0..900 {
        let e = match case % 5 {
            0 => 0.0,
            1 => 1.0,
            2 | 3 => cases.uniform(0.05, 0.9),
            _ => cases.uniform(1.1, 2.5),
        };
        let w = draw(&mut cases, e, e < 1.0 && case % 3 == 0);
        let size = 1.6 * w.parameter;
        let (u, v) = (cases.uniform(-size, size), cases.uniform(-size, size));
        let (x, y) = place(&w, u, v);
        let sum = w.caustic(x, y);
        let mut dangerous = sum.error > 1e-9 * sum.value;
        w.for_each_root(x, y, |r| {
            let edge = r.on_arc.abs().min(r.below_rim.abs()).min(r.free.abs());
            dangerous |= edge < 1e-3 || r.spread.abs() < 0.02 * r.from_wall;
        });
        if dangerous || level(&w, [x, y]).abs() < 1e-2 {
            continue;
        }
        let (total, count, smallest) = traced(&w, x, y, &mut shaded);
        if smallest < 1e-2 {
            continue;
        }
        assert_eq!(sum.roots, count, "case {case}: {w:?} {x} {y}");
        assert!(
            (total - sum.value).abs() <= 2e-5 * sum.value,
            "case {case}: traced {total}, closed form {sum:?}, {smallest}"
        );
        roots[count as usize] += 1;
        // Direct light with its shadow.
        if w.clearance(x, y).abs() > 1e-3 {
            let dark = blocked(&w, light(&w), [x, y, 0.0]);
            let to = add(light(&w), [x, y, 0.0], -1.0);
            let free = w.intensity * unit(to)[2] / dot(to, to);
            let e = if dark { 0.0 } else { free };
            assert!(
                (w.direct(x, y).value - e).abs() <= 1e-13 * free,
                "case {case}"
            );
        }
    }
    assert!(
        roots[0] > 60 && roots[1] > 60 && roots[2] > 15 && roots[3] + roots[4] > 5 && shaded > 20,
        "{roots:?}, {shaded} shaded"
    );
}

#[test]
fn a_circle_is_the_cup() {
    let mut cases = Cases(22);
    let mut several = 0;
    for case in 0..300 {
        let mut w = draw(&mut cases, 0.0, case % 2 == 0);
        w.axis = (1.0, 0.0);
        let cup = CylinderCup {
            wall: Wall {
                radius: w.parameter,
                height: Some(w.height),
                cos_half_arc: w.half_arc.map(cos),
            },
            reflectance: w.reflectance,
            light: Light::Point(Lamp {
                x: w.light.x - w.x,
                y: w.light.y - w.y,
                height: w.light.z,
                intensity: w.intensity,
            }),
        };
        let r = w.parameter * cases.uniform(0.0, 1.4);
        let t = cases.uniform(-PI, PI);
        let (u, v) = (r * cos(t), r * sin(t));
        let (a, b) = (w.caustic(w.x + u, w.y + v), cup.caustic(u, v, 1));
        assert_eq!(a.roots, b.roots, "case {case}");
        let bound = a.error + b.error + 1e-15 * a.value;
        assert!(
            (a.value - b.value).abs() <= bound,
            "case {case}: {a:?} {b:?}"
        );
        several += u32::from(a.roots > 2);
        let d = w.direct(w.x + u, w.y + v).value;
        assert!(
            (d - cup.direct(u, v).value).abs() <= 1e-13 * d,
            "case {case}"
        );
        let near = w.singularity(w.x + u, w.y + v).map(|s| s.distance);
        match (near, cup.distance_to_fold(u, v, 1)) {
            (None, None) => {}
            (Some(n), Some(m)) => {
                // The cup's search knows no cusps off the axis: 1/512 of a turn along the curve.
                assert!((n - m).abs() <= 1e-3 * w.parameter, "case {case}: {n} {m}")
            }
            other => panic!("case {case}: {other:?}"),
        }
    }
    assert!(several > 10, "{several}");
}

#[test]
fn light_at_the_focus() {
    let mut cases = Cases(23);
    let mut lit = 0;
    for case in 0..300 {
        let e = match case % 3 {
            0 => 1.0,
            1 => cases.uniform(0.0, 0.9),
            _ => cases.uniform(1.1, 2.5),
        };
        let mut w = draw(&mut cases, e, case % 2 == 0 && e < 1.0);
        w.light = vec3(w.x, w.y, w.light.z);
        let size = 1.2 * w.parameter;
        let (u, v) = (cases.uniform(-size, size), cases.uniform(-size, size));
        let (x, y) = place(&w, u, v);
        let (mut explicit, mut general) = (vec![], vec![]);
        let listed = |r: nephroid_analytic::kinds::conic_wall::Root<f64>| {
            (r.theta, r.irradiance, r.is_lit(), r.conditioning)
        };
        w.for_each_focal_root(x, y, |r| {
            if r.on_arc > 0.0 {
                explicit.push(listed(r));
            }
        });
        w.for_each_general_root(x, y, |r| general.push(listed(r)));
        explicit.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(explicit.len(), general.len(), "case {case}: {w:?} {x} {y}");
        for (a, b) in explicit.iter().zip(&general) {
            let bound = 16.0 * f64::EPSILON * (4.0 + a.3 + b.3);
            assert!((a.1 / b.1 - 1.0).abs() <= bound, "case {case}: {a:?} {b:?}");
            assert_eq!(a.2, b.2, "case {case}");
            lit += u32::from(a.2);
        }
    }
    assert!(lit > 100, "{lit}");
}

#[test]
fn a_far_light_on_the_axis_of_a_parabola_meets_in_the_focus() {
    // The beam along the axis at elevation ε: E = E0 R sin ε Σ r/d, d from the focus, r = |Q|, on both sides of it.
    let mut cases = Cases(24);
    for _ in 0..50 {
        let (p, tan) = (cases.uniform(0.5, 2.0), cases.uniform(0.3, 1.5));
        let far = 1e7;
        let w = ConicWall {
            x: 0.0,
            y: 0.0,
            axis: (1.0, 0.0),
            parameter: p,
            eccentricity: 1.0,
            half_arc: Some(2.0),
            height: 10.0 * p * tan,
            reflectance: 0.8,
            light: vec3(-far, 0.0, far * tan),
            intensity: far * far * (1.0 + tan * tan),
        };
        let (d, t) = (p * cases.uniform(0.05, 0.2), cases.uniform(-PI, PI));
        let sum: f64 = [t, t + PI]
            .into_iter()
            .filter(|&q| atan2(sin(q), cos(q)).abs() <= 2.0)
            .map(|q| p / (1.0 + cos(q)) / d)
            .sum();
        let expected = 0.8 * tan / sqrt(1.0 + tan * tan) * sum;
        let got = w.caustic(d * cos(t), d * sin(t)).value;
        assert!((got / expected - 1.0).abs() < 1e-5, "{got} {expected}");
    }
}

#[test]
fn flux_of_a_light_at_the_focus() {
    // What the wall reflects to its floor: in the closed ellipse from hits below the height from which the ray comes
    // down before the wall; else from all below the rim. Floor in polar coordinates about the other focus (there E is
    // singular like 1/d), in strips for the parabola.
    let rule = gauss_legendre(48);
    let mut cases = Cases(25);
    for case in 0..6 {
        let e = [0.5, 1.0, 1.6, 0.2, 1.0, 2.2][case];
        let mut w = draw(&mut cases, e, e < 1.0);
        w.axis = (1.0, 0.0);
        (w.x, w.y) = (0.0, 0.0);
        let h = w.light.z;
        w.light = vec3(0.0, 0.0, h);
        w.height = if e < 1.0 { h } else { 0.4 * h };
        let p = w.parameter;
        let half = w.half_arc.unwrap_or(PI);
        let long = 2.0 * p / (1.0 - e * e);
        let other = -e * long;
        let (mut sent, mut landed) = (0.0, 0.0);
        for &(u, wu) in &rule {
            let theta = half * u;
            let r = p / (1.0 + e * cos(theta));
            let (qx, qy) = (r * cos(theta), r * sin(theta));
            let dr = r * r / p * e * sin(theta);
            // Velocity of Q with θ.
            let (vx, vy) = (dr * cos(theta) - qy, dr * sin(theta) + qx);
            // The last leg's direction and length, by the focal property.
            let (wx, wy, reach) = if e == 1.0 {
                (-1.0, 0.0, 0.0)
            } else {
                let d = hypot(qx - other, qy);
                let sign = if e < 1.0 { -1.0 } else { 1.0 };
                (sign * (qx - other) / d, sign * qy / d, d)
            };
            let (top, end) = if e < 1.0 {
                // To the far end of the chord through the other focus.
                let beyond = p / (1.0 - e * wx);
                let tau = reach + beyond;
                (h * tau / (r + tau), tau)
            } else {
                (w.height, r * w.height / (h - w.height))
            };
            for &(v, wv) in &rule {
                let (z, tau) = (0.5 * top * (v + 1.0), 0.5 * end * (v + 1.0));
                sent += wu * wv * half * 0.5 * top * density(&w, theta, z);
                if e >= 1.0 {
                    // The floor strip behind Q: area |velocity of Q across the ray| scaled by the divergence.
                    let across = (vx * wy - vy * wx).abs();
                    let spread = if e == 1.0 { 1.0 } else { (reach + tau) / reach };
                    let floor = w.caustic(qx + tau * wx, qy + tau * wy).value;
                    landed += wu * wv * half * 0.5 * end * across * spread * floor;
                }
            }
        }
        if e < 1.0 {
            for &(u, wu) in &rule {
                let phi = PI * u;
                let end = p / (1.0 - e * cos(phi));
                for &(v, wv) in &rule {
                    let d = 0.5 * end * (v + 1.0);
                    let floor = w.caustic(other + d * cos(phi), d * sin(phi)).value;
                    landed += wu * wv * PI * 0.5 * end * d * floor;
                }
            }
        }
        assert!((landed / sent - 1.0).abs() < 1e-7, "{e}: {landed} {sent}");
    }
}

#[test]
fn pairs_of_roots_are_born_on_the_caustic() {
    let mut cases = Cases(26);
    let mut folds = 0;
    for case in 0..300 {
        let e = [0.3, 0.7, 1.0, 1.5][case % 4];
        let mut w = draw(&mut cases, e, false);
        w.height = 2.0 * w.light.z;
        let from = (cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0));
        let step = (cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0));
        let at = |t: f64| {
            let p = w.parameter;
            place(&w, p * (from.0 + t * step.0), p * (from.1 + t * step.1))
        };
        let count = |t: f64| {
            let (x, y) = at(t);
            w.caustic(x, y).roots
        };
        for n in 0..200 {
            let (mut a, mut b) = (f64::from(n) / 200.0, f64::from(n + 1) / 200.0);
            let (low, high) = (count(a), count(b));
            if low.abs_diff(high) != 2 {
                continue;
            }
            while b - a > 1e-12 {
                let m = 0.5 * (a + b);
                if count(m) == low { a = m } else { b = m }
            }
            let (x, y) = at(a);
            // Two edges of the arc's light can lie in one step: then the numbers differ by one. All rays end at the wall.
            if count(a).abs_diff(count(b)) != 2 || level(&w, [x, y]).abs() < 1e-9 {
                continue;
            }
            let near = w.singularity(x, y).expect("a caustic");
            assert!(near.distance < 1e-8, "case {case}: {near:?}");
            assert_ne!(near.kind, SingularityKind::PointFocus);
            folds += 1;
        }
    }
    assert!(folds > 20, "{folds}");
}

#[test]
fn the_point_focus_is_reported() {
    let mut w = draw(&mut Cases(27), 0.6, true);
    w.light = vec3(w.x, w.y, w.light.z);
    w.height = 2.0 * w.light.z;
    let long = 2.0 * 0.6 * w.parameter / (1.0 - 0.36);
    let (x, y) = place(&w, -long, 0.0);
    let near = w.singularity(x, y).expect("a focus");
    assert_eq!(near.kind, SingularityKind::PointFocus);
    assert!(near.distance < 1e-14);
    // The light at that focus has its image at the first one.
    w.light = vec3(x, y, w.light.z);
    let near = w.singularity(w.x, w.y).expect("a focus");
    assert_eq!(near.kind, SingularityKind::PointFocus);
    assert!(!w.caustic(w.x, w.y).error.is_finite() || w.caustic(w.x, w.y).value > 1e12);
}

/// The formulas in single precision stay within the bounds that they state.
#[test]
fn single_precision_is_within_its_bound() {
    let mut cases = Cases(28);
    let mut checked = 0;
    for case in 0..400 {
        let e = [0.3, 0.8, 1.0, 1.7][case % 4];
        let mut w = draw(&mut cases, e, false);
        if case % 3 == 0 {
            w.light = vec3(w.x, w.y, w.light.z);
        }
        let (u, v) = (cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0));
        let (x, y) = place(&w, u, v);
        let single = ConicWall {
            x: w.x as f32,
            y: w.y as f32,
            axis: (w.axis.0 as f32, w.axis.1 as f32),
            parameter: w.parameter as f32,
            eccentricity: e as f32,
            half_arc: w.half_arc.map(|h| h as f32),
            height: w.height as f32,
            reflectance: w.reflectance as f32,
            light: vec3(w.light.x as f32, w.light.y as f32, w.light.z as f32),
            intensity: w.intensity as f32,
        };
        let (a, b) = (w.caustic(x, y), single.caustic(x as f32, y as f32));
        let off = (a.value - f64::from(b.value)).abs();
        assert!(off <= f64::from(b.error), "case {case}: {a:?} {b:?}");
        checked += u32::from(a.value > 0.0 && b.error < 1e-3 * b.value);
    }
    assert!(checked > 60, "{checked}");
}
