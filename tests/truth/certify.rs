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

/// Evenly spread numbers in [-1, 1].
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }
}

/// `probe --certify --json` of a scene at points of its floor, written in decimals.
fn probe(scene: &str, name: &str, points: &[[f64; 2]]) -> Vec<Value> {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let lines = points.iter().map(|[x, y]| format!("\n{x},{y},0"));
    std::fs::write(&path, format!("x,y,z{}", lines.collect::<String>())).expect("a file");
    let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args([
            "probe",
            scene,
            &path.display().to_string(),
            "--certify",
            "--json",
        ])
        .output()
        .expect("the program");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    report["answers"].as_array().expect("answers").clone()
}

#[test]
fn every_entry() {
    let mut spread = Spread(20_261_122);
    for scene in nephroid::entry::names() {
        let entry = nephroid::entry::load(scene).expect("an entry");
        let Some(truth) = nephroid_analytic::entries::FloorTruth::new(&entry) else {
            continue;
        };
        let count = if scene == "ripple-pool" { 12 } else { 60 };
        let points: Vec<_> = (0..count)
            .map(|_| {
                [0, 1].map(|k| {
                    let [low, high] = truth.range(k);
                    let x = low + (high - low) * (0.5 + 0.49 * spread.next());
                    (x * 1e6).round() / 1e6
                })
            })
            .collect();
        let (mut proven, mut lit, mut widest) = (0, 0, 0.0_f64);
        let answers = probe(scene, &format!("{scene}.csv"), &points);
        for a in &answers {
            if a["certified"] != true {
                println!("{scene}: {a}");
                assert!(a["not_certified"].is_string(), "{scene}: {a}");
                continue;
            }
            proven += 1;
            let end = |i: usize| a["enclosure"][i].as_f64().expect("an end");
            let (low, high) = (end(0), end(1));
            let (e, bound) = (a["E"].as_f64(), a["error_bound"].as_f64());
            let (Some(e), Some(bound)) = (e, bound) else {
                continue;
            };
            assert!(e - bound <= high && e + bound >= low, "{scene}: {a}");
            assert_eq!(a["proven_roots"], a["roots"], "{scene}: {a}");
            if e > 0.0 {
                lit += 1;
                // Away from singularities: the bound is less than 100 roundings.
                if bound < 3e-14 * e {
                    widest = widest.max((high - low) / low);
                    let wrong = e * (1.0 + 1e-9);
                    assert!(wrong < low || wrong > high, "{scene}: {a}");
                }
            }
        }
        let all = answers.len();
        println!("{scene}: {proven} of {all} certified, {lit} lit, widest {widest:.1e}");
        assert!(
            proven * 50 >= all * 49 && lit > 0,
            "{scene}: {proven} of {all}"
        );
        assert!(widest <= 1e-11, "{scene}: {widest:e}");
    }
}

#[test]
fn probes_are_enclosed_from_decimals() {
    // 0.1 is not a double: over (0.1, 0) a light at (0.1, 0, 0.1) gives I/h² = 100 only for the decimals.
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("decimals.toml");
    let text = include_str!("../../scenes/floor.toml")
        .replace("[0.35, -0.2, 1.7]", "[0.1, 0.0, 0.1]")
        .replace("intensity = 2.3", "intensity = 1.0");
    std::fs::write(&path, text).expect("a file");
    let answers = probe(&path.display().to_string(), "decimals.csv", &[[0.1, 0.0]]);
    let ends = [0, 1].map(|i| answers[0]["enclosure"][i].as_f64().expect("an end"));
    assert!(
        ends[0] <= 100.0 && ends[1] >= 100.0 && ends[1] - ends[0] < 1e-12,
        "{ends:?}"
    );
}

#[test]
fn a_probe_on_a_caustic_is_not_certified() {
    // The cusp of the nephroid is at half the radius, where all rays next to the axis meet.
    let answers = probe("cup", "cusp.csv", &[[0.6, 0.0]]);
    let caustic = answers.iter().find(|a| a["class"] == "LSDE").expect("LSDE");
    assert_eq!(caustic["certified"], false, "{caustic}");
    assert!(
        caustic["not_certified"]
            .as_str()
            .expect("why")
            .contains("fold"),
        "{caustic}"
    );
}
