//! Finite bandwidth by second routes: sums over a Cartesian grid on the mirror and on the floor with vector reflections,
//! additivity over parts of the mirror, reciprocity, and the small-bandwidth laws.

use nephroid_analytic::bandwidth::{Expectation, HalfSpace, Kernel, PlanarSetting, Technique};
use nephroid_analytic::scene::RectangleMirror;
use nephroid_analytic::vector::{Vec3, vec3};

const PI: f64 = core::f64::consts::PI;

fn mirror(center: [f64; 3], normal: [f64; 3], edge: [f64; 3], half: [f64; 2]) -> RectangleMirror {
    RectangleMirror {
        center,
        normal,
        edge,
        half_width: half[0],
        half_height: half[1],
        reflectance: 0.8,
    }
}

fn setting(light: [f64; 3], m: &RectangleMirror) -> PlanarSetting {
    PlanarSetting::unbounded(
        light,
        3.7,
        m.center,
        m.normal,
        m.reflectance,
        [0.0, 0.0, 1.0],
    )
    .unwrap()
    .with_mirror(m)
}

fn expect(s: &PlanarSetting, t: Technique, k: Kernel, b: f64, x: [f64; 3]) -> [f64; 2] {
    let e = Expectation::new(s.clone(), t, k, &[b]).unwrap();
    let m = e.at(x, 1e-12);
    assert!(
        m.mean.error <= 2e-11 * m.mean.value + 1e-17,
        "{t} {k} {b} {x:?} {m:?}"
    );
    [m.mean.value, m.second_moment.value]
}

/// Kernels by their definitions, the normaliser by a midpoint sum.
fn kernel(k: Kernel, a: f64) -> impl Fn(f64) -> f64 {
    let shape = move |g: f64| match k {
        Kernel::Epanechnikov if g < a => 1.0 - g * g / (a * a),
        Kernel::VonMisesFisher => libm::exp(4.0 / (a * a) * (libm::cos(g) - 1.0)),
        Kernel::Cone if g < a => 1.0,
        _ => 0.0,
    };
    let end = if k == Kernel::VonMisesFisher { PI } else { a };
    let n = 4000;
    let sum: f64 = (0..n)
        .map(|i| {
            let g = end * (f64::from(i) + 0.5) / f64::from(n);
            shape(g) * libm::sin(g) * 2.0 * PI * end / f64::from(n)
        })
        .sum();
    move |g| shape(g) / sum
}

/// All techniques on a grid over the mirror: [technique][kernel] → (mean, second moment). `linked` is the distance along
/// the exact ray from s in a direction, if it contributes.
fn by_grid(
    light: [f64; 3],
    m: &RectangleMirror,
    x: [f64; 3],
    a: f64,
    linked: impl Fn(Vec3<f64>, Vec3<f64>) -> Option<f64>,
) -> Vec<(Technique, Kernel, [f64; 2])> {
    let (x, y) = (Vec3::from_f64(x), Vec3::from_f64(light));
    let n = Vec3::from_f64(m.normal).normalized();
    let e = Vec3::from_f64(m.edge).normalized();
    let f = n.cross(e);
    let strength = 3.7 * m.reflectance;
    let kernels = [Kernel::Cone, Kernel::Epanechnikov, Kernel::VonMisesFisher];
    let phi: Vec<_> = kernels.iter().map(|k| kernel(*k, a)).collect();
    let techniques = [Technique::Camera, Technique::Light, Technique::Symmetric];
    let mut out: Vec<_> = techniques
        .iter()
        .flat_map(|t| kernels.iter().map(move |k| (*t, *k, [0.0; 2])))
        .collect();
    out.push((Technique::Linked, Kernel::Cone, [0.0; 2]));
    let steps = 1200;
    let area = 4.0 * m.half_width * m.half_height / f64::from(steps * steps);
    for i in 0..steps {
        for j in 0..steps {
            let at = |i: i32| 2.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0;
            let s =
                Vec3::from_f64(m.center) + e * (at(i) * m.half_width) + f * (at(j) * m.half_height);
            let (to_x, to_y) = (x - s, y - s);
            let (r1, r2) = (to_x.length(), to_y.length());
            let (u, v) = (to_x * (1.0 / r1), to_y * (1.0 / r2));
            let (cx, c1, c2) = (-u.z, u.dot(n), v.dot(n));
            if cx <= 0.0 {
                continue;
            }
            let exact = n * (2.0 * c2) - v;
            let g = 2.0 * libm::asin((0.5 * (u - exact).length()).min(1.0));
            let base = strength * area * cx / (r1 * r1 * r2 * r2);
            let camera = PI * strength / (r2 * r2);
            let from_light = 4.0 * PI * strength * cx / (r1 * r1);
            for (t, k, sum) in &mut out {
                let (weight, sample) = match t {
                    Technique::Camera => (c1, camera),
                    Technique::Symmetric => ((c1 * c2).sqrt(), camera * (c2 / c1).sqrt()),
                    _ => (c2, from_light),
                };
                let p = if *t == Technique::Linked {
                    let alpha = linked(s, exact).map_or(0.0, |d| libm::atan(a / d));
                    if g < alpha {
                        1.0 / (2.0 * PI * (1.0 - libm::cos(alpha)))
                    } else {
                        0.0
                    }
                } else {
                    phi[kernels.iter().position(|q| q == k).unwrap()](g)
                };
                sum[0] += base * weight * p;
                sum[1] += base * weight * p * p * sample;
            }
        }
    }
    out
}

#[test]
fn a_bounded_mirror_agrees_with_a_grid_of_vector_reflections() {
    let wall = mirror(
        [0.0, 1.0, 0.625],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.75, 0.5],
    );
    let low = mirror(
        [0.1, 1.2, 0.4],
        [0.1, -1.0, 0.0],
        [1.0, 0.1, 0.0],
        [0.9, 0.4],
    );
    let tilted = mirror(
        [1.5, 0.0, 1.0],
        [-0.8, 0.0, -0.6],
        [0.0, 1.0, 0.0],
        [0.7, 0.5],
    );
    // The specular root is inside; outside; outside with a wide kernel; below the horizon's reach (the mirror stands on
    // the receiver's plane).
    let cases = [
        (&wall, [0.25, 0.0, 2.0], [0.2, -0.3, 0.0], 0.35),
        (&wall, [0.25, 0.0, 2.0], [-1.6, 0.1, 0.0], 0.4),
        (&wall, [0.25, 0.0, 2.0], [0.3, -1.4, 0.0], 1.1),
        (&low, [-0.2, 0.1, 0.7], [0.3, 0.6, 0.0], 0.5),
        (&tilted, [0.2, 0.1, 1.0], [-0.3, 0.4, 0.0], 0.7),
    ];
    for (m, light, x, a) in cases {
        let s = setting(light, m);
        let grid = by_grid(light, m, x, a, |p, d| (d.z < 0.0).then(|| p.z / -d.z));
        for (t, k, [mean, second]) in grid {
            let got = expect(&s, t, k, a, x);
            assert!(mean > 0.0);
            // A jump in the kernel costs a midpoint sum about (steps)^(-3/2).
            let limit = if matches!(k, Kernel::Cone) {
                4e-4
            } else {
                3e-5
            };
            let off = [(got[0] / mean - 1.0).abs(), (got[1] / second - 1.0).abs()];
            assert!(
                off[0] < limit && off[1] < 2.0 * limit,
                "{t} {k} {x:?} {a}: {off:?}"
            );
        }
    }
}

#[test]
fn the_parts_of_a_mirror_add_up() {
    let edges = |s: &PlanarSetting, x: [f64; 2], z: [f64; 2]| {
        let mut s = s.clone();
        let half = |normal: Vec3<f64>, offset: f64| HalfSpace { normal, offset };
        s.mirror_edges = vec![
            half(vec3(1.0, 0.0, 0.0), x[1]),
            half(vec3(-1.0, 0.0, 0.0), -x[0]),
            half(vec3(0.0, 0.0, 1.0), z[1]),
            half(vec3(0.0, 0.0, -1.0), -z[0]),
        ];
        s
    };
    let unbounded = PlanarSetting::unbounded(
        [0.25, 0.0, 1.1],
        2.3,
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        0.9,
        [0.0, 0.0, 1.0],
    )
    .unwrap();
    let x = [-0.2, -0.1, 0.0];
    let cases = [
        (Technique::Camera, Kernel::Cone, 0.3),
        (Technique::Camera, Kernel::VonMisesFisher, 0.2),
        (Technique::Light, Kernel::Epanechnikov, 1.0),
        (Technique::Light, Kernel::Cone, 2.5),
        (Technique::Symmetric, Kernel::Cone, 0.01),
        (Technique::Linked, Kernel::Cone, 0.25),
        (Technique::Linked, Kernel::Epanechnikov, 0.1),
        (Technique::Linked, Kernel::VonMisesFisher, 0.1),
    ];
    for (t, k, b) in cases {
        let cuts_x = [-2.0, -0.31, 0.04, 0.9];
        let cuts_z = [0.0, 0.5, 0.62, 1.9];
        let whole = expect(&edges(&unbounded, [-2.0, 0.9], [0.0, 1.9]), t, k, b, x);
        let mut sum = [0.0; 2];
        for i in 0..3 {
            for j in 0..3 {
                let (cx, cz) = ([cuts_x[i], cuts_x[i + 1]], [cuts_z[j], cuts_z[j + 1]]);
                let e = Expectation::new(edges(&unbounded, cx, cz), t, k, &[b]).unwrap();
                let part = e.at(x, 1e-12);
                sum[0] += part.mean.value;
                sum[1] += part.second_moment.value;
            }
        }
        for c in 0..2 {
            let off = (sum[c] / whole[c] - 1.0).abs();
            assert!(off < 1e-11, "{t} {k} {b}: {off:e}");
        }
        if t != Technique::Linked && b <= 0.3 && k != Kernel::VonMisesFisher {
            let all = expect(&unbounded, t, k, b, x);
            assert!((all[0] / whole[0] - 1.0).abs() < 1e-12, "{t} {k}");
        }
    }
}

#[test]
fn light_and_receiver_exchange_under_a_parallel_mirror() {
    // With the receiver parallel to the mirror c_x = c₁, so the weight of `light`, c_x c₂, is symmetric in x and y.
    let m = mirror(
        [0.2, 0.1, 2.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.6, 0.5],
    );
    let (x, y) = ([0.0, 0.0, 0.0], [0.7, -0.4, 0.9]);
    for (k, a) in [
        (Kernel::Cone, 0.3),
        (Kernel::Epanechnikov, 0.8),
        (Kernel::VonMisesFisher, 0.2),
    ] {
        let there = expect(&setting(y, &m), Technique::Light, k, a, x)[0];
        let back = expect(&setting(x, &m), Technique::Light, k, a, y)[0];
        assert!((there / back - 1.0).abs() < 1e-12, "{k}: {there} {back}");
        // The camera's weight is c_x c₁: not symmetric.
        let other = expect(&setting(y, &m), Technique::Camera, k, a, x)[0];
        assert!((there / other - 1.0).abs() > 1e-4);
    }
}

#[test]
fn the_bias_at_small_bandwidth_follows_the_laws() {
    let (p, q, h) = (2.0, 0.8, 1.2);
    let s = PlanarSetting::unbounded(
        [0.0, 0.0, h],
        5.0,
        [0.0, 0.0, 2.0],
        [0.0, 0.0, -1.0],
        0.9,
        [0.0, 0.0, 1.0],
    )
    .unwrap();
    let d = p + q;
    let truth = 4.5 / (d * d);
    let kappa_camera = (p * p - 2.0 * p * q - q * q) / (2.0 * d * d);
    let kappa_light = -p * q / (d * d);
    let cases = [
        (Technique::Camera, Kernel::Cone, kappa_camera / 2.0),
        (Technique::Camera, Kernel::Epanechnikov, kappa_camera / 3.0),
        (
            Technique::Camera,
            Kernel::VonMisesFisher,
            kappa_camera / 2.0,
        ),
        (Technique::Light, Kernel::Cone, kappa_light / 2.0),
        (
            Technique::Symmetric,
            Kernel::Cone,
            (kappa_camera + kappa_light) / 4.0,
        ),
        (Technique::Linked, Kernel::Cone, -1.0 / (2.0 * p * d)),
        (Technique::Merge, Kernel::Disc, -0.75 / (d * d)),
        (Technique::Merge, Kernel::Epanechnikov, -0.5 / (d * d)),
        (Technique::Merge, Kernel::Biweight, -0.375 / (d * d)),
        (Technique::Merge, Kernel::Cone, -0.45 / (d * d)),
    ];
    for (t, k, coefficient) in cases {
        let b = 0.003;
        let bias = expect(&s, t, k, b, [0.0; 3])[0] / truth - 1.0;
        let ratio = bias / (coefficient * b * b);
        // The symmetric law is the mean of the other two to this order.
        assert!((ratio - 1.0).abs() < 2e-4, "{t} {k}: {ratio}");
    }
    // Second moments of the radial kernels: 4RI ∫k², (16/3), (36/5)·, 6 RI/r² times E.
    for (k, c) in [
        (Kernel::Disc, 4.0),
        (Kernel::Epanechnikov, 16.0 / 3.0),
        (Kernel::Biweight, 7.2),
        (Kernel::Cone, 6.0),
    ] {
        let got = expect(&s, Technique::Merge, k, 1e-4, [0.0; 3])[1];
        let law = c * 4.5 / 1e-8 * truth;
        assert!((got / law - 1.0).abs() < 1e-7, "{k}: {got} {law}");
    }
}

#[test]
fn published_biases_of_the_camera_technique() {
    // A receiver that faces down above the mirror z = 0; numbers computed independently, quadrature 48 × 40.
    let s = PlanarSetting::unbounded(
        [0.8, 0.0, 1.5],
        1.0,
        [0.0; 3],
        [0.0, 0.0, 1.0],
        1.0,
        [0.0, 0.0, -1.0],
    )
    .unwrap();
    let truth = 0.138232822525301;
    for (a, bias) in [
        (0.2, -0.006600654),
        (0.1, -0.001656813),
        (0.05, -0.000414621),
        (0.025, -0.000103681),
    ] {
        let got = expect(&s, Technique::Camera, Kernel::Cone, a, [0.0, 0.0, 1.0])[0];
        assert!(
            (got / truth - 1.0 - bias).abs() < 2e-9,
            "{a}: {}",
            got / truth - 1.0
        );
    }
}

#[test]
fn a_schedule_is_the_average_of_its_bandwidths() {
    let wall = mirror(
        [0.0, 1.0, 0.625],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.75, 0.5],
    );
    let s = setting([0.25, 0.0, 2.0], &wall);
    let points = [[0.2, -0.3, 0.0], [0.2, 0.85, 0.0], [-1.2, 0.1, 0.0]];
    let cases = [
        (Technique::Camera, Kernel::Cone),
        (Technique::Light, Kernel::Epanechnikov),
        (Technique::Symmetric, Kernel::VonMisesFisher),
        (Technique::Merge, Kernel::Disc),
        (Technique::Merge, Kernel::Biweight),
        (Technique::Linked, Kernel::Cone),
    ];
    for n in [2_i32, 40] {
        let schedule: Vec<f64> = (1..=n)
            .map(|i| 0.3 * libm::pow(f64::from(i), -1.0 / 6.0))
            .collect();
        for (t, k) in cases {
            if n > 2 && t == Technique::Linked {
                continue;
            }
            for x in points {
                let together = Expectation::new(s.clone(), t, k, &schedule).unwrap();
                let m = together.at(x, 1e-11);
                let mut sum = [0.0; 2];
                for &b in &schedule {
                    let one = Expectation::new(s.clone(), t, k, &[b])
                        .unwrap()
                        .at(x, 1e-12);
                    sum[0] += one.mean.value / f64::from(n);
                    sum[1] += one.second_moment.value / f64::from(n);
                }
                for (got, sum) in [(m.mean, sum[0]), (m.second_moment, sum[1])] {
                    let off = (got.value - sum).abs();
                    assert!(
                        off <= 3e-11 * sum + 1e-18,
                        "{t} {k} {n} {x:?}: {off:e} of {sum:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn merging_agrees_with_a_grid_on_the_floor_and_tends_to_the_truth() {
    let wall = mirror(
        [0.0, 1.0, 0.625],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.75, 0.5],
    );
    let mut s = setting([0.25, 0.0, 2.0], &wall);
    let half = |normal: Vec3<f64>, offset: f64| HalfSpace { normal, offset };
    s.receiver_edges = vec![
        half(vec3(0.0, -1.0, 0.0), 0.4),
        half(vec3(1.0, 0.0, 0.0), 0.5),
    ];
    let image = vec3(0.25, 2.0, 2.0);
    let strength = 3.7 * 0.8;
    // Lit if the segment to the image crosses the rectangle in y = 1.
    let irradiance = |x: f64, y: f64| {
        let t = (2.0 - 1.0) / (2.0 - y);
        let (sx, sz) = (0.25 + t * (x - 0.25), 2.0 - 2.0 * t);
        let lit = y < 1.0 && sx.abs() <= 0.75 && (sz - 0.625).abs() <= 0.5;
        let on_floor = y >= -0.4 && x <= 0.5;
        let d = (image - vec3(x, y, 0.0)).length();
        if lit && on_floor {
            strength * 2.0 / (d * d * d)
        } else {
            0.0
        }
    };
    // Inside; over the lit polygon's front edge and behind the mirror's plane; over the floor's corner.
    for x in [
        [0.1, 0.2],
        [0.1, 0.95],
        [0.2, 1.05],
        [0.42, -0.33],
        [-1.2, 0.1],
    ] {
        let (r, steps) = (0.22, 2600);
        let kernels = [
            Kernel::Disc,
            Kernel::Epanechnikov,
            Kernel::Biweight,
            Kernel::Cone,
        ];
        let mut sums = [[0.0; 2]; 4];
        let cell = 2.0 * r / f64::from(steps);
        for i in 0..steps {
            for j in 0..steps {
                let at = |i: i32| (f64::from(i) + 0.5) * cell - r;
                // Turned, so that no row of the grid runs along an edge.
                let (u, v) = (0.8 * at(i) - 0.6 * at(j), 0.6 * at(i) + 0.8 * at(j));
                let t2 = (u * u + v * v) / (r * r);
                let e = irradiance(x[0] + u, x[1] + v) * cell * cell;
                if t2 >= 1.0 || e == 0.0 {
                    continue;
                }
                let shapes = [
                    1.0,
                    2.0 * (1.0 - t2),
                    3.0 * (1.0 - t2) * (1.0 - t2),
                    3.0 * (1.0 - t2.sqrt()),
                ];
                for (sum, shape) in sums.iter_mut().zip(shapes) {
                    let phi = shape / (PI * r * r);
                    sum[0] += phi * e;
                    sum[1] += 4.0 * PI * strength * phi * phi * e;
                }
            }
        }
        for (k, sum) in kernels.into_iter().zip(sums) {
            let got = expect(&s, Technique::Merge, k, r, [x[0], x[1], 0.0]);
            for (got, sum) in got.into_iter().zip(sum) {
                assert!((got - sum).abs() <= 5e-4 * sum, "{k} {x:?}: {got} {sum}");
            }
        }
    }
    for x in [[0.1, 0.2], [-0.3, 0.5]] {
        let got = expect(&s, Technique::Merge, Kernel::Disc, 1e-5, [x[0], x[1], 0.0])[0];
        assert!((got / irradiance(x[0], x[1]) - 1.0).abs() < 1e-9);
    }
    assert_eq!(
        expect(&s, Technique::Merge, Kernel::Disc, 0.05, [0.0, 1.05, 0.0]),
        [0.0; 2]
    );
}

#[test]
fn extreme_bandwidths_and_grazing_places_stay_finite_and_bounded() {
    let wall = mirror(
        [0.0, 1.0, 0.5],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.75, 0.5],
    );
    for light in [[0.25, 0.0, 2.0], [0.7, 0.999, 0.3], [-0.1, 0.9999, 1.5]] {
        let s = setting(light, &wall);
        for x in [
            [0.1, 0.2, 0.0],
            [-0.6, 0.9999, 0.0],
            [0.3, 0.99, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.2, 0.0],
        ] {
            for t in Technique::ALL {
                for &k in t.kernels() {
                    let wide = if t.bandwidth_is_angle() { PI } else { 30.0 };
                    for b in [1e-6, 1e-3, 0.2, 1.0, wide] {
                        let e = Expectation::new(s.clone(), t, k, &[b]).unwrap();
                        let m = e.at(x, 1e-6);
                        for v in [m.mean, m.second_moment] {
                            let fine = v.value >= 0.0 && v.value.is_finite() && v.error >= 0.0;
                            assert!(fine, "{t} {k} {b} {x:?} {light:?}: {m:?}");
                            let limit = 1e-4 * v.value + 1e-9;
                            if v.value == m.mean.value {
                                assert!(v.error <= limit, "{t} {k} {b} {x:?} {light:?}: {m:?}");
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_kernel_that_does_not_fit_and_a_bandwidth_out_of_range_are_refused() {
    let wall = mirror(
        [0.0, 1.0, 0.5],
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.75, 0.5],
    );
    let s = setting([0.25, 0.0, 2.0], &wall);
    let refused = |t, k, b: &[f64]| Expectation::new(s.clone(), t, k, b).unwrap_err().key;
    assert_eq!(
        refused(Technique::Merge, Kernel::VonMisesFisher, &[0.1]),
        "kernel"
    );
    assert_eq!(refused(Technique::Camera, Kernel::Disc, &[0.1]), "kernel");
    for b in [
        &[][..],
        &[0.0],
        &[-1.0],
        &[f64::NAN],
        &[0.1, 3.2],
        &[f64::INFINITY],
    ] {
        assert_eq!(refused(Technique::Camera, Kernel::Cone, b), "bandwidth");
    }
}
