//! Planning and running a final test, on estimators made of known distributions.

use nephroid::film::Film;
use nephroid::integrators::Prepared;
use nephroid::judge::finding::State;
use nephroid::judge::hypotheses::Levels;
use nephroid::regions::Regions;
use nephroid::stream::{philox, uniform};
use nephroid::verify::expected::Expected;
use nephroid::verify::gather::{Evidence, gather};
use nephroid::verify::replicates::{Canvas, Seeds, Shape};
use nephroid::verify::sizing::Demand;
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;

const CLASSES: &[PathClass] = &[PathClass::LDE, PathClass::LSDE];
const CANVAS: Canvas = Canvas {
    width: 4,
    height: 2,
    classes: CLASSES,
};
const FIRST: Shape = Shape {
    bandwidths: Vec::new(),
    paths_per_iteration: 4096,
};

/// Each path hits with a probability and then brings an exponential amount, so that the mean is `mean` and the variance of a
/// path `mean² (2/probability - 1)`.
#[derive(Clone, Copy)]
struct Spikes {
    mean: f64,
    probability: f64,
    /// Called with the film after an iteration, to spoil it.
    spoil: fn(u64, &mut Film),
}

impl Prepared for Spikes {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let pixels = film.pixels() as u64;
        for path in 0..paths {
            let key = [seed as u32, (seed >> 32) as u32];
            let [a, b, c, d] = philox([path as u32, 0, iteration, 0], key);
            if uniform(a, b) < self.probability {
                let amount = -libm::log(1.0 - uniform(c, d)) * self.mean / self.probability;
                film.layers[0][(path % pixels) as usize] += amount * pixels as f64;
                film.nonzero[0] += 1;
            }
        }
        (self.spoil)(seed, film);
    }
}

fn healthy(_: u64, _: &mut Film) {}

const TRUTH: [Option<Bounded>; 2] = [
    Some(Bounded {
        value: 1.0,
        error: 0.0,
    }),
    None,
];

fn run(spikes: Spikes, most_paths: u64, seed: u64) -> (Evidence, Demand) {
    run_at(0.05, spikes, most_paths, seed)
}

fn run_at(margin: f64, spikes: Spikes, most_paths: u64, seed: u64) -> (Evidence, Demand) {
    let demand = Demand {
        margin,
        levels: Levels::shared(1e-6, 1e-3, 10),
        most_paths,
    };
    let shape = Shape {
        bandwidths: vec![0.1],
        ..FIRST
    };
    let seeds = Seeds::new(seed, "spikes", "fake");
    let regions = Regions::image(CANVAS.width, CANVAS.height);
    let expected = TRUTH.map(|t| t.map(Expected::of_first));
    let prepare = || -> Box<dyn Prepared> { Box::new(spikes) };
    let evidence = gather(prepare, CANVAS, &regions, shape, seeds, &expected, demand);
    (evidence, demand)
}

const HONEST: Spikes = Spikes {
    mean: 1.0,
    probability: 0.2,
    spoil: healthy,
};
const PLENTY: u64 = 1 << 40;

/// The plan is made from an estimated variance, to which it adds 20 %: within 0.8 to 2 of what the true variance asks for.
#[test]
fn the_plan_has_the_size_that_theory_asks_for() {
    let noisy = Spikes {
        probability: 0.02,
        ..HONEST
    };
    for seed in 1..=5 {
        let (evidence, demand) = run(noisy, PLENTY, seed);
        assert_eq!(evidence.judged[0].finding.state, State::Equivalent);
        assert!(evidence.judged[0].finding.power.unwrap() > 0.9);
        let paths = evidence.size.shape.paths();
        let variance = 99.0 / paths as f64;
        let needed = nephroid::judge::power::replicates_needed(
            variance,
            TRUTH[0].unwrap(),
            demand.margin,
            // The planned look's half, and the image's half of it.
            Levels {
                different: 0.25 * demand.levels.different,
                equivalent: 0.5 * demand.levels.equivalent,
            },
        );
        let ratio = f64::from(evidence.size.replicates) / needed.unwrap() as f64;
        assert!((0.8..2.0).contains(&ratio), "{ratio}");
    }
}

/// A factor of two takes one look, the first: a quarter of what is planned.
#[test]
fn a_clear_case_ends_early() {
    let doubled = Spikes {
        mean: 2.0,
        ..HONEST
    };
    let (evidence, _) = run_at(0.01, doubled, PLENTY, 1);
    assert_eq!(evidence.judged[0].finding.state, State::Different);
    assert_eq!(evidence.looks, 1);
    assert!(
        evidence.replicates * 4 <= evidence.size.replicates,
        "{} of {}",
        evidence.replicates,
        evidence.size.replicates
    );
}

/// Light in the wrong place: an image of 64 by 64 whose two halves trade a tenth of their light. The mean over the image
/// is right, and the verdict names a tile.
#[test]
fn light_in_the_wrong_place_is_found_in_a_tile() {
    let spoil = |_: u64, film: &mut Film| {
        for row in film.layers[0].chunks_exact_mut(64) {
            for i in 0..32 {
                let moved = 0.1 * row[i];
                row[i] -= moved;
                row[i + 32] += moved;
            }
        }
    };
    let canvas = Canvas {
        width: 64,
        height: 64,
        classes: CLASSES,
    };
    let demand = Demand {
        margin: 0.05,
        levels: Levels::shared(1e-6, 1e-3, 10),
        most_paths: PLENTY,
    };
    let regions = Regions::quadtree(64, 64);
    let one = TRUTH[0].unwrap();
    let expected = [
        Some(Expected::new(one, vec![one; regions.areas().len() - 1])),
        None,
    ];
    let shape = Shape {
        bandwidths: vec![0.1],
        paths_per_iteration: 1 << 15,
    };
    for (spoil, state) in [
        (healthy as fn(u64, &mut Film), State::Equivalent),
        (spoil, State::Different),
    ] {
        let spikes = Spikes {
            probability: 0.5,
            spoil,
            ..HONEST
        };
        let seeds = Seeds::new(1, "tiles", "fake");
        let prepare = || -> Box<dyn Prepared> { Box::new(spikes) };
        let evidence = gather(
            prepare,
            canvas,
            &regions,
            shape.clone(),
            seeds,
            &expected,
            demand,
        );
        let f = &evidence.judged[0].finding;
        assert_eq!(f.state, state, "{f:?}");
        assert_eq!(f.tiles, 20);
        assert_eq!(f.place.is_some(), state == State::Different, "{f:?}");
        assert!(f.effect.unwrap().abs() < 0.03);
    }
}

#[test]
fn replicates_grow_until_rare_contributions_are_many() {
    let rare = Spikes {
        probability: 1e-3,
        ..HONEST
    };
    let (evidence, _) = run(rare, PLENTY, 1);
    assert_eq!(
        evidence.judged[0].finding.state,
        State::Equivalent,
        "{:?}",
        evidence.judged[0].finding
    );
    assert!(evidence.fewest_contributions >= 200);
}

#[test]
fn a_bias_of_the_margin_is_different_on_both_sides() {
    for mean in [0.95, 1.05] {
        for seed in 1..=5 {
            let (evidence, _) = run(Spikes { mean, ..HONEST }, PLENTY, seed);
            assert_eq!(evidence.judged[0].finding.state, State::Different);
        }
    }
}

#[test]
fn too_few_paths_are_undecided_and_say_how_many_would_do() {
    let noisy = Spikes {
        probability: 0.08,
        ..HONEST
    };
    let (evidence, demand) = run(noisy, 32 * 4096, 1);
    let f = &evidence.judged[0].finding;
    assert_eq!(f.state, State::Undecided);
    let more = f.replicates_needed.unwrap() * evidence.size.shape.paths();
    assert!(more > demand.most_paths);
    let (evidence, _) = run(noisy, more, 1);
    assert_eq!(evidence.judged[0].finding.state, State::Equivalent);
}

#[test]
fn one_pixel_that_is_not_a_number_fails_the_run() {
    let spoil = |seed: u64, film: &mut Film| {
        if seed % 16 == 3 {
            film.layers[0][6] = f64::NAN;
        }
    };
    let (evidence, _) = run(Spikes { spoil, ..HONEST }, PLENTY, 1);
    let f = &evidence.judged[0].finding;
    assert_eq!(f.state, State::Different);
    assert!(f.reason.contains("column 2, row 1"), "{}", f.reason);
}

#[test]
fn the_same_film_every_time_is_no_evidence() {
    let spoil = |_: u64, film: &mut Film| film.layers[0].fill(film.paths as f64);
    let (evidence, _) = run(Spikes { spoil, ..HONEST }, PLENTY, 1);
    let f = &evidence.judged[0].finding;
    assert_eq!(f.state, State::Undecided);
    assert!(f.reason.contains("do not vary"), "{}", f.reason);
}

#[test]
fn energy_in_a_class_that_was_declared_impossible_is_different() {
    let (evidence, _) = run(HONEST, PLENTY, 1);
    assert_eq!(evidence.judged[1].finding.state, State::NotSampled);
    let spoil = |_: u64, film: &mut Film| film.nonzero[1] += 1;
    let (evidence, _) = run(Spikes { spoil, ..HONEST }, PLENTY, 1);
    assert_eq!(evidence.judged[1].finding.state, State::Different);
}

/// Nothing in 2·10⁷ paths, pilots not counted.
#[test]
fn a_claimed_class_that_never_comes_is_missing() {
    let dead = Spikes {
        probability: 0.0,
        ..HONEST
    };
    let (evidence, _) = run(dead, PLENTY, 1);
    assert_eq!(evidence.judged[0].finding.state, State::Different);
    assert!(evidence.judged[0].finding.reason.starts_with("missing"));
    let paths = evidence.size.shape.paths() * u64::from(evidence.replicates);
    assert!(paths >= 20_000_000, "{paths}");
}
