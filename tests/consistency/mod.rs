//! The committed tables with certificates: what the tests of precision and of unseen parameters share.

use std::path::PathBuf;

use nephroid::evaluate::{Report, Row};
use serde_json::Value;

/// Scenes of which every value must be certified.
pub fn tables() -> Vec<String> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("golden/reference");
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .expect("the tables")
        .map(|f| {
            f.expect("a file")
                .file_name()
                .into_string()
                .expect("a name")
        })
        .filter_map(|name| Some(name.strip_suffix(".json")?.to_owned()))
        // Expectations and sums of schedules: tables of other commands.
        .filter(|name| !name.starts_with("bandwidth") && name != "consistency")
        .collect();
    names.sort();
    names
}

/// A table as JSON.
pub fn table(name: &str) -> Value {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("golden/reference/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("the table")).expect("JSON")
}

/// Width of a certified interval over its smaller modulus.
pub fn relative_width(row: &Row) -> f64 {
    let c = row.certificate.expect("a certificate");
    if c.low == c.high {
        0.0
    } else {
        (c.high - c.low) / f64::abs(c.low).min(f64::abs(c.high))
    }
}

/// The interval of a row and what the closed form says agree, and so do the numbers of rays.
pub fn assert_consistent(what: &str, report: &Report) {
    for c in &report.configurations {
        for item in &c.items {
            for row in &item.rows {
                let Some(certificate) = row.certificate else {
                    continue;
                };
                let (low, high) = (row.value - row.error_bound, row.value + row.error_bound);
                assert!(
                    low <= certificate.high && high >= certificate.low,
                    "{what} {} {row:?}",
                    item.id
                );
            }
            for (class, count) in &item.roots {
                let key = format!("paths.{class}.E");
                let row = item.rows.iter().find(|r| r.key == key).expect("the class");
                if let Some(c) = row.certificate.filter(|c| c.certified) {
                    assert_eq!(c.roots, *count, "{what} {} {class}: {row:?}", item.id);
                }
            }
        }
    }
}
