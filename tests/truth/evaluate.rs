//! `evaluate`: the committed tables to 1e-12, files with other parameters, and files that are wrong.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use nephroid::evaluate::{Report, evaluate};
use serde_json::{Value, json};

const TABLES: [&str; 4] = ["diffuse", "planar-mirror", "cylinder-cup", "flat-interface"];

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("golden/reference/{name}.json"))
}

fn table(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(path(name)).expect("the table")).expect("JSON")
}

fn report(file: &Value) -> Report {
    evaluate("test.json", &file.to_string()).expect("a good file")
}

/// Every value within the tolerance or, near a singularity, its conditioning; and within its own error bound.
fn assert_good(what: &str, report: &Report, at_least: usize) {
    let mut compared = 0;
    for placed in report.rows() {
        let row = placed.row;
        let Some(expected) = row.expected else {
            continue;
        };
        compared += 1;
        assert!(row.passes(1e-12), "{what} {placed:?}");
        let half_ulp = 0.5 * f64::EPSILON * f64::abs(expected);
        let difference = f64::abs(row.value - expected);
        assert!(
            difference <= row.error_bound + half_ulp,
            "{what} {placed:?}"
        );
    }
    assert!(compared >= at_least, "{what}: {compared} values compared");
    let worst = report.worst(true).and_then(|p| p.row.relative_difference);
    assert!(worst.is_some_and(|w| w <= 1e-12), "{what}: {worst:?}");
}

#[test]
fn committed_tables() {
    for (name, compared) in TABLES.into_iter().zip([74, 252, 528, 243]) {
        assert_good(name, &report(&table(name)), compared);
    }
}

#[test]
fn values_do_not_depend_on_the_expected_ones() {
    for name in TABLES {
        let full = table(name);
        let mut bare = full.clone();
        for c in bare["configurations"]
            .as_array_mut()
            .expect("configurations")
        {
            for list in ["points", "views"] {
                for item in c[list].as_array_mut().into_iter().flatten() {
                    let inputs = ["id", "x", "c", "bounces", "camera", "aim", "first_hit"];
                    let map = item.as_object_mut().expect("an object");
                    map.retain(|key, _| inputs.contains(&key.as_str()));
                }
            }
        }
        let (full, bare) = (report(&full), report(&bare));
        assert!(bare.worst(false).is_none());
        for row in bare.rows() {
            let same = full
                .rows()
                .find(|r| r.item == row.item && r.row.key == row.row.key)
                .expect("the same row");
            assert_eq!(same.row.value.to_bits(), row.row.value.to_bits(), "{row:?}");
        }
    }
}

fn numbers(value: &mut Value, map: &impl Fn(f64) -> f64) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|v| numbers(v, map)),
        Value::String(s) => {
            if let Ok(x) = s.parse::<f64>() {
                *value = json!(map(x));
            }
        }
        _ => {}
    }
}

/// Multiplies the radiometric values of a point, its classes and its roots.
fn scale_values(item: &mut Value, factor: f64) {
    match item {
        Value::Array(list) => list.iter_mut().for_each(|v| scale_values(v, factor)),
        Value::Object(map) => {
            for (key, value) in map {
                match key.as_str() {
                    "paths" | "roots" => scale_values(value, factor),
                    k if k.starts_with(['E', 'L']) || k.starts_with("fluence") => {
                        numbers(value, &|x| x * factor);
                    }
                    _ => {}
                }
            }
        }
        _ => {}
    }
}

#[test]
fn scaled_scenes() {
    // Lengths times s: light of a point source falls like 1/s², that of a beam stays.
    let s = 2.3;
    for (name, compared) in TABLES.into_iter().zip([67, 252, 528, 243]) {
        let mut file = table(name);
        let configurations = file["configurations"]
            .as_array_mut()
            .expect("configurations");
        configurations.retain(|c| c["id"] != "A3");
        for c in configurations {
            let p = c["parameters"].as_object_mut().expect("parameters");
            let lengths = [
                "a",
                "s",
                "light",
                "mirror_point",
                "surface_z",
                "Z",
                "wall_height",
                "x_line",
            ];
            for (key, value) in p.iter_mut() {
                if lengths.contains(&key.as_str()) {
                    numbers(value, &|x| x * s);
                }
            }
            let factor = if p.contains_key("I") {
                1.0 / (s * s)
            } else {
                1.0
            };
            for list in ["points", "views"] {
                for item in c[list].as_array_mut().into_iter().flatten() {
                    for key in ["x", "camera", "aim", "first_hit"] {
                        numbers(&mut item[key], &|x| x * s);
                    }
                    scale_values(item, factor);
                }
            }
        }
        assert_good(name, &report(&file), compared);
    }
}

#[test]
fn turned_and_shifted_scenes() {
    // About the vertical by the angle of the 3-4-5 triangle, then along x and y; both exact but for rounding.
    let turn = |v: &mut Value, shift: f64| {
        let Some(list) = v.as_array() else {
            return;
        };
        let x: Vec<f64> = list
            .iter()
            .map(|c| c.as_str().expect("a decimal").parse().expect("a decimal"))
            .collect();
        *v = json!([
            0.6 * x[0] - 0.8 * x[1] + shift,
            0.8 * x[0] + 0.6 * x[1] - 2.0 * shift,
            x[2]
        ]);
    };
    for (name, compared) in [("planar-mirror", 252), ("flat-interface", 243)] {
        let mut file = table(name);
        for c in file["configurations"]
            .as_array_mut()
            .expect("configurations")
        {
            let p = &mut c["parameters"];
            turn(&mut p["light"], 0.5);
            if name == "planar-mirror" {
                turn(&mut p["mirror_point"], 0.5);
                turn(&mut p["mirror_normal"], 0.0);
            }
            for list in ["points", "views"] {
                for item in c[list].as_array_mut().into_iter().flatten() {
                    for key in ["x", "camera", "aim", "first_hit"] {
                        turn(&mut item[key], 0.5);
                    }
                }
            }
        }
        assert_good(name, &report(&file), compared);
    }
}

#[test]
fn bounded_mirror() {
    // A rectangle that holds the specular points of B2 near the axis and cuts off the others.
    let mut file = table("planar-mirror");
    let configurations = file["configurations"]
        .as_array_mut()
        .expect("configurations");
    configurations.retain(|c| c["id"] == "B2");
    configurations[0]["parameters"]["extent"] =
        json!({ "edge": [0, 1, 0], "half_width": 0.4, "half_height": 0.6 });
    let report = report(&file);
    let value = |id: &str| {
        let row = report
            .rows()
            .find(|r| r.item == id && r.row.key == "E_caustic")
            .expect("a row");
        (
            row.row.value,
            row.row.relative_difference.expect("compared"),
        )
    };
    // s = (1.5, 0.0536, 0.536): inside. s = (1.5, 1.01, 0.35) and (1.5, -0.28, 0.66): outside.
    assert!(value("B2-00").1 <= 1e-12);
    assert_eq!(value("B2-06").0, 0.0);
    assert_eq!(value("B2-05").0, 0.0);
}

#[test]
fn wrong_expected_values_are_seen() {
    let change = |name: &str, point: usize, edit: &dyn Fn(&mut Value)| {
        let mut file = table(name);
        edit(&mut file["configurations"][0]["points"][point]);
        report(&file)
            .rows()
            .filter(|r| !r.row.passes(1e-12))
            .count()
    };
    assert_eq!(
        change("diffuse", 0, &|p| p["E_caustic"] = json!(2.042658792709)),
        1
    );
    // A root too few, and one too many.
    let too_few = |p: &mut Value| {
        p["paths"][0]["roots"].as_array_mut().expect("roots").pop();
    };
    assert!(change("cylinder-cup", 5, &too_few) >= 1);
    let too_many = |p: &mut Value| {
        let roots = p["paths"][0]["roots"].as_array_mut().expect("roots");
        let last = roots[0].clone();
        roots.push(last);
    };
    assert!(change("cylinder-cup", 5, &too_many) >= 1);
    // A class that is not there, an expected zero where there is light, light where zero is expected.
    let extra = |p: &mut Value| p["paths"][0]["class"] = json!("LSSSDE");
    assert!(change("cylinder-cup", 5, &extra) >= 1);
    assert_eq!(
        change("cylinder-cup", 15, &|p| p["E_caustic"] = json!(1e-9)),
        1
    );
    assert_eq!(change("cylinder-cup", 0, &|p| p["E_caustic"] = json!(0)), 1);
    // Near a singularity the conditioning is allowed, and no more: G1-18, conditioning 1.5e4.
    let near = |factor: f64| {
        change("cylinder-cup", 18, &|p| {
            p["E_caustic"] = json!(62.399_032_349_779_5 * factor);
        })
    };
    assert_eq!(near(1.0 + 5e-12), 0);
    assert_eq!(near(1.0 + 5e-10), 1);
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(arguments)
        .output()
        .expect("the program runs")
}

#[test]
fn the_command() {
    let file = path("flat-interface");
    let file = file.to_str().expect("a name");
    let text = run(&["evaluate", file, "--tolerance", "1e-12"]);
    assert_eq!(text.status.code(), Some(0));
    let text = String::from_utf8(text.stdout).expect("text");
    let last = text.lines().last().expect("a line");
    assert!(last.starts_with("worst relative difference: "), "{last}");

    let output = run(&["evaluate", file, "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["schema"], "nephroid-evaluate/1");
    assert!(
        answer["worst_relative_difference"]
            .as_f64()
            .expect("a number")
            <= 1e-12
    );
    let point = &answer["configurations"][0]["points"][1];
    assert_eq!(point["id"], "C1-01");
    let value = point["values"]["E_caustic"]["value"]
        .as_f64()
        .expect("a number");
    assert!((value / 2.029171623608747 - 1.0).abs() <= 1e-15);

    // Too strict a tolerance is a difference; a file that cannot be read is bad input.
    assert_eq!(
        run(&["evaluate", file, "--tolerance", "0"]).status.code(),
        Some(1)
    );
    let missing = run(&["evaluate", "no-such-file.json"]);
    assert_eq!(missing.status.code(), Some(2));
    let message = String::from_utf8_lossy(&missing.stderr).into_owned();
    assert!(message.contains("no-such-file.json"), "{message}");
    assert_eq!(
        run(&["evaluate", file, "--tolerance", "nan"]).status.code(),
        Some(2)
    );
}
