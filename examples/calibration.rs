//! Runs the whole suite again and again and counts: right integrators must never be called different, wrong ones always.
//!
//! ```text
//! cargo run --release --example calibration -- null --runs 20              the quick suite
//! cargo run --release --example calibration -- reduced --runs 1000         three entries, pt and lt
//! cargo run --release --example calibration -- faults --runs 10            every fault, every integrator it acts on
//! ```
//!
//! Exit code 1 if a right integrator was called different or a wrong one was not.

use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use nephroid::entry;
use nephroid::integrators::{Fault, Integrator, NAMES, Settings, Treatment, by_name};
use nephroid::judge::finding::State;
use nephroid::judge::hypotheses::LEVEL;
use nephroid::verify::effort::{BANDWIDTH, Effort};
use nephroid::verify::expected::Truths;
use nephroid::verify::run::{Request, run};
use nephroid::verify::suite::{Coverage, Subject};
use nephroid::verify::verdicts::Outcome;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Kind, PlanarMirrorScene};

#[derive(Parser)]
struct Args {
    /// What to run.
    #[arg(value_parser = ["null", "reduced", "faults"])]
    mode: String,
    /// Seeds to run.
    #[arg(long, default_value_t = 20)]
    runs: u64,
    /// The first seed.
    #[arg(long, default_value_t = 1)]
    first: u64,
}

/// The entries and integrators of the reduced suite: those that are neither dear nor alike.
const REDUCED: ([&str; 3], [&str; 2]) = (["floor", "mirror-wall", "cup"], ["pt", "lt"]);

fn main() -> ExitCode {
    let args = Args::parse();
    let seeds = args.first..args.first + args.runs;
    let bad = match args.mode.as_str() {
        "null" => null_runs(seeds, &entry::names().collect::<Vec<_>>(), &NAMES),
        "reduced" => null_runs(seeds, &REDUCED.0, &REDUCED.1),
        _ => fault_runs(seeds),
    };
    ExitCode::from(u8::from(bad > 0))
}

fn subjects(names: &[&str]) -> Vec<Subject> {
    let subject = |name: &&str| Subject {
        argument: (*name).to_owned(),
        entry: entry::load(name).unwrap_or_else(|e| panic!("{e}")),
    };
    names.iter().map(subject).collect()
}

fn integrator(name: &str, fault: Option<Fault>) -> Box<dyn Integrator> {
    let settings = Settings {
        kernel: None,
        fault,
        ..Settings::default()
    };
    by_name(name, &settings).unwrap_or_else(|e| panic!("{e}"))
}

fn request(
    scenes: Vec<Subject>,
    integrators: Vec<Box<dyn Integrator>>,
    seed: u64,
    margin: f64,
) -> Request {
    Request {
        scenes,
        integrators,
        left_out: Vec::new(),
        effort: Effort::Quick,
        coverage: Coverage::Covering,
        margin,
        level: LEVEL,
        checks: None,
        most_paths: Effort::Quick.most_paths(),
        variations: false,
        seed,
        bandwidth: BANDWIDTH,
        kernel: None,
        mask: None,
    }
}

fn judged(request: &Request, truths: &mut Truths) -> Outcome {
    run(request, truths, &|_, _, _, _| {}).unwrap_or_else(|e| panic!("{e}"))
}

/// Right integrators: counts false "different" and undecided verdicts, and prints the smallest p-value, which among n verdicts
/// should be about 1/n.
fn null_runs(seeds: impl Iterator<Item = u64>, entries: &[&str], names: &[&str]) -> u64 {
    let margin = Effort::Quick.margin();
    let mut truths = Truths::for_margin(margin);
    let (mut different, mut undecided, mut verdicts, mut runs) = (0, 0, 0, 0);
    let mut smallest = 1.0_f64;
    let mut longest = 0.0_f64;
    for seed in seeds {
        let scenes = subjects(entries);
        let integrators = names.iter().map(|name| integrator(name, None)).collect();
        let outcome = judged(&request(scenes, integrators, seed, margin), &mut truths);
        let count = |s: State| {
            let is = |v: &&_| is_state(v, s);
            outcome.verdicts.iter().filter(is).count() as u64
        };
        let (d, u, e) = (
            count(State::Different),
            count(State::Undecided),
            count(State::Equivalent),
        );
        for v in &outcome.verdicts {
            smallest = smallest.min(v.finding.p_different.unwrap_or(1.0));
            if v.finding.state == State::Different || v.finding.state == State::Undecided {
                println!(
                    "  {} {} {}: {:?}",
                    v.scene, v.integrator, v.class, v.finding
                );
            }
        }
        println!(
            "seed {seed}: {e} equivalent, {d} different, {u} undecided, {:.1} s",
            outcome.seconds
        );
        // The first run computes the truths for all.
        if runs > 0 {
            longest = longest.max(outcome.seconds);
        }
        (different, undecided) = (different + d, undecided + u);
        (verdicts, runs) = (verdicts + d + u + e, runs + 1);
    }
    println!(
        "{runs} runs, {verdicts} verdicts: {different} different, {undecided} undecided; smallest p of a difference \
         {smallest:.1e}; longest run after the first {longest:.1} s"
    );
    different
}

fn is_state(v: &nephroid::verify::verdicts::Verdict, state: State) -> bool {
    v.finding.state == state
}

/// Wrong integrators on `mirror-wall`, with an intensity and a reflectance that are not 1: every class on which a
/// fault acts must be different. Returns how many were not.
fn fault_runs(seeds: impl Iterator<Item = u64>) -> u64 {
    const GROSS_MARGIN: f64 = 0.05;
    const PI_ALPHA_SQUARED_MARGIN: f64 = 0.01;
    let mut gross = Truths::for_margin(GROSS_MARGIN);
    let mut fine = Truths::for_margin(PI_ALPHA_SQUARED_MARGIN);
    let (mut survived, mut total) = (0, 0);
    for seed in seeds {
        for name in NAMES {
            for fault in faults(name) {
                let started = Instant::now();
                let mut request = request(
                    vec![subject_without_ones()],
                    vec![integrator(name, Some(fault))],
                    seed,
                    GROSS_MARGIN,
                );
                let mut truths = &mut gross;
                if fault == Fault::KernelNormalizedByPiAlphaSquared {
                    // 1 - α²/12: 2.07 %.
                    (request.margin, request.bandwidth) = (PI_ALPHA_SQUARED_MARGIN, 0.5);
                    truths = &mut fine;
                }
                let outcome = judged(&request, truths);
                let missed: Vec<_> = outcome
                    .verdicts
                    .iter()
                    .filter(|v| {
                        v.class
                            .parse()
                            .is_ok_and(|c| acts_on(fault, c, v.bandwidth))
                    })
                    .filter(|v| !matches!(v.finding.state, State::Different | State::NotSampled))
                    .collect();
                for v in &missed {
                    println!("  survived: {} {}: {:?}", v.integrator, v.class, v.finding);
                }
                total += 1;
                survived += u64::from(!missed.is_empty());
                println!(
                    "seed {seed}: {name} {}: {}, {:.1} s",
                    shown(fault),
                    if missed.is_empty() {
                        "different"
                    } else {
                        "SURVIVED"
                    },
                    started.elapsed().as_secs_f64()
                );
            }
        }
    }
    println!("{total} faulty runs, {survived} survived");
    survived
}

fn subject_without_ones() -> Subject {
    let mut subjects = subjects(&["mirror-wall"]);
    let mut subject = subjects.remove(0);
    if let Kind::PlanarMirror(PlanarMirrorScene { light, mirror, .. }) = &mut subject.entry.kind {
        light.intensity = 3.7;
        mirror.reflectance = 0.7;
    }
    subject
}

/// The faults that act on an integrator.
fn faults(name: &str) -> Vec<Fault> {
    let plan = integrator(name, None).plan(&subject_without_ones().entry);
    let mut faults = vec![
        Fault::CosineTwice,
        Fault::IntensityForgotten,
        Fault::ReflectanceForgotten,
    ];
    if plan
        .iter()
        .any(|c| matches!(c.treatment, Treatment::Regularized(_)))
    {
        faults.push(Fault::RadiusForRadiusSquared);
    }
    if name == "pt-reg" {
        faults.push(Fault::KernelNormalizedByPiAlphaSquared);
    }
    let claimed = plan.iter().filter(|c| c.treatment != Treatment::NotSampled);
    faults.extend(claimed.map(|c| Fault::ClassDropped(c.class)));
    faults
}

fn shown(fault: Fault) -> String {
    match fault {
        Fault::ClassDropped(class) => format!("ClassDropped({class})"),
        other => format!("{other:?}"),
    }
}

/// Whether a fault changes a class that is or is not regularized.
fn acts_on(fault: Fault, class: PathClass, bandwidth: Option<f64>) -> bool {
    match fault {
        Fault::CosineTwice | Fault::IntensityForgotten => true,
        Fault::ReflectanceForgotten => class != PathClass::LDE,
        Fault::KernelNormalizedByPiAlphaSquared | Fault::RadiusForRadiusSquared => {
            bandwidth.is_some()
        }
        Fault::ClassDropped(dropped) => class == dropped,
        // Not among those of `faults`: the museum has them.
        _ => false,
    }
}
