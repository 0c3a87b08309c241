//! What the reports of both studies write alike.

use core::fmt::Write as _;

use serde_json::{Map, Value, json};

use super::bias::CONFIDENCE;
use super::classes::Skipped;
use super::outcome::Test;

/// A p-value below this is worth a line for people.
const REMARKABLE: f64 = 1e-3;

/// What a report is about.
#[derive(Clone, Copy, Debug)]
pub struct Heading<'a> {
    /// The scene's name.
    pub scene: &'a str,
    /// The integrator's name.
    pub integrator: &'a str,
    /// The bandwidths of the iterations, where there is a schedule.
    pub schedule: Option<&'a str>,
    /// The seed.
    pub seed: u64,
    /// Of all tests of a class together.
    pub level: f64,
}

impl Heading<'_> {
    /// A document of a schema, with what was found about the classes.
    pub(super) fn document(&self, schema: &str, classes: Vec<Value>, skipped: &[Skipped]) -> Value {
        let skipped: Vec<Value> = skipped
            .iter()
            .map(|s| json!({ "class": s.class.to_string(), "reason": s.reason }))
            .collect();
        let mut document = Map::new();
        let mut put = |key: &str, value: Value| document.insert(key.to_owned(), value);
        put("schema", json!(schema));
        put("scene", json!(self.scene));
        put("integrator", json!(self.integrator));
        if let Some(schedule) = self.schedule {
            put("schedule", json!(schedule));
        }
        put("seed", json!(self.seed));
        put("level", json!(self.level));
        put("confidence", json!(CONFIDENCE));
        put("classes", Value::Array(classes));
        put("not_measured", Value::Array(skipped));
        Value::Object(document)
    }

    /// The end of a table: the classes that were not measured.
    pub(super) fn skipped(&self, out: &mut String, skipped: &[Skipped]) {
        for s in skipped {
            let _ = writeln!(
                out,
                "{}, {}, {}: {}",
                self.scene, self.integrator, s.class, s.reason
            );
        }
    }
}

/// Lines about the tests that all but rejected.
pub(super) fn remarkable(out: &mut String, tests: &[Test]) {
    for test in tests.iter().filter(|t| !(t.p > REMARKABLE)) {
        let _ = writeln!(out, "  {}: p = {:.1e}", test.what, test.p);
    }
}

/// The tests.
pub(super) fn tests_json(tests: &[Test]) -> Value {
    let one = |t: &Test| json!({ "hypothesis": t.what, "p": number(t.p) });
    tests.iter().map(one).collect()
}

/// Numbers that JSON cannot hold become null.
pub(super) fn number(v: f64) -> Value {
    if v.is_finite() { json!(v) } else { Value::Null }
}

/// An interval, null where it is unbounded.
pub(super) fn interval([low, high]: [f64; 2]) -> Value {
    json!([number(low), number(high)])
}

/// An interval for people.
pub(super) fn range([low, high]: [f64; 2]) -> String {
    let bound = |v: f64| {
        if v.is_finite() {
            format!("{v:.3}")
        } else {
            "unbounded".to_owned()
        }
    };
    format!("[{}, {}]", bound(low), bound(high))
}

/// Counts such as 3.2e8.
pub(super) fn paths(n: f64) -> String {
    format!("{n:.1e}")
}
