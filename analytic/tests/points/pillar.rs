//! The pillar against a second route that shares no code with it: forward tracing with vectors in three dimensions, finite differences
//! for the Jacobian, a dense scan for the roots; the flat limit; and the flux on the whole floor.

use std::f64::consts::PI;

use crate::forward::{Cases, V, add, dot, jacobian, land, unit};
use libm::{acos, cos, hypot, sin};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::planar_mirror::PlanarMirror;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::vector::vec3;

fn draw(cases: &mut Cases) -> Pillar<f64> {
    let a = cases.uniform(0.2, 2.0);
    let at = cases.uniform(-PI, PI);
    let d = a * cases.uniform(1.05, 5.0);
    let (x, y) = (cases.uniform(-3.0, 3.0), cases.uniform(-3.0, 3.0));
    let h = cases.uniform(0.3, 4.0);
    Pillar {
        x,
        y,
        radius: a,
        height: h * cases.uniform(0.1, 1.2),
        reflectance: cases.uniform(0.3, 1.0),
        light: vec3(x + d * cos(at), y + d * sin(at), h),
        intensity: cases.uniform(0.5, 3.0),
    }
}

fn position(p: &Pillar<f64>) -> V {
    [p.light.x, p.light.y, p.light.z]
}

/// Where the side at the angle φ and height z is, and the reflected direction of the light's ray to it; nothing if the
/// light does not see it.
fn reflect_at(p: &Pillar<f64>, phi: f64, z: f64) -> Option<(V, V, V)> {
    let n = [cos(phi), sin(phi), 0.0];
    let q = add([p.x, p.y, z], n, p.radius);
    let d = unit(add(q, position(p), -1.0));
    (dot(d, n) < 0.0).then(|| (q, d, add(d, n, -2.0 * dot(d, n))))
}

/// Flux per area of the side.
fn density(p: &Pillar<f64>, phi: f64, q: V, d: V) -> f64 {
    let w = add(q, position(p), -1.0);
    p.intensity * p.reflectance * -dot(d, [cos(phi), sin(phi), 0.0]) / dot(w, w)
}

#[test]
fn irradiance_roots_and_visibility() {
    let mut cases = Cases(11);
    let (mut lit, mut above, mut none) = (0, 0, 0);
    for case in 0..400 {
        let p = draw(&mut cases);
        let (r, t) = (p.radius * cases.uniform(1.02, 6.0), cases.uniform(-PI, PI));
        let (x, y) = (p.x + r * cos(t), p.y + r * sin(t));
        // In plan: the offset of the point from the reflected ray, at every angle that the light sees.
        let offset = |phi: f64| {
            let (q, _, w) = reflect_at(&p, phi, 0.0)?;
            let along = ((x - q[0]) * w[0] + (y - q[1]) * w[1]) / hypot(w[0], w[1]);
            let across = (x - q[0]) * w[1] - (y - q[1]) * w[0];
            Some((across, along, q))
        };
        let steps = 4000;
        let mut total = 0.0;
        let mut found = 0;
        let mut before: Option<(f64, f64)> = None;
        for n in 0..=steps {
            let phi = 2.0 * PI * f64::from(n) / f64::from(steps);
            let now = offset(phi).map(|(across, ..)| (phi, across));
            if let (Some((low, at_low)), Some((high, at_high))) = (before, now)
                && (at_low < 0.0) != (at_high < 0.0)
            {
                let (mut b, mut c) = (low, high);
                for _ in 0..60 {
                    let m = 0.5 * (b + c);
                    match offset(m) {
                        Some((across, ..)) if (across < 0.0) == (at_low < 0.0) => b = m,
                        _ => c = m,
                    }
                }
                let phi = 0.5 * (b + c);
                let (_, along, q) = offset(phi).expect("seen");
                if along > 0.0 {
                    found += 1;
                    let first = hypot(q[0] - p.light.x, q[1] - p.light.y);
                    let z = p.light.z * along / (first + along);
                    if z <= p.height {
                        let (q, d, _) = reflect_at(&p, phi, z).expect("seen");
                        let map = |phi: f64, z: f64| {
                            let (q, _, w) = reflect_at(&p, phi, z)?;
                            Some(land((q, w)))
                        };
                        let h = 1e-5 * z.min(p.light.z - z).min(1.0);
                        let det = jacobian(map, phi, z, [1e-5, h]).expect("seen");
                        total += p.radius * density(&p, phi, q, d) / det;
                    }
                }
            }
            before = now;
        }
        let sum = p.caustic(x, y);
        let root = p.reflection(x, y);
        // The scan's resolution ends at the edge of the plan shadow.
        if root.is_some_and(|r| r.cos_incidence < 0.02) || p.shadow(x, y).1 < 0.01 * p.radius {
            continue;
        }
        assert_eq!(found, u32::from(root.is_some()), "case {case}: {root:?}");
        assert!(
            (total - sum.value).abs() <= 1e-5 * sum.value,
            "case {case}: traced {total}, closed form {sum:?}"
        );
        assert!(sum.error <= 1e-11 * sum.value, "case {case}: {sum:?}");
        lit += u32::from(sum.roots == 1);
        above += u32::from(root.is_some() && sum.roots == 0);
        none += u32::from(root.is_none());
    }
    assert!(
        lit > 60 && above > 60 && none > 30,
        "{lit} lit, {above} over the top, {none} without"
    );
}

/// The segment to the light against the solid cylinder, point by point.
#[test]
fn direct_light_and_shadow() {
    let mut cases = Cases(12);
    let (mut free, mut dark) = (0, 0);
    for case in 0..600 {
        let p = draw(&mut cases);
        let (r, t) = (p.radius * cases.uniform(0.5, 5.0), cases.uniform(-PI, PI));
        let (x, y) = (p.x + r * cos(t), p.y + r * sin(t));
        let light = position(&p);
        let inside = (0..=20_000).any(|k| {
            let q = add(
                [x, y, 0.0],
                add(light, [x, y, 0.0], -1.0),
                f64::from(k) / 2e4,
            );
            hypot(q[0] - p.x, q[1] - p.y) < p.radius && q[2] < p.height
        });
        let (shadow, margin) = p.shadow(x, y);
        if margin < 1e-3 {
            continue;
        }
        assert_eq!(inside, shadow, "case {case}: {p:?} {x} {y} {margin}");
        let w = add(light, [x, y, 0.0], -1.0);
        let e = if inside {
            0.0
        } else {
            p.intensity * unit(w)[2] / dot(w, w)
        };
        assert!((p.direct(x, y).value - e).abs() <= 1e-14 * e, "case {case}");
        free += u32::from(!inside);
        dark += u32::from(inside);
    }
    assert!(free > 200 && dark > 100, "{free} free, {dark} dark");
}

/// A pillar so large that its side is flat.
#[test]
fn flat_limit() {
    let mut cases = Cases(13);
    for _ in 0..100 {
        let a = 1e7;
        let light = vec3(cases.uniform(0.5, 2.0), cases.uniform(-1.0, 1.0), 1.7);
        let (x, y) = (cases.uniform(0.1, 2.0), cases.uniform(-1.0, 1.0));
        let pillar = Pillar {
            x: -a,
            y: 0.0,
            radius: a,
            height: 10.0,
            reflectance: 0.8,
            light,
            intensity: 2.0,
        };
        let normal = vec3(1.0, 0.0, 0.0);
        let flat = PlanarMirror::new(light, 2.0, 0.8, vec3(0.0, 0.0, 0.0), normal, None);
        let (e, f) = (
            pillar.caustic(x, y).value,
            flat.caustic_value(vec3(x, y, 0.0)),
        );
        assert!((e / f - 1.0).abs() < 3e-6, "{e} {f}");
    }
}

/// What the side reflects lands on the floor: all of it that hits below the light. Quadrature of the closed form over
/// the floor around the pillar, against quadrature of the intensity over the side.
#[test]
fn flux_on_the_floor() {
    let rule = gauss_legendre(60);
    let mut cases = Cases(14);
    for _ in 0..6 {
        let mut p = draw(&mut cases);
        p.height = 2.0 * p.light.z;
        let (a, h) = (p.radius, p.light.z);
        let (dx, dy) = (p.light.x - p.x, p.light.y - p.y);
        let (d, at) = (hypot(dx, dy), libm::atan2(dy, dx));
        let edge = acos(a / d);
        let mut sent = 0.0;
        let mut landed = 0.0;
        for &(u, wu) in &rule {
            for &(v, wv) in &rule {
                let (phi, z) = (at + edge * u, 0.5 * h * (v + 1.0));
                let (q, ray, _) = reflect_at(&p, phi, z).expect("seen");
                sent += wu * wv * edge * 0.5 * h * a * density(&p, phi, q, ray);
                // r = a + w/(1-t)² - w, and the angle up to the edge of the plan shadow.
                let t = 0.5 * (v + 1.0);
                let m = t / (1.0 - t);
                let r = a + a * m * m;
                let dr = a * 2.0 * m / ((1.0 - t) * (1.0 - t));
                let reach = edge + acos(a / r);
                let angle = at + reach * u;
                let e = p.caustic(p.x + r * cos(angle), p.y + r * sin(angle)).value;
                landed += wu * wv * reach * 0.5 * dr * r * e;
            }
        }
        assert!((landed / sent - 1.0).abs() < 2e-6, "{landed} {sent}");
    }
}

/// The formulas in single precision stay within the bounds that they state.
#[test]
fn single_precision_is_within_its_bound() {
    let mut cases = Cases(15);
    let mut checked = 0;
    for case in 0..400 {
        let p = draw(&mut cases);
        let (r, t) = (p.radius * cases.uniform(1.02, 6.0), cases.uniform(-PI, PI));
        let (x, y) = (p.x + r * cos(t), p.y + r * sin(t));
        let single = Pillar {
            x: p.x as f32,
            y: p.y as f32,
            radius: p.radius as f32,
            height: p.height as f32,
            reflectance: p.reflectance as f32,
            light: vec3(p.light.x as f32, p.light.y as f32, p.light.z as f32),
            intensity: p.intensity as f32,
        };
        for (a, b) in [
            (p.caustic(x, y), single.caustic(x as f32, y as f32)),
            (p.direct(x, y), single.direct(x as f32, y as f32)),
        ] {
            let off = (a.value - f64::from(b.value)).abs();
            assert!(off <= f64::from(b.error), "case {case}: {a:?} {b:?}");
            checked += u32::from(a.value > 0.0 && b.error < 1e-3 * b.value);
        }
    }
    assert!(checked > 100, "{checked}");
}

/// Towards the edge of the plan shadow, where the root vanishes: what single precision says, with its bound, contains what
/// double precision says about the same numbers, on both sides of the edge.
#[test]
fn the_bound_holds_across_the_edge_of_the_plan_shadow() {
    let (ax, ay, radius) = (-3.0_f64, 0.4_f64, 0.5_f64);
    let far = libm::hypot(ax, ay);
    let mut dark = 0;
    for k in 2..36 {
        for sign in [-1.0, 1.0] {
            let clearance = sign * libm::ldexp(1.0, -k);
            // The line from the light that passes the axis at the radius plus the clearance.
            let turn = libm::asin((radius + clearance) / far);
            let towards = libm::atan2(-ay, -ax) + turn;
            let (x, y) = (ax + 4.3 * libm::cos(towards), ay + 4.3 * libm::sin(towards));
            let numbers = [ax, ay, radius, x, y].map(|v| v as f32);
            let single = Pillar {
                x: 0.0_f32,
                y: 0.0,
                radius: numbers[2],
                height: 2.0,
                reflectance: 0.9,
                light: vec3(numbers[0], numbers[1], 1.5),
                intensity: 3.0,
            };
            let double = Pillar {
                x: 0.0,
                y: 0.0,
                radius: f64::from(numbers[2]),
                height: 2.0,
                reflectance: f64::from(0.9_f32),
                light: vec3(f64::from(numbers[0]), f64::from(numbers[1]), 1.5),
                intensity: 3.0,
            };
            let a = single.caustic(numbers[3], numbers[4]);
            let b = double.caustic(f64::from(numbers[3]), f64::from(numbers[4]));
            let (value, error) = (f64::from(a.value), f64::from(a.error));
            assert!(
                (value - b.value).abs() <= error + b.error,
                "{clearance:e}: {value:e} ± {error:e}, {:e} ± {:e}",
                b.value,
                b.error
            );
            dark += u32::from(a.value == 0.0 && b.value > 0.0);
        }
    }
    assert!(dark > 0, "the edge was not met");
}
