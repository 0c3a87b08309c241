//! Laws that every closed form obeys, whatever its formula: on random variations of every entry of the catalogue.
//!
//! Entries are changed as TOML, key by key, so that the laws hold for kinds to come without a line here. No expected value
//! comes from the code: each law compares two scenes that it makes itself.

use std::cell::{Cell, RefCell};

use nephroid::entry;
use nephroid_analytic::entries::{FloorTruth, PointTruth};
use nephroid_analytic::kinds::singularity::SingularityKind;
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

fn is_length(table: &str, key: &str) -> bool {
    let pixels = table == "camera" && (key == "width" || key == "height");
    !PURE.contains(&key) && !key.ends_with("_degrees") && !pixels && key != "wave_vector"
}

/// Applies `f(table, key, index, value)` to every floating-point number of an entry.
fn change(entry: &Table, mut f: impl FnMut(&str, &str, usize, f64) -> f64) -> Table {
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

fn truth(entry: &Table) -> Option<FloorTruth> {
    FloorTruth::new(&entry::from_toml("varied.toml", &entry.to_string()).ok()?)
}

fn catalogue() -> Vec<(String, Table)> {
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
fn variations(
    name: &str,
    entry: &Table,
    count: u32,
    check: impl FnMut(&Table, &FloorTruth, [f64; 2]),
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
            (check.borrow_mut())(&varied, &truth, [at(0, inner(s)), at(1, inner(t))]);
        }
        Ok(())
    });
    outcome.unwrap_or_else(|e| panic!("{name}: {e}"));
    assert_eq!(accepted.get(), count, "{name}");
}

/// Whether a value has a bound that is worth comparing: neither on a fold nor on a shadow edge.
fn is_clear(p: &PointTruth) -> bool {
    let e = &p.irradiance;
    e.error.is_finite() && e.error <= 1e-6 * e.value
}

/// Asserts that irradiances agree, `factor` times the first with the second, within both bounds.
fn assert_same(
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

/// E(kx) of the scene enlarged k times is E(x)/k² under a point light, E(x) under parallel light.
#[test]
fn irradiance_scales_with_the_scene() {
    for (name, entry) in catalogue() {
        let point_light = entry["light"].get("intensity").is_some();
        let mut compared = 0;
        variations(&name, &entry, 12, |varied, truth, [x, y]| {
            for k in [3.7, 0.013] {
                let scaled = change(varied, |table, key, _, v| match key {
                    "wave_vector" => v / k,
                    _ if is_length(table, key) => v * k,
                    _ => v,
                });
                let larger = self::truth(&scaled).expect("a scaled entry is as valid");
                let factor = if point_light { 1.0 / (k * k) } else { 1.0 };
                let (a, b) = (truth.at(x, y), larger.at(k * x, k * y));
                compared += assert_same(&name, "scaling", &a, &b, factor);
            }
        });
        assert!(compared >= 10, "{name}: {compared}");
    }
}

/// Twice the light is twice the irradiance, to the bit.
#[test]
fn irradiance_is_proportional_to_the_light() {
    for (name, entry) in catalogue() {
        variations(&name, &entry, 6, |varied, truth, [x, y]| {
            let twice = change(varied, |_, key, _, v| match key {
                "intensity" | "irradiance" => 2.0 * v,
                _ => v,
            });
            let brighter = self::truth(&twice).expect("as valid");
            for (a, b) in truth.at(x, y).iter().zip(brighter.at(x, y)) {
                assert_eq!(
                    2.0 * a.irradiance.value,
                    b.irradiance.value,
                    "{name} {}",
                    a.class
                );
            }
        });
    }
}

/// Kinds whose surfaces are not mapped to themselves by y → -y, other than through keys that are coordinates.
const HANDED: [&str; 1] = ["planar-chains"];

/// The scene mirrored at the plane y = 0 has the mirrored irradiance.
#[test]
fn irradiance_has_the_symmetry_of_space() {
    const POINTS: [&str; 9] = [
        "focus",
        "direction",
        "position",
        "center",
        "look_at",
        "normal",
        "edge",
        "up",
        "wave_vector",
    ];
    for (name, entry) in catalogue() {
        if HANDED.contains(&entry["kind"].as_str().unwrap()) {
            continue;
        }
        let mut compared = 0;
        variations(&name, &entry, 12, |varied, truth, [x, y]| {
            let mirrored = change(varied, |_, key, i, v| {
                if POINTS.contains(&key) && i == 1 || key == "azimuth_degrees" {
                    -v
                } else {
                    v
                }
            });
            let other = self::truth(&mirrored).expect("a mirrored entry is as valid");
            compared += assert_same(&name, "symmetry", &truth.at(x, y), &other.at(x, -y), 1.0);
        });
        assert!(compared >= 5, "{name}: {compared}");
    }
}

/// Two roots appear or vanish together across a fold. Across a shadow edge, which is no singularity, it may be one.
#[test]
fn the_number_of_roots_changes_by_two_across_a_fold() {
    let mut folds = 0;
    for (name, entry) in catalogue() {
        let truth = truth(&entry).unwrap();
        let at = |s: f64, t: f64| {
            let point = |axis: usize, s: f64| {
                let [low, high] = truth.range(axis);
                low + (high - low) * s
            };
            (point(0, s), point(1, t))
        };
        let lines = [0.137, 0.291, 0.418, 0.503, 0.632, 0.779];
        for (t, across) in lines.into_iter().flat_map(|t| [(t, false), (t, true)]) {
            let place = |s: f64| if across { at(t, s) } else { at(s, t) };
            let along = |s: f64| {
                let (x, y) = place(s);
                truth.at(x, y)
            };
            let steps = 96;
            for k in 0..steps {
                let (a, b) = (
                    f64::from(k) / f64::from(steps),
                    f64::from(k + 1) / f64::from(steps),
                );
                let (first, last) = (along(a), along(b));
                for c in 0..first.len() {
                    let roots = |p: &[PointTruth]| p[c].irradiance.roots;
                    if roots(&first) == roots(&last) {
                        continue;
                    }
                    // Bisection to a change between neighbours 1e-9 apart.
                    let (mut low, mut high) = (a, b);
                    for _ in 0..24 {
                        let middle = 0.5 * (low + high);
                        if roots(&along(middle)) == roots(&first) {
                            low = middle;
                        } else {
                            high = middle;
                        }
                    }
                    let (p, q) = (along(low)[c], along(high)[c]);
                    let near = [low, high]
                        .into_iter()
                        .filter_map(|s| {
                            let (x, y) = place(s);
                            truth.singularity(x, y, c)
                        })
                        .any(|s| s.kind == SingularityKind::Fold && s.distance < 1e-6);
                    let change = p.irradiance.roots.abs_diff(q.irradiance.roots);
                    if near {
                        folds += 1;
                        assert_eq!(change, 2, "{name} {} {p:?} {q:?}", p.class);
                    } else {
                        // A shadow edge takes whole branches with it; the irradiance stays finite.
                        let larger = p.irradiance.value.max(q.irradiance.value);
                        assert!(larger.is_finite() && larger < 1e4, "{name} {p:?} {q:?}");
                    }
                }
            }
        }
    }
    assert!(folds >= 3, "{folds}");
}
