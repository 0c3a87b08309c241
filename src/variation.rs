//! An entry changed in a way of which the effect on its image is known: scaled, moved, brighter, larger, cropped.
//!
//! Entries are changed as TOML, key by key, so that this holds for every kind. What is known about the image needs no
//! formula: it follows from units and from geometry.

use nephroid_analytic::scene::Entry;
use toml::{Table, Value};

use crate::entry;
use crate::error::Error;

/// Keys that are no lengths, wherever they stand.
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

/// Keys that are counts.
const COUNTS: [&str; 1] = ["divisor"];

/// Keys that are positions, which a translation moves.
const POSITIONS: [&str; 3] = ["position", "look_at", "center"];

/// Kinds of which every surface and light has a position of its own, so that the whole scene can be moved.
const MOVABLE: [&str; 2] = ["diffuse", "planar-mirror"];

/// A change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Variation {
    /// All lengths times k.
    Scaled(f64),
    /// Everything moved in the plane of the floor [m].
    Moved([f64; 2]),
    /// The light times k.
    Brighter(f64),
    /// Twice as many rows and columns of the same view.
    Finer,
    /// The middle half of the view's rows and columns.
    Cropped,
}

impl Variation {
    /// What is said of the scene: `scaled by 1000`.
    pub fn name(self) -> String {
        match self {
            Variation::Scaled(k) => format!("scaled by {k}"),
            Variation::Moved([x, y]) => format!("moved by {x}, {y} m"),
            Variation::Brighter(k) => format!("light times {k}"),
            Variation::Finer => "twice the resolution".to_owned(),
            Variation::Cropped => "cropped to the middle".to_owned(),
        }
    }

    /// The factor on lengths, a radius among them.
    pub fn length(self) -> f64 {
        match self {
            Variation::Scaled(k) => k,
            _ => 1.0,
        }
    }

    /// The changed entry and the factor on its radiance (over the part of the image that it shows). `None` if the kind
    /// cannot express the change.
    ///
    /// # Errors
    /// A scene that is not there, or what validation says about the changed one.
    pub fn of(self, scene: &str) -> Result<Option<(Entry, f64)>, Error> {
        let (file, text) = entry::text(scene)?;
        let mut table: Table = match text.parse() {
            Ok(table) => table,
            // The reader's own message is better.
            Err(_) => return entry::from_toml(&file, &text).map(|e| Some((e, 1.0))),
        };
        let has_point_light = table
            .get("light")
            .and_then(Value::as_table)
            .is_some_and(|light| light.contains_key("intensity"));
        let mut factor = 1.0;
        match self {
            Variation::Scaled(k) => {
                change(&mut table, &mut |table, key, _, v| match key {
                    "wave_vector" => v / k,
                    _ if is_length(table, key) => v * k,
                    _ => v,
                });
                if has_point_light {
                    factor = 1.0 / (k * k);
                }
            }
            Variation::Moved(by) => {
                let kind = table.get("kind").and_then(Value::as_str).unwrap_or("");
                if !MOVABLE.contains(&kind) {
                    return Ok(None);
                }
                // A floor without a centre is at the origin.
                if let Some(floor) = table.get_mut("floor").and_then(Value::as_table_mut) {
                    floor
                        .entry("center")
                        .or_insert_with(|| Value::Array(vec![Value::Float(0.0); 2]));
                }
                change(&mut table, &mut |_, key, i, v| {
                    if POSITIONS.contains(&key) && i < 2 {
                        v + by[i]
                    } else {
                        v
                    }
                });
            }
            Variation::Brighter(k) => {
                factor = k;
                change(&mut table, &mut |table, key, _, v| {
                    if table == "light" && ["intensity", "irradiance"].contains(&key) {
                        v * k
                    } else {
                        v
                    }
                });
            }
            Variation::Finer => resize(&mut table, |n| Some(2 * n)),
            Variation::Cropped => {
                // Whole pixels only.
                if camera(&table, "width").is_none_or(|n| n % 4 != 0)
                    || camera(&table, "height").is_none_or(|n| n % 4 != 0)
                {
                    return Ok(None);
                }
                resize(&mut table, |n| Some(n / 2));
                change(&mut table, &mut |_, key, _, v| {
                    if key == "field_of_view_degrees" {
                        let half = libm::tan(0.5 * v.to_radians());
                        2.0 * libm::atan(0.5 * half).to_degrees()
                    } else {
                        v
                    }
                });
            }
        }
        let changed = entry::from_toml(&file, &table.to_string())?;
        Ok(Some((changed, factor)))
    }
}

fn camera(table: &Table, key: &str) -> Option<i64> {
    table.get("camera")?.as_table()?.get(key)?.as_integer()
}

fn resize(table: &mut Table, f: impl Fn(i64) -> Option<i64>) {
    let Some(camera) = table.get_mut("camera").and_then(Value::as_table_mut) else {
        return;
    };
    for key in ["width", "height"] {
        if let Some(n) = camera.get(key).and_then(Value::as_integer).and_then(&f) {
            camera.insert(key.to_owned(), Value::Integer(n));
        }
    }
}

/// Whether a number is a length [m].
pub fn is_length(table: &str, key: &str) -> bool {
    let pixels = table == "camera" && (key == "width" || key == "height");
    !PURE.contains(&key)
        && !COUNTS.contains(&key)
        && !key.ends_with("_degrees")
        && !pixels
        && key != "wave_vector"
}

/// Applies `f(table, key, index, value)` to every number of an entry.
pub fn change(entry: &mut Table, f: &mut dyn FnMut(&str, &str, usize, f64) -> f64) {
    fn walk(
        value: &mut Value,
        table: &str,
        key: &str,
        index: usize,
        f: &mut dyn FnMut(&str, &str, usize, f64) -> f64,
    ) {
        match value {
            Value::Float(x) => *x = f(table, key, index, *x),
            Value::Integer(n) => {
                let x = *n as f64;
                let y = f(table, key, index, x);
                // What is a count stays one.
                if y != x {
                    *value = Value::Float(y);
                }
            }
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
    for (key, value) in entry.iter_mut() {
        let name = key.to_owned();
        walk(value, &name, &name, 0, f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every entry of the catalogue can be scaled, lit, refined and cropped; those that can be moved are.
    #[test]
    fn every_entry_can_be_changed() {
        for name in entry::names() {
            for variation in [
                Variation::Scaled(1e3),
                Variation::Scaled(0.5),
                Variation::Brighter(2.0),
                Variation::Finer,
                Variation::Cropped,
            ] {
                let changed = variation.of(name).unwrap_or_else(|e| panic!("{name}: {e}"));
                assert!(changed.is_some(), "{name} {variation:?}");
            }
        }
        assert!(
            Variation::Moved([1e4, 1e4])
                .of("mirror-wall")
                .unwrap()
                .is_some()
        );
        assert!(Variation::Moved([1e4, 1e4]).of("cup").unwrap().is_none());
        assert!(Variation::Finer.of("no-such-scene").is_err());
    }

    #[test]
    fn the_factors_are_those_of_units() {
        let factor = |v: Variation, name: &str| v.of(name).unwrap().unwrap().1;
        assert_eq!(factor(Variation::Scaled(10.0), "mirror-wall"), 0.01);
        assert_eq!(factor(Variation::Scaled(10.0), "cup"), 1.0);
        assert_eq!(factor(Variation::Brighter(2.0), "cup"), 2.0);
        let (cropped, _) = Variation::Cropped.of("cup").unwrap().unwrap();
        assert_eq!((cropped.camera.width, cropped.camera.height), (64, 64));
    }
}
