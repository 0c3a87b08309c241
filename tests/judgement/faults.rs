//! Integrators that are wrong on purpose must be called different, in every run.
//!
//! The scene has no factor that is 1, so that a forgotten one shows. The bandwidth is wide, because a wide one needs fewer paths;
//! `examples/calibration.rs` does the same at length and at the usual bandwidth.

use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use nephroid::entry::from_toml;
use nephroid::integrators::{Fault, Integrator, Settings, by_name};
use nephroid::judge::finding::State;
use nephroid::judge::hypotheses::{LEVEL, Levels};
use nephroid::regions::Regions;
use nephroid::verify::effort::Effort;
use nephroid::verify::expected::{Expected, Truths};
use nephroid::verify::gather::gather;
use nephroid::verify::replicates::{Canvas, Seeds, Shape};
use nephroid::verify::run::{Request, run};
use nephroid::verify::sizing::Demand;
use nephroid::verify::suite::{Coverage, Subject};
use nephroid::verify::verdicts::Outcome;
use nephroid_analytic::class::PathClass;

/// Angle [rad] and radius [m].
const BANDWIDTH: f64 = 0.6;
/// Half of the weakest gross fault here: the cosine twice, -10 % on direct light.
const MARGIN: f64 = 0.05;

const WALL: &str = r#"
name = "wall"
title = "A mirror on the floor, nothing equal to 1"
kind = "planar-mirror"

[light]
position = [0.25, 0.1, 1.9]
intensity = 3.7

[floor]
half_width = [2.0, 2.0]
albedo = 0.6

[mirror]
center = [0.0, 1.1, 0.7]
normal = [0.0, -1.0, 0.0]
edge = [1.0, 0.0, 0.0]
half_width = 0.8
half_height = 0.6
reflectance = 0.7

[camera]
position = [0.0, -2.6, 1.8]
look_at = [0.0, 0.6, 0.3]
field_of_view_degrees = 45.0
width = 32
height = 32
"#;

fn integrator(name: &str, fault: Option<Fault>) -> Box<dyn Integrator> {
    let settings = Settings {
        kernel: None,
        fault,
        ..Settings::default()
    };
    by_name(name, &settings).unwrap()
}

fn request(integrators: Vec<Box<dyn Integrator>>, seed: u64, margin: f64) -> Request {
    let entry = from_toml("wall.toml", WALL).unwrap();
    let argument = "wall.toml".to_owned();
    Request {
        scenes: vec![Subject { argument, entry }],
        integrators,
        left_out: Vec::new(),
        effort: Effort::Quick,
        coverage: Coverage::Everything,
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

fn verdicts(request: &Request, truths: &mut Truths) -> Outcome {
    run(request, truths, &|_, _, _, _| {}).unwrap()
}

/// One set of truths for all tests, which thus take turns.
fn truths() -> MutexGuard<'static, Truths> {
    static TRUTHS: LazyLock<Mutex<Truths>> =
        LazyLock::new(|| Mutex::new(Truths::for_margin(MARGIN)));
    TRUTHS.lock().unwrap_or_else(PoisonError::into_inner)
}

const ALL: [&str; 5] = ["pt", "pt-reg", "lt", "pm", "ppm"];

#[test]
fn without_a_fault_all_are_equivalent() {
    let integrators = ALL.map(|name| integrator(name, None)).into();
    let mut truths = truths();
    let outcome = verdicts(&request(integrators, 1, MARGIN), &mut truths);
    assert_eq!(outcome.exit_code(), 0, "{outcome:#?}");
    let equivalent = |s: State| {
        outcome
            .verdicts
            .iter()
            .filter(|v| v.finding.state == s)
            .count()
    };
    assert_eq!(equivalent(State::Equivalent), 3 + 5 + 3 + 5 + 5);
    assert_eq!(equivalent(State::NotSampled), 2 + 2);
}

#[test]
fn gross_faults_are_different_wherever_they_act() {
    let mut truths = truths();
    for (seed, fault) in (1..).zip([
        Fault::CosineTwice,
        Fault::IntensityForgotten,
        Fault::ReflectanceForgotten,
        Fault::RadiusForRadiusSquared,
    ]) {
        // `pm` shares its code with `ppm`.
        let names = ["pt", "pt-reg", "lt", "ppm"];
        let integrators = names.map(|name| integrator(name, Some(fault))).into();
        let outcome = verdicts(&request(integrators, seed, MARGIN), &mut truths);
        for v in &outcome.verdicts {
            let Ok(class) = v.class.parse::<PathClass>() else {
                continue;
            };
            let hit = match fault {
                Fault::ReflectanceForgotten => class != PathClass::LDE,
                Fault::RadiusForRadiusSquared => v.bandwidth.is_some(),
                _ => true,
            };
            let state = v.finding.state;
            if hit && state != State::NotSampled {
                let name = &v.integrator;
                assert_eq!(state, State::Different, "{fault:?} {name} {class}: {v:?}");
            }
        }
    }
}

/// One class of three integrators; all others are dropped by `examples/calibration.rs`.
#[test]
fn a_class_that_is_dropped_is_missing() {
    let mut truths = truths();
    for (name, class) in [
        ("pt", PathClass::LDE),
        ("lt", PathClass::LSDE),
        ("pt-reg", PathClass::LSDSE),
    ] {
        let integrators = vec![integrator(name, Some(Fault::ClassDropped(class)))];
        let outcome = verdicts(&request(integrators, 5, MARGIN), &mut truths);
        let class = class.to_string();
        let v = outcome.verdicts.iter().find(|v| v.class == class).unwrap();
        assert_eq!(v.finding.state, State::Different, "{name} {class}");
        assert!(v.finding.reason.starts_with("missing"), "{:?}", v.finding);
        assert_eq!(outcome.exit_code(), 1);
    }
}

/// At α = 0.5 the cone normalised by πα² instead of 2π(1 - cos α) is 2.07 % too dark. With a margin of 1.5 % the bias is
/// found with probability above 1 - 1e-6.
#[test]
fn the_kernel_of_the_tangent_plane_is_different_at_half_a_radian() {
    let entry = from_toml("wall.toml", WALL).unwrap();
    let alpha = 0.5;
    let means = nephroid::expectation::class_means(
        &entry,
        nephroid_analytic::bandwidth::Technique::Camera,
        nephroid_analytic::bandwidth::Kernel::Cone,
        &[alpha],
        2e-4,
    )
    .unwrap();
    let truth = means.iter().find(|(c, _)| *c == PathClass::LSDE).unwrap();
    let classes = entry.kind.classes();
    let expected: Vec<_> = classes
        .iter()
        .map(|&c| (c == PathClass::LSDE).then(|| Expected::of_first(truth.1.mean)))
        .collect();
    let demand = Demand {
        margin: 0.015,
        levels: Levels::shared(LEVEL, 1e-3, 20),
        most_paths: 1 << 32,
    };
    let shape = Shape {
        bandwidths: vec![alpha],
        paths_per_iteration: 1 << 18,
    };
    let canvas = Canvas {
        width: entry.camera.width,
        height: entry.camera.height,
        classes,
    };
    for (fault, state) in [
        (None, State::Equivalent),
        (
            Some(Fault::KernelNormalizedByPiAlphaSquared),
            State::Different,
        ),
    ] {
        let prepare = || integrator("pt-reg", fault).prepare(&entry);
        let seeds = Seeds::new(9, "wall", "pt-reg");
        let regions = Regions::image(canvas.width, canvas.height);
        let shape = shape.clone();
        let evidence = gather(prepare, canvas, &regions, shape, seeds, &expected, demand);
        let lsde = evidence.judged.iter().find(|j| j.truth.is_some()).unwrap();
        assert_eq!(lsde.finding.state, state, "{:?}", lsde.finding);
    }
}
