//! The judge is judged: on data whose distribution is known, and on integrators that are wrong on purpose.
//!
//! Each statistical test states the probability of a false alarm, which is at most 1e-6, and what it would catch.

use crate::synthetic::{Random, normal_sample, of_values, sample, spiky_sample};
use nephroid::exit;
use nephroid::judge::evidence::{FEWEST_REPLICATES, Invalid, Sample};
use nephroid::judge::finding::{State, exit_code};
use nephroid::judge::hypotheses::{Levels, difference_p, equivalence_p};
use nephroid::judge::power::replicates_needed;
use nephroid::judge::spending::looks;
use nephroid::judge::verdict::{Case, Spent, decide, decide_at};
use nephroid_analytic::camera::Bounded;

const ONE: Bounded = Bounded {
    value: 1.0,
    error: 0.0,
};

/// Kolmogorov and Smirnov's distance from uniform, times √n; above 2.7 with probability 2 exp(-2 · 2.7²) < 1e-6.
fn distance_from_uniform(mut p: Vec<f64>) -> f64 {
    p.sort_by(f64::total_cmp);
    let n = p.len() as f64;
    let off = p
        .iter()
        .enumerate()
        .map(|(i, p)| (p - i as f64 / n).max((i + 1) as f64 / n - p));
    off.fold(0.0, f64::max) * n.sqrt()
}

/// Would catch a variance wrong by 5 %, a one-sided p-value, or the wrong number of degrees of freedom.
#[test]
fn p_values_of_right_normal_replicates_are_uniform() {
    let mut random = Random::new(11);
    for replicates in [32, 100] {
        let p: Vec<_> = (0..10_000)
            .map(|_| difference_p(&normal_sample(&mut random, replicates, 1.0, 0.1), ONE))
            .collect();
        assert!(distance_from_uniform(p) < 2.7);
    }
}

/// Replicates of 200 to 300 contributions, each exponentially distributed, the fewest and the spikiest that are accepted.
#[test]
fn p_values_of_right_spiky_replicates_are_uniform() {
    let mut random = Random::new(12);
    let p: Vec<_> = (0..4_000)
        .map(|_| difference_p(&spiky_sample(&mut random, 40), ONE))
        .collect();
    assert!(distance_from_uniform(p) < 2.7);
}

/// At level 1e-3, 30000 suites of one check each: 30 false alarms expected; 64 or more with probability 1e-7 (Poisson). Would
/// catch a tail too heavy by a factor of 2.1.
#[test]
fn false_alarms_are_as_rare_as_stated() {
    for spiky in [false, true] {
        let mut random = Random::new(13);
        let runs = if spiky { 6_000 } else { 30_000 };
        let biased = (0..runs).filter(|_| {
            let s = if spiky {
                spiky_sample(&mut random, 32)
            } else {
                normal_sample(&mut random, 32, 1.0, 0.1)
            };
            // A truth that is off by its whole bound is still inside it.
            let truth = Bounded {
                value: 1.0 + 0.003,
                error: 0.003,
            };
            difference_p(&s, truth) <= 1e-3
        });
        let limit = if spiky { 24 } else { 64 };
        let count = biased.count();
        assert!(count < limit, "{count} of {runs}");
    }
}

/// Judged at every look of a growing sample, with its share of the level: a false alarm at any look is still as rare as the level
/// says. At most 100 of 2000 runs at level 0.05 (170 with probability below 1e-9); that some looks are wasted for a union bound
/// leaves more than 20.
#[test]
fn looking_often_does_not_raise_false_alarms() {
    let mut random = Random::new(18);
    let schedule = looks(128, 512);
    let levels = Levels {
        different: 0.05,
        equivalent: 1e-9,
    };
    let wrong = (0..2_000)
        .filter(|_| {
            let values: Vec<f64> = (0..512).map(|_| 1.0 + 0.1 * random.normal()).collect();
            let mut spent = Spent::default();
            schedule.iter().any(|look| {
                let case = Case {
                    sample: of_values(&values[..look.replicates as usize]),
                    truth: ONE,
                    weight: 1.0,
                    most: 512,
                    fewest: FEWEST_REPLICATES,
                    dependence: None,
                    too_bright: None,
                    parts: Vec::new(),
                };
                decide_at(&case, 0.001, levels, look.share, &mut spent).bias_established
            })
        })
        .count();
    assert!((20..170).contains(&wrong), "{wrong}");
}

/// A bias of exactly the margin is called equivalent with probability at most the level, and not far below it where the other side
/// of the margin is out of sight: at most 200 of 20000 expected, above 290 with probability below 1e-9; what is allowed for
/// skewness leaves more than 40.
#[test]
fn a_bias_of_the_margin_passes_as_often_as_stated() {
    let (margin, level) = (0.02, 0.01);
    for mean in [1.0 - margin, 1.0 + margin] {
        let mut random = Random::new(14);
        let passed = (0..20_000)
            .filter(|_| {
                let s = normal_sample(&mut random, 64, mean, 0.02);
                equivalence_p(&s, ONE, margin) <= level
            })
            .count();
        assert!((40..290).contains(&passed), "{passed}");
    }
}

/// The truth's error bound is taken at its worst: a mean at the margin from the far end of the interval does not pass more
/// often than from the truth itself.
#[test]
fn the_bound_of_the_truth_counts_against_equivalence() {
    let truth = Bounded {
        value: 1.0,
        error: 0.004,
    };
    let mut random = Random::new(15);
    let passed = (0..20_000)
        .filter(|_| {
            // If the truth is 0.996, this mean is biased by the whole margin.
            let s = normal_sample(&mut random, 64, 0.996 * 1.02, 0.02);
            equivalence_p(&s, truth, 0.02) <= 0.01
        })
        .count();
    assert!(passed < 290, "{passed}");
}

/// Sample sizes are planned for power 0.9 of "different" at the margin and of "equivalent" at no bias. Below 0.86 in 2000 runs
/// with probability under 1e-6.
#[test]
fn planned_sample_sizes_have_the_power_they_were_planned_for() {
    let levels = Levels::shared(1e-6, 1e-3, 33);
    for spread in [0.02, 0.1] {
        let margin = 0.02;
        let n = replicates_needed(spread * spread, ONE, margin, levels).unwrap() as usize;
        let mut random = Random::new(16);
        let mut count = |mean: f64, state: State| {
            let is = |_: &usize| {
                let s = normal_sample(&mut random, n, mean, spread);
                decide(&s, ONE, margin, levels).state == state
            };
            (0..2_000).filter(is).count()
        };
        assert!(count(1.0, State::Equivalent) > 1_720);
        assert!(count(1.0 + margin, State::Different) > 1_720);
        assert!(count(1.0 - margin, State::Different) > 1_720);
    }
}

/// A bias of the minimum detectable size is found with power 0.9: outside 0.86 to 0.94 of 2000 runs with probability under 1e-6.
#[test]
fn the_minimum_detectable_bias_is_detected_nine_times_of_ten() {
    let levels = Levels {
        different: 1e-7,
        equivalent: 1e-5,
    };
    let mut random = Random::new(17);
    for replicates in [256, 400, 1000] {
        let f = decide(&sample(1.0, 0.05, replicates), ONE, 0.02, levels);
        let bias = f.minimum_detectable_bias.unwrap();
        let found = |_: &usize| {
            let s = normal_sample(&mut random, replicates, 1.0 + bias, 0.05);
            difference_p(&s, ONE) <= levels.different
        };
        let count = (0..2_000).filter(found).count();
        assert!((1_720..1_880).contains(&count), "{replicates}: {count}");
    }
}

#[test]
fn an_established_bias_inside_the_margin_is_equivalent_and_said() {
    let levels = Levels::shared(1e-6, 1e-3, 1);
    let small = decide(&sample(1.005, 0.001, 100), ONE, 0.02, levels);
    assert_eq!(
        (small.state, small.bias_established),
        (State::Equivalent, true)
    );
    assert!(small.reason.contains("bias"));
    let [low, high] = small.interval.unwrap();
    assert!(low > 0.0 && high < 0.02);
    // The same bias with a margin that it fills.
    let margin = decide(&sample(1.005, 0.001, 100), ONE, 0.005, levels);
    assert_eq!(margin.state, State::Different);
}

#[test]
fn what_is_not_decided_says_how_much_would_decide() {
    let levels = Levels::shared(1e-6, 1e-3, 1);
    let f = decide(&sample(1.0, 0.3, 40), ONE, 0.02, levels);
    assert_eq!(f.state, State::Undecided);
    let more = f.replicates_needed.unwrap();
    let f = decide(&sample(1.0, 0.3, more as usize), ONE, 0.02, levels);
    assert_eq!((f.state, f.replicates_needed), (State::Equivalent, None));
    // No number of paths helps against a truth that is not known.
    let vague = Bounded {
        value: 1.0,
        error: 0.02,
    };
    let f = decide(&sample(1.0, 0.001, 100), vague, 0.02, levels);
    assert_eq!((f.state, f.replicates_needed), (State::Undecided, None));
}

#[test]
fn no_variance_too_few_replicates_or_contributions_are_no_evidence() {
    let levels = Levels::shared(1e-6, 1e-3, 1);
    let good = sample(1.0, 0.001, 100);
    assert_eq!(decide(&good, ONE, 0.02, levels).state, State::Equivalent);
    for bad in [
        Sample {
            variance: 0.0,
            ..good
        },
        Sample {
            variance: 0.0,
            mean: 2.0,
            ..good
        },
        Sample {
            replicates: 31,
            ..good
        },
        Sample {
            fewest_contributions: 199,
            ..good
        },
    ] {
        let f = decide(&bad, ONE, 0.02, levels);
        assert_eq!(f.state, State::Undecided, "{bad:?}");
        assert!(!f.reason.is_empty());
    }
}

#[test]
fn what_cannot_be_fails_and_is_located() {
    let levels = Levels::shared(1e-6, 1e-3, 1);
    let invalid = Invalid {
        not_finite: 3,
        negative: 1,
        first: Some((12, 40)),
    };
    let bad = Sample {
        invalid,
        invalid_replicate: 5,
        ..sample(1.0, 0.001, 100)
    };
    let f = decide(&bad, ONE, 0.02, levels);
    assert_eq!(f.state, State::Different);
    for part in [
        "3 pixels",
        "1 are negative",
        "replicate 5",
        "column 12",
        "row 40",
    ] {
        assert!(f.reason.contains(part), "{}", f.reason);
    }
}

#[test]
fn a_claimed_class_without_energy_is_missing() {
    let levels = Levels::shared(1e-6, 1e-3, 1);
    let empty = Sample {
        contributions: 0,
        fewest_contributions: 0,
        ..sample(0.0, 0.0, 32)
    };
    let f = decide(&empty, ONE, 0.02, levels);
    assert_eq!((f.state, f.effect), (State::Different, Some(-1.0)));
    // Nothing where nothing should be is no evidence of anything.
    let f = decide(&empty, Bounded::default(), 0.02, levels);
    assert_eq!(f.state, State::NotComparable);
    // Light where none should be.
    let f = decide(&sample(1.0, 0.01, 100), Bounded::default(), 0.02, levels);
    assert_eq!(f.state, State::Different);
}

#[test]
fn exit_codes_of_mixed_results() {
    use State::{Different, Equivalent, NotComparable, NotSampled, Undecided, Unreadable};
    for (states, code) in [
        (vec![], exit::NOTHING_RAN),
        (vec![NotSampled, NotComparable], exit::NOTHING_RAN),
        (vec![NotSampled, Equivalent], exit::PASS),
        (vec![Equivalent, Undecided], exit::UNDECIDED),
        (vec![Undecided, Different, Equivalent], exit::DIFFERENT),
        (vec![Different, Unreadable], exit::BAD_INPUT),
    ] {
        assert_eq!(exit_code(states.clone()), code, "{states:?}");
    }
}
