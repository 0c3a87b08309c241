//! The reference table of finite bandwidth: every entry, mean and second moment.

use nephroid_analytic::bandwidth::{Expectation, Kernel, PlanarSetting, Technique};
use serde_json::Value;

const TABLE: &str = include_str!("../../../golden/reference/bandwidth-planar-mirror.json");

fn number(v: &Value) -> f64 {
    v.as_str().unwrap().parse().unwrap()
}

fn vector(v: &Value) -> [f64; 3] {
    core::array::from_fn(|i| number(&v[i]))
}

/// Relative agreement that an entry allows: the precision with which it is printed, and 1e-12 for the quadrature.
fn allowed(entry: &Value, key: &str) -> f64 {
    let text = entry[key].as_str().unwrap();
    let digits = text
        .split(['e', 'E'])
        .next()
        .unwrap()
        .trim_start_matches(['0', '.'])
        .chars()
        .filter(char::is_ascii_digit)
        .count();
    1e-12 + libm::pow(10.0, 1.0 - digits as f64)
}

#[test]
fn every_entry_of_the_reference_table() {
    let table: Value = serde_json::from_str(TABLE).unwrap();
    let (mut entries, mut worst) = (0, [0.0_f64; 2]);
    for configuration in table["configurations"].as_array().unwrap() {
        let p = &configuration["parameters"];
        let setting = PlanarSetting::unbounded(
            vector(&p["light"]),
            number(&p["I"]),
            vector(&p["mirror_point"]),
            vector(&p["mirror_normal"]),
            number(&p["R"]),
            [0.0, 0.0, 1.0],
        )
        .unwrap();
        for point in configuration["points"].as_array().unwrap() {
            for entry in point["expectations"].as_array().unwrap() {
                let technique: Technique = entry["technique"].as_str().unwrap().parse().unwrap();
                let kernel: Kernel = entry["kernel"].as_str().unwrap().parse().unwrap();
                let bandwidth = entry.get("alpha").or(entry.get("radius")).unwrap();
                let expectation =
                    Expectation::new(setting.clone(), technique, kernel, &[number(bandwidth)])
                        .unwrap();
                let m = expectation.at(vector(&point["x"]), 1e-13);
                let name = format!("{} {technique} {kernel} {bandwidth}", point["id"]);
                for (k, key, got) in [(0, "E", m.mean), (1, "second_moment", m.second_moment)] {
                    if entry.get(key).is_none() {
                        continue;
                    }
                    let expected = number(&entry[key]);
                    let off = (got.value - expected).abs() / expected;
                    let limit = allowed(entry, key);
                    assert!(off <= limit, "{name} {key}: {} off by {off:e}", got.value);
                    assert!(
                        got.error <= 1e-11 * expected,
                        "{name} {key}: bound {:e}",
                        got.error
                    );
                    if limit < 2e-12 {
                        worst[k] = worst[k].max(off);
                    }
                }
                entries += 1;
            }
        }
    }
    assert_eq!(entries, 368);
    println!("{entries} entries, worst {worst:?}");
}
