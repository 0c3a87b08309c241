//! The glass pillar against second routes that share no code with it: forward tracing with Snell's law and Fresnel's equations in three
//! dimensions, finite differences for the Jacobian; the energy of all classes; and the paraxial focus.

use std::f64::consts::PI;

use crate::forward::{Cases, V, add, dot, jacobian, land, unit};
use libm::{asin, cos, floor, hypot, sin, sqrt, tan};
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::singularity::SingularityKind;

fn draw(cases: &mut Cases) -> GlassPillar<f64> {
    let e = cases.uniform(0.1, 1.4);
    let a = cases.uniform(0.2, 2.0);
    GlassPillar {
        x: cases.uniform(-2.0, 2.0),
        y: cases.uniform(-2.0, 2.0),
        radius: a,
        height: a * tan(e) * cases.uniform(0.5, 8.0),
        index: cases.uniform(1.1, 2.2),
        irradiance: cases.uniform(0.5, 3.0),
        sin_elevation: sin(e),
        cos_elevation: cos(e),
    }
}

fn beam(g: &GlassPillar<f64>) -> V {
    [g.cos_elevation, 0.0, -g.sin_elevation]
}

/// The refracted unit direction, for a unit normal against the ray, and the unpolarised reflectance, by Snell's law in
/// vector form and Fresnel's equations in the angles.
fn refract(d: V, n: V, ratio: f64) -> (V, f64) {
    let c = -dot(d, n);
    // Rounding at grazing incidence must not become total reflection.
    let c2 = sqrt((1.0 - ratio * ratio * (1.0 - c * c).max(0.0)).max(0.0));
    let t = add(d.map(|x| ratio * x), n, ratio * c - c2);
    let (i, r) = (libm::acos(c.min(1.0)), libm::acos(c2.min(1.0)));
    let f = if i < 1e-6 {
        let q = (ratio - 1.0) / (ratio + 1.0);
        q * q
    } else {
        let s = sin(i - r) / sin(i + r);
        let p = tan(i - r) / tan(i + r);
        0.5 * (s * s + p * p)
    };
    (t, f)
}

fn reflect(d: V, n: V) -> V {
    add(d, n, -2.0 * dot(d, n))
}

/// Where and how the ray that meets the side at y = a sin i and height z leaves after m interactions: point, direction,
/// weight.
fn trace(g: &GlassPillar<f64>, i: f64, z: f64, m: u32) -> (V, V, f64) {
    let out = |p: V| [(p[0] - g.x) / g.radius, (p[1] - g.y) / g.radius, 0.0];
    let mut p = [g.x - g.radius * cos(i), g.y + g.radius * sin(i), z];
    let d = beam(g);
    let (mut w, f) = refract(d, out(p), 1.0 / g.index);
    if m == 1 {
        return (p, reflect(d, out(p)), f);
    }
    let mut weight = 1.0 - f;
    for k in 2..=m {
        // The far intersection of the line with the circle.
        let (x, y) = (p[0] - g.x, p[1] - g.y);
        let t = -2.0 * (x * w[0] + y * w[1]) / (w[0] * w[0] + w[1] * w[1]);
        p = add(p, w, t);
        let inner = out(p).map(|c| -c);
        let (leaving, f) = refract(w, inner, g.index);
        if k == m {
            weight *= 1.0 - f;
            w = leaving;
        } else {
            weight *= f;
            w = reflect(w, inner);
        }
    }
    (p, w, weight)
}

#[test]
fn irradiance_roots_and_heights() {
    let mut cases = Cases(31);
    let mut roots = [0; 5];
    let mut over = 0;
    for case in 0..900 {
        let g = draw(&mut cases);
        let m = 1 + case % 5;
        // Half of the points where the light is bundled.
        let wide = if case % 2 == 0 { PI } else { 0.5 };
        let (r, t) = (
            g.radius * cases.uniform(1.03, 4.0),
            cases.uniform(-wide, wide),
        );
        let (x, y) = (g.x + r * cos(t), g.y + r * sin(t));
        let sum = g.caustic(x, y, m);
        let mut dangerous = sum.error > 1e-9 * sum.value.max(1e-3);
        g.for_each_root(x, y, m, |r| {
            dangerous |= r.below_top.abs() < 1e-3 * g.height
                || r.spread.abs() < 0.02 * g.radius
                || r.incidence.abs() > 1.55;
        });
        if dangerous {
            continue;
        }
        // From far above: the offset of the point from the last leg in plan.
        let offset = |i: f64| {
            let (p, w, _) = trace(&g, i, 0.0, m);
            (x - p[0]) * w[1] - (y - p[1]) * w[0]
        };
        let steps = 3000;
        let at = |n: u32| (PI - 1e-9) * (f64::from(n) / f64::from(steps) - 0.5);
        let (mut total, mut count) = (0.0, 0);
        for n in 1..=steps {
            let (mut a, mut b) = (at(n - 1), at(n));
            let sign = offset(a) < 0.0;
            if sign == (offset(b) < 0.0) {
                continue;
            }
            for _ in 0..60 {
                let c = 0.5 * (a + b);
                if (offset(c) < 0.0) == sign {
                    a = c;
                } else {
                    b = c;
                }
            }
            let i = 0.5 * (a + b);
            let (p, w, _) = trace(&g, i, 0.0, m);
            let along = ((x - p[0]) * w[0] + (y - p[1]) * w[1]) / hypot(w[0], w[1]);
            if !(along > 0.0) {
                continue;
            }
            // The ray that enters at 0 comes by the point at this depth.
            let z = -(p[2] + along * w[2] / hypot(w[0], w[1]));
            if z > g.height {
                over += 1;
                continue;
            }
            let (p, w, weight) = trace(&g, i, z, m);
            assert!(p[2] > 0.0);
            let foot = land((p, w));
            assert!(hypot(foot[0] - x, foot[1] - y) < 1e-7 * g.radius);
            let map = |i: f64, z: f64| {
                let (p, w, _) = trace(&g, i, z, m);
                Some(land((p, w)))
            };
            let det = jacobian(map, i, z, [1e-5, 1e-5]).expect("lands");
            let normal = unit([cos(i), -sin(i), 0.0]);
            total += g.irradiance * weight * g.radius * dot(beam(&g), normal) / det;
            count += 1;
        }
        assert_eq!(sum.roots, count, "case {case}: {g:?} {x} {y}");
        assert!(
            (total - sum.value).abs() <= 2e-5 * sum.value,
            "case {case}: traced {total}, closed form {sum:?}"
        );
        roots[count as usize] += 1;
    }
    assert!(
        roots[0] > 60 && roots[1] > 60 && roots[2] + roots[3] > 20 && over > 60,
        "{roots:?}, {over} over the top"
    );
}

/// The segment to the sun against the solid cylinder, point by point.
#[test]
fn direct_light_and_shadow() {
    let mut cases = Cases(32);
    let (mut free, mut dark) = (0, 0);
    for case in 0..400 {
        let g = draw(&mut cases);
        let (r, t) = (g.radius * cases.uniform(0.5, 5.0), cases.uniform(-PI, PI));
        let (x, y) = (g.x + r * cos(t), g.y + r * sin(t));
        let clearance = g.clearance(x, y);
        if clearance.abs() < 1e-2 * g.radius {
            continue;
        }
        let inside = (0..=4000).any(|k| {
            let s = 10.0 * g.radius / g.cos_elevation * f64::from(k) / 4e3;
            let q = add([x, y, 0.0], beam(&g), -s);
            hypot(q[0] - g.x, q[1] - g.y) < g.radius && q[2] < g.height
        });
        assert_eq!(inside, clearance < 0.0, "case {case}");
        let e = if inside {
            0.0
        } else {
            g.irradiance * g.sin_elevation
        };
        assert!((g.direct(x, y).value - e).abs() <= 1e-15 * e);
        free += u32::from(!inside);
        dark += u32::from(inside);
    }
    assert!(free > 150 && dark > 50, "{free} free, {dark} dark");
}

/// All classes together return what the side takes, but for what is absorbed by the floor inside. Rays of one plan
/// position that are reflected or leave from height z on: a fraction of the heights. The floor is integrated along
/// each last leg, τ from 0, where dA = |J| di dτ and E is the closed form of that root.
#[test]
fn flux_of_all_classes() {
    let mut cases = Cases(33);
    for _ in 0..4 {
        let mut g = draw(&mut cases);
        g.height = 5.0 * g.radius * g.slope();
        let most = g.max_interactions();
        assert!(most <= 200, "{most}");
        let (mut landed, mut absorbed) = (0.0, 0.0);
        let steps = 200;
        for n in 0..steps {
            // sin i is uniform over the beam.
            let i = asin((2.0 * f64::from(n) + 1.0) / f64::from(steps) - 1.0);
            let di = 2.0 / f64::from(steps) / cos(i);
            let mut inside = 1.0;
            for m in 1..=most {
                let (p, w, weight) = trace(&g, i, g.height, m);
                if m > 1 {
                    inside -= weight * (p[2] / g.height).max(0.0);
                } else {
                    inside -= weight;
                }
                if p[2] <= 0.0 {
                    continue;
                }
                let k = g.cos_elevation / g.sin_elevation;
                let longest = p[2] * k;
                for s in 0..4 {
                    let tau = longest * (f64::from(s) + 0.5) / 4.0;
                    let h = hypot(w[0], w[1]);
                    let (x, y) = (p[0] + tau * w[0] / h, p[1] + tau * w[1] / h);
                    // The root that is this ray.
                    g.for_each_root(x, y, m, |r| {
                        if (r.incidence - i).abs() < 1e-7 && r.below_top >= 0.0 {
                            landed += r.irradiance * r.spread.abs() * di * longest / 4.0;
                        }
                    });
                }
            }
            let area = g.radius * cos(i) * di * g.height;
            absorbed += inside * area * g.irradiance * g.cos_elevation;
        }
        let sent = 2.0 * g.radius * g.height * g.irradiance * g.cos_elevation;
        let balance = (landed + absorbed) / sent;
        assert!(
            (balance - 1.0).abs() < 1e-4,
            "{balance}, absorbed {}",
            absorbed / sent
        );
        assert!(absorbed < 0.9 * sent && absorbed > 0.0);
    }
}

#[test]
fn the_series_ends_and_its_tail_is_bounded() {
    let mut cases = Cases(34);
    for _ in 0..100 {
        let g = draw(&mut cases);
        let most = g.max_interactions();
        // The shortest chord is that of the grazing ray.
        let (p, _, _) = trace(&g, 0.5 * PI - 1e-9, g.height, most);
        let (q, _, _) = trace(&g, 0.5 * PI - 1e-9, g.height, most + 1);
        assert!(most == 1 || p[2] > 0.0, "{most} {p:?}");
        assert!(q[2] <= 1e-4 * g.height, "{most} {q:?}");
        assert_eq!(g.flux_beyond(most), 0.0);
        // The flux of every class up to the end, whatever the heights, is below the bound.
        let steps = 500;
        for first in 1..most.min(6) {
            let mut flux = 0.0;
            for n in 0..steps {
                let i = asin((2.0 * f64::from(n) + 1.0) / f64::from(steps) - 1.0);
                for m in first + 1..=most.min(40) {
                    let (p, _, weight) = trace(&g, i, g.height, m);
                    flux += weight * (p[2] / g.height).max(0.0) / f64::from(steps);
                }
            }
            let on_side = 2.0 * g.radius * g.height * g.irradiance * g.cos_elevation;
            assert!(flux * on_side <= g.flux_beyond(first), "{first} of {most}");
        }
    }
}

#[test]
fn folds_are_where_pairs_are_born() {
    let mut cases = Cases(35);
    let mut folds = [0; 3];
    for case in 0..120 {
        let mut g = draw(&mut cases);
        g.height = 30.0 * g.radius * g.slope();
        let m = 2 + case % 3;
        let at = |t: f64| {
            let k = f64::from(case);
            let a = g.radius;
            // A ring around the axis.
            let r = a * (1.2 + 2.0 * (0.37 * k - floor(0.37 * k)));
            (g.x + r * cos(t), g.y + r * sin(t))
        };
        let count = |t: f64| {
            let (x, y) = at(t);
            g.caustic(x, y, m).roots
        };
        for n in 0..300 {
            let (mut a, mut b) = (PI * f64::from(n) / 150.0, PI * f64::from(n + 1) / 150.0);
            let low = count(a);
            if low.abs_diff(count(b)) != 2 {
                continue;
            }
            while b - a > 1e-12 {
                let c = 0.5 * (a + b);
                if count(c) == low {
                    a = c;
                } else {
                    b = c;
                }
            }
            if count(a).abs_diff(count(b)) != 2 {
                continue;
            }
            let (x, y) = at(a);
            let near = g.singularity(x, y, m).expect("a caustic");
            assert!(near.distance < 1e-8, "case {case}, m = {m}: {near:?}");
            folds[m as usize - 2] += 1;
        }
    }
    assert!(folds.iter().all(|&f| f > 10), "{folds:?}");
}

/// The cusp of LTTDE is the paraxial focus, at the back focal distance of a ball lens with the index in plan,
/// n' a/(2(n' - 1)) from the axis; n' from Snell's law in space for a ray near the axis.
#[test]
fn the_cusp_is_the_paraxial_focus() {
    let mut cases = Cases(36);
    let mut seen = 0;
    for _ in 0..100 {
        let mut g = draw(&mut cases);
        g.height = 30.0 * g.radius * g.slope();
        let (p, w, _) = trace(&g, 1e-5, 0.0, 2);
        // Where a ray close to the axis crosses it.
        let cross = p[0] - (p[1] - g.y) * w[0] / w[1] - g.x;
        if cross < 1.05 * g.radius {
            continue;
        }
        let near = g.singularity(g.x + cross, g.y, 2).expect("a caustic");
        assert_eq!(near.kind, SingularityKind::Cusp);
        assert!(near.distance < 1e-6 * cross, "{near:?}");
        let n = g.effective_index();
        let focal = n * g.radius / (2.0 * (n - 1.0));
        assert!((cross / focal - 1.0).abs() < 1e-7, "{cross} {focal}");
        seen += 1;
    }
    assert!(seen > 30, "{seen}");
}

/// The formulas in single precision stay within the bounds that they state.
#[test]
fn single_precision_is_within_its_bound() {
    let mut cases = Cases(37);
    let mut checked = 0;
    for case in 0..500 {
        let g = draw(&mut cases);
        let (r, t) = (g.radius * cases.uniform(1.03, 4.0), cases.uniform(-PI, PI));
        let (x, y) = (g.x + r * cos(t), g.y + r * sin(t));
        let single = GlassPillar {
            x: g.x as f32,
            y: g.y as f32,
            radius: g.radius as f32,
            height: g.height as f32,
            index: g.index as f32,
            irradiance: g.irradiance as f32,
            sin_elevation: g.sin_elevation as f32,
            cos_elevation: g.cos_elevation as f32,
        };
        let m = 1 + case % 4;
        let (a, b) = (g.caustic(x, y, m), single.caustic(x as f32, y as f32, m));
        let off = (a.value - f64::from(b.value)).abs();
        assert!(off <= f64::from(b.error), "case {case}: {a:?} {b:?}");
        checked += u32::from(a.value > 0.0 && b.error < 1e-3 * b.value);
    }
    assert!(checked > 100, "{checked}");
}
