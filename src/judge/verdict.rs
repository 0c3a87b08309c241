//! The rules that turn a sample and a truth into a verdict.
//!
//! In this order: what cannot be (not a number, infinite, negative) is different; a class that is claimed and has no energy in
//! any replicate is missing, thus different; a sample that does not meet the conditions of the tests is undecided; then
//! the two tests. If both a bias and equivalence are established, the verdict is equivalent and the bias is printed.

use nephroid_analytic::camera::Bounded;
use serde::Serialize;

use super::distributions::student_quantile;
use super::evidence::{FEWEST_CONTRIBUTIONS, FEWEST_REPLICATES, Sample};
use super::hypotheses::{Levels, difference_p, equivalence_p};
use super::power::{self, Power};
use crate::exit;

/// What a check says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// The bias, if any, is within the margin.
    Equivalent,
    /// A bias is established, and equivalence is not.
    Different,
    /// Neither is established.
    Undecided,
    /// The method declares that it cannot build paths of this class.
    NotSampled,
    /// There is nothing to compare with.
    NotComparable,
    /// The input cannot be read.
    Unreadable,
}

impl State {
    /// The word, as in JSON.
    pub const fn word(self) -> &'static str {
        match self {
            State::Equivalent => "equivalent",
            State::Different => "different",
            State::Undecided => "undecided",
            State::NotSampled => "not_sampled",
            State::NotComparable => "not_comparable",
            State::Unreadable => "unreadable",
        }
    }

    /// What the verdict does to the exit code; `None` where it does not count.
    pub const fn exit_code(self) -> Option<u8> {
        match self {
            State::Equivalent => Some(exit::PASS),
            State::Different => Some(exit::DIFFERENT),
            State::Undecided => Some(exit::UNDECIDED),
            State::Unreadable => Some(exit::BAD_INPUT),
            State::NotSampled | State::NotComparable => None,
        }
    }
}

/// The exit code of many verdicts: "nothing ran" if none of them counts.
pub fn exit_code(states: impl IntoIterator<Item = State>) -> u8 {
    states
        .into_iter()
        .filter_map(State::exit_code)
        .reduce(exit::combine)
        .unwrap_or(exit::NOTHING_RAN)
}

/// What the tests say about one region.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The state.
    pub state: State,
    /// Relative difference of the mean from the truth; `None` where there is no sample or no truth.
    pub effect: Option<f64>,
    /// Confidence interval of the effect, at one minus the check's level of a false "different": without the truth's
    /// error bound it excludes 0 exactly if a bias is established.
    pub interval: Option<[f64; 2]>,
    /// p-value of "different".
    pub p_different: Option<f64>,
    /// p-value of "equivalent".
    pub p_equivalent: Option<f64>,
    /// Whether a bias is established, however small.
    pub bias_established: bool,
    /// See [`Power::power`].
    pub power: Option<f64>,
    /// See [`Power::minimum_detectable_bias`].
    pub minimum_detectable_bias: Option<f64>,
    /// Replicates that would decide, where these did not and more would.
    pub replicates_needed: Option<u64>,
    /// One sentence for a person; empty where the figures say it all.
    pub reason: String,
}

impl Finding {
    /// A finding without figures.
    pub fn bare(state: State, reason: impl Into<String>) -> Self {
        Finding {
            state,
            effect: None,
            interval: None,
            p_different: None,
            p_equivalent: None,
            bias_established: false,
            power: None,
            minimum_detectable_bias: None,
            replicates_needed: None,
            reason: reason.into(),
        }
    }
}

/// Decides about one region: `margin` is relative to the truth.
pub fn decide(sample: &Sample, truth: Bounded, margin: f64, levels: Levels) -> Finding {
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
    if let Some(reason) = unmet_condition(sample) {
        let mut finding = Finding::bare(State::Undecided, reason);
        finding.replicates_needed =
            power::replicates_needed(sample.variance, truth, margin, levels)
                .filter(|&n| n > sample.replicates as u64);
        return finding;
    }
    let p_different = difference_p(sample, truth);
    if !carries_light {
        return light_where_none_is(p_different, levels);
    }
    let p_equivalent = equivalence_p(sample, truth, margin);
    let Power {
        power,
        minimum_detectable_bias,
    } = power::of_sample(sample, truth, margin, levels);
    let effect = (sample.mean - truth.value) / truth.value;
    let half = student_quantile(0.5 * levels.different, sample.dof()) * sample.standard_error()
        / truth.value;
    let bias_established = p_different <= levels.different;
    let state = match (p_equivalent <= levels.equivalent, bias_established) {
        (true, _) => State::Equivalent,
        (false, true) => State::Different,
        (false, false) => State::Undecided,
    };
    let needed = match state {
        State::Undecided => power::replicates_needed(sample.variance, truth, margin, levels),
        _ => None,
    };
    let reason = match state {
        State::Equivalent if bias_established => {
            "a bias inside the margin is established".to_owned()
        }
        State::Undecided if needed.is_none() => {
            "the truth is not known well enough for this margin".to_owned()
        }
        State::Undecided => {
            "neither a bias nor its absence is established with these replicates".to_owned()
        }
        _ => String::new(),
    };
    Finding {
        state,
        effect: Some(effect),
        interval: Some([effect - half, effect + half]),
        p_different: Some(p_different),
        p_equivalent: Some(p_equivalent),
        bias_established,
        power: Some(power),
        minimum_detectable_bias: Some(minimum_detectable_bias),
        // With an effect near the margin's edge the plan for no bias is not enough: at least twice as many.
        replicates_needed: needed.map(|n| n.max(2 * sample.replicates as u64)),
        reason,
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
fn unmet_condition(sample: &Sample) -> Option<String> {
    if sample.replicates < FEWEST_REPLICATES {
        return Some(format!(
            "{} replicates, {FEWEST_REPLICATES} are needed",
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
