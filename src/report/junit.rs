//! For continuous integration: JUnit XML, a suite per scene, a case per check, with ids that do not change from run to
//! run.

use core::time::Duration;

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::text;
use crate::gate::checks::SEPARATED;
use crate::judge::finding::State;
use crate::verify::verdicts::{MASK, Outcome, Verdict, WHOLE_IMAGE};

/// The whole answer.
///
/// # Errors
/// What the XML writer says.
pub fn outcome(o: &Outcome) -> Result<String, String> {
    let mut report = Report::new(format!("nephroid {}", o.program.name()));
    report.set_time(duration(o.seconds));
    let mut suites: Vec<TestSuite> = Vec::new();
    let (mut scene, mut pair) = (None, None);
    let mut ids: Vec<String> = Vec::new();
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
            let base = format!("{}/{}", v.scene, name(v));
            let alike = ids.iter().filter(|id| **id == base).count();
            let id = match alike {
                0 => base.clone(),
                n => format!("{base}#{}", n + 1),
            };
            ids.push(base);
            suite.add_test_case(case(v, if first { v.seconds } else { 0.0 }, id));
        }
    }
    report.add_test_suites(suites);
    report.to_string().map_err(|e| e.to_string())
}

/// The name does not depend on what was found: the region of a bias is in the message.
fn name(v: &Verdict) -> String {
    let place = match (&v.variation, v.region.as_str()) {
        (Some(variation), _) => variation,
        (None, MASK) => MASK,
        (None, SEPARATED) => SEPARATED,
        _ => WHOLE_IMAGE,
    };
    format!("{}/{}/{place}", v.integrator, v.class)
}

fn case(v: &Verdict, seconds: f64, id: String) -> TestCase {
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
    let mut case = TestCase::new(name(v), status);
    case.set_classname(v.scene.as_str())
        .set_time(duration(seconds));
    case.extra.insert("id".into(), id.into());
    let number = |v: Option<f64>| v.map(|v| v.to_string());
    let properties = [
        ("seed", Some(v.seed.to_string())),
        ("level", Some(v.levels.different.to_string())),
        ("equivalence_level", Some(v.levels.equivalent.to_string())),
        ("margin", Some(v.margin.to_string())),
        ("power", number(f.power)),
        ("effect", number(f.effect)),
        ("minimum_detectable_bias", number(f.minimum_detectable_bias)),
        ("region", Some(v.region.clone())),
        ("replicates", Some(v.replicates.to_string())),
        ("paths", Some(v.paths.to_string())),
        ("looks_like", v.looks_like.clone()),
        ("command", Some(v.command.clone())),
    ];
    for (key, value) in properties {
        if let Some(value) = value {
            case.add_property((key, value.as_str()));
        }
    }
    case
}

fn duration(seconds: f64) -> Duration {
    Duration::try_from_secs_f64(seconds).unwrap_or_default()
}
