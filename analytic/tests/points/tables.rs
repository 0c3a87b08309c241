//! The closed forms against the committed 30-digit tables, per class and per root, without the program's file reader.

use nephroid_analytic::kinds::cylinder_cup::Root;

use crate::reference_table::{configurations, cup, mirror, number, vector, water};

fn check(id: &str, value: f64, error: f64, expected: f64) {
    let difference = (value - expected).abs();
    assert!(
        difference <= error,
        "{id}: {value:e} is {difference:e} off, bound {error:e}"
    );
    assert!(
        difference <= 1e-12 * expected.abs() || error > 1e-12 * expected,
        "{id}"
    );
}

#[test]
fn cup_tables() {
    let mut roots_seen = 0;
    for c in configurations(include_str!("../../../golden/reference/cylinder-cup.json")) {
        let p = &c["parameters"];
        if p.get("x_line").is_some() {
            continue;
        }
        let cup = cup::<f64>(p);
        for point in c["points"].as_array().expect("points") {
            let id = point["id"].as_str().expect("id");
            let x = vector(&point["x"]);
            let direct = cup.direct(x.x, x.y);
            check(id, direct.value, direct.error, number(&point["E_direct"]));
            let (mut value, mut error) = (0.0, 0.0);
            for k in 1..=p["max_bounces"].as_u64().expect("bounces") as u32 {
                let sum = cup.caustic(x.x, x.y, k);
                value += sum.value;
                error += sum.error;
                let mut found: Vec<Root<f64>> = vec![];
                cup.for_each_lit_root(x.x, x.y, k, |r| found.push(r));
                found.sort_by(|a, b| a.phi().total_cmp(&b.phi()));
                let class = format!("L{}DE", "S".repeat(k as usize));
                let empty = vec![];
                let paths = point["paths"].as_array().expect("paths");
                let listed = paths
                    .iter()
                    .find(|q| q["class"] == class.as_str())
                    .map_or(&empty, |q| q["roots"].as_array().expect("roots"));
                assert_eq!(found.len(), listed.len(), "{id} {class}");
                for (f, l) in found.iter().zip(listed) {
                    roots_seen += 1;
                    let room = 1e-15 * (10.0 + cup.conditioning(x.x, x.y, k, f));
                    assert!(
                        (f.phi() - number::<f64>(&l["phi"])).abs() <= room,
                        "{id} {f:?}"
                    );
                    assert!(
                        (f.wall_z - number::<f64>(&l["wall_z"])).abs() <= room,
                        "{id} {f:?}"
                    );
                    let e: f64 = number(&l["E"]);
                    assert!((f.irradiance - e).abs() <= room * 16.0 * e, "{id} {f:?}");
                }
            }
            check(id, value, error, number(&point["E_caustic"]));
        }
    }
    assert_eq!(roots_seen, 116);
}

#[test]
fn mirror_tables() {
    for c in configurations(include_str!("../../../golden/reference/planar-mirror.json")) {
        let p = &c["parameters"];
        let mirror = mirror::<f64>(p);
        for point in c["points"].as_array().expect("points") {
            let id = point["id"].as_str().expect("id");
            let x = vector(&point["x"]);
            let (direct, caustic) = (mirror.direct(x), mirror.caustic(x));
            check(id, direct.value, direct.error, number(&point["E_direct"]));
            check(
                id,
                caustic.value,
                caustic.error,
                number(&point["E_caustic"]),
            );
        }
    }
}

#[test]
fn interface_tables() {
    for c in configurations(include_str!(
        "../../../golden/reference/flat-interface.json"
    )) {
        let p = &c["parameters"];
        let water = water::<f64>(p);
        for point in c["points"].as_array().expect("points") {
            let id = point["id"].as_str().expect("id");
            let x = vector(&point["x"]);
            let (direct, caustic) = (water.direct(x.x, x.y), water.caustic(x.x, x.y));
            check(id, direct.value, direct.error, number(&point["E_direct"]));
            check(
                id,
                caustic.value,
                caustic.error,
                number(&point["E_caustic"]),
            );
        }
    }
}
