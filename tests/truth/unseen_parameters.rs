//! Variations of the committed tables: other parameters, points and cameras. There are no expected values; what is certified
//! is the truth, and shares no formula with the values.

use crate::consistency::{assert_consistent, relative_width, table, tables};
use nephroid::evaluate::evaluate_certified;
use serde_json::{Value, json};

/// Evenly spread numbers in [-1, 1], without a generator that could change.
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

/// Changes every decimal in a value by up to 3 %.
fn vary(value: &mut Value, spread: &mut Spread) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(|v| vary(v, spread)),
        Value::String(s) => {
            if let Ok(x) = s.parse::<f64>() {
                *s = format!("{:.17}", x * (1.0 + 0.03 * spread.next()));
            }
        }
        _ => {}
    }
}

fn decimal(value: &Value) -> f64 {
    value
        .as_str()
        .expect("a decimal")
        .parse()
        .expect("a decimal")
}

/// Restores what ties parameters to each other.
fn tie(old: &Value, parameters: &mut Value) {
    let p = parameters.as_object_mut().expect("an object");
    let text = |x: f64| json!(format!("{x:.17}"));
    if p.contains_key("sin_elevation") {
        p.remove("light_direction");
        let angle = libm::atan2(decimal(&p["sin_elevation"]), decimal(&p["cos_elevation"]));
        p.insert("sin_elevation".into(), text(libm::sin(angle)));
        p.insert("cos_elevation".into(), text(libm::cos(angle)));
    }
    if p.contains_key("light_polar") {
        p.remove("light");
    }
    if p.contains_key("half_arc")
        && let (Some(focus), Some(light)) = (old.get("focus"), old.get("light"))
        // A light at the focus stays there.
        && focus[0] == light[0]
        && focus[1] == light[1]
    {
        let z = p["light"][2].clone();
        p.insert("light".into(), json!([p["focus"][0], p["focus"][1], z]));
    }
    let focus = if p.contains_key("f") && p.contains_key("light") {
        Some(decimal(&p["f"]))
    } else if p.contains_key("delta") && p.contains_key("e") {
        Some(-decimal(&p["a"]) * decimal(&p["e"]))
    } else if p.contains_key("A") {
        Some(decimal(&p["A"]) * decimal(&p["e"]))
    } else {
        None
    };
    if let Some(z) = focus {
        p.insert("light".into(), json!(["0", "0", text(z)]));
    }
}

/// The height of the receiver of a configuration with these parameters.
fn receiver_z(p: &Value) -> f64 {
    let of = |key: &str| p.get(key).map(decimal);
    if p.get("half_arc").is_some() {
        return 0.0;
    }
    if p.get("A").is_none() && p.get("e").is_some() {
        return decimal(&p["a"]) * decimal(&p["e"]) + decimal(&p["delta"]);
    }
    ["z_receiver", "receiver_z", "zr", "Z", "c"]
        .into_iter()
        .find_map(of)
        .or_else(|| of("delta").map(|d| -d))
        .unwrap_or(0.0)
}

/// Whether the light is so close to the side of a pillar that a variation could put it inside.
fn next_to_side(p: &Value) -> bool {
    let (Some(center), Some(light)) = (p.get("center"), p.get("light")) else {
        return false;
    };
    let [dx, dy] = [0, 1].map(|k| decimal(&light[k]) - decimal(&center[k]));
    libm::hypot(dx, dy) < 1.1 * decimal(&p["a"])
}

/// A variation of a table: other parameters, points and cameras, and no expected values.
fn variation(name: &str, spread: &mut Spread) -> Value {
    let mut file = table(name);
    for c in file["configurations"]
        .as_array_mut()
        .expect("configurations")
    {
        let old = c["parameters"].clone();
        let next_to_side = next_to_side(&old);
        for (key, value) in c["parameters"].as_object_mut().expect("an object") {
            // A light on the wall stays there, a whole sphere whole, a focused beam's receiver inside its annulus.
            // A parabola stays one.
            let fixed = key == "e" && decimal(value) == 1.0
                || next_to_side && ["a", "center", "light"].contains(&key.as_str())
                || key == "cap_cos_min" && decimal(value) == -1.0
                || old["light"][0] == "-1.0000000000000000000" && (key == "light" || key == "a");
            if !fixed {
                vary(value, spread);
            }
        }
        tie(&old, &mut c["parameters"]);
        let plane = format!("{:.17}", receiver_z(&c["parameters"]));
        let line = c["parameters"].get("x_line").cloned();
        for list in ["points", "views"] {
            for item in c[list].as_array_mut().into_iter().flatten() {
                let inputs = ["id", "x", "c", "bounces", "camera", "aim", "first_hit"];
                let map = item.as_object_mut().expect("an object");
                map.retain(|key, _| inputs.contains(&key.as_str()));
                for (key, value) in map {
                    if key != "id" && key != "c" {
                        vary(value, spread);
                    }
                    if key == "x" {
                        if let Some(z) = value.get_mut(2) {
                            *z = json!(plane);
                        }
                        if let Some(line) = &line {
                            value[0] = line.clone();
                        }
                    }
                }
            }
        }
    }
    file
}

#[test]
fn unseen_parameters() {
    let mut spread = Spread(20_261_122);
    for name in tables() {
        let (mut rows, mut proven, mut widest, mut error) = (0, 0, 0.0_f64, 0.0_f64);
        for _ in 0..6 {
            let file = variation(&name, &mut spread);
            let report = evaluate_certified(&name, &file.to_string()).expect("a good file");
            assert_consistent(&name, &report);
            for placed in report.rows() {
                let row = placed.row;
                rows += 1;
                let Some(c) = row.certificate.filter(|c| c.certified) else {
                    println!("{name} {placed:?}");
                    continue;
                };
                proven += 1;
                if row.near_singularity || row.value == 0.0 {
                    continue;
                }
                widest = widest.max(relative_width(row));
                let off = f64::max(c.low - row.value, row.value - c.high);
                error = error.max(off / f64::abs(row.value));
            }
        }
        println!(
            "{name}: {proven} of {rows} certified, widest {widest:.1e}, f64 off by {error:.1e}"
        );
        // A ray within rounding of a shadow's edge may happen, but not often.
        assert!(
            rows > 100 && proven * 100 >= rows * 99,
            "{name}: {proven} of {rows}"
        );
        assert!(
            widest <= 1e-11 && error <= 1e-12,
            "{name}: {widest:e} {error:e}"
        );
    }
}
