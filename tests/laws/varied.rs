//! Random variations of the catalogue's entries, and the comparison of two scenes.

use std::cell::{Cell, RefCell};

use nephroid::entry;
use nephroid_analytic::entries::{FloorTruth, PointTruth};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use toml::{Table, Value};

/// Keys that are no lengths.
const PURE: [&str; 11] = [
    "direction",
    "intensity",
    "irradiance",
    "albedo",
    "reflectance",
    "index",
    "eccentricity",
    "phase",
    "normal",
    "edge",
    "up",
];

pub fn is_length(table: &str, key: &str) -> bool {
    let pixels = table == "camera" && (key == "width" || key == "height");
    !PURE.contains(&key) && !key.ends_with("_degrees") && !pixels && key != "wave_vector"
}

/// Applies `f(table, key, index, value)` to every floating-point number of an entry.
pub fn change(entry: &Table, mut f: impl FnMut(&str, &str, usize, f64) -> f64) -> Table {
    fn walk(
        value: &mut Value,
        table: &str,
        key: &str,
        index: usize,
        f: &mut dyn FnMut(&str, &str, usize, f64) -> f64,
    ) {
        match value {
            Value::Float(x) => *x = f(table, key, index, *x),
            Value::Array(list) => {
                for (i, v) in list.iter_mut().enumerate() {
                    walk(v, table, key, i, f);
                }
            }
            Value::Table(inner) => {
                for (k, v) in inner.iter_mut() {
                    walk(v, table, k, 0, f);
                }
            }
            _ => {}
        }
    }
    let mut entry = entry.clone();
    for (key, value) in &mut entry {
        let name = key.clone();
        walk(value, &name, &name, 0, &mut f);
    }
    entry
}

pub fn truth(entry: &Table) -> Option<FloorTruth> {
    FloorTruth::new(&entry::from_toml("varied.toml", &entry.to_string()).ok()?)
}

pub fn catalogue() -> Vec<(String, Table)> {
    let read = |name: &str| {
        let text = std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap();
        (name.to_owned(), text.parse::<Table>().unwrap())
    };
    entry::names()
        .filter(|name| FloorTruth::new(&entry::load(name).unwrap()).is_some())
        .map(read)
        .collect()
}

/// Variations of an entry: every number times 1 ± 4 %, mirror directions apart. Those that validation refuses are skipped,
/// but for most entries most are accepted.
pub fn variations(
    name: &str,
    entry: &Table,
    count: u32,
    mut check: impl FnMut(&Table, &FloorTruth, [f64; 2]),
) {
    free_variations(name, entry, count, |varied, truth, point, _| {
        check(varied, truth, point)
    });
}

/// As [`variations`], with four numbers from -1 to 1 more for whatever else is random.
pub fn free_variations(
    name: &str,
    entry: &Table,
    count: u32,
    check: impl FnMut(&Table, &FloorTruth, [f64; 2], [f64; 4]),
) {
    let config = Config {
        cases: count,
        failure_persistence: None,
        max_global_rejects: 100 * count,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let numbers = proptest::collection::vec(-1.0..1.0_f64, 48);
    let (accepted, check) = (Cell::new(0), RefCell::new(check));
    let outcome = runner.run(&(numbers, 0.02..0.98_f64, 0.02..0.98_f64), |(r, s, t)| {
        let mut n = 0;
        let varied = change(entry, |_, key, _, x| {
            n += 1;
            let fixed = ["normal", "edge", "up", "albedo"].contains(&key);
            if fixed {
                x
            } else {
                x * (1.0 + 0.04 * r[n % r.len()])
            }
        });
        let Some(truth) = truth(&varied) else {
            return Err(TestCaseError::reject("validation"));
        };
        accepted.set(accepted.get() + 1);
        let at = |axis: usize, s: f64| {
            let [low, high] = truth.range(axis);
            low + (high - low) * s
        };
        // Some entries light the middle of their floor only.
        for part in [1.0, 0.5, 0.2] {
            let inner = |s: f64| 0.5 + part * (s - 0.5);
            let point = [at(0, inner(s)), at(1, inner(t))];
            (check.borrow_mut())(&varied, &truth, point, [r[44], r[45], r[46], r[47]]);
        }
        Ok(())
    });
    outcome.unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(accepted.get(), count, "{name}");
}

/// Calls `check` with `count` lists of `N` numbers from -1 to 1.
pub fn random<const N: usize>(count: u32, check: impl FnMut([f64; N])) {
    let config = Config {
        cases: count,
        failure_persistence: None,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[11; 32]);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let check = RefCell::new(check);
    let numbers: [_; N] = std::array::from_fn(|_| -1.0..1.0_f64);
    let outcome = runner.run(&numbers, |r| {
        (check.borrow_mut())(r);
        Ok(())
    });
    outcome.unwrap_or_else(|e| panic!("{e}"));
}

/// The names of all kinds in the catalogue, each once.
pub fn kinds() -> Vec<String> {
    let mut kinds: Vec<_> = entry::names()
        .map(|name| entry::load(name).unwrap().kind.name().to_owned())
        .collect();
    kinds.sort();
    kinds.dedup();
    kinds
}

/// Asserts that a table says something of every kind, once.
pub fn assert_complete<'a>(listed: impl Iterator<Item = &'a str>) {
    let mut listed: Vec<_> = listed.collect();
    listed.sort_unstable();
    assert_eq!(listed, kinds());
}

/// Puts `value` in place of what stands under `key` of a table of an entry.
pub fn set(entry: &mut Table, table: &str, key: &str, value: impl Into<Value>) {
    let inner = entry[table].as_table_mut().unwrap();
    inner.insert(key.to_owned(), value.into());
}

/// A number of an entry.
pub fn get(entry: &Table, table: &str, key: &str) -> f64 {
    entry[table][key].as_float().unwrap()
}

/// A point or direction of an entry.
pub fn get_vector<const N: usize>(entry: &Table, table: &str, key: &str) -> [f64; N] {
    let list = entry[table][key].as_array().unwrap();
    std::array::from_fn(|i| list[i].as_float().unwrap())
}

/// A camera high above a point of the floor that sees a few centimetres of it: no wall is in its frame.
pub fn look_down_at(entry: &mut Table, [x, y]: [f64; 2]) {
    set(entry, "camera", "position", vec![x, y, 12.0]);
    set(entry, "camera", "look_at", vec![x, y, 0.0]);
    set(entry, "camera", "up", vec![0.0, 1.0, 0.0]);
    set(entry, "camera", "field_of_view_degrees", 0.2);
}

/// Whether a value has a bound that is worth comparing: neither on a fold nor on a shadow edge.
pub fn is_clear(p: &PointTruth) -> bool {
    let e = &p.irradiance;
    e.error.is_finite() && e.error <= 1e-6 * e.value
}

/// Asserts that irradiances agree, `factor` times the first with the second, within both bounds.
pub fn assert_same(
    name: &str,
    law: &str,
    first: &[PointTruth],
    second: &[PointTruth],
    factor: f64,
) -> u32 {
    assert_eq!(first.len(), second.len());
    let mut compared = 0;
    for (a, b) in first.iter().zip(second) {
        assert_eq!(a.class, b.class);
        if !(is_clear(a) && is_clear(b)) {
            continue;
        }
        let (left, right) = (a.irradiance.value * factor, b.irradiance.value);
        let bound = a.irradiance.error * factor + b.irradiance.error + 4e-15 * right;
        assert!(
            (left - right).abs() <= bound && a.irradiance.roots == b.irradiance.roots,
            "{name} {law} {}: {left:e} {right:e} ± {bound:e}",
            a.class
        );
        compared += u32::from(a.irradiance.value > 0.0);
    }
    compared
}
