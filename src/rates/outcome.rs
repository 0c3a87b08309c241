//! What a study of rates ends in.

use core::fmt;

use crate::exit;

/// Whether a measured rate agrees with the predicted one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing is rejected, and the intervals are as narrow as asked.
    Consistent,
    /// A deviation from the prediction is established.
    Different,
    /// Nothing is rejected, but an interval is too wide.
    Undecided,
}

impl State {
    /// The word in tables and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            State::Consistent => "consistent",
            State::Different => "different",
            State::Undecided => "undecided",
        }
    }

    /// The exit code.
    pub const fn exit_code(self) -> u8 {
        match self {
            State::Consistent => exit::PASS,
            State::Different => exit::DIFFERENT,
            State::Undecided => exit::UNDECIDED,
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// One of the tests that a state rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// The null hypothesis, in a few words.
    pub what: String,
    /// Its p-value, or a bound above it.
    pub p: f64,
}

/// The state that follows from tests that share a level equally (Bonferroni: valid under any dependence), and from whether the
/// intervals are narrow enough.
pub fn state(tests: &[Test], level: f64, is_resolved: bool) -> State {
    let share = level / tests.len().max(1) as f64;
    // A p-value that is not a number rejects.
    if tests.iter().any(|t| !(t.p > share)) {
        State::Different
    } else if is_resolved {
        State::Consistent
    } else {
        State::Undecided
    }
}
