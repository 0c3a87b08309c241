//! Laws of small bandwidth and best bandwidths on the catalogue's scenes, against exact expectations.

use nephroid::entry;
use nephroid::extrapolation::{Richardson, Sampler};
use nephroid_analytic::bandwidth::law::{Place, extrapolated};
use nephroid_analytic::bandwidth::optimum::{self, Curve, Study, fixed, of_schedule, progressive};
use nephroid_analytic::bandwidth::{Convention, Expectation, Kernel, PlanarSetting, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::{Entry, Kind};
use proptest::prelude::*;

fn study(entry: &Entry, technique: Technique, kernel: Kernel) -> Study {
    Study::new(entry, technique, kernel, Convention::Exact, 1.0).unwrap()
}

fn mean(s: &Study, class: usize, x: [f64; 2], b: f64) -> (f64, f64) {
    let m = s.moments(class, x, b, 1e-12).unwrap().mean;
    (m.value, m.error)
}

/// A lit floor point of a scene: of a grid, the one with this rank.
fn lit(entry: &Entry, rank: f64) -> Option<[f64; 2]> {
    let truth = FloorTruth::new(entry)?;
    let points: Vec<[f64; 2]> = (0..24 * 24)
        .map(|k| [k % 24, k / 24].map(|i| (f64::from(i) + 0.5) / 24.0))
        .map(|t| {
            [0, 1].map(|i| {
                let [a, b] = truth.range(i);
                a + (b - a) * t[i]
            })
        })
        .filter(|[x, y]| {
            let light = truth.at(*x, *y);
            light
                .iter()
                .any(|t| t.class.is_caustic() && t.is_finite() && t.irradiance.value > 0.0)
        })
        .collect();
    points.get((rank * points.len() as f64) as usize).copied()
}

/// The light moved a little, so that every case is another scene.
fn moved(mut entry: Entry, by: [f64; 3]) -> Entry {
    let light = match &mut entry.kind {
        Kind::PlanarMirror(s) => Some(&mut s.light.position),
        Kind::FlatInterface(s) => Some(&mut s.light.position),
        Kind::Underwater(s) => Some(&mut s.light.position),
        Kind::Pillar(s) => Some(&mut s.light.position),
        Kind::ConcaveSphere(s) => Some(&mut s.light.position),
        Kind::ConvexSphere(s) => Some(&mut s.light.position),
        Kind::GlassSlab(s) => Some(&mut s.light.position),
        _ => None,
    };
    if let Some(position) = light {
        for k in 0..3 {
            position[k] += by[k];
        }
    }
    entry
}

const SCENES: [&str; 9] = [
    "mirror-wall",
    "pool",
    "underwater",
    "pillar",
    "dome",
    "ball",
    "dish",
    "lens",
    "slab",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]
    /// Random probes of random scenes: coefficients from derivatives at the paths are those of exact expectations at three
    /// bandwidths, for every technique.
    #[test]
    fn the_law_is_that_of_the_expectations(
        scene in 0..SCENES.len(),
        by in [-0.05..0.05, -0.05..0.05, -0.05..0.05_f64],
        rank in 0.0..1.0_f64,
        which in 0..5_usize,
    ) {
        let entry = moved(entry::load(SCENES[scene]).unwrap(), by);
        let technique = if SCENES[scene] == "slab" { Technique::Merge } else { Technique::ALL[which] };
        let kernels = technique.kernels();
        let kernel = kernels[(rank * 1e6) as usize % kernels.len()];
        prop_assume!(entry.validate().is_ok());
        let Some(x) = lit(&entry, rank) else { return Ok(()) };
        let s = study(&entry, technique, kernel);
        for (class, law) in s.laws(x[0], x[1]).into_iter().enumerate() {
            // Only a linked bandwidth on a wall may have none.
            let Some(law) = law else {
                prop_assert!(technique == Technique::Linked, "{} {} {:?}", SCENES[scene], technique, x);
                continue;
            };
            prop_assume!(law.place == Place::Smooth);
            // The foot of a wall adds a term of the next order, which has a test of its own.
            prop_assume!(technique != Technique::Linked || SCENES[scene] != "pillar");
            let a = 0.06 * law.reach.min(0.5);
            let mut bound = 0.0;
            let found = extrapolated(|b| {
                let (value, error) = mean(&s, class, x, b);
                bound += 12.0 * error / (a * a);
                value
            }, a, 2.0);
            let off = (found - law.coefficient).abs();
            prop_assert!(off < 2e-4 * law.coefficient.abs() + 1e-4 * law.limit.unwrap() + bound, "{} {} {} {:?} {} {:?}", SCENES[scene], technique, kernel, x, found, law);
            let second = s.moments(class, x, a, 1e-9).unwrap().second_moment.value;
            prop_assume!(!second.is_nan());
            prop_assert!((second / law.second_moment(a) - 1.0).abs() < 0.05, "{} {} {} {:?}", SCENES[scene], technique, second, law);
        }
    }
}

#[test]
fn on_an_edge_the_mean_tends_to_half() {
    let entry = entry::load("mirror-wall").unwrap();
    let truth = FloorTruth::new(&entry).unwrap();
    let value = |x: f64, y: f64| {
        let light = truth.at(x, y);
        light
            .iter()
            .find(|t| t.class == PathClass::LSDE)
            .unwrap()
            .irradiance
            .value
    };
    let [inside, y] = lit(&entry, 0.5).unwrap();
    // Along x to the border.
    let (mut low, mut high) = (inside, truth.range(0)[0]);
    assert_eq!(value(high, y), 0.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if value(middle, y) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    for (t, k) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Light, Kernel::Epanechnikov),
        (Technique::Merge, Kernel::Disc),
    ] {
        let s = study(&entry, t, k);
        let law = s.laws(low, y)[0].unwrap();
        assert_eq!((law.place, law.order), (Place::Edge, Some(1.0)));
        let limit = law.limit.unwrap();
        assert!((limit / value(low, y) - 0.5).abs() < 1e-9);
        let slope = |a: f64| (mean(&s, 0, [low, y], a).0 - limit) / a;
        let (coarse, fine) = (slope(2e-2) - law.coefficient, slope(1e-2) - law.coefficient);
        assert!(
            fine.abs() < 0.02 * limit && (coarse / fine - 2.0).abs() < 0.1,
            "{t} {coarse} {fine} {law:?}"
        );
    }
}

/// At the nephroid's cusp, at half the radius, rounding hides the place: there is a law of a cusp or none, never that of a fold, whose
/// strength has no bound there. The exact moments grow like α^(−2/3) and α^(−8/3).
#[test]
fn a_cusp_is_not_taken_for_a_fold() {
    let cup = entry::load("cup").unwrap();
    for (t, k) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        let s = study(&cup, t, k);
        if let Some(law) = s.laws(0.6, 0.0)[0] {
            assert_eq!(law.place, Place::Cusp, "{t} {law:?}");
        }
        let [coarse, fine] = [1e-3, 1e-4].map(|b| s.moments(0, [0.6, 0.0], b, 1e-6).unwrap());
        let order = |a: f64, b: f64| libm::log10(b / a);
        let mean = order(coarse.mean.value, fine.mean.value);
        let second = order(coarse.second_moment.value, fine.second_moment.value);
        assert!((mean - 2.0 / 3.0).abs() < 0.05, "{t} {mean}");
        assert!((second - 8.0 / 3.0).abs() < 0.05, "{t} {second}");
    }
}

/// Where the kernel begins to reach, and not before.
#[test]
fn the_dark_is_exactly_dark() {
    let entry = entry::load("dome").unwrap();
    let s = study(&entry, Technique::Camera, Kernel::Cone);
    let mut seen = 0;
    for x in [[-2.0, 1.5], [1.1, 0.4], [0.9, -1.8]] {
        let law = s.laws(x[0], x[1])[0].unwrap();
        if law.place == Place::Dark && law.reach < 3.0 {
            seen += 1;
            assert_eq!(mean(&s, 0, x, 0.999 * law.reach).0, 0.0, "{law:?}");
            assert!(mean(&s, 0, x, 1.01 * law.reach).0 > 0.0, "{law:?}");
        }
    }
    assert!(seen > 0);
}

#[test]
fn the_best_bandwidth_has_the_least_error_and_follows_the_law_for_many_paths() {
    let entry = entry::load("mirror-wall").unwrap();
    let x = lit(&entry, 0.4).unwrap();
    for (t, k) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        let s = study(&entry, t, k);
        let curve = s.curve(0, x).unwrap();
        let law = *curve.law();
        let exact = |b: f64, n: f64| {
            let m = s.moments(0, x, b, 1e-12).unwrap();
            let (mean, second) = (m.mean.value, m.second_moment.value);
            let bias = mean - curve.truth();
            bias * bias + (second - mean * mean) / n
        };
        for n in [1e4, 1e6] {
            let best = fixed(&[&curve], n).unwrap();
            let here = exact(best.bandwidth, n);
            assert!(
                (best.rmse * best.rmse / here - 1.0).abs() < 1e-5,
                "{t} {best:?} {here}"
            );
            for factor in [0.5, 0.8, 0.95, 1.05, 1.25, 2.0, 4.0] {
                let b: f64 = factor * best.bandwidth;
                if b < curve.high() {
                    assert!(
                        exact(b, n) > here * (1.0 - 1e-6),
                        "{t} {n} {factor} {best:?}"
                    );
                }
            }
        }
        // α⁶ = d C/(2 p c² n), to O(α²).
        let best = fixed(&[&curve], 1e14).unwrap();
        assert!(
            (best.bandwidth / law.best(1e14).unwrap() - 1.0).abs() < 5e-3,
            "{best:?} {law:?}"
        );
        // theory/consistency.md, section 1: the best progressive average needs 1.0817 times the error of the best bandwidth.
        let average =
            progressive(&[&Curve::of_law(law, 1e3)], 1_000_000_000_000, 1.0 / 6.0).unwrap();
        let single = fixed(&[&Curve::of_law(law, 1e3)], 1e12).unwrap();
        let loss = libm::pow(average.rmse / single.rmse, 2.0);
        assert!((loss - 1.0817).abs() < 2e-3, "{t} {loss}");
        // The best first bandwidth, there as well.
        let (d, p, c) = (2.0, 2.0, law.coefficient);
        let lambda = 1.0_f64 / 6.0;
        let rest = 1.0 - lambda * p;
        let first = d * law.squared * rest * rest / (2.0 * p * c * c * (1.0 + lambda * d));
        let first = libm::pow(first, 1.0 / 6.0);
        assert!(
            (average.bandwidth / first - 1.0).abs() < 1e-2,
            "{average:?} {first}"
        );
    }
}

#[test]
fn an_average_of_exact_moments_is_that_of_the_averaged_kernel() {
    // The schedule's expectation by one quadrature with the averaged kernel.
    let entry = entry::load("mirror-wall").unwrap();
    let x = lit(&entry, 0.4).unwrap();
    let s = study(&entry, Technique::Camera, Kernel::Cone);
    let curve = s.curve(0, x).unwrap();
    let (n, first, decay) = (3000_u64, 0.4, 0.2);
    let schedule: Vec<f64> = (1..=n)
        .map(|k| first * libm::pow(k as f64, -decay))
        .collect();
    let setting = PlanarSetting::of_entry(&entry).unwrap().unwrap();
    let e = Expectation::new(setting, Technique::Camera, Kernel::Cone, &schedule).unwrap();
    let exact = e.at([x[0], x[1], 0.0], 1e-11).mean.value - curve.truth();
    let found = of_schedule(&curve, first, decay, n);
    assert!((found.bias / exact - 1.0).abs() < 1e-4, "{found:?} {exact}");
}

#[test]
fn preview_misses_with_the_stated_probability() {
    let entry = entry::load("mirror-wall").unwrap();
    let x = lit(&entry, 0.5).unwrap();
    let setting = PlanarSetting::of_entry(&entry).unwrap().unwrap();
    for t in [
        Technique::Camera,
        Technique::Light,
        Technique::Merge,
        Technique::Linked,
    ] {
        let k = t.default_kernel();
        let s = study(&entry, t, k);
        let b = s.preview(0, x, 1e5, 1e-3).unwrap();
        let p = s.hit_probability(0, x, b).unwrap().value;
        assert!(
            ((1e5 * libm::log1p(-p)) / libm::log(1e-3) - 1.0).abs() < 1e-4,
            "{t} {b} {p}"
        );
        // Another quadrature, where it exists.
        let other = Expectation::new(setting.clone(), t, k, &[b]).unwrap();
        if let Some(other) = other.hit_probability([x[0], x[1], 0.0], 1e-10) {
            assert!((p / other.value - 1.0).abs() < 1e-8, "{t} {p} {other:?}");
        }
        // A billionth of a radian needs more paths than that.
        assert!(s.preview(0, x, 1.0, 1e-3).is_none());
    }
}

#[test]
fn extrapolation_has_order_four() {
    let entry = entry::load("pillar").unwrap();
    let x = lit(&entry, 0.5).unwrap();
    for (t, k) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
        (Technique::Light, Kernel::Epanechnikov),
    ] {
        let s = study(&entry, t, k);
        let law = s.laws(x[0], x[1])[0].unwrap();
        assert_eq!(law.place, Place::Smooth);
        let limit = law.limit.unwrap();
        let moments = |b: f64| {
            let pair = [b, 0.5 * b].map(|b| s.moments(0, x, b, 1e-13).unwrap());
            optimum::extrapolated(t, k, b, 2.0, pair)
        };
        let a = 0.3 * law.reach.min(0.6);
        let order = |f: &dyn Fn(f64) -> f64| libm::log2((f(a) - limit) / (f(0.5 * a) - limit));
        let (plain, better) = (
            order(&|b| mean(&s, 0, x, b).0),
            order(&|b| moments(b).mean.value),
        );
        assert!(
            (plain - 2.0).abs() < 0.1 && (better - 4.0).abs() < 0.2,
            "{t} {plain} {better}"
        );
        // The wrapper, over the expectations as a sampler.
        let wrapped = Richardson::new(|b: f64, _: u64| mean(&s, 0, x, b).0, 2.0).unwrap();
        assert!((wrapped.sample(a, 0) / moments(a).mean.value - 1.0).abs() < 1e-12);
        // docs/bandwidth.md: 57/9 of the second moment of a constant kernel.
        let m = moments(1e-3).second_moment;
        let ratio = m.value / s.moments(0, x, 1e-3, 1e-9).unwrap().second_moment.value;
        if k == Kernel::Epanechnikov {
            assert!(m.error > 0.1 * m.value);
        } else {
            assert!((ratio - 57.0 / 9.0).abs() < 1e-3, "{t} {ratio}");
            assert!(m.error < 1e-6 * m.value);
        }
    }
    assert!(Richardson::new(|_: f64, _: u64| 0.0, 0.0).is_none());
    assert!(Richardson::new(|_: f64, _: u64| 0.0, f64::NAN).is_none());
}

/// Photons on a plane floor under a plane mirror: samples with common random numbers have the moments that are predicted.
#[test]
fn extrapolated_samples_have_the_predicted_moments() {
    let entry = entry::load("mirror-wall").unwrap();
    let Kind::PlanarMirror(scene) = &entry.kind else {
        panic!()
    };
    let x = lit(&entry, 0.5).unwrap();
    let radius = 0.6;
    let (y, m) = (scene.light.position, &scene.mirror);
    let n = m.normal;
    let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
    let n = n.map(|c| c / length);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let edge = {
        let l = dot(m.edge, m.edge).sqrt();
        m.edge.map(|c| c / l)
    };
    let across = [
        n[1] * edge[2] - n[2] * edge[1],
        n[2] * edge[0] - n[0] * edge[2],
        n[0] * edge[1] - n[1] * edge[0],
    ];
    let flux = 4.0 * core::f64::consts::PI * scene.light.intensity * m.reflectance;
    let sampler = |b: f64, index: u64| {
        // A lattice of directions: sample number k of a two-dimensional Kronecker sequence.
        let k = index as f64 + 0.5;
        let u = [0.754_877_666_246_693, 0.569_840_290_998_053].map(|g: f64| (k * g).fract());
        let (cos, phi) = (1.0 - 2.0 * u[0], core::f64::consts::TAU * u[1]);
        let sin = (1.0 - cos * cos).sqrt();
        let (sp, cp) = libm::sincos(phi);
        let d = [sin * cp, sin * sp, cos];
        let towards = dot(d, n);
        let t = -dot([0, 1, 2].map(|i| y[i] - m.center[i]), n) / towards;
        let s = [0, 1, 2].map(|i| y[i] + t * d[i]);
        let v = [0, 1, 2].map(|i| s[i] - m.center[i]);
        if !(towards < 0.0
            && dot(v, edge).abs() <= m.half_width
            && dot(v, across).abs() <= m.half_height)
        {
            return 0.0;
        }
        let r = [0, 1, 2].map(|i| d[i] - 2.0 * towards * n[i]);
        let fall = -s[2] / r[2];
        let p = [s[0] + fall * r[0], s[1] + fall * r[1]];
        let hit = fall > 0.0 && libm::hypot(p[0] - x[0], p[1] - x[1]) < b;
        if hit {
            flux / (core::f64::consts::PI * b * b)
        } else {
            0.0
        }
    };
    let s = study(&entry, Technique::Merge, Kernel::Disc);
    let pair = [radius, 0.5 * radius].map(|b| s.moments(0, x, b, 1e-10).unwrap());
    let exact = optimum::extrapolated(Technique::Merge, Kernel::Disc, radius, 2.0, pair);
    let richardson = Richardson::new(sampler, 2.0).unwrap();
    let count = 6_000_000_u64;
    let (mut mean, mut second) = (0.0, 0.0);
    for k in 0..count {
        let v = richardson.sample(radius, k);
        mean += v / count as f64;
        second += v * v / count as f64;
    }
    // The sequence is fixed and better than random: two standard errors of independent samples bound it. Without the common part of
    // both supports the second moment would be 8/57 larger, more than four of them.
    let hits = s.hit_probability(0, x, 0.5 * radius).unwrap().value * count as f64;
    let spread = 2.0 / hits.sqrt();
    assert!(hits > 2e3, "{hits}");
    assert!(
        (mean / exact.mean.value - 1.0).abs() < 3.0 * spread,
        "{mean} {exact:?}"
    );
    assert!(
        (second / exact.second_moment.value - 1.0).abs() < spread,
        "{second} {exact:?}"
    );
}

fn command(arguments: &[&str]) -> std::process::Output {
    std::process::Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .arg("bandwidth")
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn the_command_answers_and_refuses() {
    let output = command(&["mirror-wall", "--paths", "1e9", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(answer["schema"], "nephroid-bandwidth/1");
    let probes = answer["probes"].as_array().unwrap();
    assert!(!probes.is_empty());
    for probe in probes {
        assert_eq!(probe["class"], "LSDE");
        assert_eq!(probe["law"]["place"], "smooth");
        let best = &probe["best"];
        let [bias, deviation, rmse] =
            ["bias", "standard_deviation", "rmse"].map(|k| best[k].as_f64().unwrap());
        assert!((libm::hypot(bias, deviation) / rmse - 1.0).abs() < 1e-12);
        // At the optimum of the law the variance is p/d·2 = 2 squared biases.
        assert!(
            (deviation * deviation / (bias * bias) - 2.0).abs() < 0.5,
            "{probe}"
        );
        assert!((probe["lambda"].as_f64().unwrap() - 1.0 / 6.0).abs() < 1e-15);
        assert!(probe["preview"].as_f64().unwrap() < best["bandwidth"].as_f64().unwrap());
    }
    assert_eq!(answer["picture"][0]["class"], "LSDE");

    let text = command(&["pool", "--paths", "30000", "--technique", "light"]);
    assert_eq!(text.status.code(), Some(0), "{text:?}");
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(
        text.contains("preview") && text.contains("picture"),
        "{text}"
    );

    for (arguments, names) in [
        (&["mirror-wall", "--paths", "0"][..], "whole number"),
        (&["nowhere", "--paths", "10"], "nowhere"),
        (
            &["mirror-wall", "--paths", "10", "--kernel", "disc"],
            "disc",
        ),
        (
            &["mirror-wall", "--paths", "10", "--technique", "backwards"],
            "backwards",
        ),
        (
            &["mirror-wall", "--paths", "10", "--epsilon", "0"],
            "epsilon",
        ),
        (
            &["mirror-wall", "--paths", "10", "--points", "no.csv"],
            "no.csv",
        ),
        (&["floor", "--paths", "10", "--beam-area=-1"], "beam-area"),
        (
            &["corner", "--paths", "10", "--technique", "camera"],
            "technique",
        ),
        (&["furnace", "--paths", "10"], "floor"),
    ] {
        let output = command(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {output:?}");
        assert!(
            String::from_utf8_lossy(&output.stderr).contains(names),
            "{arguments:?} {output:?}"
        );
    }
    // Nothing is regularized there.
    assert_eq!(command(&["floor", "--paths", "10"]).status.code(), Some(4));
}
