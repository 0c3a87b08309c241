//! Rates: fits on synthetic data of known law, and integrators whose rates are right or wrong on purpose.
//!
//! Every study here shares a level of 1e-6 among its tests, so a false "different" anywhere in this file has a probability below
//! 2e-5 in all; seeds are fixed.

use libm::{cos, log, pow, sqrt};
use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Fault, Integrator, Plan, Prepared, Schedule, Settings, by_name};
use nephroid::rates::bias::{self, Study};
use nephroid::rates::converge;
use nephroid::rates::counts::{none_of, p_bound};
use nephroid::rates::expected::{expected, sharp};
use nephroid::rates::outcome::State;
use nephroid::rates::power_law::Design;
use nephroid::rates::region::{View, interior};
use nephroid::rates::runs::at_bandwidths;
use nephroid::rates::variance::{slope_contrast, variance_slope, variance_test};
use nephroid::stream::{philox, uniform};
use nephroid::verify::replicates::Seeds;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind};

const LEVEL: f64 = 1e-6;

/// Standard normal values one after the other.
struct Normal {
    seed: u32,
    counter: u32,
}

impl Normal {
    fn next(&mut self) -> f64 {
        self.counter += 1;
        let [a, b, c, d] = philox([self.counter, 9, 0, 0], [self.seed, 41]);
        let (u, v) = (uniform(a, b), uniform(c, d));
        sqrt(-2.0 * log(1.0 - u)) * cos(core::f64::consts::TAU * v)
    }
}

const BANDWIDTHS: [f64; 4] = [0.4, 0.28, 0.2, 0.1];

/// Replicates of y = c x² with noise that grows like 1/x, and their design.
fn power_data(normal: &mut Normal, count: usize, c: f64) -> (Design, Vec<Vec<f64>>) {
    let weights = BANDWIDTHS.map(|x| x * x);
    let rows = (0..count)
        .map(|_| BANDWIDTHS.map(|x| c * x * x + normal.next() / x).to_vec())
        .collect();
    (Design::new(&BANDWIDTHS, &weights), rows)
}

#[test]
fn an_exponent_without_noise_is_exact() {
    for p in [-3.0, -0.5, 0.0, 1.0 / 3.0, 2.0, 4.0] {
        let design = Design::new(&BANDWIDTHS, &[1.0, 4.0, 0.1, 7.0]);
        let y = BANDWIDTHS.map(|x| -3e-4 * pow(x, p));
        assert!((design.exponent_of(&y) - p).abs() < 1e-6, "{p}");
        // The contrast does not see the coefficient.
        let t: f64 = design.contrast(p).iter().zip(y).map(|(a, y)| a * y).sum();
        let size: f64 = design
            .contrast(p)
            .iter()
            .zip(y)
            .map(|(a, y)| (a * y).abs())
            .sum();
        assert!(t.abs() < 1e-12 * size);
    }
}

/// Coverage of the 95 % interval from a strong signal down to none, 400 data sets each: fewer than 358 covered would be 4.9 standard
/// deviations off, and fewer than 3 or more than 46 rejections of the truth at level 0.05 have a probability of 6e-7.
#[test]
fn intervals_of_exponents_cover_at_any_noise() {
    let mut normal = Normal {
        seed: 3,
        counter: 0,
    };
    for signal in [200.0, 30.0, 8.0, 0.0] {
        let (mut covered, mut bounded, mut rejected) = (0, 0, 0);
        for _ in 0..400 {
            let (design, rows) = power_data(&mut normal, 16, signal);
            let fit = design.fit(&rows, 0.05);
            covered += u32::from((fit.interval[0]..=fit.interval[1]).contains(&2.0));
            bounded += u32::from(fit.half_width().is_finite());
            let exact = BANDWIDTHS.map(|x| signal * x * x);
            rejected += u32::from(signal > 0.0 && design.p_value(&exact, &[0.0; 4], &rows) < 0.05);
        }
        println!(
            "signal {signal}: covered {covered}, bounded {bounded}, rejected {rejected} of 400"
        );
        assert!(covered >= 358, "signal {signal}: {covered}");
        assert!(signal == 0.0 || (3..=46).contains(&rejected), "{rejected}");
        // With a strong signal intervals are bounded, without any they are not.
        assert!(signal < 200.0 || bounded == 400);
        assert!(signal > 0.0 || bounded < 40, "{bounded}");
    }
}

#[test]
fn slopes_of_variances_of_running_means() {
    // Var ~ n⁻¹ from running means of white noise: the samples are shared between the n, and the jackknife knows.
    let mut normal = Normal {
        seed: 5,
        counter: 0,
    };
    let n: Vec<f64> = (0..6).map(|k| f64::from(1 << k)).collect();
    let (mut covered, trials) = (0, 200);
    for _ in 0..trials {
        let rows: Vec<Vec<f64>> = (0..64)
            .map(|_| {
                let (mut sum, mut row) = (0.0, Vec::new());
                for i in 1..=32_u32 {
                    sum += normal.next();
                    if i.is_power_of_two() {
                        row.push(sum / f64::from(i));
                    }
                }
                row
            })
            .collect();
        let slope = variance_slope(&n, &rows, 0.05);
        covered += u32::from((slope.interval[0]..=slope.interval[1]).contains(&-1.0));
        assert!(slope.p_value(-1.0) > 1e-7);
    }
    // 190 ± 3 expected; fewer than 174 would be five standard deviations off.
    println!("covered {covered} of {trials}");
    assert!(covered >= 174, "{covered}");
}

#[test]
fn bounds_of_counts_are_bounds() {
    // Against the exact binomial tail, 2 P(S ≥ s), by summation.
    let (n, q) = (40, 0.1_f64);
    let term = |s: i32| {
        let choose = (0..s).fold(1.0, |c, i| c * f64::from(n - i) / f64::from(i + 1));
        choose * pow(q, f64::from(s)) * pow(1.0 - q, f64::from(n - s))
    };
    for s in 5..20 {
        let exact: f64 = (s..=n).map(term).sum();
        let bound = p_bound(s as u64, f64::from(n), 4.0, 0.0);
        assert!(
            bound >= exact && bound <= 30.0 * exact.max(0.02),
            "{s}: {bound} {exact}"
        );
    }
    assert_eq!(p_bound(4, 40.0, 4.0, 0.0), 1.0);
    assert_eq!(p_bound(5, 40.0, 4.0, 1.0), 1.0);
    assert_eq!(p_bound(1, 40.0, 0.0, 0.0), 0.0);
    assert!((none_of(0.1, 40.0) - pow(0.9, 40.0)).abs() < 1e-15);
}

fn mirror_wall() -> Entry {
    entry::load("mirror-wall").unwrap()
}

fn integrator(name: &str) -> Box<dyn Integrator> {
    by_name(name, &Settings::default()).unwrap()
}

/// A change of what an iteration is asked for.
#[derive(Clone, Copy)]
enum Change {
    /// The bandwidth never falls below this.
    NeverBelow(f64),
    /// The bandwidth of iteration i (from 1) is as for √i.
    HalfTheExponent(f64),
    /// Every iteration draws the random numbers of the first.
    SameNumbers,
    /// Half of the paths, each counted twice.
    HalfThePaths,
}

/// An integrator with a defect of its rate.
struct Changed(Box<dyn Integrator>, Change);

struct PreparedChanged(Box<dyn Prepared>, Change);

impl Integrator for Changed {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn title(&self) -> &'static str {
        self.0.title()
    }

    fn plan(&self, entry: &Entry) -> Plan {
        self.0.plan(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        Box::new(PreparedChanged(self.0.prepare(entry), self.1))
    }
}

impl Prepared for PreparedChanged {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        let (mut iteration, mut drawn, mut bandwidth) = (iteration, paths, bandwidth);
        match self.1 {
            Change::NeverBelow(least) => bandwidth = bandwidth.max(least),
            Change::HalfTheExponent(first) => bandwidth = sqrt(first * bandwidth),
            Change::SameNumbers => iteration = 0,
            Change::HalfThePaths => drawn = paths / 2,
        }
        let scale = paths as f64 / drawn as f64;
        let mut one = Film::new(film.width, film.height, film.classes);
        self.0.iterate(seed, iteration, drawn, bandwidth, &mut one);
        one.layers.iter_mut().flatten().for_each(|v| *v *= scale);
        film.add(&one);
        film.paths += paths - drawn;
    }
}

fn bias_study(integrator: &dyn Integrator, technique: Option<Technique>, paths: u64) -> Study {
    study_of(&mirror_wall(), integrator, technique, paths)
}

fn study_of(
    entry: &Entry,
    integrator: &dyn Integrator,
    technique: Option<Technique>,
    paths: u64,
) -> Study {
    let request = bias::Request {
        entry,
        integrator,
        kernel: None,
        technique,
        bandwidths: &BANDWIDTHS,
        class: Some(PathClass::LSDE),
        region: None,
        paths: Some(paths),
        replicates: 32,
        seed: 11,
        level: LEVEL,
        half_width: 1.0,
    };
    let (mut studies, skipped) = bias::study(&request).unwrap();
    assert!(skipped.is_empty() && studies.len() == 1);
    studies.remove(0)
}

/// The order of the exact expectation is close to 2, and the measured one agrees (an order wrong by 1.3 is found with probability 0.9, a
/// size of the bias wrong by a quarter); with prediction and measurement exchanged
/// between techniques, or a bandwidth that stops shrinking, it does not.
#[test]
fn the_order_of_the_bias_of_regularized_path_tracing() {
    let paths = 16_000_000;
    let healthy = bias_study(integrator("pt-reg").as_ref(), None, paths);
    println!(
        "fitted {:.3} {:?}, predicted {:.4}, size {:?}, detectable {:.2}",
        healthy.exponent.fitted,
        healthy.exponent.interval,
        healthy.predicted,
        healthy.scale,
        healthy.detectable
    );
    assert_eq!(healthy.state, State::Consistent, "{:?}", healthy.tests);
    // α² with a correction of relative order α²: not 2 exactly, and known from the expectation.
    assert!((healthy.predicted - 2.0).abs() < 0.15 && (healthy.predicted - 2.0).abs() > 0.02);
    let stuck = Changed(integrator("pt-reg"), Change::NeverBelow(0.4));
    assert_eq!(bias_study(&stuck, None, paths / 2).state, State::Different);
    let other = bias_study(
        integrator("pt-reg").as_ref(),
        Some(Technique::Light),
        paths / 2,
    );
    assert_eq!(other.state, State::Different);
    // A kernel whose mass grows as the bandwidth shrinks.
    let settings = Settings {
        kernel: None,
        fault: Some(Fault::RadiusForRadiusSquared),
    };
    let heavy = by_name("pt-reg", &settings).unwrap();
    assert_eq!(
        bias_study(heavy.as_ref(), None, paths / 2).state,
        State::Different
    );
}

/// A wide wall and a low light close to it: at a radius of 0.4 m merging has a bias of a tenth, far from every edge. (On `mirror-wall`
/// the interior bias of merging is half a per cent, and photons enough to know its order would take hours.)
fn low_light() -> Entry {
    let mut entry = mirror_wall();
    let Kind::PlanarMirror(scene) = &mut entry.kind else {
        panic!("a planar mirror");
    };
    scene.light.position = [0.25, 0.8, 0.4];
    scene.mirror.center = [0.0, 1.0, 2.5];
    (scene.mirror.half_width, scene.mirror.half_height) = (5.0, 2.45);
    entry
}

#[test]
fn the_order_of_the_bias_of_progressive_photon_mapping() {
    let paths = 8_000_000;
    let entry = low_light();
    let healthy = study_of(&entry, integrator("ppm").as_ref(), None, paths);
    println!(
        "{}: fitted {:.3} {:?}, predicted {:.4}, size {:?}, detectable {:.2}",
        healthy.view.name,
        healthy.exponent.fitted,
        healthy.exponent.interval,
        healthy.predicted,
        healthy.scale,
        healthy.detectable
    );
    assert_eq!(healthy.state, State::Consistent, "{:?}", healthy.tests);
    assert!(
        healthy
            .points
            .iter()
            .filter(|p| p.variance.is_some())
            .count()
            >= 3
    );
    let stuck = Changed(integrator("ppm"), Change::NeverBelow(0.4));
    let stuck = study_of(&entry, &stuck, None, paths);
    assert_eq!(stuck.state, State::Different);
    let order = stuck
        .tests
        .iter()
        .find(|t| t.what.starts_with("order"))
        .unwrap();
    assert!(order.p < 1e-6, "{order:?}");
}

fn converge_studies(
    integrator: &dyn Integrator,
    schedule: &Schedule,
    predicted: Option<&Schedule>,
    [iterations, paths, replicates]: [u32; 3],
    class: PathClass,
) -> converge::Study {
    let entry = mirror_wall();
    let request = converge::Request {
        entry: &entry,
        integrator,
        kernel: None,
        technique: None,
        schedule,
        predicted_schedule: predicted,
        class: Some(class),
        region: None,
        iterations,
        paths_per_iteration: Some(u64::from(paths)),
        replicates,
        seed: 12,
        level: LEVEL,
        half_widths: [0.08, 3.0],
    };
    let (mut studies, skipped) = converge::study(&request).unwrap();
    assert!(skipped.is_empty() && studies.len() == 1, "{skipped:?}");
    studies.remove(0)
}

fn power_schedule(first: f64, lambda: f64, iterations: u32) -> Schedule {
    let at = |i: u32| first * pow(f64::from(i), -lambda);
    Schedule::List((1..=iterations).map(at).collect())
}

#[test]
fn variance_and_bias_slopes_along_a_schedule() {
    let sizes = [64, 1024, 160];
    let schedule = Schedule::Progressive {
        first: 0.4,
        reduction: 2.0 / 3.0,
    };
    let run = |integrator: &dyn Integrator| {
        converge_studies(integrator, &schedule, None, sizes, PathClass::LSDE)
    };
    let healthy = run(integrator("pt-reg").as_ref());
    let (slope, predicted) = healthy.variance.unwrap();
    println!(
        "variance {slope:?}, predicted {predicted}, bias {:?}",
        healthy.bias
    );
    assert_eq!(
        healthy.state,
        State::Consistent,
        "{:?} {:?}",
        healthy.tests,
        healthy.remarks
    );
    // `theory/consistency.md` section 5 has the sums for V ~ α⁻², bias ~ α²; the exact ones differ by relative orders of α². The
    // asymptotic −2/3 and −1/3 would be off by more.
    let a = 2.0 / 3.0;
    let ratio = |n: f64, p: f64, q: f64| libm::exp(libm::lgamma(n + p) - libm::lgamma(n + q));
    let n: Vec<f64> = (0..7).map(|k| f64::from(1 << k)).collect();
    let law: Vec<f64> = n
        .iter()
        .map(|&n| (ratio(n, 2.0, a) - 1.0 / libm::tgamma(a)) / (n * n))
        .collect();
    let contrast = slope_contrast(&n);
    let of_law: f64 = contrast.iter().zip(&law).map(|(c, v)| c * log(*v)).sum();
    assert!((predicted - of_law).abs() < 0.02, "{predicted} {of_law}");
    assert!((of_law + 2.0 / 3.0).abs() > 0.05);
    let weights: Vec<f64> = law.iter().map(|v| 1.0 / v).collect();
    let bias: Vec<f64> = n
        .iter()
        .map(|&n| (ratio(n, 1.0 + a, 1.0) / libm::tgamma(1.0 + a) - 1.0) / (n * a))
        .collect();
    let of_law = Design::new(&n, &weights).exponent_of(&bias);
    let predicted = healthy.bias.unwrap().1;
    assert!(
        (predicted / of_law - 1.0).abs() < 0.08,
        "{predicted} {of_law}"
    );
    // r in place of r² in the recursion: consistent as well, with other rates.
    let halved = Changed(integrator("pt-reg"), Change::HalfTheExponent(0.4));
    assert_eq!(run(&halved).state, State::Different);
    // The same random numbers in every iteration: every mean is right, and the variance stays.
    let repeated = Changed(integrator("pt-reg"), Change::SameNumbers);
    assert_eq!(run(&repeated).state, State::Different);
}

#[test]
fn an_estimator_without_bias_has_slope_minus_one() {
    let schedule = Schedule::Fixed(0.2);
    let sizes = [32, 2048, 128];
    for (name, class) in [("lt", PathClass::LSDE), ("pt", PathClass::LDE)] {
        let study = converge_studies(integrator(name).as_ref(), &schedule, None, sizes, class);
        let (slope, predicted) = study.variance.unwrap();
        assert_eq!(predicted, -1.0);
        assert!(
            slope.p_value(-1.0) > LEVEL && slope.half_width() < 0.15,
            "{slope:?}"
        );
        assert!(study.state != State::Different && study.bias.is_none());
    }
}

/// Merging at a point: the variance of a photon map is that of its photons. λ = 0.6 > 1/2: the variance grows, most replicates
/// see nothing any more, and the numbers of photons are those of the exact probabilities.
#[test]
fn a_schedule_beyond_the_window_starves() {
    let sizes = [128, 256, 128];
    let schedule = power_schedule(0.3, 0.6, 128);
    let healthy = converge_studies(
        integrator("ppm").as_ref(),
        &schedule,
        None,
        sizes,
        PathClass::LSDE,
    );
    assert!(healthy.state != State::Different, "{:?}", healthy.tests);
    let (first, last) = (healthy.points[0], healthy.points[7]);
    // The prediction itself: n^0.2/2.2 by facts.md, up to the finite sum.
    let growth = last.predicted_variance.unwrap() / first.predicted_variance.unwrap();
    assert!(growth > 1.0, "{growth}");
    let events = last.events.unwrap();
    println!("growth {growth:.3}, {events:?}, median {}", last.median);
    assert!(events.expected_empty > 0.3 * 128.0 && last.median < 0.9);
    // A bandwidth with a floor: every expectation stays within its error, the counts do not.
    let floored = Changed(integrator("ppm"), Change::NeverBelow(0.06));
    let study = converge_studies(&floored, &schedule, None, sizes, PathClass::LSDE);
    assert_eq!(study.state, State::Different);
    let count_tests = study.tests.iter().filter(|t| t.what.contains("not zero"));
    assert!(count_tests.clone().any(|t| t.p < 1e-9), "{:?}", study.tests);
}

/// The variance of replicate means is (m₂ − mean²)/paths. 4096 replicates: a variance wrong by 15 % is found with probability 0.9 (χ² with
/// the kurtosis of the number of contributions); a healthy one is rejected with probability below 1e-6 each.
#[test]
fn second_moments_of_regularized_path_tracing() {
    let mut entry = mirror_wall();
    (entry.camera.width, entry.camera.height) = (16, 16);
    let bandwidth = 0.3;
    let (technique, kernel) = (Technique::Camera, Kernel::Cone);
    let whole = View::whole(&entry, "");
    let part = View::pixels(&entry, [4, 6, 12, 12]).unwrap();
    let close = interior(
        &entry,
        PathClass::LSDE,
        technique,
        kernel,
        &[0.1, bandwidth],
    );
    let close = close.unwrap().unwrap();
    for view in [whole, part, close] {
        let exact = expected(&view, PathClass::LSDE, technique, kernel, &[bandwidth]).unwrap()[0];
        let paths = 512;
        let layer = entry
            .kind
            .classes()
            .iter()
            .position(|&c| c == PathClass::LSDE)
            .unwrap();
        let values = |integrator: &dyn Integrator| -> Vec<f64> {
            let prepared = integrator.prepare(&view.entry);
            let seeds = Seeds::new(21, "mirror-wall", "pt-reg");
            at_bandwidths(
                prepared.as_ref(),
                &view,
                layer,
                &[bandwidth],
                &[paths],
                seeds,
                4096,
            )
            .iter()
            .map(|r| r.means[0])
            .collect()
        };
        let variance = exact.variance() / paths as f64;
        let kurtosis = 1.0 / (exact.effective_hit() * paths as f64);
        let healthy = variance_test(&values(integrator("pt-reg").as_ref()), variance, kurtosis);
        println!("{}: {healthy:?}", view.name);
        assert!(healthy.p > LEVEL, "{}: {healthy:?}", view.name);
        assert!(exact.second_moment.error < 1e-2 * variance * paths as f64);
        let half = Changed(integrator("pt-reg"), Change::HalfThePaths);
        let twice = variance_test(&values(&half), variance, kurtosis);
        assert!(twice.p < LEVEL, "{}: {twice:?}", view.name);
    }
}

/// Interior regions: the sharp truth of the pixels is the closed form at points, every bandwidth's expectation has the sign of the
/// largest one's, and merging keeps off the circle of radius √(8/3) about (0.25, 2), where its α² coefficient is zero.
#[test]
fn regions_are_interior_and_their_bias_has_one_sign() {
    let entry = mirror_wall();
    for (technique, kernel) in [
        (Technique::Camera, Kernel::Cone),
        (Technique::Merge, Kernel::Disc),
    ] {
        for class in [PathClass::LSDE, PathClass::LSDSE] {
            let view = interior(&entry, class, technique, kernel, &BANDWIDTHS)
                .unwrap()
                .unwrap();
            let truth = sharp(&view, class).unwrap().unwrap();
            let biases: Vec<f64> = expected(&view, class, technique, kernel, &BANDWIDTHS)
                .unwrap()
                .iter()
                .map(|e| e.mean.value - truth.value)
                .collect();
            assert!(biases.iter().all(|b| b * biases[0] > 0.0), "{biases:?}");
            let film = nephroid_analytic::bandwidth::film::FilmExpectation::new(
                &view.entry,
                technique,
                kernel,
                &[BANDWIDTHS[0]],
            )
            .unwrap();
            for (u, v) in [(0.1, 0.1), (7.9, 0.1), (4.0, 4.0), (0.1, 7.9), (7.9, 7.9)] {
                let point = film.at(class, u, v, 1e-6).unwrap();
                assert!(point.is_interior, "{}", view.name);
                assert!((point.sharp / truth.value - 1.0).abs() < 0.2);
                // ∇²E/E = −6/D² + 15 h²/D⁴, and the bias is r²/8 times it, to r⁴.
                let [x, y, _] = point.floor;
                let h2 = (x - 0.25) * (x - 0.25) + (y - 2.0) * (y - 2.0);
                let d2 = h2 + 4.0;
                let laplacian = 15.0 * h2 / (d2 * d2) - 6.0 / d2;
                let relative = point.moments.mean.value / point.sharp - 1.0;
                if technique == Technique::Merge {
                    let predicted = 0.02 * laplacian;
                    assert!(
                        (relative / predicted - 1.0).abs() < 0.15,
                        "{relative} {predicted}"
                    );
                    assert!((h2 - 8.0 / 3.0).abs() > 0.3, "{h2}");
                }
            }
        }
    }
}

/// Fewer contributions than a normal mean needs: shown, not used, and nothing is decided.
#[test]
fn too_few_contributions_decide_nothing() {
    let study = bias_study(integrator("pt-reg").as_ref(), None, 4000);
    assert_eq!(study.state, State::Undecided);
    assert!(study.points.iter().all(|p| !p.is_used) && study.tests.is_empty());
    assert!(study.exponent.fitted.is_nan() && study.exponent.half_width() == f64::INFINITY);
    // A class that is claimed and lost is different, though its variance is zero.
    let settings = Settings {
        kernel: None,
        fault: Some(Fault::ClassDropped(PathClass::LSDE)),
    };
    let dropped = by_name("pt-reg", &settings).unwrap();
    let study = bias_study(dropped.as_ref(), None, 4_000_000);
    assert_eq!(study.state, State::Different);
}

fn nephroid(threads: &str, arguments: &[&str]) -> (i32, String, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

const BIAS: [&str; 10] = [
    "bias",
    "mirror-wall",
    "--integrator",
    "pt-reg",
    "--bandwidths",
    "0.4,0.2",
    "--class",
    "LSDE",
    "--paths",
    "4e6",
];
const CONVERGE: [&str; 14] = [
    "converge",
    "mirror-wall",
    "--integrator",
    "ppm",
    "--schedule",
    "ppm(0.4,0.5)",
    "--class",
    "LSDE",
    "--iterations",
    "8",
    "--replicates",
    "64",
    "--paths-per-iteration",
    "8192",
];

#[test]
fn answers_have_the_keys_of_the_contract_and_exit_codes_say_what_follows() {
    let plot = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("rates.svg");
    let plot = plot.to_str().unwrap();
    for (arguments, schema) in [
        (&BIAS[..], "nephroid-bias/1"),
        (&CONVERGE[..], "nephroid-converge/1"),
    ] {
        let mut pictures = Vec::new();
        let mut points = Vec::new();
        for threads in ["1", "3"] {
            let all = [arguments, &["--json", "--plot", plot]].concat();
            let (code, text, error) = nephroid(threads, &all);
            assert!([0, 3].contains(&code), "{text} {error}");
            let json: serde_json::Value = serde_json::from_str(&text).unwrap();
            assert_eq!(json["schema"], schema);
            let class = &json["classes"][0];
            let fits = match schema {
                "nephroid-bias/1" => vec![class],
                _ => vec![&class["variance"], &class["squared_bias"]],
            };
            for fit in fits {
                assert!(
                    fit["fitted"].is_number() && fit["predicted"].is_number(),
                    "{text}"
                );
                assert_eq!(fit["interval"].as_array().unwrap().len(), 2);
            }
            // Times differ, and what is derived from them.
            let mut values = class["points"].clone();
            for p in values.as_array_mut().unwrap() {
                p.as_object_mut().unwrap().remove("efficiency");
            }
            points.push(values);
            pictures.push(std::fs::read_to_string(plot).unwrap());
        }
        assert!(points[0] == points[1] && pictures[0] == pictures[1]);
        assert!(pictures[0].starts_with("<svg") && pictures[0].ends_with("</svg>\n"));
        assert!(!pictures[0].contains("NaN") && pictures[0].contains("predicted"));
    }
    // Another technique's prediction, an integrator with nothing to measure.
    let (code, text, _) = nephroid(
        "2",
        &[&BIAS[..9], &["8e6", "--technique", "light"]].concat(),
    );
    assert_eq!(code, 1, "{text}");
    let nothing = [
        "bias",
        "floor",
        "--integrator",
        "pt-reg",
        "--bandwidths",
        "0.4,0.2",
    ];
    assert_eq!(nephroid("2", &nothing).0, 4);
    let unknown = [
        "bias",
        "cup",
        "--integrator",
        "pt-reg",
        "--bandwidths",
        "0.4,0.2",
    ];
    let (code, text, _) = nephroid("2", &unknown);
    assert!(code == 4 && text.contains("cylinder-cup"), "{text}");
}

#[test]
fn bad_input_names_the_option_and_what_is_allowed() {
    let bias = |option: &'static str, value: &'static str| [&BIAS[..], &[option, value]].concat();
    let converge =
        |option: &'static str, value: &'static str| [&CONVERGE[..], &[option, value]].concat();
    let cases = [
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3",
            ],
            "--bandwidths",
            "2 to 32",
        ),
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,-1",
            ],
            "--bandwidths",
            "positive",
        ),
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,9",
            ],
            "--bandwidths",
            "radians",
        ),
        (
            vec![
                "bias",
                "no-such-scene",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,0.1",
            ],
            "no-such-scene",
            "mirror-wall",
        ),
        (bias("--region", "5,5,5,9"), "--region", "x0 < x1"),
        (bias("--region", "0,0,500,9"), "--region", "128"),
        (bias("--replicates", "3"), "--replicates", "16 to 65536"),
        (bias("--technique", "merge"), "--technique", "camera"),
        (bias("--kernel", "disc"), "kernel", "cone"),
        (bias("--level", "2"), "--level", "1e-15"),
        (converge("--region", "0,0,1,500"), "--region", "128"),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "ppm",
                "--schedule",
                "pow(1)",
            ],
            "--schedule",
            "ppm(R1,A)",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "ppm",
                "--schedule",
                "0.2",
                "--iterations",
                "9",
            ],
            "--iterations",
            "power of two",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--schedule",
                "4,3",
            ],
            "--schedule",
            "radians",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "lt",
                "--schedule",
                "0.2",
                "--class",
                "LTTDE",
            ],
            "--class",
            "LSDE",
        ),
    ];
    for (arguments, option, allowed) in cases {
        let (code, _, error) = nephroid("1", &arguments);
        let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(code, 2, "{arguments:?}: {error}");
        assert!(
            error.contains(option) && error.contains(allowed),
            "{arguments:?}: {error}"
        );
    }
}
