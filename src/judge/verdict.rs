//! The rules that turn samples and truths into a verdict.
//!
//! In this order: what cannot be (not a number, infinite, negative) is different; a class that is claimed and has no energy in
//! any replicate is missing, thus different; a sample that does not meet the conditions of the tests is undecided, unless
//! it is too bright by a test that has none ([`super::betting`]); then the two tests. Equivalence is a statement about
//! the mean over the image. A bias is looked for in the image and in each of its tiles, each with its weight of the
//! check's error probability: min p/weight is the check's p-value, by the union bound. If both a bias and equivalence are established
//! where the bias is, the verdict is equivalent and the bias is printed.

use nephroid_analytic::camera::Bounded;

use super::evidence::{FEWEST_CONTRIBUTIONS, FEWEST_REPLICATES, Sample};
use super::finding::{Finding, State};
use super::hypotheses::{Levels, difference_p, equivalence_p};
use super::power::{self, Power};

/// A part of the image beside the whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub place: String,
    /// Its weight of the check's error probability.
    pub weight: f64,
    /// What was measured there.
    pub sample: Sample,
    /// What the mean should be there.
    pub truth: Bounded,
    /// What it is the mean of.
    pub measure: Measure,
}

/// What is measured in a part of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Measure {
    /// Radiance.
    #[default]
    Radiance,
    /// By how many columns to the right, or rows down, the image has moved.
    Pixels,
}

/// All that is known about a check at a look.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The whole image.
    pub sample: Sample,
    /// What its mean should be.
    pub truth: Bounded,
    /// The image's weight of the check's error probability.
    pub weight: f64,
    /// Replicates that there may be in the end: the power is that of going on so far.
    pub most: u64,
    /// Replicates below which nothing is tested.
    pub fewest: usize,
    /// p-value of "replicates are independent", and its weight.
    pub dependence: Option<(f64, f64)>,
    /// p-value of "not too bright" at any time, and its weight.
    pub too_bright: Option<(f64, f64)>,
    /// The parts.
    pub parts: Vec<Part>,
}

/// p-values of a check over the looks so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Spent {
    /// Of "different".
    pub different: f64,
    /// Where it was found; `None` for the whole image.
    pub place: Option<String>,
    /// Of "equivalent".
    pub equivalent: f64,
}

impl Default for Spent {
    fn default() -> Self {
        Spent {
            different: 1.0,
            place: None,
            equivalent: 1.0,
        }
    }
}

/// The place of a bias that is none: replicates that depend on each other.
pub const SEEDS: &str = "seeds";

/// Decides about the whole image alone, at a single look: `margin` is relative to the truth.
pub fn decide(sample: &Sample, truth: Bounded, margin: f64, levels: Levels) -> Finding {
    let case = Case {
        sample: *sample,
        truth,
        weight: 1.0,
        most: sample.replicates as u64,
        fewest: FEWEST_REPLICATES,
        dependence: None,
        too_bright: None,
        parts: Vec::new(),
    };
    decide_at(&case, margin, levels, 1.0, &mut Spent::default())
}

/// Decides at a look that may spend `share` of the error probabilities. What it spends is added to `spent`.
pub fn decide_at(
    case: &Case,
    margin: f64,
    levels: Levels,
    share: f64,
    spent: &mut Spent,
) -> Finding {
    let Case { sample, truth, .. } = case;
    let (sample, truth) = (sample, *truth);
    if sample.invalid.pixels() > 0 {
        return impossible(sample);
    }
    let carries_light = truth.value > truth.error;
    if sample.contributions == 0 {
        return if carries_light {
            missing(sample)
        } else {
            Finding::bare(
                State::NotComparable,
                "this image shows no light of this class",
            )
        };
    }
    // The betting test is valid at every look at once: it has its weight, and no share.
    if let Some((p, weight)) = case.too_bright {
        spend(spent, p / weight, None);
    }
    let unmet = unmet_condition(sample, case.fewest);
    if let (Some(reason), false) = (&unmet, spent.different <= levels.different) {
        let mut finding = Finding::bare(State::Undecided, reason);
        finding.replicates_needed =
            power::replicates_needed(sample.variance, truth, margin, levels)
                .filter(|&n| n > sample.replicates as u64);
        return finding;
    }
    let equivalent = |sample: &Sample, truth: Bounded| {
        let has_meaning =
            unmet_condition(sample, case.fewest).is_none() && truth.value > truth.error;
        if has_meaning {
            equivalence_p(sample, truth, margin) / share
        } else {
            1.0
        }
    };
    if unmet.is_none() {
        let p = difference_p(sample, truth) / (case.weight * share);
        spend(spent, p, None);
        if let Some((p, weight)) = case.dependence {
            spend(spent, p / (weight * share), Some(SEEDS));
        }
        spent.equivalent = spent.equivalent.min(equivalent(sample, truth));
    }
    let tested = || {
        case.parts
            .iter()
            .filter(|p| unmet_condition(&p.sample, case.fewest).is_none())
    };
    for part in tested() {
        let p = difference_p(&part.sample, part.truth) / (part.weight * share);
        // A bias that is shown to be inside the margin there is no difference.
        if p < spent.different && equivalent(&part.sample, part.truth) > levels.equivalent {
            spend(spent, p, Some(&part.place));
        }
    }
    if !carries_light {
        return light_where_none_is(spent.different, levels);
    }
    let bias_established = spent.different <= levels.different;
    let is_equivalent = spent.equivalent <= levels.equivalent;
    let elsewhere = bias_established && spent.place.is_some();
    let state = match (is_equivalent && !elsewhere, bias_established) {
        (true, _) => State::Equivalent,
        (false, true) => State::Different,
        (false, false) => State::Undecided,
    };
    let finding = figures(case, margin, levels, share, state);
    let place = spent.place.clone().filter(|_| bias_established);
    let reason = match (&place, state) {
        (Some(place), State::Different) if place == SEEDS => {
            "replicates depend on their predecessors: their seeds do not make them independent"
                .to_owned()
        }
        (Some(place), State::Different) => {
            let part = case.parts.iter().find(|p| p.place == *place);
            part.map_or_else(String::new, about_part)
        }
        (None, State::Different) if unmet.is_some() => {
            "too bright, whatever the distribution of the replicates".to_owned()
        }
        (_, State::Equivalent) if bias_established => {
            "a bias inside the margin is established".to_owned()
        }
        _ => finding.reason.clone(),
    };
    Finding {
        place,
        reason,
        p_different: Some(spent.different.min(1.0)),
        p_equivalent: Some(spent.equivalent.min(1.0)),
        bias_established,
        tiles: tested().count() as u32,
        ..finding
    }
}

/// What is wrong in a part.
fn about_part(part: &Part) -> String {
    let Part {
        sample,
        truth,
        place,
        measure,
        ..
    } = part;
    if *measure == Measure::Pixels {
        return format!("{place} by {:+.2} pixels", sample.mean);
    }
    if truth.value > truth.error {
        let effect = 100.0 * (sample.mean - truth.value) / truth.value;
        format!("in {place}: {effect:+.2} %")
    } else {
        format!("in {place}: light where the truth has none")
    }
}

fn spend(spent: &mut Spent, p: f64, place: Option<&str>) {
    if p < spent.different {
        (spent.different, spent.place) = (p, place.map(str::to_owned));
    }
}

/// What is told about a decision on the image's mean: `different` and `equivalent` levels are those left for it at this
/// look.
fn figures(case: &Case, margin: f64, levels: Levels, share: f64, state: State) -> Finding {
    let (sample, truth) = (&case.sample, case.truth);
    let here = Levels {
        different: levels.different * case.weight * share,
        equivalent: levels.equivalent * share,
    };
    let Power {
        minimum_detectable_bias,
        ..
    } = power::of_sample(sample, truth, margin, here);
    let in_the_end = Sample {
        replicates: sample.replicates.max(case.most as usize),
        ..*sample
    };
    let Power { power, .. } = power::of_sample(&in_the_end, truth, margin, here);
    let effect = (sample.mean - truth.value) / truth.value;
    let half = |above: bool| {
        let critical = sample.tail(above).critical(0.5 * levels.different);
        critical * sample.standard_error() / truth.value
    };
    let interval = [effect - half(true), effect + half(false)];
    let needed = match state {
        State::Undecided => power::replicates_needed(sample.variance, truth, margin, here),
        _ => None,
    };
    let reason = match state {
        State::Undecided if needed.is_none() => {
            "the truth is not known well enough for this margin".to_owned()
        }
        State::Undecided => {
            "neither a bias nor its absence is established with these replicates".to_owned()
        }
        _ => String::new(),
    };
    Finding {
        effect: Some(effect),
        interval: Some(interval).filter(|i| i.iter().all(|v| v.is_finite())),
        power: Some(power),
        minimum_detectable_bias: Some(minimum_detectable_bias).filter(|b| b.is_finite()),
        // With an effect near the margin's edge the plan for no bias is not enough: at least twice as many.
        replicates_needed: needed.map(|n| n.max(2 * sample.replicates as u64)),
        ..Finding::bare(state, reason)
    }
}

fn impossible(sample: &Sample) -> Finding {
    let i = sample.invalid;
    let (column, row) = i.first.unwrap_or_default();
    Finding::bare(
        State::Different,
        format!(
            "{} pixels are not a number or infinite, {} are negative: the first in replicate {}, column {column}, row {row}",
            i.not_finite, i.negative, sample.invalid_replicate
        ),
    )
}

fn missing(sample: &Sample) -> Finding {
    Finding {
        effect: Some(-1.0),
        bias_established: true,
        ..Finding::bare(
            State::Different,
            format!(
                "missing: claimed, but without energy in any of {} replicates",
                sample.replicates
            ),
        )
    }
}

fn light_where_none_is(p_different: f64, levels: Levels) -> Finding {
    let different = p_different <= levels.different;
    let mut finding = if different {
        Finding::bare(
            State::Different,
            "contributions where the truth has no light",
        )
    } else {
        Finding::bare(
            State::NotComparable,
            "the truth is zero within its error bound",
        )
    };
    finding.p_different = Some(p_different);
    finding.bias_established = different;
    finding
}

/// The conditions under which means of replicates are taken to be normal. No variance at all is never evidence.
fn unmet_condition(sample: &Sample, fewest: usize) -> Option<String> {
    if sample.replicates < fewest {
        return Some(format!(
            "{} replicates, {fewest} are needed",
            sample.replicates
        ));
    }
    if sample.fewest_contributions < FEWEST_CONTRIBUTIONS {
        return Some(format!(
            "a replicate has {} contributions, {FEWEST_CONTRIBUTIONS} are needed",
            sample.fewest_contributions
        ));
    }
    if !(sample.variance > 0.0) {
        return Some("the replicates do not vary at all: no evidence".to_owned());
    }
    None
}
