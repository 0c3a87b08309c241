//! Energy in the circular wall: the integral of each caustic over its receiver is the flux that was sent there.
//!
//! The left side is a quadrature of the irradiance over the floor; the right side counts the light where it leaves, and
//! knows nothing of Jacobians. 1e-9 where no fold is cut, 1e-6 across folds.

use std::f64::consts::PI;

use libm::{asin, cos, hypot, sin, sqrt, tan};
use nephroid_analytic::kinds::cylinder_cup::flatland::Flatland;
use nephroid_analytic::kinds::cylinder_cup::point_light::Lamp;
use nephroid_analytic::kinds::cylinder_cup::{Beam, CylinderCup, Light, Wall};
use nephroid_analytic::quadrature::{gauss_legendre, integrate, integrate_between_folds};

fn assert_close(what: &str, found: f64, expected: f64, tolerance: f64) {
    let difference = (found / expected - 1.0).abs();
    println!("{what}: {found} of {expected}, relative difference {difference:.1e}");
    assert!(
        difference <= tolerance,
        "{what}: {found} of {expected}, {difference:e}"
    );
}

/// A curve on which the irradiance along a line may be singular: a fold or the edge of a shadow.
struct Curve {
    point: Box<dyn Fn(f64) -> Option<[f64; 2]>>,
    samples: Vec<(f64, Option<[f64; 2]>)>,
}

impl Curve {
    fn new(range: (f64, f64), point: impl Fn(f64) -> Option<[f64; 2]> + 'static) -> Self {
        let steps = 1500;
        let at = |n: u32| range.0 + (range.1 - range.0) * (f64::from(n) + 0.5) / f64::from(steps);
        let samples = (0..steps).map(|n| (at(n), point(at(n)))).collect();
        Curve {
            point: Box::new(point),
            samples,
        }
    }

    /// The parameter between `a` and `b` where a condition that holds at `a` stops holding.
    fn bisect(&self, a: f64, b: f64, holds: impl Fn(Option<[f64; 2]>) -> bool) -> f64 {
        let (mut a, mut b) = (a, b);
        for _ in 0..50 {
            let m = 0.5 * (a + b);
            if holds((self.point)(m)) { a = m } else { b = m }
        }
        a
    }

    /// x where the curve crosses a line y = const.
    fn crossings(&self, y: f64, into: &mut Vec<f64>) {
        for w in self.samples.windows(2) {
            if let [(u, Some(p)), (v, Some(q))] = w
                && (p[1] < y) != (q[1] < y)
            {
                let below = p[1] < y;
                let at = self.bisect(*u, *v, |r| r.is_some_and(|r| (r[1] < y) == below));
                into.extend((self.point)(at).map(|r| r[0]));
            }
        }
    }

    /// y where the curve ends, or turns back.
    fn turns(&self, into: &mut Vec<f64>) {
        for w in self.samples.windows(2) {
            match w {
                [(u, Some(_)), (v, None)] | [(v, None), (u, Some(_))] => {
                    let at = self.bisect(*u, *v, |r| r.is_some());
                    into.extend((self.point)(at).map(|r| r[1]));
                }
                _ => {}
            }
        }
        for w in self.samples.windows(3) {
            if let [(u, Some(p)), (_, Some(q)), (v, Some(r))] = w
                && (p[1] < q[1]) != (q[1] < r[1])
            {
                let sign = if q[1] > p[1] { 1.0 } else { -1.0 };
                let height = |t: f64| (self.point)(t).map_or(f64::NEG_INFINITY, |s| sign * s[1]);
                let (mut a, mut b) = (*u, *v);
                for _ in 0..80 {
                    let (m, n) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                    if height(m) < height(n) { a = m } else { b = n }
                }
                into.push(sign * height(0.5 * (a + b)));
            }
        }
    }
}

fn sorted(mut cuts: Vec<f64>, low: f64, high: f64) -> Vec<f64> {
    cuts.retain(|c| *c > low && *c < high);
    cuts.extend([low, high]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    cuts
}

/// ∫ E dA over the half y > 0 of the disc, along lines y = const that are cut at the curves.
fn over_disc(cup: &CylinderCup<f64>, bounces: u32, curves: &[Curve], tolerance: f64) -> f64 {
    let a = cup.wall.radius;
    let line = |y: f64| {
        let half = sqrt((a - y) * (a + y));
        let mut cuts = vec![];
        curves.iter().for_each(|c| c.crossings(y, &mut cuts));
        let cuts = sorted(cuts, -half, half);
        let e = |x: f64| {
            let mut e = 0.0;
            cup.for_each_lit_root(x, y, bounces, |r| e += r.irradiance);
            e
        };
        cuts.windows(2)
            .map(|w| integrate_between_folds(e, w[0], w[1], 0.1 * tolerance).value)
            .sum::<f64>()
    };
    let mut turns = vec![];
    curves.iter().for_each(|c| c.turns(&mut turns));
    let turns = sorted(turns, 0.0, a);
    turns
        .windows(2)
        .map(|w| integrate_between_folds(line, w[0], w[1], tolerance).value)
        .sum()
}

/// The point at plan length τ on the last leg of the beam's ray φ, if it is inside the circle.
fn on_leg(a: f64, bounces: u32, phi: f64, tau: f64) -> Option<[f64; 2]> {
    let k = f64::from(bounces);
    let (at, toward) = (
        (2.0 * k - 1.0) * phi + (k - 1.0) * PI,
        2.0 * k * phi + k * PI,
    );
    let p = [
        a * cos(at) + tau * cos(toward),
        a * sin(at) + tau * sin(toward),
    ];
    (tau > 0.0 && tau < 2.0 * a * cos(phi)).then_some(p)
}

fn beam(e: f64) -> Light<f64> {
    Light::Beam(Beam {
        irradiance: 3.4,
        sin_elevation: sin(e),
        cos_elevation: cos(e),
    })
}

#[test]
fn whole_arc_lands_on_the_floor() {
    // The catalogue's cup: |φ| ≤ 60°, one bounce, across the nephroid and its cusp.
    let e = PI / 6.0;
    let cup = CylinderCup {
        wall: Wall {
            radius: 1.2,
            height: Some(0.69),
            cos_half_arc: Some(0.5),
        },
        reflectance: 0.9,
        light: beam(e),
    };
    let expected = 3.4 * 0.9 * cos(e) * 0.69 * 2.0 * 1.2 * sin(PI / 3.0);
    let arc = (-PI / 3.0, PI / 3.0);
    let curves = [
        Curve::new(arc, |phi| on_leg(1.2, 1, phi, 0.6 * cos(phi))),
        Curve::new(arc, move |phi| on_leg(1.2, 1, phi, 0.69 / tan(e))),
        // The rays of the wall's ends, which bound the light.
        Curve::new((0.0, 1.2), |t| on_leg(1.2, 1, PI / 3.0, t)),
        Curve::new((0.0, 1.2), |t| on_leg(1.2, 1, -PI / 3.0, t)),
    ];
    let found = 2.0 * over_disc(&cup, 1, &curves, 1e-6);
    assert_close("arc", found, expected, 1e-6);
}

#[test]
fn strip_without_a_fold() {
    // Between the cusp and the opening there is one root, smooth everywhere.
    let e = 0.7;
    let cup = CylinderCup {
        wall: Wall {
            radius: 1.2,
            height: None,
            cos_half_arc: Some(0.0),
        },
        reflectance: 0.9,
        light: beam(e),
    };
    let (x0, x1, y1) = (-0.3, 0.4, 0.35);
    let rule = gauss_legendre(40);
    let mut found = 0.0;
    for &(s, ws) in &rule {
        for &(t, wt) in &rule {
            let x = 0.5 * (x0 + x1) + 0.5 * (x1 - x0) * s;
            let y = y1 * t;
            found += ws * wt * 0.5 * (x1 - x0) * y1 * cup.caustic(x, y, 1).value;
        }
    }
    // The light of the wall element a dφ that crosses the strip: E0 R sin ε a cos φ times the length of its ray inside.
    let inside = |phi: f64| {
        let (px, py) = (1.2 * cos(phi), 1.2 * sin(phi));
        let (dx, dy) = (-cos(2.0 * phi), -sin(2.0 * phi));
        let (mut low, mut high) = (0.0f64, 2.4 * cos(phi));
        for (p, d, a, b) in [(px, dx, x0, x1), (py, dy, -y1, y1)] {
            let (s, t) = ((a - p) / d, (b - p) / d);
            low = low.max(s.min(t));
            high = high.min(s.max(t));
        }
        (high - low).max(0.0) * 1.2 * cos(phi)
    };
    // The integrand has corners where a ray passes a corner of the strip.
    let expected = 3.4 * 0.9 * sin(e) * 2.0 * integrate(inside, 0.0, 0.5 * PI, 1e-12).value;
    assert_close("strip", found, expected, 1e-9);
}

#[test]
fn closed_cup_by_number_of_bounces() {
    let (a, e, height) = (1.3, asin(0.28), 1.2);
    let cup = CylinderCup {
        wall: Wall {
            radius: a,
            height: Some(height),
            cos_half_arc: None,
        },
        reflectance: 0.9,
        light: beam(e),
    };
    for bounces in [1, 2, 3] {
        // First hits between heights z0 and z1 that need exactly k bounces to come down, lit over the rim.
        let k = f64::from(bounces);
        let share = |phi: f64| {
            let drop = 2.0 * a * cos(phi) * tan(e);
            let low = (height - drop).max((k - 1.0) * drop);
            let high = height.min(k * drop);
            (high - low).max(0.0) * a * cos(phi)
        };
        let r = libm::pow(0.9, k);
        let expected = 3.4 * r * cos(e) * 2.0 * integrate(share, 0.0, 0.5 * PI, 1e-11).value;
        let all = (-0.5 * PI, 0.5 * PI);
        let run = height / tan(e);
        let curves = [
            Curve::new(all, move |phi| {
                on_leg(a, bounces, phi, (2.0 * k - 1.0) / (2.0 * k) * a * cos(phi))
            }),
            Curve::new(all, move |phi| {
                on_leg(a, bounces, phi, run - (k - 1.0) * 2.0 * a * cos(phi))
            }),
            Curve::new(all, move |phi| {
                on_leg(a, bounces, phi, run - k * 2.0 * a * cos(phi))
            }),
        ];
        let found = 2.0 * over_disc(&cup, bounces, &curves, 3e-6);
        assert_close("closed cup", found, expected, 1e-6);
    }
}

#[test]
fn lamp_inside_and_on_the_wall() {
    let (a, h) = (0.9, 0.8);
    // Cells (x0, x1, y0, y1): without a fold, and with one that runs through from bottom to top.
    let cases = [
        (
            "lamp inside",
            -0.5,
            0.3,
            [-0.2, 0.05, 0.1, 0.3],
            false,
            1e-9,
        ),
        (
            "lamp inside, fold",
            -0.5,
            0.3,
            [0.0, 0.0, 0.0, 0.0],
            true,
            1e-6,
        ),
        (
            "lamp on the wall",
            -0.9,
            0.0,
            [-0.3, 0.1, 0.25, 0.45],
            false,
            1e-9,
        ),
        (
            "lamp on the wall, fold",
            -0.9,
            0.0,
            [0.0, 0.0, 0.0, 0.0],
            true,
            1e-6,
        ),
    ];
    for (name, x, y, mut cell, folded, tolerance) in cases {
        let cup = CylinderCup {
            wall: Wall {
                radius: a,
                height: None,
                cos_half_arc: None,
            },
            reflectance: 0.85,
            light: Light::Point(Lamp {
                x,
                y,
                height: h,
                intensity: 1.9,
            }),
        };
        // The ray to the wall point φ: normal, length r1, cos i, direction after the reflection.
        let ray = move |phi: f64| {
            let n = [cos(phi), sin(phi)];
            let d = [a * n[0] - x, a * n[1] - y];
            let r1 = hypot(d[0], d[1]);
            let c = (d[0] * n[0] + d[1] * n[1]) / r1;
            (
                n,
                r1,
                c,
                [d[0] / r1 - 2.0 * c * n[0], d[1] / r1 - 2.0 * c * n[1]],
            )
        };
        // The caustic of the first reflection: 1/r1 + 1/r2 = 2/(a cos i).
        let fold = Curve::new((-PI, PI), move |phi| {
            let (n, r1, c, q) = ray(phi);
            let r2 = r1 / (2.0 * r1 / (a * c) - 1.0);
            (r2 > 0.0 && r2 < 2.0 * a * c).then(|| [a * n[0] + r2 * q[0], a * n[1] + r2 * q[1]])
        });
        if folded {
            let [px, py] = (fold.point)(0.7).expect("the caustic is inside");
            cell = [px - 0.12, px + 0.12, py - 0.02, py + 0.02];
        }
        let [x0, x1, y0, y1] = cell;
        let line = |y: f64| {
            let mut cuts = vec![];
            fold.crossings(y, &mut cuts);
            let cuts = sorted(cuts, x0, x1);
            assert_eq!(cuts.len() > 2, folded, "{name}: {cuts:?}");
            let e = |x: f64| {
                let mut e = 0.0;
                cup.for_each_lit_root(x, y, 1, |r| e += r.irradiance);
                e
            };
            let pieces = cuts.windows(2);
            pieces
                .map(|w| integrate_between_folds(e, w[0], w[1], 1e-12).value)
                .sum::<f64>()
        };
        let rule = gauss_legendre(20);
        let found: f64 = rule
            .iter()
            .map(|&(t, w)| 0.5 * (y1 - y0) * w * line(0.5 * (y0 + y1) + 0.5 * (y1 - y0) * t))
            .sum();
        // sin η between the horizontal lengths at which the last leg is inside the cell.
        let share = |phi: f64| {
            let (n, r1, c, q) = ray(phi);
            let (mut low, mut high) = (0.0f64, 2.0 * a * c);
            for (k, from, to) in [(0, x0, x1), (1, y0, y1)] {
                let (s, t) = ((from - a * n[k]) / q[k], (to - a * n[k]) / q[k]);
                low = low.max(s.min(t));
                high = high.min(s.max(t));
            }
            // dψ = a cos i dφ/r1.
            let sine = |r2: f64| h / hypot(h, r1 + r2);
            if high > low {
                a * c / r1 * (sine(low) - sine(high))
            } else {
                0.0
            }
        };
        // The cell fills a small part of the directions: no panel may jump over it.
        let at = |n: i32| PI * f64::from(n) / 200.0;
        let expected = 1.9
            * 0.85
            * (-200..200)
                .map(|n| integrate(share, at(n), at(n + 1), 1e-15).value)
                .sum::<f64>();
        assert_close(name, found, expected, tolerance);
    }
}

#[test]
fn flatland_lines() {
    let cup = Flatland::new(1.0, 2.0, 0.9);
    // A line without a fold, and one across the fold at y = 0.0588...: the beam width that lands there.
    for (line, ends, fold, tolerance) in [
        (0.3, 0.9, 0.2, 1e-9),
        (0.6, 0.5, 0.058_841_779_041_315_26, 1e-6),
    ] {
        let e = |y: f64| cup.caustic(line, y).1.value;
        let found = 2.0
            * (integrate_between_folds(e, 0.0, fold, 1e-11).value
                + integrate_between_folds(e, fold, ends, 1e-11).value);
        // Wall points whose ray crosses the line within the ends, by a fine scan and bisection of the landing height.
        let landing = |phi: f64| {
            let t = (line - cos(phi)) / -cos(2.0 * phi);
            (t > 0.0 && t < 2.0 * cos(phi)).then(|| sin(phi) - t * sin(2.0 * phi))
        };
        let lands = |phi: f64| landing(phi).is_some_and(|y| y.abs() <= ends);
        let mut width = 0.0;
        let steps = 20_000;
        for k in 0..steps {
            let (a, b) = (
                0.5 * PI * f64::from(k) / f64::from(steps),
                0.5 * PI * f64::from(k + 1) / f64::from(steps),
            );
            let mut cut = b;
            if lands(a) != lands(b) {
                let (mut low, mut high) = (a, b);
                for _ in 0..60 {
                    let m = 0.5 * (low + high);
                    if lands(m) == lands(a) {
                        low = m
                    } else {
                        high = m
                    }
                }
                cut = low;
            }
            if lands(a) {
                width += sin(cut) - sin(a);
            }
            if lands(b) {
                width += sin(b) - sin(cut);
            }
        }
        assert_close("line", found, 2.0 * 0.9 * 2.0 * width, tolerance);
    }
}
