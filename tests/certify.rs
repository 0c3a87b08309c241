//! `evaluate --certify` on the command line: an interval for every value, in text and JSON.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::{Value, json};

fn run(file: &str, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(["evaluate", file, "--certify"])
        .args(more)
        .output()
        .expect("the program")
}

fn reference(name: &str) -> String {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("golden/reference/{name}.json"));
    path.display().to_string()
}

/// A file with one configuration of one point.
fn file(name: &str, scene: &str, parameters: &Value, x: &Value) -> String {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let text = json!({
        "schema": "nephroid-theory-reference/1",
        "scene": scene,
        "configurations": [{ "id": "A", "parameters": parameters, "points": [{ "id": "P", "x": x }] }],
    });
    std::fs::write(&path, text.to_string()).expect("a temporary file");
    path.display().to_string()
}

fn values(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    report["configurations"][0]["points"][0]["values"].clone()
}

#[test]
fn every_value_of_a_table() {
    let text = run(&reference("planar-mirror"), &["--tolerance", "1e-12"]);
    let text = String::from_utf8(text.stdout).expect("text");
    assert!(text.contains("252 of 252 values certified"), "{text}");
    let output = run(&reference("planar-mirror"), &["--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    for point in report["configurations"][0]["points"]
        .as_array()
        .expect("points")
    {
        for (key, row) in point["values"].as_object().expect("values") {
            let end = |i: usize| row["enclosure"][i].as_f64().expect("an end");
            let value = row["value"].as_f64().expect("a value");
            assert_eq!(row["certified"], true, "{key}");
            let room = row["error_bound"].as_f64().expect("a bound");
            assert!(
                end(0) <= value + room && value - room <= end(1),
                "{key} {row}"
            );
        }
    }
}

#[test]
fn decimals_are_not_rounded_first() {
    // 0.1 is not a double: the light at height 0.1 over x = 0 gives I/h² = 100, which only the decimal does.
    let p = json!({ "light": ["0", "0", "0.1"], "I": "1", "albedo": "0.5" });
    let file = file("decimal.json", "diffuse", &p, &json!(["0", "0", "0"]));
    let v = values(&run(&file, &["--json"]));
    let row = &v["E_direct"];
    let ends = [&row["enclosure"][0], &row["enclosure"][1]].map(|e| e.as_f64().expect("an end"));
    assert!(
        ends[0] <= 100.0 && ends[1] >= 100.0 && ends[0] < ends[1],
        "{row}"
    );
    assert!(ends[1] - ends[0] < 1e-12, "{row}");
}

#[test]
fn a_cusp_is_not_certified() {
    let p = json!({
        "a": "1", "R": "0.9", "E0": "2", "sin_elevation": "0.6", "cos_elevation": "0.8",
        "wall": "half", "wall_height": "1.2", "albedo": "0.7", "max_bounces": 1,
    });
    let file = file("cusp.json", "cylinder-cup", &p, &json!(["0.5", "0", "0"]));
    let v = values(&run(&file, &["--json"]));
    assert_eq!(v["E_caustic"]["certified"], false, "{v}");
    assert_eq!(v["E_caustic"]["enclosure"][1], Value::Null, "{v}");
    assert_eq!(v["E_direct"]["certified"], true, "{v}");
    let text = run(&file, &[]);
    let text = String::from_utf8(text.stdout).expect("text");
    assert!(text.contains("undecided"), "{text}");
}

#[test]
fn without_the_option_nothing_changes() {
    let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(["evaluate", &reference("diffuse"), "--json"])
        .output()
        .expect("the program");
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(!text.contains("enclosure") && !text.contains("certified"));
}
