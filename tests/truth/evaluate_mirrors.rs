//! `nephroid evaluate` on the committed tables: every radiometric key is answered, and as close as promised; files with
//! damage become errors that name the place.

use nephroid::error::Error;
use nephroid::evaluate::{Report, evaluate};
use serde_json::{Value, json};

/// Largest relative difference away from singularities.
const TOLERANCE: f64 = 1e-12;

const FILES: [(&str, &str); 4] = [
    (
        "concave-sphere",
        include_str!("../../golden/reference/concave-sphere.json"),
    ),
    (
        "convex-sphere",
        include_str!("../../golden/reference/convex-sphere.json"),
    ),
    (
        "glass-slab",
        include_str!("../../golden/reference/glass-slab.json"),
    ),
    (
        "planar-chains",
        include_str!("../../golden/reference/planar-chains.json"),
    ),
];

fn is_radiometric(key: &str) -> bool {
    key.starts_with('E')
        || key.starts_with('L')
        || key.starts_with("fluence")
        || key == "specular_weight"
        || key == "T"
}

/// Numbers under radiometric keys at any depth of a point or view.
fn radiometric_values(value: &Value) -> usize {
    match value {
        Value::Array(items) => items.iter().map(radiometric_values).sum(),
        Value::Object(map) => map
            .iter()
            .map(|(key, v)| {
                let leaf = is_radiometric(key) && (v.is_string() || v.is_number());
                usize::from(leaf) + radiometric_values(v)
            })
            .sum(),
        _ => 0,
    }
}

fn report(name: &str, text: &str) -> Report {
    evaluate(name, text).unwrap_or_else(|e| panic!("{name}: {e}"))
}

#[test]
fn every_radiometric_value_is_met() {
    for (name, text) in FILES {
        let report = report(name, text);
        for placed in report.rows() {
            assert!(
                placed.row.passes(TOLERANCE),
                "{name} {} {:?}",
                placed.item,
                placed.row
            );
        }
        let away = report.worst(true).and_then(|p| p.row.relative_difference);
        assert!(away.is_some_and(|d| d <= TOLERANCE), "{name} {away:?}");
        let file: Value = serde_json::from_str(text).expect("JSON");
        let expected: usize = file["configurations"]
            .as_array()
            .expect("configurations")
            .iter()
            .map(|c| radiometric_values(&c["points"]) + radiometric_values(&c["views"]))
            .sum();
        let compared = report
            .rows()
            .filter(|p| p.row.relative_difference.is_some())
            .count();
        assert_eq!(compared, expected, "{name}");
    }
}

/// Without expected values the file still computes, to the same values.
#[test]
fn expected_values_are_not_needed() {
    for (name, text) in FILES {
        let mut file: Value = serde_json::from_str(text).expect("JSON");
        for c in file["configurations"].as_array_mut().expect("an array") {
            for list in ["points", "views"] {
                for item in c[list].as_array_mut().into_iter().flatten() {
                    let item = item.as_object_mut().expect("an object");
                    let inputs = ["id", "x", "camera", "aim", "first_hit"];
                    item.retain(|key, _| inputs.contains(&key.as_str()));
                }
            }
        }
        let (bare, full) = (report(name, &file.to_string()), report(name, text));
        for (a, b) in bare.configurations.iter().zip(&full.configurations) {
            for (a, b) in a.items.iter().zip(&b.items) {
                for row in &a.rows {
                    let same = b.rows.iter().find(|r| r.key == row.key);
                    let same = same.unwrap_or_else(|| panic!("{name} {} {}", a.id, row.key));
                    assert_eq!(row.value.to_bits(), same.value.to_bits(), "{name} {}", a.id);
                    assert!(row.relative_difference.is_none());
                }
            }
        }
    }
}

/// One value that is a part in 10^10 off is found.
#[test]
fn a_wrong_expected_value_is_found() {
    for (name, text) in FILES {
        let mut file: Value = serde_json::from_str(text).expect("JSON");
        let point = &mut file["configurations"][0]["points"][2];
        let e: f64 = point["E_caustic"]
            .as_str()
            .expect("a decimal")
            .parse()
            .expect("a decimal");
        point["E_caustic"] = json!(e * (1.0 + 1e-10));
        let report = report(name, &file.to_string());
        let failed: Vec<_> = report.rows().filter(|p| !p.row.passes(TOLERANCE)).collect();
        assert_eq!(failed.len(), 1, "{name}");
        assert_eq!(failed[0].row.key, "E_caustic");
    }
}

/// Every parameter and every coordinate, replaced by nonsense one at a time: an error that names configuration, point and
/// key, or an answer; never a panic.
#[test]
fn damage_is_an_error_with_its_place() {
    let nonsense = [
        json!("text"),
        json!(-1e300),
        json!(1e300),
        json!("NaN"),
        json!({}),
        json!([]),
        json!(0),
        json!(-3),
        json!(null),
        json!(["0", "0", "0"]),
        json!([1e9, -1e9, 1e9]),
    ];
    for (name, text) in FILES {
        let whole: Value = serde_json::from_str(text).expect("JSON");
        for configuration in whole["configurations"].as_array().expect("an array") {
            // One point and one view are enough.
            let mut small = configuration.clone();
            for list in ["points", "views"] {
                if let Some(items) = small[list].as_array_mut() {
                    items.truncate(1);
                }
            }
            let id = small["id"].as_str().expect("id").to_owned();
            let file = json!({
                "schema": whole["schema"], "scene": whole["scene"], "configurations": [small]
            });
            for (place, key) in places(&file) {
                for value in &nonsense {
                    let mut damaged = file.clone();
                    *damaged.pointer_mut(&place).expect("a place") = value.clone();
                    match evaluate(name, &damaged.to_string()) {
                        Ok(_) => {}
                        Err(Error::Content { message, help, .. }) => {
                            let named = message.contains(&id) && message.contains("key `");
                            assert!(named, "{name} {place} {value}: {message}");
                            assert!(help.starts_with("allowed: "), "{help}");
                            if place.contains("/points/") {
                                assert!(message.contains("point `"), "{message}");
                            }
                            if matches!(value, Value::Object(_)) {
                                assert!(message.contains(&key), "{place}: {message}");
                            }
                        }
                        Err(other) => panic!("{name} {place} {value}: {other}"),
                    }
                }
                if !matches!(
                    key.as_str(),
                    "side" | "mirrors" | "cap_axis" | "cap_cos_min"
                ) {
                    let mut damaged = file.clone();
                    *damaged.pointer_mut(&place).expect("a place") = json!("text");
                    let answer = evaluate(name, &damaged.to_string());
                    assert!(answer.is_err(), "{name} {place} {key}");
                }
            }
        }
    }
}

/// JSON pointers of all parameters, and of the inputs of the first point and view.
fn places(file: &Value) -> Vec<(String, String)> {
    let mut out = vec![];
    for (list, inputs) in [
        ("parameters", None),
        ("points/0", Some(&["x"][..])),
        ("views/0", Some(&["camera", "first_hit"][..])),
    ] {
        let base = format!("/configurations/0/{list}");
        let Some(object) = file.pointer(&base).and_then(Value::as_object) else {
            continue;
        };
        for key in object.keys() {
            if inputs.is_none_or(|inputs| inputs.contains(&key.as_str())) {
                out.push((format!("{base}/{key}"), key.clone()));
            }
        }
    }
    out
}
