//! A light at a focus: the explicit solution, the beam into a parabola, the flux, and the point focus.

use std::f64::consts::PI;

use libm::{atan2, cos, hypot, sin, sqrt};
use nephroid_analytic::kinds::conic_wall::{ConicWall, Root};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::vector::vec3;

use crate::forward::Cases;
use crate::tracer::{density, draw, place};

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
        let listed = |r: Root<f64>| (r.theta, r.irradiance, r.is_lit(), r.conditioning);
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
