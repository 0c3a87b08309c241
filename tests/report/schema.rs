//! The JSON that is written fits the committed schema, and what does not is refused.

use serde_json::{Value, json};

use super::support::{gate, verify};

const SCHEMA: &str = include_str!("../../docs/schema/verdicts-1.json");

/// What does not fit, each with its place: the keywords of JSON Schema 2020-12 that the schema uses, and no others.
fn misfits(schema: &Value, root: &Value, value: &Value, at: &str) -> Vec<String> {
    let mut found = Vec::new();
    let Some(keywords) = schema.as_object() else {
        return vec![format!("{at}: the schema is not an object")];
    };
    let mut complain = |what: &str| found.push(format!("{at}: {what}, found {value}"));
    let number = value.as_f64();
    let length = value.as_array().map(Vec::len);
    let mut inner = Vec::new();
    for (key, expected) in keywords {
        let bound = expected.as_f64();
        let fits = match key.as_str() {
            "$schema" | "$id" | "$defs" | "title" | "description" => true,
            "$ref" => {
                let pointer = expected.as_str().unwrap().trim_start_matches('#');
                inner.extend(misfits(root.pointer(pointer).unwrap(), root, value, at));
                true
            }
            "type" => match expected {
                Value::Array(types) => types.iter().any(|t| is_of_type(value, t)),
                one => is_of_type(value, one),
            },
            "enum" => expected.as_array().unwrap().contains(value),
            "minimum" => number.is_none_or(|v| v >= bound.unwrap()),
            "exclusiveMinimum" => number.is_none_or(|v| v > bound.unwrap()),
            "maximum" => number.is_none_or(|v| v <= bound.unwrap()),
            "minItems" => length.is_none_or(|n| n as f64 >= bound.unwrap()),
            "maxItems" => length.is_none_or(|n| n as f64 <= bound.unwrap()),
            "required" => {
                let names = expected.as_array().unwrap();
                value
                    .as_object()
                    .is_none_or(|o| names.iter().all(|n| o.contains_key(n.as_str().unwrap())))
            }
            "additionalProperties" => {
                assert_eq!(*expected, json!(false));
                let known = schema["properties"].as_object().unwrap();
                value
                    .as_object()
                    .is_none_or(|o| o.keys().all(|k| known.contains_key(k)))
            }
            "properties" => {
                for (name, of) in expected.as_object().unwrap() {
                    if let Some(v) = value.get(name) {
                        inner.extend(misfits(of, root, v, &format!("{at}/{name}")));
                    }
                }
                true
            }
            "items" => {
                for (k, v) in value.as_array().into_iter().flatten().enumerate() {
                    inner.extend(misfits(expected, root, v, &format!("{at}/{k}")));
                }
                true
            }
            other => panic!("{at}: this check does not know the keyword {other}"),
        };
        if !fits {
            complain(&format!("{key} is {expected}"));
        }
    }
    found.extend(inner);
    found
}

fn is_of_type(value: &Value, name: &Value) -> bool {
    match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("no type: {other}"),
    }
}

#[test]
fn what_is_written_fits_the_schema() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    for (written, name) in [(verify(), "verify.json"), (gate(), "gate.json")] {
        let json: Value = serde_json::from_str(&written.read(name)).unwrap();
        assert_eq!(misfits(&schema, &schema, &json, ""), Vec::<String>::new());
        assert_eq!(json["exit_code"], written.code);
        assert!(!json["verdicts"].as_array().unwrap().is_empty());
    }
}

#[test]
fn what_does_not_fit_is_told_with_its_place() {
    let schema: Value = serde_json::from_str(SCHEMA).unwrap();
    let right: Value = serde_json::from_str(&verify().read("verify.json")).unwrap();
    let mutations: [(&str, Value); 5] = [
        ("/verdicts/0/state", json!("fine")),
        ("/verdicts/0/power", json!(1.5)),
        ("/verdicts/0/interval", json!([0.1])),
        ("/schema", json!("nephroid-verify/2")),
        ("/seed", json!("1")),
    ];
    for (pointer, wrong) in mutations {
        let mut json = right.clone();
        *json.pointer_mut(pointer).unwrap() = wrong;
        let found = misfits(&schema, &schema, &json, "");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with(pointer), "{found:?}");
    }
    let mut json = right.clone();
    json["verdicts"][0].as_object_mut().unwrap().remove("paths");
    json["more"] = json!(1);
    assert_eq!(misfits(&schema, &schema, &json, "").len(), 2);
}
