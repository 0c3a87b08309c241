//! The verdict in words.

use core::fmt::Write as _;

use super::{anchor, escaped};
use crate::exit;
use crate::judge::finding::{State, exit_code};
use crate::report::text;
use crate::verify::verdicts::{Outcome, Verdict};

/// The state that decides, as a class of the style, and the sentence.
pub fn verdict(o: &Outcome) -> (&'static str, String) {
    let all = o.verdicts.len();
    let count = |s: State| o.verdicts.iter().filter(|v| v.finding.state == s).count();
    let different = count(State::Different);
    let undecided = count(State::Undecided);
    let margin = text::percent(o.margin);
    match o.exit_code() {
        exit::PASS => (
            "equivalent",
            format!("Equivalent: everything that was judged is within {margin} of the truth."),
        ),
        exit::DIFFERENT => (
            "different",
            format!(
                "Different: {different} of {all} verdicts {} a bias that noise does not explain.",
                if different == 1 { "finds" } else { "find" }
            ),
        ),
        exit::UNDECIDED => (
            "undecided",
            format!("Undecided: {undecided} of {all} verdicts need more samples."),
        ),
        exit::BAD_INPUT => (
            "unreadable",
            "Unreadable: some input cannot be judged.".to_owned(),
        ),
        _ => ("nothing", "Nothing was judged.".to_owned()),
    }
}

/// How sure that is.
pub fn certainty(o: &Outcome) -> Vec<String> {
    text::certainty(o).lines().map(str::to_owned).collect()
}

/// The worst state of some verdicts, as exit codes rank them.
pub fn worst(group: &[Verdict]) -> &'static str {
    let code = exit_code(group.iter().map(|v| v.finding.state));
    let decides = |v: &&Verdict| v.finding.state.exit_code() == Some(code);
    match group.iter().find(decides) {
        Some(v) => v.finding.state.word(),
        None => group.first().map_or("", |v| v.finding.state.word()),
    }
}

/// What is different or undecided, each with what it looks like.
pub fn found(o: &Outcome) -> String {
    let is_told = |v: &&Verdict| {
        matches!(
            v.finding.state,
            State::Different | State::Undecided | State::Unreadable
        )
    };
    let mut told: Vec<&Verdict> = o.verdicts.iter().filter(is_told).collect();
    told.sort_by_key(|v| v.finding.state != State::Different);
    if told.is_empty() {
        return String::new();
    }
    let mut out = "<ul class=\"found\">\n".to_owned();
    for v in told {
        let f = &v.finding;
        let state = f.state.word();
        let bias = text::bias(f).map_or(String::new(), |b| format!(" {b}"));
        let why = v.looks_like.as_ref().unwrap_or(&f.reason);
        let _ = writeln!(
            out,
            "<li><span class=\"state {state}\">{state}</span> <a href=\"#{}\">{}, {}, {}</a>{}{}</li>",
            anchor(v),
            escaped(&v.scene),
            escaped(&v.integrator),
            escaped(&v.class),
            escaped(&bias),
            if why.is_empty() {
                String::new()
            } else {
                format!(": {}", escaped(why))
            }
        );
    }
    out += "</ul>\n";
    out
}
