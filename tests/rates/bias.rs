//! Orders of biases, right and wrong.

use nephroid::integrators::{Fault, Integrator, Settings, by_name};
use nephroid::rates::bias::{self, Study};
use nephroid::rates::classes::Asked;
use nephroid::rates::outcome::State;
use nephroid_analytic::bandwidth::Technique;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind};

use super::{BANDWIDTHS, Change, Changed, LEVEL, integrator, mirror_wall};

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
        asked: Asked {
            entry,
            integrator,
            kernel: None,
            technique,
            class: Some(PathClass::LSDE),
            region: None,
            replicates: 32,
            seed: 11,
            level: LEVEL,
        },
        bandwidths: &BANDWIDTHS,
        paths: Some(paths),
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
        ..Settings::default()
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
    let paths = 4_000_000;
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
        ..Settings::default()
    };
    let dropped = by_name("pt-reg", &settings).unwrap();
    let study = bias_study(dropped.as_ref(), None, 4_000_000);
    assert_eq!(study.state, State::Different);
}
