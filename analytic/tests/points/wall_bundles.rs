//! The ray bundles of the walls against the closed forms at points: at random rays, flux over |det ∂x/∂u| is the irradiance of
//! the root with these parameters; at random floor points, every lit root is a ray of a bundle; and the stopped rays
//! make the shadow.

use std::f64::consts::PI;

use crate::forward::{Cases, add, dot, jacobian, land, unit};
use libm::{atan2, cos, hypot, sin, tan};
use nephroid_analytic::flux::{Bundle, Ray};
use nephroid_analytic::kinds::conic_wall::ConicWall;
use nephroid_analytic::kinds::conic_wall::bundle::{ConicPart, ConicRays};
use nephroid_analytic::kinds::glass_pillar::GlassPillar;
use nephroid_analytic::kinds::glass_pillar::bundle::{GlassPart, GlassRays};
use nephroid_analytic::kinds::open_floor::{FloorLight, OpenFloor};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::pillar::bundle::{PillarPart, PillarRays};
use nephroid_analytic::vector::vec3;

/// A random ray of a bundle that exists, away from its edges: parameters, ray, and irradiance by finite differences.
fn random_ray(bundle: &dyn Bundle, cases: &mut Cases) -> Option<([f64; 2], Ray, f64)> {
    let d = bundle.domain();
    let u = d.map(|[low, high]| cases.uniform(low, high));
    let ray = bundle.ray(u);
    let widths = d.map(|[low, high]| high - low);
    if !(widths[0] > 0.0 && widths[1] > 0.0 && exists(&ray)) {
        return None;
    }
    let away = (0..2).all(|k| (u[k] - d[k][0]).min(d[k][1] - u[k]) > 0.01 * widths[k]);
    let step = widths.map(|w| 1e-5 * w);
    let map = |a: f64, b: f64| Some(bundle.ray([a, b]).floor);
    let det = jacobian(map, u[0], u[1], step)?;
    // Central differences lose their digits on a fold.
    let size = widths[0] * widths[1] * det;
    (away && size > 1e-2).then(|| (u, ray, ray.flux / det))
}

fn exists(ray: &Ray) -> bool {
    ray.margins.iter().all(|&m| m >= 0.0)
}

/// Whether the bundle has a ray near these parameters that lands at the point; its floor point is continuous in them.
fn has_ray(bundle: &dyn Bundle, u: [f64; 2], x: f64, y: f64) -> bool {
    let d = bundle.domain();
    if (0..2).any(|k| u[k] < d[k][0] || u[k] > d[k][1]) {
        return false;
    }
    let ray = bundle.ray(u);
    exists(&ray) && hypot(ray.floor[0] - x, ray.floor[1] - y) < 1e-7
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-5 * b.abs()
}

fn pillar(cases: &mut Cases) -> Pillar<f64> {
    let a = cases.uniform(0.3, 1.5);
    let (d, at) = (a * cases.uniform(1.2, 4.0), cases.uniform(-PI, PI));
    let h = cases.uniform(0.5, 3.0);
    let (x, y) = (cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0));
    Pillar {
        x,
        y,
        radius: a,
        height: h * cases.uniform(0.2, 1.4),
        reflectance: cases.uniform(0.4, 0.9),
        light: vec3(x + d * cos(at), y + d * sin(at), h),
        intensity: cases.uniform(0.5, 3.0),
    }
}

/// The angle as one in the domain.
fn into(angle: f64, [low, high]: [f64; 2]) -> f64 {
    let middle = 0.5 * (low + high);
    middle + atan2(sin(angle - middle), cos(angle - middle))
}

#[test]
fn pillar_rays() {
    let mut cases = Cases(41);
    let mut seen = [0; 5];
    for case in 0..1000 {
        let p = pillar(&mut cases);
        let rays = |part| PillarRays {
            pillar: p,
            part,
            reach: 50.0,
        };
        if let Some((u, ray, e)) = random_ray(&rays(PillarPart::Reflected), &mut cases) {
            let root = p.reflection(ray.floor[0], ray.floor[1]).expect("a root");
            assert!(
                close(e, root.irradiance) && root.inside > 0.0,
                "case {case}"
            );
            assert!((root.hit.z - u[1]).abs() < 1e-8 * p.height);
            seen[0] += 1;
        }
        for (k, part) in [PillarPart::StoppedBySide, PillarPart::StoppedByTop]
            .into_iter()
            .enumerate()
        {
            if let Some((_, ray, e)) = random_ray(&rays(part), &mut cases) {
                let [x, y] = ray.floor;
                assert!(close(
                    -e,
                    free(p.light.x, p.light.y, p.light.z, x, y) * p.intensity
                ));
                assert!(p.shadow(x, y).0, "case {case}");
                seen[1 + k] += 1;
            }
        }
        // Back from a floor point.
        let (r, t) = (p.radius * cases.uniform(0.0, 4.0), cases.uniform(-PI, PI));
        let (x, y) = (p.x + r * cos(t), p.y + r * sin(t));
        let side = rays(PillarPart::Reflected);
        let angle = |hx: f64, hy: f64| into(atan2(hy - p.y, hx - p.x), side.domain()[0]);
        let lit = p.reflection(x, y).filter(|r| r.inside.abs() > 1e-9);
        if let Some(root) = lit {
            let found = has_ray(&side, [angle(root.hit.x, root.hit.y), root.hit.z], x, y);
            assert_eq!(
                found,
                root.inside > 0.0 && root.from_wall < 50.0,
                "case {case}"
            );
            seen[3] += 1;
        }
        if p.shadow(x, y).1 < 1e-6 {
            continue;
        }
        // Where the segment from the light to the point first meets the side, and where it meets the top.
        let (lx, ly, h) = (p.light.x - p.x, p.light.y - p.y, p.light.z);
        let (dx, dy) = (x - p.light.x, y - p.light.y);
        let (b, s2) = (lx * dx + ly * dy, dx * dx + dy * dy);
        let under = b * b - s2 * (lx * lx + ly * ly - p.radius * p.radius);
        let t = (-b - under.max(0.0).sqrt()) / s2;
        let q = (p.light.x + t * dx, p.light.y + t * dy, h * (1.0 - t));
        let by_side = under > 0.0
            && (0.0..=1.0).contains(&t)
            && has_ray(
                &rays(PillarPart::StoppedBySide),
                [angle(q.0, q.1), q.2],
                x,
                y,
            );
        let t = 1.0 - p.height / h;
        let q = (p.light.x + t * dx - p.x, p.light.y + t * dy - p.y);
        let on_top = [atan2(q.1, q.0), hypot(q.0, q.1)];
        let by_top = h > p.height && has_ray(&rays(PillarPart::StoppedByTop), on_top, x, y);
        assert!(!(by_side && by_top));
        assert_eq!(by_side || by_top, p.shadow(x, y).0, "case {case}");
        seen[4] += u32::from(by_side || by_top);
    }
    assert!(seen.iter().all(|&n| n > 80), "{seen:?}");
}

/// E of a point light of unit intensity.
fn free(lx: f64, ly: f64, h: f64, x: f64, y: f64) -> f64 {
    let to = add([lx, ly, h], [x, y, 0.0], -1.0);
    unit(to)[2] / dot(to, to)
}

fn conic(cases: &mut Cases, e: f64, closed: bool) -> ConicWall<f64> {
    let p = cases.uniform(0.5, 1.5);
    let end = if e < 1.0 { PI } else { libm::acos(-1.0 / e) };
    let turn = cases.uniform(-PI, PI);
    let at = cases.uniform(-0.8, 0.8) * end;
    let r = (p / (1.0 + e * cos(at))).min(3.0 * p) * cases.uniform(0.0, 0.9);
    let h = cases.uniform(0.5, 2.0);
    let (x, y) = (cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0));
    ConicWall {
        x,
        y,
        axis: (cos(turn), sin(turn)),
        parameter: p,
        eccentricity: e,
        half_arc: (!closed).then(|| cases.uniform(0.3, 0.85) * end),
        height: h * cases.uniform(0.3, 1.3),
        reflectance: cases.uniform(0.4, 0.9),
        light: vec3(x + r * cos(at + turn), y + r * sin(at + turn), h),
        intensity: cases.uniform(0.5, 3.0),
    }
}

#[test]
fn conic_rays() {
    let mut cases = Cases(42);
    let mut seen = [0; 6];
    for case in 0..1500 {
        let e = match case % 5 {
            0 => 0.0,
            1 => 1.0,
            2 | 3 => cases.uniform(0.05, 0.9),
            _ => cases.uniform(1.1, 2.5),
        };
        let w = conic(&mut cases, e, e < 1.0 && case % 3 == 0);
        let rays = |part| ConicRays {
            wall: w,
            part,
            reach: 50.0,
        };
        for (k, part) in [ConicPart::Inside, ConicPart::Outside]
            .into_iter()
            .enumerate()
        {
            let Some((u, ray, e)) = random_ray(&rays(part), &mut cases) else {
                continue;
            };
            let [x, y] = ray.floor;
            let mut matched = 0;
            w.for_each_root(x, y, |r| {
                if (r.theta - u[0]).abs() < 1e-7 {
                    assert!(close(e, r.irradiance), "case {case}: {e} {r:?}");
                    assert!((r.hit.z - u[1]).abs() < 1e-7);
                    assert!(r.is_lit() || r.free.abs() < 1e-9, "case {case}: {r:?}");
                    matched += 1;
                }
            });
            assert_eq!(matched, 1, "case {case}: {w:?} {u:?}");
            assert_eq!(
                w.inside(x, y) > 0.0,
                part == ConicPart::Inside,
                "case {case}"
            );
            seen[k] += 1;
        }
        if let Some((_, ray, e)) = random_ray(&rays(ConicPart::Stopped), &mut cases) {
            let [x, y] = ray.floor;
            assert!(close(
                -e,
                free(w.light.x, w.light.y, w.light.z, x, y) * w.intensity
            ));
            assert!(w.clearance(x, y) < 0.0, "case {case}");
            seen[2] += 1;
        }
        // Back from a floor point.
        let (x, y) = (cases.uniform(-2.0, 2.0), cases.uniform(-2.0, 2.0));
        w.for_each_root(x, y, |r| {
            let edge = r.on_arc.abs().min(r.below_rim.abs()).min(r.free.abs());
            if edge < 1e-6 || r.from_wall > 49.0 || r.spread.abs() < 1e-4 {
                return;
            }
            let found = [ConicPart::Inside, ConicPart::Outside]
                .into_iter()
                .filter(|&part| has_ray(&rays(part), [r.theta, r.hit.z], x, y))
                .count();
            assert_eq!(found, usize::from(r.is_lit()), "case {case}: {r:?} {w:?}");
            seen[3 + usize::from(r.is_lit())] += 1;
        });
        // The wall's shadow, from the hit of the direct ray.
        if w.clearance(x, y).abs() > 1e-6 && w.inside(x, y) < 0.0 {
            let (mut near, mut far) = (0.0, 1.0);
            let at = |t: f64| {
                (
                    w.light.x + t * (x - w.light.x),
                    w.light.y + t * (y - w.light.y),
                )
            };
            for _ in 0..60 {
                let m = 0.5 * (near + far);
                let q = at(m);
                if w.inside(q.0, q.1) > 0.0 {
                    near = m;
                } else {
                    far = m;
                }
            }
            let (qx, qy) = at(near);
            let (dx, dy) = (qx - w.x, qy - w.y);
            let (c, s) = w.axis;
            let theta = atan2(dy * c - dx * s, dx * c + dy * s);
            let z = w.light.z * (1.0 - near);
            let stopped = has_ray(&rays(ConicPart::Stopped), [theta, z], x, y);
            assert_eq!(stopped, w.clearance(x, y) < 0.0, "case {case}");
            seen[5] += u32::from(stopped);
        }
    }
    assert!(seen.iter().all(|&n| n > 50), "{seen:?}");
}

#[test]
fn glass_rays() {
    let mut cases = Cases(43);
    let mut seen = [0; 6];
    for case in 0..1500 {
        let a = cases.uniform(0.3, 1.5);
        let e = cases.uniform(0.2, 1.3);
        let g = GlassPillar {
            x: cases.uniform(-1.0, 1.0),
            y: cases.uniform(-1.0, 1.0),
            radius: a,
            height: a * tan(e) * cases.uniform(1.0, 8.0),
            index: cases.uniform(1.1, 2.2),
            irradiance: cases.uniform(0.5, 3.0),
            sin_elevation: sin(e),
            cos_elevation: cos(e),
        };
        let rays = |part| GlassRays { pillar: g, part };
        let m = 1 + case % 4;
        let part = GlassPart::Interactions(m);
        if let Some((u, ray, e)) = random_ray(&rays(part), &mut cases) {
            let [x, y] = ray.floor;
            let mut matched = 0;
            g.for_each_root(x, y, m, |r| {
                if (r.incidence - u[0]).abs() < 1e-7 {
                    assert!(close(e, r.irradiance), "case {case}: {e} {r:?}");
                    assert!((r.entry_z - u[1]).abs() < 1e-7 && r.below_top > 0.0);
                    matched += 1;
                }
            });
            assert_eq!(matched, 1, "case {case}");
            seen[if m < 3 { m as usize - 1 } else { 2 }] += 1;
        }
        let direct = g.irradiance * g.sin_elevation;
        for part in [GlassPart::StoppedBySide, GlassPart::StoppedByTop] {
            if let Some((_, ray, e)) = random_ray(&rays(part), &mut cases) {
                assert!(close(-e, direct) && g.clearance(ray.floor[0], ray.floor[1]) < 0.0);
                seen[3] += 1;
            }
        }
        let (r, t) = (a * cases.uniform(0.0, 4.0), cases.uniform(-PI, PI));
        let (x, y) = (g.x + r * cos(t), g.y + r * sin(t));
        if r > a {
            g.for_each_root(x, y, m, |r| {
                if r.below_top.abs() < 1e-6 || r.spread.abs() < 1e-4 {
                    return;
                }
                let found = has_ray(&rays(part), [r.incidence, r.entry_z], x, y);
                assert_eq!(found, r.below_top > 0.0, "case {case}: {r:?}");
                seen[4] += 1;
            });
        }
        if g.clearance(x, y).abs() > 1e-6 {
            let (px, py) = (x - g.x, y - g.y);
            let i = libm::asin(py / a);
            let z = (px + a * cos(i)) * tan(e);
            let by_side = has_ray(&rays(GlassPart::StoppedBySide), [i, z], x, y);
            let back = px - g.height / tan(e);
            let on_top = [atan2(py, back), hypot(py, back)];
            let by_top = has_ray(&rays(GlassPart::StoppedByTop), on_top, x, y);
            assert!(!(by_side && by_top));
            assert_eq!(by_side || by_top, g.clearance(x, y) < 0.0, "case {case}");
            seen[5] += u32::from(by_side || by_top);
        }
    }
    assert!(seen.iter().all(|&n| n > 80), "{seen:?}");
}

#[test]
fn open_floor() {
    let mut cases = Cases(44);
    for _ in 0..50 {
        let position = [0.3, -0.4, cases.uniform(0.5, 2.0)];
        let floor = OpenFloor {
            region: [[-1.0, 2.0], [-2.0, 1.0]],
            light: FloorLight::Point {
                position,
                intensity: 1.7,
            },
        };
        let u = [cases.uniform(-1.0, 2.0), cases.uniform(-2.0, 1.0)];
        let ray = floor.ray(u);
        let [x, y] = land((position, add([u[0], u[1], 0.0], position, -1.0)));
        assert!(hypot(x - ray.floor[0], y - ray.floor[1]) < 1e-14);
        assert!(close(
            ray.flux,
            1.7 * free(0.3, -0.4, position[2], u[0], u[1])
        ));
    }
}
