//! For a person at a terminal: one line per verdict, within 110 columns, and a summary that says how sure it is.

use core::fmt::Write as _;

use crate::judge::finding::{Finding, State};
use crate::judge::power::DETECTION_POWER;
use crate::verify::verdicts::{NotRun, Outcome, Program, Verdict};

/// The whole answer, without a final newline.
pub fn outcome(outcome: &Outcome) -> String {
    let mut text = format!("{HEAD}\n");
    let mut previous = None;
    let mut variation = None;
    for v in &outcome.verdicts {
        let pair = (
            v.scene.as_str(),
            v.integrator.as_str(),
            v.variation.as_deref(),
        );
        let first = previous.replace(pair) != Some(pair);
        if let Some(name) = pair.2.filter(|n| variation.replace(*n) != Some(*n)) {
            let _ = writeln!(text, "{name}:");
        }
        let _ = writeln!(text, "{}", line(v, first));
        for detail in details(v) {
            let _ = writeln!(text, "    {detail}");
        }
    }
    for not_run in grouped(&outcome.not_run) {
        let _ = writeln!(text, "not run: {not_run}");
    }
    for note in &outcome.notes {
        let _ = writeln!(text, "note: {note}");
    }
    let _ = write!(text, "\n{}", summary(outcome));
    text
}

const HEAD: &str = "scene        integrator class  verdict          bias ± interval     detects   power    paths  seconds";

/// One verdict; `first` of its pair of scene and integrator, and thus the one that shows the time.
pub fn line(v: &Verdict, first: bool) -> String {
    let f = &v.finding;
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let paths = (v.paths > 0).then(|| format!("{:.1e}", v.paths as f64));
    let seconds = (first && v.paths > 0).then(|| format!("{:.1}", v.seconds));
    format!(
        "{:<12} {:<10} {:<6} {:<14} {:>20} {:>11} {:>7} {:>8} {:>8}",
        v.scene,
        v.integrator,
        v.class,
        f.state.word(),
        or_dash(bias(f)),
        or_dash(
            f.minimum_detectable_bias
                .map(|b| format!("{:.2} %", 100.0 * b))
        ),
        or_dash(f.power.map(power)),
        or_dash(paths),
        seconds.unwrap_or_default(),
    )
    .trim_end()
    .to_owned()
}

/// Effect and half width of its interval.
pub fn bias(f: &Finding) -> Option<String> {
    let effect = 100.0 * f.effect?;
    Some(match f.interval {
        Some([low, high]) => format!("{effect:+.2} % ± {:.2} %", 50.0 * (high - low)),
        None => format!("{effect:+.2} %"),
    })
}

/// Rounded down, so that 1 is never claimed.
pub(super) fn power(power: f64) -> String {
    if power > 0.999 {
        ">0.999".to_owned()
    } else {
        format!("{:.3}", (1e3 * power).floor() / 1e3)
    }
}

/// Why, and what to do about it, where the line does not say it all.
fn details(v: &Verdict) -> Vec<String> {
    let f = &v.finding;
    let mut lines = Vec::new();
    let telling = matches!(
        f.state,
        State::Different | State::Undecided | State::NotComparable
    );
    let unbiased = f.state == State::Equivalent && !f.bias_established;
    if !f.reason.is_empty() && !unbiased && f.state != State::NotSampled {
        lines.push(f.reason.clone());
    }
    if let (State::Different, Some(p), Some(mean), Some(truth)) =
        (f.state, f.p_different, v.mean, v.truth)
    {
        lines.push(format!(
            "mean {mean:.6e}, should be {:.6e} W/(m² sr); p = {p:.1e}, level {:.1e}",
            truth.value, v.levels.different
        ));
    }
    if let Some(e) = v.excluded.filter(|e| e.pixels > 0) {
        lines.push(format!(
            "excluded: {} pixels that a fold crosses, with {:.2} % of the light (the variance is infinite there)",
            e.pixels,
            100.0 * e.energy
        ));
    }
    if v.tail.is_some_and(|t| t.variance_is_in_doubt()) && f.state != State::NotSampled {
        lines.push(
            "the largest pixels have a tail index of 2 or less: the variance may be infinite, and the tests not valid"
                .to_owned(),
        );
    }
    lines.extend(v.looks_like.clone());
    if let Some(paths) = v.paths_needed {
        lines.push(format!("about {:.1e} paths would decide", paths as f64));
    }
    if telling {
        lines.push(format!("again: {}", v.command));
    }
    lines
}

/// Pairs that were left out for the same reason, one line for each reason.
pub fn grouped(not_run: &[NotRun]) -> Vec<String> {
    let mut reasons: Vec<&str> = not_run.iter().map(|n| n.reason.as_str()).collect();
    let mut seen = Vec::new();
    reasons.retain(|r| {
        !seen.contains(r) && {
            seen.push(*r);
            true
        }
    });
    reasons
        .into_iter()
        .map(|r| format!("{}: {r}", pairs_with(not_run, r)))
        .collect()
}

/// `floor with pt, lt; cup with pm`.
fn pairs_with(not_run: &[NotRun], reason: &str) -> String {
    let mut text = String::new();
    let mut scene = None;
    for n in not_run.iter().filter(|n| n.reason == reason) {
        if scene.replace(&n.scene) == Some(&n.scene) {
            let _ = write!(text, ", {}", n.integrator);
        } else {
            let separator = if text.is_empty() { "" } else { "; " };
            let _ = write!(text, "{separator}{} with {}", n.scene, n.integrator);
        }
    }
    text
}

/// How many of each, and what the error probabilities are.
pub fn summary(o: &Outcome) -> String {
    let certainty = certainty(o);
    let (counts, errors) = certainty.split_once('\n').unwrap_or((&certainty, ""));
    format!("{counts} {}{:.1} s.\n{errors}", settings(o), o.seconds)
}

/// The same without settings and times.
pub(super) fn certainty(o: &Outcome) -> String {
    const STATES: [State; 6] = [
        State::Equivalent,
        State::Different,
        State::Undecided,
        State::NotSampled,
        State::NotComparable,
        State::Unreadable,
    ];
    let count = |s: State| o.verdicts.iter().filter(|v| v.finding.state == s).count();
    let counts: Vec<_> = STATES
        .into_iter()
        .filter(|&s| count(s) > 0 || s == State::Equivalent)
        .map(|s| format!("{} {}", count(s), s.word()))
        .collect();
    let weak: Vec<_> = o
        .verdicts
        .iter()
        .filter(|v| v.finding.power.is_some_and(|p| p < DETECTION_POWER))
        .map(|v| format!("{} {} {}", v.scene, v.integrator, v.class))
        .collect();
    let weak = if weak.is_empty() {
        String::new()
    } else {
        format!(
            "\nPower below {DETECTION_POWER} at the margin: {}.",
            weak.join(", ")
        )
    };
    format!(
        "{}.\n\
         Equivalent: within {} of the truth; a suite says so falsely with probability at most {:e}.\n\
         Different: a suite of correct integrators says so with probability at most {:e}, shared by {}.{weak}",
        counts.join(", "),
        percent(o.margin),
        o.equivalence_level,
        o.level,
        match o.checks {
            1 => "1 check".to_owned(),
            n => format!("{n} checks"),
        },
    )
}

/// What was asked for.
fn settings(o: &Outcome) -> String {
    let mut parts = Vec::new();
    parts.extend(o.effort.map(|e| format!("Effort {e}")));
    parts.extend(o.bandwidth.map(|b| format!("α = r = {b}")));
    if o.program == Program::Verify {
        parts.push(format!("seed {}", o.seed));
    }
    parts.iter().map(|p| format!("{p}, ")).collect()
}

pub(super) fn percent(fraction: f64) -> String {
    // Through f32, so that 100 × 0.07 does not show its rounding.
    format!("{} %", (100.0 * fraction) as f32)
}
