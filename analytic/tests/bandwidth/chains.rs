//! Finite bandwidth of chains of specular interactions against chains that are traced step by step: sums over the directions at
//! the receiver and over the light's rays, the planar engine, and the limit of small bandwidths.

use crate::chain_tracer::scenes::{BEAM, Scene, ball, corner, cup, pillar, slab};
use crate::chain_tracer::sums::{angle, camera_sums, grid, light_sums, square, to_receiver};
use crate::chain_tracer::{Light, PI, V, add, dot};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{
    Convention, Expectation, HalfSpace, Kernel, PlanarSetting, Technique,
};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Kind;
use nephroid_analytic::vector::Vec3;

fn interactions(class: &PathClass) -> u32 {
    class.light.len() as u32
}

/// Mean and second moment of a class by the engine.
fn found(
    scene: &Scene,
    k: u32,
    technique: Technique,
    kernel: Kernel,
    convention: Convention,
    bandwidth: f64,
    x: [f64; 2],
    tolerance: f64,
) -> [f64; 2] {
    let estimator = Estimator {
        technique,
        kernel,
        convention,
        bandwidths: &[bandwidth],
    };
    let e = EntryExpectation::new(&scene.entry, estimator, BEAM).expect("an expectation");
    let class = e
        .classes()
        .iter()
        .position(|c| interactions(c) == k)
        .expect("the class");
    let m = e.at(x[0], x[1], tolerance)[class];
    for v in [m.mean, m.second_moment] {
        assert!(
            v.error <= 30.0 * tolerance * v.value + 1e-14,
            "{technique} {kernel} k = {k} {x:?}: {m:?}"
        );
    }
    [m.mean.value, m.second_moment.value]
}

/// Kernels by their definitions.
fn kernel(k: Kernel, a: f64) -> impl Fn(f64) -> f64 {
    let n = match k {
        Kernel::Cone => 1.0 / (4.0 * PI * square(libm::sin(0.5 * a))),
        Kernel::Epanechnikov => {
            0.5 / PI / (1.0 - 2.0 * libm::sin(a) / a + 4.0 * square(libm::sin(0.5 * a)) / (a * a))
        }
        _ => 2.0 / (PI * a * a) / (1.0 - libm::exp(-8.0 / (a * a))),
    };
    move |g: f64| match k {
        Kernel::Cone if g < a => n,
        Kernel::Epanechnikov if g < a => n * (1.0 - g * g / (a * a)),
        Kernel::VonMisesFisher => n * libm::exp(-8.0 / (a * a) * square(libm::sin(0.5 * g))),
        _ => 0.0,
    }
}

fn close(found: [f64; 2], sums: [f64; 2], tolerance: f64, what: &str) {
    for (k, (f, s)) in found.into_iter().zip(sums).enumerate() {
        let off = (f / s - 1.0).abs();
        assert!(
            s > 0.0 && off <= tolerance,
            "{what} [{k}]: {f:e} {s:e} {off:e}"
        );
    }
}

/// The von Mises–Fisher kernel is analytic, and at these places nothing cuts it: midpoint sums converge geometrically.
#[test]
fn an_uncut_kernel_agrees_with_traced_sums_to_ten_digits() {
    let k = Kernel::VonMisesFisher;
    // With finer sums where rays are focused.
    let cases: &[(Scene, u32, [f64; 2], f64, u32)] = &[
        (corner(), 2, [2.3, 1.9], 0.03, 600),
        (ball(), 1, [1.1, 0.7], 0.03, 300),
        (ball(), 2, [0.9, 0.4], 0.03, 400),
        (pillar(0.9), 2, [0.9, 0.3], 0.02, 600),
        (cup(0.9), 1, [-0.65, -0.035], 0.02, 600),
        (cup(1.556), 2, [-0.4, 0.1], 0.02, 800),
        (cup(1.556), 3, [-0.76, -0.3965], 0.005, 600),
    ];
    for (scene, n, x, alpha, steps) in cases {
        let what = |t| format!("{:?} {n} {x:?} {t}", scene.world);
        let phi = kernel(k, *alpha);
        let p = [x[0], x[1], 0.0];
        let get = |t| found(scene, *n, t, k, Convention::Exact, *alpha, *x, 1e-10);
        let reach = 4.6 * alpha;
        let [camera, symmetric] = camera_sums(scene, *n, p, reach, *steps, &phi);
        let t = Technique::Camera;
        close(get(t), camera, 1e-10, &what(t));
        if camera != symmetric {
            let t = Technique::Symmetric;
            close(get(t), symmetric, 1e-10, &what(t));
        }
        let light = light_sums(scene, *n, p, reach, *steps, |g, _, _| phi(g));
        let t = Technique::Light;
        close(get(t), light, 1e-10, &what(t));
    }
}

/// Kernels that end somewhere, cut by edges, horizons, rims and shadows; linked ones; and merging.
#[test]
fn wide_kernels_agree_with_traced_sums() {
    let cases: &[(Scene, u32, [f64; 2])] = &[
        (corner(), 2, [2.0, 0.4]),
        (slab(), 4, [0.9, 0.4]),
        (ball(), 1, [1.1, 0.7]),
        (ball(), 2, [0.3, 0.4]),
        (pillar(0.9), 2, [0.9, 0.3]),
        (pillar(1.1), 3, [-0.908, 0.733]),
        (cup(1.556), 3, [-0.6, 0.4]),
    ];
    let (k, alpha, r) = (Kernel::Epanechnikov, 0.3, 0.25);
    for (scene, n, x) in cases {
        let what = |t| format!("{:?} {n} {x:?} {t}", scene.world);
        let phi = kernel(k, alpha);
        let p = [x[0], x[1], 0.0];
        let get = |t, c, b| found(scene, *n, t, k, c, b, *x, 1e-6);
        let exact = Convention::Exact;
        // Several roots at once need more.
        let steps = if *n == 3 { 1500 } else { 700 };
        let sums = camera_sums(scene, *n, p, alpha, steps, &phi);
        for (t, s) in [Technique::Camera, Technique::Symmetric]
            .into_iter()
            .zip(sums)
        {
            close(get(t, exact, alpha), s, 4e-4, &what(t));
        }
        let sums = light_sums(scene, *n, p, alpha, 700, |g, _, _| phi(g));
        let t = Technique::Light;
        close(get(t, exact, alpha), sums, 4e-4, &what(t));
        // Linked kernels reach everywhere; photons land everywhere.
        let escape = scene.escape();
        let [mut vertex, mut along, mut merged] = [[0.0; 2]; 3];
        grid([[0.0, 1.0]; 2], 900, |u, v, area| {
            let Some((end, flux)) = scene.light_path(*n, u, v) else {
                return;
            };
            let landing = scene.landing(&end);
            let count = |sums: &mut [f64; 2], f: f64| {
                sums[0] += area * flux * end.weight * f;
                sums[1] += area * flux * scene.photons() * square(end.weight * f);
            };
            if let Some((q, _)) = landing {
                let t = (square(q[0] - x[0]) + square(q[1] - x[1])) / (r * r);
                count(&mut merged, (2.0 / (PI * r * r) * (1.0 - t)).max(0.0));
            }
            let Some((to, d)) = to_receiver(&end, p) else {
                return;
            };
            let g = angle(to, end.exact);
            let f = -to[2] / (d * d);
            let linked = |d: f64| {
                let alpha = libm::atan(r / d);
                if g < alpha { kernel(k, alpha)(g) } else { 0.0 }
            };
            count(&mut vertex, f * linked(d));
            let far = landing.map(|l| l.1).or(escape);
            count(&mut along, f * far.map_or(0.0, linked));
        });
        let t = Technique::Linked;
        close(get(t, Convention::Vertex, r), vertex, 1e-3, &what(t));
        close(get(t, exact, r), along, 1e-3, &what(t));
        let t = Technique::Merge;
        close(get(t, exact, r), merged, 1e-3, &what(t));
    }
}

/// Unfolded by hand, one reflection after the other, a corner's chain is a plane mirror that ends at the edge.
#[test]
fn a_corner_is_a_sum_of_plane_mirrors() {
    let scene = corner();
    let Light::Point(y, intensity) = scene.light else {
        unreachable!()
    };
    let b = PI / 3.0;
    let walls = [
        ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        (
            [libm::cos(b), libm::sin(b), 0.0],
            [libm::sin(b), -libm::cos(b), 0.0],
        ),
    ];
    let image = |p: V, k: u32, last: usize| {
        (1..k).fold(p, |p, j| {
            let (_, n) = walls[(last + (k - j) as usize) % 2];
            add(p, n, -2.0 * dot(p, n))
        })
    };
    let half = |normal: V, offset: f64| HalfSpace {
        normal: Vec3::from_f64(normal),
        offset,
    };
    for x in [[2.3, 1.1], [1.7, 0.3]] {
        let p = [x[0], x[1], 0.0];
        for k in 1..=3 {
            for t in [
                Technique::Camera,
                Technique::Light,
                Technique::Symmetric,
                Technique::Linked,
            ] {
                let alpha = 0.3;
                let mut sums = [0.0; 2];
                for (last, (along, normal)) in walls.into_iter().enumerate() {
                    let from_light = matches!(t, Technique::Light | Technique::Linked);
                    let (light, at) = if from_light {
                        (image(y, k, last), p)
                    } else {
                        (y, image(p, k, last))
                    };
                    let mut setting = PlanarSetting::unbounded(
                        light,
                        intensity,
                        [0.0; 3],
                        normal,
                        (0..k).map(|_| 0.84).product(),
                        [0.0, 0.0, 1.0],
                    )
                    .expect("a setting");
                    setting.mirror_edges = vec![half(add([0.0; 3], along, -1.0), 0.0)];
                    let [[x0, x1], [y0, y1]] = scene.floor;
                    setting.receiver_edges = vec![
                        half([1.0, 0.0, 0.0], x1),
                        half([-1.0, 0.0, 0.0], -x0),
                        half([0.0, 1.0, 0.0], y1),
                        half([0.0, -1.0, 0.0], -y0),
                    ];
                    if !from_light {
                        setting.receiver_edges.clear();
                    }
                    let e = Expectation::new(setting, t, Kernel::Cone, &[alpha]).expect("one");
                    let m = e.at(at, 1e-12);
                    sums[0] += m.mean.value;
                    sums[1] += m.second_moment.value;
                }
                let exact = Convention::Exact;
                let got = found(&scene, k, t, Kernel::Cone, exact, alpha, x, 1e-11);
                close(got, sums, 1e-10, &format!("{t} {k} {x:?}"));
            }
        }
    }
}

/// With the air's own index nothing is refracted: light goes straight through what is, reflected in itself, a plane mirror.
#[test]
fn a_slab_of_air_is_a_plane_mirror_upside_down() {
    let mut scene = slab();
    let Kind::GlassSlab(s) = &mut scene.entry.kind else {
        unreachable!()
    };
    s.slab.index = 1.0 + 4.0 * f64::EPSILON;
    let (light, intensity) = (s.light.position, s.light.intensity);
    for (t, z) in [(Technique::Camera, 1.85), (Technique::Light, 1.5)] {
        {
            let x = [0.9, 0.4];
            let setting = PlanarSetting::unbounded(
                [light[0], light[1], 2.0 * z - light[2]],
                intensity,
                [0.0, 0.0, z],
                [0.0, 0.0, -1.0],
                1.0,
                [0.0, 0.0, 1.0],
            )
            .expect("a setting");
            let e = Expectation::new(setting, t, Kernel::Cone, &[0.3]).expect("one");
            let m = e.at([x[0], x[1], 0.0], 1e-11);
            let sums = [m.mean.value, m.second_moment.value];
            let (k, exact) = (Kernel::Cone, Convention::Exact);
            let got = found(&scene, 2, t, k, exact, 0.3, x, 1e-11);
            close(got, sums, 1e-10, &format!("{t} {x:?}"));
        }
    }
}

/// The truth is the limit, and what is missing from it goes like the square of the bandwidth.
#[test]
fn expectations_tend_to_the_truth_at_second_order() {
    let cases: &[(Scene, u32, [f64; 2], f64)] = &[
        (corner(), 1, [2.3, 1.1], 0.02),
        (corner(), 2, [2.3, 1.1], 0.02),
        (corner(), 3, [2.3, 1.9], 0.01),
        (slab(), 2, [0.9, 0.4], 0.02),
        (slab(), 6, [0.9, 0.4], 0.02),
        (ball(), 1, [1.1, 0.7], 0.002),
        (ball(), 2, [0.9, 0.4], 0.002),
        (ball(), 4, [0.9, 0.4], 0.002),
        (pillar(0.9), 1, [0.1, 1.4], 0.002),
        (pillar(0.9), 2, [0.9, 0.3], 0.002),
        (pillar(1.1), 3, [-0.908, 0.733], 0.00015),
        (cup(0.9), 1, [-0.65, -0.035], 0.002),
        (cup(1.556), 2, [0.3, 0.1], 0.002),
        (cup(1.556), 3, [-0.76, -0.3965], 0.001),
    ];
    for (scene, n, x, alpha) in cases {
        let truth = FloorTruth::new(&scene.entry)
            .expect("a floor")
            .at(x[0], x[1])
            .into_iter()
            .find(|p| interactions(&p.class) == *n)
            .expect("the class")
            .irradiance
            .value;
        assert!(truth > 0.0);
        for t in Technique::ALL {
            let kernel = match t {
                Technique::Merge => Kernel::Disc,
                _ => Kernel::Epanechnikov,
            };
            let off = |a: f64| {
                let exact = Convention::Exact;
                found(scene, *n, t, kernel, exact, a, *x, 1e-10)[0] / truth - 1.0
            };
            let (two, one) = (off(2.0 * alpha), off(*alpha));
            let what = format!("{:?} {n} {x:?} {t}: {two:e} {one:e}", scene.world);
            assert!(one.abs() < 4e-3, "{what}");
            assert!((two / one - 4.0).abs() < 0.1, "{what}");
            assert!(((4.0 * one - two) / 3.0).abs() < 0.02 * one.abs(), "{what}");
        }
    }
}
