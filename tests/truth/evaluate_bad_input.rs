//! `evaluate` on files that are wrong: messages that name the place, and no panic.

use std::fs;
use std::path::PathBuf;

use nephroid::evaluate::evaluate;
use serde_json::{Value, json};

const TABLES: [&str; 4] = ["diffuse", "planar-mirror", "cylinder-cup", "flat-interface"];

fn table(name: &str) -> Value {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let path = path.join(format!("golden/reference/{name}.json"));
    serde_json::from_str(&fs::read_to_string(path).expect("the table")).expect("JSON")
}

#[test]
fn messages_name_the_place() {
    let say = |edit: &dyn Fn(&mut Value)| {
        let mut file = table("cylinder-cup");
        edit(&mut file);
        let error = evaluate("cup.json", &file.to_string()).expect_err("a bad file");
        format!("{error}")
    };
    for (words, edit) in [
        (
            vec!["cup.json", "`G1`", "`R`"],
            Box::new(|f: &mut Value| f["configurations"][0]["parameters"]["R"] = json!("nan"))
                as Box<dyn Fn(&mut Value)>,
        ),
        (
            vec!["`G1`", "`a`", "nothing"],
            Box::new(|f| f["configurations"][0]["parameters"]["a"] = Value::Null),
        ),
        (
            vec!["`G1-02`", "`x[1]`", "1e999"],
            Box::new(|f| f["configurations"][0]["points"][2]["x"][1] = json!("1e999")),
        ),
        (
            vec!["`G1-02`", "`x[2]`"],
            Box::new(|f| f["configurations"][0]["points"][2]["x"][2] = json!(0.1)),
        ),
        (
            vec!["`G1-03`", "`E_caustic`", "true"],
            Box::new(|f| f["configurations"][0]["points"][3]["E_caustic"] = json!(true)),
        ),
        (
            vec!["`G1-v0`", "`camera`"],
            Box::new(|f| f["configurations"][0]["views"][0]["camera"] = json!([1, 2])),
        ),
        (
            vec!["`wall`", "quarter"],
            Box::new(|f| f["configurations"][0]["parameters"]["wall"] = json!("quarter")),
        ),
        (
            vec!["`max_bounces`"],
            Box::new(|f| f["configurations"][0]["parameters"]["max_bounces"] = json!(1.5)),
        ),
        (
            vec!["`sin_elevation`"],
            Box::new(|f| f["configurations"][0]["parameters"]["sin_elevation"] = json!(0.61)),
        ),
        (
            vec!["`G3`", "`light`"],
            Box::new(|f| f["configurations"][3]["parameters"]["light"][0] = json!(-1.1)),
        ),
        (
            vec!["`scene`", "teapot"],
            Box::new(|f| f["scene"] = json!("teapot")),
        ),
        (
            vec!["`schema`"],
            Box::new(|f| f["schema"] = json!("other/1")),
        ),
        (
            vec!["`configurations`"],
            Box::new(|f| f["configurations"] = json!(3)),
        ),
        (
            vec!["`id`"],
            Box::new(|f| f["configurations"][0]["points"][0]["id"] = json!(7)),
        ),
    ] {
        let message = say(&*edit);
        for word in words {
            assert!(message.contains(word), "{message} should name {word}");
        }
    }
}

/// Every place of a file, as JSON pointers.
fn places(value: &Value, at: &str, into: &mut Vec<String>) {
    into.push(at.to_owned());
    match value {
        Value::Array(list) => {
            for (n, v) in list.iter().enumerate() {
                places(v, &format!("{at}/{n}"), into);
            }
        }
        Value::Object(map) => {
            for (key, v) in map {
                places(v, &format!("{at}/{key}"), into);
            }
        }
        _ => {}
    }
}

#[test]
fn no_input_panics() {
    let replacements = [
        Value::Null,
        json!(true),
        json!("nan"),
        json!("-1e-320"),
        json!(1e9),
        json!(-1e9),
        json!(0),
        json!(1e308),
        json!(""),
        json!([]),
        json!({}),
        json!("unbounded"),
    ];
    let (mut good, mut bad) = (0, 0);
    for name in TABLES {
        let mut file = table(name);
        for c in file["configurations"]
            .as_array_mut()
            .expect("configurations")
        {
            for list in ["points", "views"] {
                if let Some(items) = c[list].as_array_mut() {
                    items.truncate(1);
                }
            }
        }
        let mut all = vec![];
        places(&file, "", &mut all);
        for (n, place) in all.iter().enumerate() {
            // Every place with a third of the replacements, which rotate.
            for replacement in replacements.iter().skip(n % 3).step_by(3) {
                let mut changed = file.clone();
                *changed.pointer_mut(place).expect("a place") = replacement.clone();
                match evaluate("mutant.json", &changed.to_string()) {
                    Ok(report) => {
                        good += 1;
                        let _ = report.worst(false);
                    }
                    Err(_) => bad += 1,
                }
            }
        }
        let text = file.to_string();
        for end in (0..text.len()).step_by(211) {
            assert!(evaluate("cut.json", text.get(..end).unwrap_or("")).is_err());
        }
    }
    assert!(good > 500 && bad > 500, "{good} read, {bad} refused");
    assert!(evaluate("deep.json", &"[".repeat(100_000)).is_err());
}
