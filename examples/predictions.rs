//! Regularized estimators at probes, held to their exact expectation at finite bandwidth: mean and second moment, for `camera`
//! (path tracing), `light` and `merge` (photon mapping) on several scenes, and the three conventions of a linked bandwidth from either
//! side.
//!
//! Each line is a probe in the lit part of a scene's floor. The mean of aimed samples is divided by the prediction;
//! `equivalent` means that the ratio is within the margin of 1 by 4.9 standard errors on both sides (a false one has a probability below
//! 5e-7), `different` that it is more than 4.9 standard errors from 1, and so is the second moment's. The truth at bandwidth zero is
//! printed as a ratio as well: what the bias would look like to a test that knows the limit only.
//!
//! For each scene and side the smallest relative difference between the predictions of two conventions is printed as well: where it is
//! beyond twice the margin, `equivalent` three times means that the measurement tells them apart.
//!
//! `cargo run --release --example predictions -- [SCENE]...`

use nephroid::entry;
use nephroid::integrators::Kernel as Shape;
use nephroid::integrators::probes::{Distance, Estimator as Sampler, Technique as Side};
use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{Convention, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::{Entry, Kind};

/// Standard errors on both sides.
const SIGMAS: f64 = 4.9;
/// Paths of one batch, and batches at most.
const BATCH: u64 = 1 << 18;
const MOST: u32 = 400;

/// Allowed relative deviation of the mean at each bandwidth (angle, or radius), and of the second moment.
const MARGINS: [(f64, f64); 4] = [(0.3, 0.005), (0.1, 0.005), (0.03, 0.01), (0.01, 0.03)];
const SECOND: f64 = 0.05;

/// The floor point of median brightness among those that are lit at bandwidth zero, away from edges of the floor and folds.
fn probe(entry: &Entry, class: PathClass) -> [f64; 2] {
    let truth = FloorTruth::new(entry).expect("a floor");
    let mut lit = Vec::new();
    let n = 40;
    for k in 0..n * n {
        let at = |k: usize, axis: usize| {
            let [low, high] = truth.range(axis);
            low + (high - low) * (0.25 + 0.5 * (k as f64 + 0.5) / f64::from(n as u32))
        };
        let x = [at(k % n, 0), at(k / n, 1)];
        let light = truth.at(x[0], x[1]);
        let Some(index) = light.iter().position(|t| t.class == class) else {
            continue;
        };
        let value = light[index].irradiance.value;
        if value > 0.0 && value.is_finite() {
            lit.push((value, x));
        }
    }
    lit.sort_by(|a, b| a.0.total_cmp(&b.0));
    lit[lit.len() / 2].1
}

/// Irradiance of parallel light, 0 of a point light.
fn beam(entry: &Entry) -> f64 {
    match &entry.kind {
        Kind::CylinderCup(s) => s.light.irradiance,
        _ => 0.0,
    }
}

struct Line {
    mean: f64,
    error: f64,
    second: f64,
    paths: u64,
}

/// Ratios of measured to predicted until the standard error suffices for the margin.
fn measure(
    sampler: &Sampler,
    bandwidth: f64,
    x: [f64; 2],
    [mean, second]: [f64; 2],
    margin: f64,
) -> Line {
    let aim = sampler.aim(bandwidth, x).expect("an aim");
    let mut sums = sampler
        .run_aimed(1, 0, BATCH, bandwidth, x, &aim)
        .expect("a sample")
        .swap_remove(0);
    for iteration in 1..MOST {
        if sums.standard_error() / mean * (SIGMAS + 3.0) < margin {
            break;
        }
        let more = sampler
            .run_aimed(1, iteration, BATCH, bandwidth, x, &aim)
            .expect("a sample");
        sums.add(&more[0]);
    }
    Line {
        mean: sums.mean() / mean,
        error: sums.standard_error() / mean,
        second: sums.second_moment() / (second * aim.share(0)),
        paths: sums.paths,
    }
}

fn main() {
    println!(
        "{:<12} {:<10} {:<8} {:>6} {:>9} {:>9} {:>9} {:>8} {:>9}  verdict",
        "scene", "technique", "d", "width", "measured", "±", "second", "limit", "paths"
    );
    let (mut wrong, mut open) = (0, 0);
    let asked: Vec<String> = std::env::args().skip(1).collect();
    for name in ["mirror-wall", "cup", "pillar", "pool", "dome"] {
        if !(asked.is_empty() || asked.iter().any(|a| a == name)) {
            continue;
        }
        let scene = entry::load(name).expect("a catalogue entry");
        let class = PathClass::LSDE;
        let x = probe(&scene, class);
        let light = FloorTruth::new(&scene).expect("a floor").at(x[0], x[1]);
        let limit = light
            .iter()
            .find(|t| t.class == class)
            .map_or(0.0, |t| t.irradiance.value);
        let plain = [
            (Technique::Camera, Side::Camera, Convention::Exact, None),
            (Technique::Light, Side::Light, Convention::Exact, None),
            (Technique::Merge, Side::Merge, Convention::Exact, None),
        ];
        let sides = [Side::Light, Side::Camera];
        let linked = sides.into_iter().flat_map(|side| {
            [
                (Convention::Exact, Distance::Exact),
                (Convention::Vertex, Distance::Receiver),
                (Convention::Light, Distance::Light),
            ]
            .map(|(c, d)| (Technique::Linked, side, c, Some(d)))
        });
        // Of the predictions by convention: side, bandwidth, mean.
        let mut apart: Vec<(Side, f64, f64)> = Vec::new();
        for (technique, side, convention, distance) in plain.into_iter().chain(linked) {
            if distance.is_some() && name != "dome" && name != "pillar" {
                continue;
            }
            let kernel = technique.default_kernel();
            let shape = match technique {
                Technique::Merge => Shape::Disc,
                _ => Shape::Cone,
            };
            let sampler = Sampler::new(&scene, side, shape, distance).expect("an estimator");
            for (bandwidth, margin) in MARGINS {
                // What photons of parallel light are sampled over is the estimator's own.
                let flux = sampler.flux(bandwidth, x).expect("a bandwidth");
                let area = match (flux, beam(&scene)) {
                    (Some(flux), e0) if e0 > 0.0 => flux[0] / e0,
                    _ => 1.0,
                };
                let estimator = Estimator {
                    technique,
                    kernel,
                    convention,
                    bandwidths: &[bandwidth],
                };
                let expectation = if distance.is_some() && side == Side::Camera {
                    EntryExpectation::linked_from_camera(&scene, kernel, convention, &[bandwidth])
                } else {
                    EntryExpectation::new(&scene, estimator, area)
                }
                .expect("an expectation");
                let m = expectation.at(x[0], x[1], 1e-8)[0];
                let predicted = [m.mean.value, m.second_moment.value];
                if distance.is_some() {
                    apart.push((side, bandwidth, predicted[0]));
                }
                let line = measure(&sampler, bandwidth, x, predicted, margin);
                let off = f64::abs(line.mean - 1.0);
                let verdict = if off > SIGMAS * line.error {
                    wrong += 1;
                    "different"
                } else if off + SIGMAS * line.error > margin {
                    open += 1;
                    "undecided"
                } else if f64::abs(line.second - 1.0) > SECOND {
                    wrong += 1;
                    "second moment different"
                } else {
                    "equivalent"
                };
                let shown = match (distance, side) {
                    (Some(_), Side::Camera) => "linked/c",
                    (Some(_), _) => "linked/l",
                    _ => technique.name(),
                };
                println!(
                    "{name:<12} {:<10} {:<8} {bandwidth:>6} {:>9.5} {:>9.5} {:>9.4} {:>8.4} {:>9}  {verdict}",
                    shown,
                    distance.map_or("", |_| convention.name()),
                    line.mean,
                    line.error,
                    line.second,
                    predicted[0] / limit,
                    line.paths,
                );
            }
        }
        for (side, what) in [(Side::Light, "light"), (Side::Camera, "camera")] {
            for (bandwidth, margin) in MARGINS {
                let means: Vec<f64> = apart
                    .iter()
                    .filter(|a| a.0 == side && a.1 == bandwidth)
                    .map(|a| a.2)
                    .collect();
                let pairs = (0..means.len()).flat_map(|k| (0..k).map(move |l| (k, l)));
                let least = pairs
                    .map(|(k, l)| f64::abs(means[k] / means[l] - 1.0))
                    .reduce(f64::min);
                if let Some(least) = least {
                    println!(
                        "{name:<12} conventions from the {what}, radius {bandwidth}: at least {least:.4} apart, margin {margin}"
                    );
                }
            }
        }
    }
    println!("{wrong} different, {open} undecided");
    std::process::exit(i32::from(wrong > 0));
}
