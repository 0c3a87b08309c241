//! The bug museum: what it says about itself, a sample of its kill matrix, what the diagnosis says about faults of which the
//! cause is known, and the rules of other renderers on images made by hand.
//!
//! The whole matrix is `nephroid faults`; its result is in docs/museum.md.

use std::collections::HashSet;
use std::sync::LazyLock;

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{
    Fault, Integrator, NAMES, Plan, Prepared, Schedule, Settings, all as integrators, by_name,
};
use nephroid::museum::baselines::{blender, mitsuba, pbrt};
use nephroid::museum::exhibits::scene;
use nephroid::museum::matrix::checks_of_suite;
use nephroid::museum::trial::{Hall, MOST_PATHS, Trial};
use nephroid::museum::{Check, Exhibit, Stand, all};
use nephroid::verify::effort::Effort;
use nephroid_analytic::scene::Entry;

#[test]
fn every_exhibit_has_a_source_a_description_and_a_place() {
    let mut ids = HashSet::new();
    let mut killable = 0;
    for e in all() {
        assert!(ids.insert(e.id), "{} is there twice", e.id);
        assert!(
            e.id.bytes().all(|b| b.is_ascii_lowercase() || b == b'-'),
            "{}",
            e.id
        );
        assert!(e.source.starts_with("https://"), "{}", e.id);
        assert!(
            e.description.ends_with('.') && e.description.len() > 20,
            "{}",
            e.id
        );
        assert!(!e.injection.is_empty(), "{}", e.id);
        assert!(!e.stands.is_empty(), "{} is nowhere", e.id);
        assert!(
            e.unkillable.is_none_or(|reason| reason.len() > 40),
            "{}",
            e.id
        );
        killable += usize::from(e.unkillable.is_none());
        for stand in e.stands {
            assert!(NAMES.contains(&stand.integrator), "{}", e.id);
            let entry = scene(stand.scene).unwrap();
            let integrator = by_name(stand.integrator, &Settings::default()).unwrap();
            assert!(integrator.supports(&entry).is_ok(), "{}", e.id);
            assert!(
                integrator
                    .plan(&entry)
                    .iter()
                    .any(|c| { c.treatment != nephroid::integrators::Treatment::NotSampled })
            );
        }
    }
    assert!(killable >= 45, "{killable}");
    let faults: HashSet<String> = all().map(|e| format!("{:?}", e.fault)).collect();
    assert_eq!(faults.len(), ids.len(), "a fault is shown twice");
}

fn film(entry: &Entry, prepared: &dyn Prepared, bandwidth: f64) -> Film {
    let camera = &entry.camera;
    let mut film = Film::new(camera.width, camera.height, entry.kind.classes());
    // More bits than a seed that is cut short keeps.
    let seed = 0x0123_4567_89ab_cdef;
    for iteration in 0..2 {
        prepared.iterate(seed, iteration, 30_000, bandwidth, &mut film);
    }
    film
}

/// A fault changes the films of its stands, except the one whose floor is not reached; the healthy method's do not change
/// when a method with a fault has been prepared beside it. (`integrators/bits.rs` pins the healthy bits.)
#[test]
fn a_fault_changes_films_and_health_does_not() {
    for e in all() {
        for stand in e.stands {
            let entry = scene(stand.scene).unwrap();
            let with = |fault: Option<Fault>| {
                let settings = Settings {
                    kernel: None,
                    fault,
                    ..Settings::default()
                };
                let integrator = by_name(stand.integrator, &settings).unwrap();
                film(&entry, integrator.prepare(&entry).as_ref(), stand.bandwidth)
            };
            let (sound, faulty) = (with(None), with(Some(e.fault)));
            // NaN differs from itself, which is as it should be.
            let reached = e.fault != Fault::TinyBandwidthFloor;
            assert_eq!(sound != faulty, reached, "{} on {}", e.id, stand.title());
            assert!(sound == with(None));
        }
    }
}

fn exhibit(id: &str) -> &'static Exhibit {
    all().find(|e| e.id == id).unwrap()
}

static CHECKS: LazyLock<u64> = LazyLock::new(|| checks_of_suite().unwrap());

/// A trial with the first stand of an exhibit.
fn trial(hall: &mut Hall, id: &str) -> Trial {
    let e = exhibit(id);
    let set_up = hall.set_up(&e.stands[0]).unwrap();
    hall.trial(&set_up, Some(e.fault), 3, MOST_PATHS, true)
        .unwrap()
}

/// The cheap ones of the matrix, one seed, and what they look like: a part of the sentence that names the planted cause.
#[test]
fn faults_are_noticed_and_named() {
    let mut hall = Hall::new(Effort::Standard, *CHECKS);
    for (id, named) in [
        ("intensity-forgotten", "1/I"),
        ("hemisphere-for-sphere", "= 2"),
        ("no-falloff", "(the distance to the light)^2"),
        (
            "inverse-distance",
            "proportional to the distance to the light",
        ),
        ("albedo-twice", "ρ"),
        ("bsdf-without-pi", "π"),
        ("pi-twice", "1/π"),
        ("cosine-twice", "a cosine applied twice"),
        ("cosine-forgotten", "a cosine forgotten"),
        ("direct-light-twice", "= 2"),
        ("image-flipped", "upside down"),
        ("splats-per-pixel-count", "number of paths"),
        ("splat-scale-on-camera-paths", "number of paths"),
        ("pixel-side-for-area", "the side of a pixel"),
        ("sensor-cosine", "proportional to the cosine at the sensor"),
        ("last-row-lost", "edge of the frame"),
        ("not-a-number", "without a result"),
        ("infinite", "division by zero"),
        ("seed-truncated", "seed"),
    ] {
        let trial = trial(&mut hall, id);
        assert!(trial.noticed, "{id}: {trial:?}");
        let text = trial.looks_like.unwrap_or_default();
        assert!(text.contains(named), "{id}: {text}");
    }
}

#[test]
fn without_a_fault_nothing_is_noticed() {
    let mut hall = Hall::new(Effort::Standard, *CHECKS);
    for (integrator, scene) in [("pt", "floor"), ("lt", "floor")] {
        for check in [Check::Verify, Check::Repeats] {
            let stand = Stand {
                integrator,
                scene,
                bandwidth: 0.2,
                check,
            };
            let set_up = hall.set_up(&stand).unwrap();
            let trial = hall.trial(&set_up, None, 3, 10_000_000, true).unwrap();
            assert!(!trial.noticed, "{trial:?}");
        }
    }
}

/// A method of a user's own, wrong by a factor 0.7 and by nothing that any of ours could have.
struct Darker(Box<dyn Integrator>);

impl Integrator for Darker {
    fn name(&self) -> &'static str {
        "darker"
    }

    fn title(&self) -> &'static str {
        "a wrong method of a user's own"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        self.0.plan(entry)
    }

    fn schedule(&self, bandwidth: f64) -> Schedule {
        self.0.schedule(bandwidth)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        Box::new(Darkened(self.0.prepare(entry)))
    }
}

struct Darkened(Box<dyn Prepared>);

impl Prepared for Darkened {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        let mut own = Film::new(film.width, film.height, film.classes);
        self.0.iterate(seed, iteration, paths, bandwidth, &mut own);
        own.layers.iter_mut().flatten().for_each(|v| *v *= 0.7);
        film.add(&own);
    }
}

/// `verify` diagnoses what is given to it through the trait: the floor's albedo is 0.7.
#[test]
fn a_users_own_method_is_diagnosed() {
    use nephroid::verify::expected::Truths;
    use nephroid::verify::run::{Request, run};
    use nephroid::verify::suite::{Coverage, Subject};
    let request = Request {
        scenes: vec![Subject {
            argument: "floor".to_owned(),
            entry: entry::load("floor").unwrap(),
        }],
        integrators: vec![Box::new(Darker(
            by_name("pt", &Settings::default()).unwrap(),
        ))],
        left_out: Vec::new(),
        effort: Effort::Quick,
        coverage: Coverage::Everything,
        margin: 0.02,
        level: 1e-6,
        checks: None,
        seed: 1,
        bandwidth: 0.2,
        most_paths: Effort::Quick.most_paths(),
        variations: false,
        kernel: None,
        mask: None,
    };
    let outcome = run(&request, &mut Truths::for_margin(0.02), &|_, _, _, _| {}).unwrap();
    let text = outcome.verdicts[0].looks_like.clone().unwrap_or_default();
    assert!(
        text.starts_with("looks like a constant factor 0.7") && text.contains("= ρ"),
        "{text}"
    );
    let shown = nephroid::report::text::outcome(&outcome);
    assert!(shown.contains(&text), "{shown}");
    let json = nephroid::report::json::outcome(&outcome);
    assert_eq!(json["verdicts"][0]["looks_like"], text);
}

#[test]
fn pbrts_rule_is_an_absolute_fortieth() {
    assert!(pbrt(1.0) && pbrt(1.0249) && pbrt(0.9751));
    assert!(!pbrt(1.0251) && !pbrt(0.9749) && !pbrt(f64::NAN));
}

/// 10000 pixels at variance 1 and 100 samples: a standard error of 0.1. The level is 1 - 0.99^(1/10000) = 1.005e-6,
/// thus z = 4.89.
#[test]
fn mitsubas_rule_tolerates_a_quarter_of_a_per_cent() {
    let n = 10_000;
    let reference = vec![1.0; n];
    let variance = vec![1.0; n];
    let with = |count: usize, off: f64| -> Vec<f64> {
        (0..n)
            .map(|i| if i < count { 1.0 + off } else { 1.0 })
            .collect()
    };
    let passes = |image: &[f64]| mitsuba(image, &reference, &variance, 100.0);
    assert!(passes(&with(n, 0.488)));
    assert!(!passes(&with(n, 0.490)));
    // Anything at all in 25 of 10000 pixels passes, NaN too; in 26 it does not.
    for off in [1e9, f64::NAN, f64::NEG_INFINITY] {
        assert!(passes(&with(25, off)));
        assert!(!passes(&with(26, off)));
    }
    // The floor of the variance: in the dark an error of 0.0048 passes.
    let black = vec![0.0; n];
    assert!(mitsuba(&vec![0.0048; n], &black, &black, 100.0));
    assert!(!mitsuba(&vec![0.0050; n], &black, &black, 100.0));
}

/// Grey of 18 % is 0.461 in the file; 4 steps of 1/255 are 0.0157, 5 are 0.0196. The slope there is 1.07 of the value per
/// unit, so that 7 % of light are 4 steps or less and 12 % are more.
#[test]
fn blenders_rule_tolerates_four_steps_and_a_per_cent_of_the_pixels() {
    let n = 1000;
    let reference = vec![2.5; n];
    let with = |count: usize, factor: f64| -> Vec<f64> {
        (0..n)
            .map(|i| 2.5 * if i < count { factor } else { 1.0 })
            .collect()
    };
    assert!(blender(&with(n, 1.07), &reference));
    assert!(blender(&with(n, 0.93), &reference));
    assert!(!blender(&with(n, 1.12), &reference));
    assert!(blender(&with(10, 0.0), &reference));
    assert!(!blender(&with(11, 0.0), &reference));
    assert!(blender(&with(10, f64::NAN), &reference));
}

/// All names of methods are tried by some exhibit, but that of the one that `verify` does not judge: its faults are for tests of its own.
#[test]
fn every_method_has_faults() {
    for integrator in integrators().iter().filter(|i| i.name() != "appm") {
        let tried = all()
            .flat_map(|e| e.stands)
            .any(|s| s.integrator == integrator.name());
        assert!(tried, "{}", integrator.name());
    }
}
