//! Waves in several directions: against waves along x, against rays of vector optics at differences, and by topology.

#[allow(dead_code, reason = "only the random cases are used here")]
use crate::forward::Cases;
use libm::{cos, hypot, sin, sqrt};
use nephroid_analytic::kinds::singularity::SingularityKind;
use nephroid_analytic::kinds::water_waves::ripples::fold::FoldNetwork;
use nephroid_analytic::kinds::water_waves::ripples::{PlaneWave, Ripples};
use nephroid_analytic::kinds::water_waves::{WaterWaves, Wave};

const INDEX: f64 = 1.333;
const BEAM: f64 = 2.3;

fn network(cases: &mut Cases, depth: f64) -> (Vec<PlaneWave<f64>>, Ripples<f64>) {
    let waves: Vec<_> = (0..5)
        .map(|_| {
            let (turn, k) = (cases.uniform(0.0, 6.3), cases.uniform(5.0, 14.0));
            PlaneWave {
                amplitude: cases.uniform(0.3, 1.1) / (k * k),
                wave_vector: [k * cos(turn), k * sin(turn)],
                phase: cases.uniform(0.0, 6.3),
            }
        })
        .collect();
    let water = Ripples::new(INDEX, depth, BEAM, waves.clone()).unwrap();
    (waves, water)
}

/// Everything that waves along x have in common with waves in the plane.
#[test]
fn waves_along_x_are_those_of_one_dimension() {
    let mut cases = Cases(11);
    let mut folded = 0;
    for _ in 0..6 {
        let waves: Vec<_> = (0..3)
            .map(|_| {
                let k = cases.uniform(4.0, 12.0);
                Wave {
                    amplitude: cases.uniform(0.4, 1.4) / (k * k),
                    wave_number: k,
                    phase: cases.uniform(0.0, 6.3),
                }
            })
            .collect();
        let depth = cases.uniform(2.5, 7.0);
        let line = WaterWaves::new(INDEX, depth, BEAM, waves.clone()).unwrap();
        let plane = waves.iter().map(|w| PlaneWave {
            amplitude: w.amplitude,
            wave_vector: [w.wave_number, 0.0],
            phase: w.phase,
        });
        let plane = Ripples::new(INDEX, depth, BEAM, plane.collect()).unwrap();
        assert!((plane.reach() - line.reach()).abs() <= 1e-15);
        for _ in 0..12 {
            let (x, y) = (cases.uniform(-1.5, 1.5), cases.uniform(-1.5, 1.5));
            let (one, two) = (line.caustic(x), plane.caustic(x, y));
            assert_eq!(one.roots, two.roots, "{x} {y}");
            folded += u32::from(one.roots > 1);
            let difference = (one.value - two.value).abs();
            assert!(
                difference <= 1e-12 * one.value || difference <= one.error + two.error,
                "{x} {y}: {one:?} {two:?}"
            );
            assert!(
                two.error >= difference && two.error <= 300.0 * one.error.max(1e-15 * one.value)
            );
            let (one, two) = (line.singularity(x), plane.singularity([x, y]));
            let wide = 4.0 * 2.0 * core::f64::consts::PI / 12.0;
            match (one, two) {
                (Some(one), Some(two)) => {
                    assert_eq!(two.kind, SingularityKind::Fold);
                    assert!(
                        (one.distance - two.distance).abs() <= 1e-9,
                        "{one:?} {two:?}"
                    );
                }
                (one, None) => assert!(one.is_none_or(|s| s.distance > wide), "{one:?}"),
                (None, two) => panic!("{two:?}"),
            }
        }
    }
    assert!(folded > 10, "{folded}");
}

/// Snell's law for vectors at the surface, and the landing point.
fn land(waves: &[PlaneWave<f64>], depth: f64, u: [f64; 2]) -> ([f64; 2], f64) {
    let (mut z, mut g) = (depth, [0.0; 2]);
    for w in waves {
        let angle = w.wave_vector[0] * u[0] + w.wave_vector[1] * u[1] + w.phase;
        z += w.amplitude * cos(angle);
        for (g, k) in g.iter_mut().zip(w.wave_vector) {
            *g -= w.amplitude * k * sin(angle);
        }
    }
    let length = sqrt(1.0 + g[0] * g[0] + g[1] * g[1]);
    let normal = [-g[0] / length, -g[1] / length, 1.0 / length];
    let c1 = normal[2];
    let c2 = sqrt(1.0 - (1.0 - c1 * c1) / (INDEX * INDEX));
    let bend = c1 / INDEX - c2;
    let d = [
        bend * normal[0],
        bend * normal[1],
        -1.0 / INDEX + bend * normal[2],
    ];
    let (s, p) = (
        (c1 - INDEX * c2) / (c1 + INDEX * c2),
        (INDEX * c1 - c2) / (INDEX * c1 + c2),
    );
    let t = 1.0 - 0.5 * (s * s + p * p);
    let along = -z / d[2];
    ([u[0] + along * d[0], u[1] + along * d[1]], t)
}

/// Landing point and transmittance by vectors, and the Jacobian by their differences.
#[test]
fn rays_are_those_of_vector_optics() {
    let mut cases = Cases(12);
    for _ in 0..20 {
        let depth = cases.uniform(0.7, 2.0);
        let (waves, water) = network(&mut cases, depth);
        for _ in 0..20 {
            let u = [cases.uniform(-2.0, 2.0), cases.uniform(-2.0, 2.0)];
            let ray = water.ray(u);
            let (x, t) = land(&waves, depth, u);
            assert!(hypot(ray.floor[0] - x[0], ray.floor[1] - x[1]) <= 1e-14 * 8.0);
            assert!((ray.transmittance - t).abs() <= 1e-14);
            let h = 1e-3;
            for j in 0..2 {
                let at = |s: f64| {
                    let mut v = u;
                    v[j] += s * h;
                    land(&waves, depth, v).0
                };
                let (a, b, c, d) = (at(1.0), at(-1.0), at(2.0), at(-2.0));
                for i in 0..2 {
                    let slope = (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h);
                    assert!((slope - ray.jacobian[i][j]).abs() <= 1e-7, "{slope}");
                }
            }
        }
    }
}

/// The map from the surface to the floor is the identity and something bounded: of degree 1, so the signs of the
/// determinants at the roots of any point add up to 1. Newton's method from a grid finds no further root.
#[test]
fn no_root_is_missing_or_twice() {
    let mut cases = Cases(13);
    let mut most = 0;
    for _ in 0..8 {
        let depth = cases.uniform(4.0, 10.0);
        let (_, water) = network(&mut cases, depth);
        for _ in 0..12 {
            let x = [cases.uniform(-1.0, 1.0), cases.uniform(-1.0, 1.0)];
            let roots = water.roots(x);
            most = most.max(roots.len());
            let degree: f64 = roots.iter().map(|r| r.determinant.signum()).sum();
            assert_eq!(degree, 1.0, "{x:?} {roots:?}");
            for r in &roots {
                let floor = water.ray(r.u).floor;
                assert!(hypot(floor[0] - x[0], floor[1] - x[1]) <= 1e-14 * 8.0);
                assert!(!r.touching);
            }
            let reach = water.reach();
            for k in 0..400 {
                let at = |j: i32| reach * (f64::from(j) - 9.5) / 9.5;
                let mut u = [x[0] + at(k % 20), x[1] + at(k / 20)];
                for _ in 0..30 {
                    let ray = water.ray(u);
                    let [[a, b], [c, d]] = ray.jacobian;
                    let f = [ray.floor[0] - x[0], ray.floor[1] - x[1]];
                    let det = ray.determinant();
                    u[0] -= (d * f[0] - b * f[1]) / det;
                    u[1] -= (a * f[1] - c * f[0]) / det;
                }
                let floor = water.ray(u).floor;
                if hypot(floor[0] - x[0], floor[1] - x[1]) <= 1e-13 {
                    let known = roots
                        .iter()
                        .any(|r| hypot(r.u[0] - u[0], r.u[1] - u[1]) <= 1e-6);
                    assert!(known, "{x:?} {u:?} {roots:?}");
                }
            }
        }
    }
    assert!(most >= 5, "{most}");
}

/// The distance to the caustic against all sign changes of the determinant on a fine grid of rays; two roots fewer or more
/// across it.
#[test]
fn the_nearest_fold_is_the_nearest_sign_change() {
    let mut cases = Cases(14);
    let mut kinds = [0; 2];
    for _ in 0..4 {
        let depth = cases.uniform(1.4, 2.6);
        let (_, water) = network(&mut cases, depth);
        // Points of the folds, between neighbours on the grid where the sign changes.
        const N: i32 = 700;
        let step = 3.2 / f64::from(N);
        let at = |k: i32| step * (f64::from(k) - 0.5 * f64::from(N));
        let sign = |i: i32, j: i32| water.ray([at(i), at(j)]).determinant();
        let mut folds = Vec::new();
        for j in 0..N {
            let row: Vec<f64> = (0..N).map(|i| sign(i, j)).collect();
            for i in 1..row.len() {
                let (a, b) = (row[i - 1], row[i]);
                if a * b < 0.0 {
                    let u = at(i as i32 - 1) + step * a / (a - b);
                    folds.push(water.ray([u, at(j)]).floor);
                }
            }
        }
        let network = FoldNetwork::new(&water, [[-0.5, 0.5]; 2]);
        for _ in 0..40 {
            let x = [cases.uniform(-0.5, 0.5), cases.uniform(-0.5, 0.5)];
            let on_grid = folds.iter().fold(f64::INFINITY, |nearest, f| {
                f64::min(nearest, hypot(f[0] - x[0], f[1] - x[1]))
            });
            // For one point, and from the folds that were found once.
            for found in [water.singularity(x), network.nearest(x)] {
                let Some(found) = found else {
                    assert!(on_grid > 0.5, "{on_grid}");
                    continue;
                };
                // Grid points are on the folds to second order, and at most a step apart along them.
                assert!(found.distance <= on_grid + 1e-4, "{found:?} {on_grid}");
                assert!(found.distance >= on_grid - 4e-3, "{found:?} {on_grid}");
                kinds[usize::from(found.kind == SingularityKind::Cusp)] += 1;
            }
        }
    }
    assert!(kinds[0] >= 10 && kinds[1] >= 1, "{kinds:?}");
}

#[test]
fn steep_and_deep_waves_are_refused() {
    let wave = |amplitude, k| PlaneWave {
        amplitude,
        wave_vector: [0.6 * k, 0.8 * k],
        phase: 0.3,
    };
    assert!(Ripples::new(1.333, 1.0, 1.0, vec![wave(0.02, 10.0)]).is_ok());
    assert!(Ripples::new(1.0, 1.0, 1.0, vec![wave(0.02, 10.0)]).is_err());
    assert!(Ripples::new(1.333, 1.0, 1.0, vec![wave(1.2, 0.1)]).is_err());
    assert!(Ripples::new(1.333, 1.0, 1.0, vec![wave(0.5, 10.0)]).is_err());
    assert!(Ripples::new(1.333, 50.0, 1.0, vec![wave(1e-3, 300.0)]).is_err());
}
