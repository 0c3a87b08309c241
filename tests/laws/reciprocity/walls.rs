//! Reciprocity at vertical walls.
//!
//! The floor is z = 0 and the light at a height h. The way back goes from a light on the floor to a receiver at h; upside
//! down it is a light at h over the floor point's place in plan, and a floor point under the light. The slope of a path is
//! that of the straight line as long as its plan, both ways: E(A, h → P) = E(P, h → A), no cosine left.

use libm::{cos, hypot, sin, sincos, sqrt};
use nephroid_analytic::kinds::conic_wall::{self, ConicWall};
use nephroid_analytic::kinds::cylinder_cup::{self, CylinderCup, Light, Wall, point_light::Lamp};
use nephroid_analytic::kinds::pillar::Pillar;
use nephroid_analytic::kinds::planar_chains::Wedge;
use nephroid_analytic::vector::{Vec3, vec3};

use super::assert_reciprocal;
use crate::varied::random;

const PI: f64 = core::f64::consts::PI;

/// Light and floor point in a circle of radius 1; up to four reflections.
#[test]
fn a_circular_wall_is_reciprocal_for_chains() {
    let mut compared = [0; 4];
    random(60, |r: [f64; 5]| {
        let plan = |k: usize| {
            let (s, c) = sincos(PI * r[k]);
            let distance = 0.97 * sqrt(r[k + 1].abs());
            (distance * c, distance * s)
        };
        let (a, b, h) = (plan(0), plan(2), 1.5 + 0.7 * r[4]);
        for k in 1..=4 {
            let roots = |(x, y): (f64, f64), (u, v): (f64, f64)| {
                let cup = CylinderCup {
                    wall: Wall {
                        radius: 1.0,
                        height: None,
                        cos_half_arc: None,
                    },
                    reflectance: 0.83,
                    light: Light::Point(Lamp {
                        x,
                        y,
                        height: h,
                        intensity: 1.7,
                    }),
                };
                let mut roots = vec![];
                cup.for_each_root(u, v, k, |root| {
                    roots.push((root, cup.conditioning(u, v, k, &root)));
                });
                roots.sort_by(|p, q| p.0.length.total_cmp(&q.0.length));
                roots
            };
            let (there, back) = (roots(a, b), roots(b, a));
            let near_fold = |(root, c): &(_, f64)| -> bool {
                let root: &cylinder_cup::Root<f64> = root;
                root.touching || *c > 1e7
            };
            if there.iter().chain(&back).any(near_fold) {
                continue;
            }
            assert_eq!(there.len(), back.len(), "{a:?} {b:?} {k}");
            for ((p, c), (q, d)) in there.iter().zip(&back) {
                compared[k as usize - 1] +=
                    assert_reciprocal("circle", p.irradiance, q.irradiance, c + d);
                let tolerance = 1e-14 * (c + d);
                assert!((p.cos_incidence - q.cos_incidence).abs() <= tolerance);
                if k == 1 {
                    // The same point of the wall, from above and from below.
                    assert!((p.wall_z + q.wall_z - h).abs() <= tolerance);
                    let off = hypot(p.cos_phi - q.cos_phi, p.sin_phi - q.sin_phi);
                    assert!(off <= tolerance, "{off}");
                }
            }
        }
    });
    assert!(compared.into_iter().all(|n| n >= 80), "{compared:?}");
}

#[test]
fn a_pillar_is_reciprocal() {
    let (mut compared, mut dark) = (0, 0);
    random(300, |r: [f64; 5]| {
        let plan = |k: usize| {
            let (s, c) = sincos(PI * r[k]);
            let distance = 1.02 + 2.0 * r[k + 1].abs();
            vec3(distance * c, distance * s, 1.5 + 0.7 * r[4])
        };
        let reflection = |light: Vec3<f64>, x: Vec3<f64>| {
            Pillar {
                x: 0.0,
                y: 0.0,
                radius: 1.0,
                height: 10.0,
                reflectance: 0.83,
                light,
                intensity: 1.7,
            }
            .reflection(x.x, x.y)
        };
        let (a, b) = (plan(0), plan(2));
        match (reflection(a, b), reflection(b, a)) {
            (Some(there), Some(back)) => {
                let c = there.conditioning + back.conditioning;
                compared += assert_reciprocal("pillar", there.irradiance, back.irradiance, c);
                assert!((there.hit.z + back.hit.z - a.z).abs() <= 1e-14 * (c + 10.0));
            }
            (None, None) => dark += 1,
            other => panic!("{other:?}"),
        }
    });
    assert!(compared >= 100 && dark >= 50, "{compared} {dark}");
}

/// Ellipses, with the light at a focus (where its form is explicit), beside it, or anywhere.
#[test]
fn a_conic_wall_is_reciprocal_also_from_its_focus() {
    let mut compared = [0; 2];
    random(120, |r: [f64; 6]| {
        let e = 0.4 + 0.39 * r[0];
        // Inside: a share of the distance from the focus to the wall.
        let plan = |k: usize| {
            let (angle, share) = (PI * r[k], 0.95 * r[k + 1].abs());
            let distance = share / (1.0 + e * cos(angle));
            vec3(
                distance * cos(angle),
                distance * sin(angle),
                1.5 + 0.7 * r[5],
            )
        };
        let at_focus = r[4] > 0.3;
        let a = if at_focus {
            vec3(0.0, 0.0, 1.5 + 0.7 * r[5])
        } else {
            plan(1)
        };
        let b = plan(3);
        let roots = |light: Vec3<f64>, x: Vec3<f64>| {
            let wall = ConicWall {
                x: 0.0,
                y: 0.0,
                axis: (1.0, 0.0),
                parameter: 1.0,
                eccentricity: e,
                half_arc: None,
                height: 10.0,
                reflectance: 0.83,
                light,
                intensity: 1.7,
            };
            let mut roots = vec![];
            wall.for_each_root(x.x, x.y, |root| roots.push(root));
            roots
        };
        let (there, back) = (roots(a, b), roots(b, a));
        if there
            .iter()
            .chain(&back)
            .any(|r| r.touching || r.conditioning > 1e7)
        {
            return;
        }
        assert_eq!(there.len(), back.len(), "{a:?} {b:?} {e}");
        for p in there {
            let same = |q: &&conic_wall::Root<f64>| {
                let d = q.hit - p.hit;
                hypot(d.x, d.y) < 1e-7
            };
            let q = back.iter().find(same).expect("the way back");
            let c = p.conditioning + q.conditioning;
            compared[usize::from(at_focus)] +=
                assert_reciprocal("conic", p.irradiance, q.irradiance, c);
        }
    });
    assert!(compared.into_iter().all(|n| n >= 30), "{compared:?}");
}

#[test]
fn a_wedge_is_reciprocal_for_chains() {
    let mut compared = 0;
    random(60, |r: [f64; 5]| {
        for m in 2..=6 {
            let opening = PI / f64::from(m);
            let polar = |k: usize| (1.5 + r[k], opening * (0.5 + 0.45 * r[k + 1]));
            let ((radius, angle), (far, other)) = (polar(0), polar(2));
            let height = 1.5 + 0.7 * r[4];
            let chain = |radius: f64, angle: f64, far: f64, other: f64, k: u32| {
                Wedge {
                    m,
                    radius,
                    angle,
                    height,
                    intensity: 1.7,
                    reflectance: 0.83,
                }
                .caustic(far * cos(other), far * sin(other), k)
            };
            for k in 1..=m {
                let there = chain(radius, angle, far, other, k);
                let back = chain(far, other, radius, angle, k);
                assert_eq!(there.roots, back.roots);
                if there.roots > 0 && there.error.is_finite() && back.error.is_finite() {
                    let c = there.conditioning() + back.conditioning();
                    compared += assert_reciprocal("wedge", there.value, back.value, c);
                }
            }
        }
    });
    assert!(compared >= 800, "{compared}");
}
