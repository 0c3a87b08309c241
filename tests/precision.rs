//! How exact every kind and quantity is, next to what is allowed: the closed forms in double precision against the committed
//! 30-digit tables, and the width of the intervals that provably contain the truth.
//!
//! A kind or a quantity without a row here fails. On variations of the tables' parameters, for which there are no expected
//! values, the certified intervals are the truth.

use std::collections::BTreeMap;
use std::path::PathBuf;

use nephroid::evaluate::{Report, Row, evaluate_certified};
use serde_json::{Value, json};

/// Scene, quantity, largest allowed relative error of the `f64` formula away from singularities, largest allowed relative
/// width of the enclosure there. Both are four times what was measured when the row was written, rounded up to 1, 2 or 5, and
/// 1e-15 at least; what is asked of all kinds is 1e-12 and 1e-11.
type Allowed = (&'static str, &'static str, f64, f64);

const ALLOWED: &[Allowed] = &[
    ("concave-sphere", "E_caustic", 1e-14, 2e-12),
    ("concave-sphere", "E_direct", 5e-15, 5e-13),
    ("concave-sphere", "L", 1e-14, 2e-12),
    ("concave-sphere", "class E", 1e-14, 1e-12),
    ("concave-sphere", "root E", 1e-14, 1e-12),
    ("concave-sphere", "specular_weight", 1e-15, 1e-15),
    ("conic-mirrors", "E_caustic", 5e-15, 2e-13),
    ("conic-mirrors", "E_direct", 2e-15, 1e-14),
    ("conic-mirrors", "L", 5e-15, 2e-13),
    ("conic-mirrors", "class E", 5e-15, 2e-13),
    ("conic-mirrors", "root E", 5e-15, 2e-13),
    ("convex-sphere", "E_caustic", 1e-14, 2e-12),
    ("convex-sphere", "E_direct", 2e-15, 5e-13),
    ("convex-sphere", "L", 1e-14, 2e-12),
    ("convex-sphere", "class E", 1e-14, 1e-12),
    ("convex-sphere", "root E", 1e-14, 1e-12),
    ("convex-sphere", "specular_weight", 1e-15, 1e-15),
    ("cylinder-cup", "E_caustic", 1e-14, 1e-12),
    ("cylinder-cup", "E_direct", 2e-15, 1e-14),
    ("cylinder-cup", "L", 1e-14, 1e-12),
    ("cylinder-cup", "class E", 1e-14, 5e-13),
    ("cylinder-cup", "fluence_caustic", 5e-15, 5e-13),
    ("cylinder-cup", "root E", 2e-14, 1e-12),
    ("cylinder-cup", "root fluence", 5e-15, 1e-12),
    ("cylinder-cup", "specular_weight", 1e-15, 1e-15),
    ("diffuse", "E_bounce1", 1e-15, 2e-15),
    ("diffuse", "E_caustic", 2e-15, 1e-14),
    ("diffuse", "E_direct", 1e-15, 1e-14),
    ("diffuse", "E_indirect_total", 1e-15, 5e-15),
    ("diffuse", "E_total", 1e-15, 1e-14),
    ("diffuse", "L", 2e-15, 1e-14),
    ("diffuse", "class E", 2e-15, 1e-14),
    ("diffuse", "root E", 2e-15, 1e-14),
    ("flat-interface", "E_caustic", 5e-15, 2e-13),
    ("flat-interface", "E_direct", 2e-15, 1e-14),
    ("flat-interface", "L", 5e-15, 2e-13),
    ("flat-interface", "T", 1e-15, 5e-14),
    ("flat-interface", "class E", 5e-15, 2e-13),
    ("flat-interface", "root E", 5e-15, 2e-13),
    ("flat-interface", "specular_weight", 1e-15, 5e-14),
    ("glass-slab", "E_caustic", 5e-15, 2e-13),
    ("glass-slab", "E_caustic_all_orders", 5e-15, 2e-13),
    ("glass-slab", "E_tail", 2e-14, 1e-12),
    ("glass-slab", "L", 5e-15, 2e-13),
    ("glass-slab", "class E", 2e-14, 1e-12),
    ("glass-slab", "root E", 2e-14, 1e-12),
    ("glass-slab", "specular_weight", 1e-15, 5e-14),
    ("glass-sphere", "E_caustic", 1e-14, 5e-12),
    ("glass-sphere", "L", 1e-14, 5e-12),
    ("glass-sphere", "class E", 1e-14, 5e-12),
    ("glass-sphere", "root E", 2e-14, 5e-12),
    ("paraboloid", "E_caustic", 5e-15, 5e-14),
    ("paraboloid", "L", 5e-15, 5e-14),
    ("paraboloid", "class E", 5e-15, 5e-14),
    ("paraboloid", "root E", 5e-15, 5e-14),
    ("planar-chains", "E_caustic", 2e-15, 5e-14),
    ("planar-chains", "E_caustic_all_orders", 2e-15, 5e-13),
    ("planar-chains", "E_direct", 2e-15, 2e-14),
    ("planar-chains", "L", 2e-15, 5e-14),
    ("planar-chains", "class E", 5e-15, 5e-14),
    ("planar-chains", "root E", 5e-15, 5e-14),
    ("planar-mirror", "E_caustic", 2e-15, 5e-14),
    ("planar-mirror", "E_direct", 2e-15, 1e-13),
    ("planar-mirror", "L", 5e-15, 1e-13),
    ("planar-mirror", "class E", 2e-15, 5e-14),
    ("planar-mirror", "root E", 2e-15, 5e-14),
    ("planar-mirror", "specular_weight", 1e-15, 1e-15),
    ("stigmatic-refractors", "E_caustic", 1e-14, 5e-12),
    ("stigmatic-refractors", "L", 1e-14, 5e-12),
    ("stigmatic-refractors", "class E", 1e-14, 5e-12),
    ("stigmatic-refractors", "root E", 1e-14, 5e-12),
    ("water-waves", "E_caustic", 1e-14, 5e-13),
    ("water-waves", "L", 1e-14, 5e-13),
    ("water-waves", "T", 1e-15, 5e-14),
    ("water-waves", "class E", 1e-14, 1e-13),
    ("water-waves", "root E", 1e-14, 2e-13),
    ("water-waves", "specular_weight", 1e-15, 5e-14),
];

/// Near a singularity an enclosure may be this many times as wide as the error bound of the closed form, which is the
/// conditioning times the rounding of the inputs: an interval adds the margins of eight units in the last place of every sine
/// and cosine in the equation whose zero it is, with one sign.
const NEAR: f64 = 20.0;

/// Scenes of which every value must be certified.
fn tables() -> Vec<String> {
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
        .filter(|name| !name.starts_with("bandwidth"))
        .collect();
    names.sort();
    names
}

fn table(name: &str) -> Value {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("golden/reference/{name}.json"));
    serde_json::from_str(&std::fs::read_to_string(path).expect("the table")).expect("JSON")
}

/// The quantity of a key: `E_caustic`, `class E`, `root E`, `L`.
fn quantity(key: &str) -> &str {
    if key.starts_with('L') {
        "L"
    } else if key.starts_with("E_tail") {
        "E_tail"
    } else if key.starts_with("paths") && !key.contains(".roots.") {
        "class E"
    } else if key.contains("roots.") && key.ends_with(".E") {
        "root E"
    } else if key.contains("roots.") {
        "root fluence"
    } else {
        key
    }
}

fn relative_width(row: &Row) -> f64 {
    let c = row.certificate.expect("a certificate");
    if c.low == c.high {
        0.0
    } else {
        (c.high - c.low) / f64::abs(c.low).min(f64::abs(c.high))
    }
}

/// The interval of a row and what the closed form says agree, and so do the numbers of rays.
fn assert_consistent(what: &str, report: &Report) {
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

#[test]
fn every_kind_and_quantity() {
    let mut measured: BTreeMap<(String, String), (f64, f64)> = BTreeMap::new();
    let mut near: f64 = 0.0;
    for name in tables() {
        let report = evaluate_certified(&name, &table(&name).to_string()).expect("a good file");
        assert_consistent(&name, &report);
        for placed in report.rows() {
            let row = placed.row;
            let Some(expected) = row.expected else {
                continue;
            };
            let certificate = row.certificate.expect("a certificate");
            assert!(certificate.certified, "{name} {placed:?}");
            // The expected value was rounded to a double.
            let ulp = f64::EPSILON * f64::abs(expected);
            assert!(
                certificate.low <= expected + ulp && expected - ulp <= certificate.high,
                "{name} {placed:?}"
            );
            if row.near_singularity {
                near = near.max((certificate.high - certificate.low) / row.error_bound);
            }
            if row.near_singularity || expected == 0.0 {
                continue;
            }
            let worst = measured
                .entry((name.clone(), quantity(&row.key).to_owned()))
                .or_default();
            worst.0 = worst
                .0
                .max(row.relative_difference.unwrap_or(f64::INFINITY));
            worst.1 = worst.1.max(relative_width(row));
        }
    }
    println!("near singularities: enclosures up to {near:.2} error bounds wide");
    assert!(near <= NEAR, "{near}");
    let mut wrong = vec![];
    for ((scene, quantity), (error, width)) in &measured {
        let allowed = ALLOWED
            .iter()
            .find(|(s, q, ..)| s == scene && q == quantity);
        let ok = allowed.is_some_and(|(_, _, e, w)| error <= e && width <= w);
        let line = format!(
            "    (\"{scene}\", \"{quantity}\", {error:.1e}, {width:.1e}), allowed {allowed:?}"
        );
        println!("{line}");
        if !ok {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (scene, quantity, ..) in ALLOWED {
        let key = ((*scene).to_owned(), (*quantity).to_owned());
        assert!(measured.contains_key(&key), "nothing measured for {key:?}");
    }
}

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
fn tie(parameters: &mut Value) {
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
    if p.get("A").is_none() && p.get("e").is_some() {
        return decimal(&p["a"]) * decimal(&p["e"]) + decimal(&p["delta"]);
    }
    ["z_receiver", "receiver_z", "zr", "Z", "c"]
        .into_iter()
        .find_map(of)
        .or_else(|| of("delta").map(|d| -d))
        .unwrap_or(0.0)
}

/// A variation of a table: other parameters, points and cameras, and no expected values.
fn variation(name: &str, spread: &mut Spread) -> Value {
    let mut file = table(name);
    for c in file["configurations"]
        .as_array_mut()
        .expect("configurations")
    {
        let old = c["parameters"].clone();
        for (key, value) in c["parameters"].as_object_mut().expect("an object") {
            // A light on the wall stays there, a whole sphere whole, a focused beam's receiver inside its annulus.
            let fixed = key == "cap_cos_min" && decimal(value) == -1.0
                || old["light"][0] == "-1.0000000000000000000" && (key == "light" || key == "a");
            if !fixed {
                vary(value, spread);
            }
        }
        tie(&mut c["parameters"]);
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
