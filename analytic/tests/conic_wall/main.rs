//! The conic wall against second routes that share no code with it: forward tracing with vectors in three dimensions off the implicit
//! surface r + e x = p, with finite differences for the Jacobian; the circular cup; a beam into a parabola; and the flux.

#[path = "../forward/mod.rs"]
mod forward;

mod foci;
mod tracer;

use std::f64::consts::PI;

use forward::{Cases, add, dot, unit};
use libm::{cos, sin};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{CylinderCup, Light, Wall};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::vector::vec3;

use tracer::{blocked, draw, level, light, place, traced};

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
