//! What the tests say about one check: a state, and the figures behind it.

use serde::Serialize;

use super::hypotheses::Levels;
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

/// What the tests say about one check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// The state.
    pub state: State,
    /// Where an established bias is, if not in the mean over the whole image.
    pub place: Option<String>,
    /// Relative difference of the mean from the truth, over the image; `None` where there is no sample or no truth.
    pub effect: Option<f64>,
    /// Confidence interval of the effect, at one minus the check's level of a false "different": without the truth's
    /// error bound it excludes 0 exactly if a bias of the image's mean is established at this look with the whole level.
    /// `None` if these replicates could not establish any.
    pub interval: Option<[f64; 2]>,
    /// p-value of "different", over all regions and looks.
    pub p_different: Option<f64>,
    /// p-value of "equivalent", over all looks.
    pub p_equivalent: Option<f64>,
    /// Whether a bias is established, however small.
    pub bias_established: bool,
    /// See [`super::power::Power::power`].
    pub power: Option<f64>,
    /// See [`super::power::Power::minimum_detectable_bias`].
    pub minimum_detectable_bias: Option<f64>,
    /// Parts of the image that were tested besides the whole.
    pub tiles: u32,
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
            place: None,
            effect: None,
            interval: None,
            p_different: None,
            p_equivalent: None,
            bias_established: false,
            power: None,
            minimum_detectable_bias: None,
            tiles: 0,
            replicates_needed: None,
            reason: reason.into(),
        }
    }

    /// Decides again at other levels, which [`super::family`] may have raised: only what was undecided changes.
    pub fn settle(&mut self, levels: Levels) {
        if self.state != State::Undecided {
            return;
        }
        let below = |p: Option<f64>, level: f64| p.is_some_and(|p| p <= level);
        self.bias_established |= below(self.p_different, levels.different);
        if below(self.p_equivalent, levels.equivalent) {
            self.state = State::Equivalent;
        } else if self.bias_established {
            self.state = State::Different;
        } else {
            return;
        }
        self.replicates_needed = None;
        self.reason =
            "decided by what other checks left of the suite's error probability".to_owned();
    }
}
