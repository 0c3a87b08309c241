//! Bundles of rays against the closed form at points: two descriptions of one light that share no formula.
//!
//! At a floor point the irradiance is the sum of flux/|det dx/du| over all rays of a class that land there
//! (`theory/scenes.md`, 0.1). Rays are found by Newton's method from a grid of starts, the Jacobian by differences.

use std::sync::Arc;

use nephroid::entry;
use nephroid_analytic::entries::{FloorTruth, form};
use nephroid_analytic::flux::{Bundle, Ray};
use nephroid_analytic::kinds::singularity::Singularity;

/// Starts along each parameter.
const STARTS: usize = 24;
/// Step of the differences, relative to the domain.
const STEP: f64 = 1e-5;

fn exists(ray: &Ray) -> bool {
    ray.margins.iter().all(|&m| m >= 0.0)
}

/// Columns of the Jacobian of the floor point, to fourth order.
fn jacobian(bundle: &dyn Bundle, u: [f64; 2], size: [f64; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|k| {
        let at = |n: f64| {
            let mut v = u;
            v[k] += n * STEP * size[k];
            bundle.ray(v).floor
        };
        let (a, b, c, d) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
        [0, 1].map(|i| (a[i] - d[i] + 8.0 * (c[i] - b[i])) / (12.0 * STEP * size[k]))
    })
}

/// Irradiance of the rays of a bundle that land at (x, y).
fn irradiance(bundle: &dyn Bundle, x: [f64; 2]) -> f64 {
    let domain = bundle.domain();
    let size = domain.map(|[low, high]| high - low);
    let inside = |u: [f64; 2]| (0..2).all(|k| (domain[k][0]..=domain[k][1]).contains(&u[k]));
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut sum = 0.0;
    for start in 0..STARTS * STARTS {
        let at = |k: usize, n: usize| domain[k][0] + size[k] * (n as f64 + 0.5) / STARTS as f64;
        let mut u = [at(0, start % STARTS), at(1, start / STARTS)];
        for _ in 0..40 {
            let p = bundle.ray(u).floor;
            let [a, b] = jacobian(bundle, u, size);
            let det = a[0] * b[1] - a[1] * b[0];
            let r = [x[0] - p[0], x[1] - p[1]];
            let step = [
                (r[0] * b[1] - r[1] * b[0]) / det,
                (a[0] * r[1] - a[1] * r[0]) / det,
            ];
            // No step longer than a tenth of the domain.
            let longest = (0..2).map(|k| step[k].abs() / size[k]).fold(0.0, f64::max);
            let damping = (0.1 / longest).min(1.0);
            u = [u[0] + damping * step[0], u[1] + damping * step[1]];
            if !(longest > 1e-13) {
                break;
            }
        }
        let ray = bundle.ray(u);
        let off = libm::hypot(ray.floor[0] - x[0], ray.floor[1] - x[1]);
        let near = |v: &[f64; 2]| (0..2).all(|k| (u[k] - v[k]).abs() < 1e-6 * size[k]);
        if inside(u) && exists(&ray) && off < 1e-10 && !found.iter().any(near) {
            found.push(u);
            let [a, b] = jacobian(bundle, u, size);
            sum += ray.flux / (a[0] * b[1] - a[1] * b[0]).abs();
        }
    }
    sum
}

/// At 20 points of each floor, and at those where up to 30 rays of each bundle land, away from singularities. A missing ray, a
/// wrong area element or a wrong weight would show.
#[test]
fn rays_that_land_at_a_point_add_up_to_the_closed_form() {
    for name in entry::names() {
        let scene = entry::load(name).unwrap();
        let Some(layers) = form(&scene.kind).bundles() else {
            continue;
        };
        let truth = FloorTruth::new(&scene).unwrap();
        for (c, bundles) in layers.iter().enumerate() {
            let anywhere = (0..20).map(|k| {
                let at = place(k);
                [0, 1].map(|axis| within(truth.range(axis), at[axis]))
            });
            let landed = bundles.iter().flat_map(|bundle| {
                // Not the middle of the domain: opposite it a full turn begins and ends, and would count twice.
                let landed = (1..1000).filter_map(|k| {
                    let (domain, at) = (bundle.domain(), place(k));
                    let ray = bundle.ray([0, 1].map(|axis| within(domain[axis], at[axis])));
                    let on_floor = truth.is_on_floor(ray.floor[0], ray.floor[1]);
                    (exists(&ray) && on_floor).then_some(ray.floor)
                });
                landed.take(30).collect::<Vec<_>>()
            });
            let lit = anywhere
                .chain(landed)
                .filter(|&x| check(name, &truth, c, bundles, x))
                .count();
            assert!(lit >= 4, "{name} {c}: {lit}");
        }
    }
}

/// A Kronecker sequence.
fn place(k: u32) -> [f64; 2] {
    [0.754_877_666, 0.569_840_291].map(|alpha| (0.5 + f64::from(k) * alpha).fract())
}

fn within([low, high]: [f64; 2], s: f64) -> f64 {
    low + (high - low) * s
}

/// Compares at a point; whether there was light to compare.
fn check(
    name: &str,
    truth: &FloorTruth,
    c: usize,
    bundles: &[Arc<dyn Bundle>],
    x: [f64; 2],
) -> bool {
    let point = truth.at(x[0], x[1])[c];
    // A hundredth of a metre, or of half the floor where that is smaller.
    let [low, high] = truth.range(0);
    let close = |s: Singularity<f64>| s.distance < 0.01 * (0.5 * (high - low)).min(1.0);
    let expected = point.irradiance.value;
    // On a shadow edge the bound is as large as the light.
    let uncertain = !(point.irradiance.error <= 1e-6 * expected);
    if uncertain || truth.singularity(x[0], x[1], c).is_some_and(close) {
        return false;
    }
    let parts: Vec<f64> = bundles.iter().map(|b| irradiance(b.as_ref(), x)).collect();
    let sum: f64 = parts.iter().sum();
    // A shadow is subtracted: what is left of it is rounding of the differences.
    let size = parts.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    assert!(
        (sum - expected).abs() <= 1e-7 * expected + 1e-9 * size,
        "{name} {} at {x:?}: {sum} for {expected} ({} roots)",
        point.class,
        point.irradiance.roots
    );
    expected > 0.0
}
