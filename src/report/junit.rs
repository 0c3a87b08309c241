//! For continuous integration: JUnit XML, a suite per scene, a case per check, with ids that do not change from run to
//! run.

use core::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::text;
use crate::judge::finding::State;
use crate::verify::verdicts::{Outcome, Verdict, WHOLE_IMAGE};

/// The whole answer.
///
/// # Errors
/// What the XML writer says.
pub fn outcome(o: &Outcome) -> Result<String, String> {
    let mut report = Report::new(format!("nephroid {}", o.program.name()));
    report.set_time(duration(o.seconds));
    let mut suites: Vec<TestSuite> = Vec::new();
    let (mut scene, mut pair) = (None, None);
    for v in &o.verdicts {
        let changed = v.variation.is_some();
        if scene.replace((&v.scene, changed)) != Some((&v.scene, changed)) {
            let suffix = if changed { ", changed" } else { "" };
            suites.push(TestSuite::new(format!("{}{suffix}", v.scene)));
        }
        // One run serves all cases of a pair of scene and integrator: the first one has its time.
        let this = (&v.scene, &v.integrator, &v.variation);
        let first = pair.replace(this) != Some(this);
        if let Some(suite) = suites.last_mut() {
            suite.add_test_case(case(v, if first { v.seconds } else { 0.0 }));
        }
    }
    report.add_test_suites(suites);
    report.to_string().map_err(|e| e.to_string())
}

fn case(v: &Verdict, seconds: f64) -> TestCase {
    let f = &v.finding;
    let mut status = match f.state {
        State::Equivalent => TestCaseStatus::success(),
        State::Different => TestCaseStatus::non_success(NonSuccessKind::Failure),
        State::Undecided | State::Unreadable => TestCaseStatus::non_success(NonSuccessKind::Error),
        State::NotSampled | State::NotComparable => TestCaseStatus::skipped(),
    };
    let bias = text::bias(f).map_or(String::new(), |b| format!("bias {b}"));
    let parts = [f.state.word(), &bias, &f.reason];
    let parts: Vec<_> = parts.into_iter().filter(|p| !p.is_empty()).collect();
    status.set_message(parts.join("; "));
    if f.state != State::Equivalent {
        status.set_type(f.state.word());
        status.set_description(format!("again: {}", v.command));
    }
    // The name does not depend on what was found: the region of a bias is in the message.
    let place = v.variation.as_deref().unwrap_or(WHOLE_IMAGE);
    let mut case = TestCase::new(format!("{}/{}/{place}", v.integrator, v.class), status);
    case.set_classname(v.scene.as_str())
        .set_time(duration(seconds));
    case
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}
