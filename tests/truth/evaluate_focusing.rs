//! `nephroid evaluate` on the reference files of paraboloid, conic mirrors, stigmatic refractors, glass sphere and waves:
//! every radiometric value of each file is compared, and nothing that a file can hold makes it panic.

use nephroid::evaluate::{Report, evaluate};
use serde_json::{Value, json};

const FILES: [(&str, &str); 5] = [
    (
        "paraboloid.json",
        include_str!("../../golden/reference/paraboloid.json"),
    ),
    (
        "conic-mirrors.json",
        include_str!("../../golden/reference/conic-mirrors.json"),
    ),
    (
        "stigmatic-refractors.json",
        include_str!("../../golden/reference/stigmatic-refractors.json"),
    ),
    (
        "glass-sphere.json",
        include_str!("../../golden/reference/glass-sphere.json"),
    ),
    (
        "water-waves.json",
        include_str!("../../golden/reference/water-waves.json"),
    ),
];

const TOLERANCE: f64 = 1e-12;

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn run(file: &str, value: &Value) -> Report {
    evaluate(file, &value.to_string()).expect("a report")
}

/// Number of radiometric values (`E*`, `L*`, `specular_weight`, `T`) in the points, their paths and roots, and the views.
fn radiometric(value: &Value) -> usize {
    let is_number = |v: &Value| v.as_str().is_some_and(|s| s.parse::<f64>().is_ok());
    match value {
        Value::Object(map) => map
            .iter()
            .map(|(key, v)| {
                let named = key.starts_with('E') || key.starts_with('L');
                let named = named || key == "specular_weight" || key == "T";
                usize::from(named && is_number(v)) + radiometric(v)
            })
            .sum(),
        Value::Array(items) => items.iter().map(radiometric).sum(),
        _ => 0,
    }
}

#[test]
fn every_value_of_every_file_is_met() {
    for (file, text) in FILES {
        let value = parsed(text);
        let report = run(file, &value);
        let mut compared = 0;
        for placed in report.rows() {
            let row = placed.row;
            let Some(difference) = row.relative_difference else {
                continue;
            };
            compared += 1;
            assert!(
                row.passes(TOLERANCE),
                "{file} {} {}: {difference:e}",
                placed.item,
                row.key
            );
            // Near a fold the bound replaces the tolerance, so it must be one. The nearest point, K3-06, is 2e-6 of the
            // fold's radius away from it: about 5e5 roundings for each of a few inputs.
            assert!(
                row.error_bound <= 1e-8 * row.value.abs(),
                "{file} {} {}: bound {:e}",
                placed.item,
                row.key,
                row.error_bound
            );
            let within = difference * row.expected.map_or(0.0, f64::abs);
            assert!(
                within <= row.error_bound || row.expected == Some(0.0),
                "{file} {} {}: {within:e} is beyond the bound {:e}",
                placed.item,
                row.key,
                row.error_bound
            );
        }
        let expected: usize = value["configurations"]
            .as_array()
            .expect("configurations")
            .iter()
            .map(|c| radiometric(&c["points"]) + radiometric(&c["views"]))
            .sum();
        assert_eq!(compared, expected, "{file}");
        let worst = report.worst(true).expect("a row").row;
        assert!(worst.relative_difference <= Some(TOLERANCE), "{file}");
    }
}

#[test]
fn the_number_of_roots_is_the_listed_one() {
    for (file, text) in FILES {
        let value = parsed(text);
        let report = run(file, &value);
        for (c, found) in value["configurations"]
            .as_array()
            .expect("configurations")
            .iter()
            .zip(&report.configurations)
        {
            for (point, item) in c["points"]
                .as_array()
                .expect("points")
                .iter()
                .zip(&found.items)
            {
                assert_eq!(point["id"], item.id.as_str());
                for path in point["paths"].as_array().expect("paths") {
                    let class = path["class"].as_str().expect("class");
                    let roots = item.roots.iter().find(|(c, _)| c == class).map(|r| r.1);
                    assert_eq!(
                        roots.map(u64::from),
                        path["count"].as_u64(),
                        "{file} {} {class}",
                        item.id
                    );
                }
            }
        }
    }
}

#[test]
fn a_wrong_value_is_noticed() {
    for (file, text) in FILES {
        let mut value = parsed(text);
        let wrong = &mut value["configurations"][0]["points"][1]["E_caustic"];
        let right: f64 = wrong
            .as_str()
            .expect("a decimal")
            .parse()
            .expect("a number");
        *wrong = json!(right * (1.0 + 4e-12));
        let report = run(file, &value);
        let failed: Vec<_> = report
            .rows()
            .filter(|p| !p.row.passes(TOLERANCE))
            .map(|p| p.row.key.clone())
            .collect();
        assert_eq!(failed, ["E_caustic"], "{file}");
    }
}

/// The error's message and help together, as a person sees them.
fn complaint(file: &str, value: &Value) -> String {
    let error = evaluate(file, &value.to_string()).expect_err("must be refused");
    let help = miette::Diagnostic::help(&error)
        .map(|h| h.to_string())
        .unwrap_or_default();
    format!("{error} | {help}")
}

#[test]
fn what_is_wrong_is_named_with_its_place() {
    let cases: [(usize, usize, &str, Value); 22] = [
        (0, 0, "f", json!("0")),
        (0, 0, "light", json!(["0", "0", "1.1"])),
        (0, 0, "mirror_radius", json!(-1)),
        (0, 1, "r1", json!("0.5")),
        (0, 1, "c", json!("high")),
        (1, 0, "e", json!("1.0")),
        (1, 0, "light", json!(["0", "0", "0.6"])),
        (1, 1, "e", json!("0.9")),
        (2, 0, "n", json!("1.0")),
        (2, 1, "C", json!("1.9")),
        (2, 1, "C", json!("3.1")),
        (2, 1, "delta", Value::Null),
        (3, 0, "receiver_z", json!("0.9")),
        (3, 0, "i_max", json!("1.6")),
        (3, 0, "light_direction", json!(["1", "0", "1"])),
        (4, 0, "waves_A_k_phase", json!([["0.05", "6"]])),
        (4, 0, "waves_A_k_phase", json!([["0.5", "9", "0"]])),
        (
            4,
            0,
            "waves_A_k_phase",
            json!([["0.00001", "20000", "0"], 3]),
        ),
        (4, 0, "mean_depth_H", json!("0.04")),
        (4, 0, "light_direction", json!(["0", "0", "1"])),
        (4, 0, "n", json!("0.75")),
        (4, 1, "waves_A_k_phase", json!([["0.1", "1", "1e9"]])),
    ];
    for (file, configuration, key, wrong) in cases {
        let (name, text) = FILES[file];
        let mut value = parsed(text);
        let c = &mut value["configurations"][configuration];
        c["parameters"][key] = wrong;
        let id = c["id"].as_str().expect("id").to_owned();
        let text = complaint(name, &value);
        for part in [name, key, &format!("configuration `{id}`"), "allowed: "] {
            assert!(text.contains(part), "`{part}` is missing in: {text}");
        }
    }
    // A point off the receiver, and a camera in the water.
    let mut value = parsed(FILES[3].1);
    value["configurations"][0]["points"][2]["x"] = json!(["0.1", "0", "1.3"]);
    let text = complaint("glass-sphere.json", &value);
    assert!(
        text.contains("point `K1-02`") && text.contains("x[2]"),
        "{text}"
    );
    let mut value = parsed(FILES[4].1);
    value["configurations"][0]["views"][0]["camera"] = json!(["0", "0", "1"]);
    let text = complaint("water-waves.json", &value);
    assert!(
        text.contains("point `L1-v0`") && text.contains("camera[2]"),
        "{text}"
    );
    let mut value = parsed(FILES[3].1);
    value["configurations"][0]["points"][0]["paths"][0]["class"] = json!("LDE");
    let text = complaint("glass-sphere.json", &value);
    assert!(text.contains("K1-00") && text.contains("class"), "{text}");
}

/// Every parameter replaced by extreme and by wrong values: an answer or an error, never a panic.
#[test]
fn no_parameter_makes_it_panic() {
    let strange = [
        Value::Null,
        json!("x"),
        json!(-1),
        json!(0),
        json!("1e-9"),
        json!("1.000001"),
        json!(10),
        json!("1e9"),
        json!("1e400"),
        json!([]),
        json!([["1e-9", "1e9", "0"]]),
        json!([["1e-3", "1e-9", "0"], ["0", "0", "0"]]),
        json!(["0", "0", "-1"]),
    ];
    for (file, text) in FILES {
        let value = parsed(text);
        let configurations = value["configurations"].as_array().expect("configurations");
        for c in configurations {
            // Three points are enough.
            let mut c = c.clone();
            let points = c["points"].as_array_mut().expect("points");
            points.truncate(3);
            let keys: Vec<String> = c["parameters"]
                .as_object()
                .expect("parameters")
                .keys()
                .cloned()
                .collect();
            for key in keys {
                for wrong in &strange {
                    let mut c = c.clone();
                    c["parameters"][&key] = wrong.clone();
                    let mut one = value.clone();
                    one["configurations"] = json!([c]);
                    // An error or a report: both are answers.
                    let _ = evaluate(file, &one.to_string());
                }
            }
            for axis in 0..3 {
                for wrong in &strange {
                    let mut c = c.clone();
                    c["points"][0]["x"][axis] = wrong.clone();
                    let mut one = value.clone();
                    one["configurations"] = json!([c]);
                    let _ = evaluate(file, &one.to_string());
                }
            }
        }
    }
}
