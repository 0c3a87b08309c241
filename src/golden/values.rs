//! Value tables: the truth at sixteen floor points of an entry, per class.

use std::path::{Path, PathBuf};

use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;
use serde_json::{Value, json};

use super::{Artifact, Comparison};
use crate::error::Error;
use crate::output::write_text;

/// The schema of a table.
const SCHEMA: &str = "nephroid-golden/1";
/// Points on a side of the grid.
const SIDE: u32 = 4;

pub(super) struct ValueTable;

/// The table of an entry.
fn table(entry: &Entry, truth: &FloorTruth) -> Value {
    let mut rows = vec![];
    for k in 0..SIDE * SIDE {
        // Off the symmetric places, where a wrong sign would not show.
        let at = |axis: usize, n: u32, shift: f64| {
            let [low, high] = truth.range(axis);
            low + (high - low) * ((f64::from(n) + shift) / f64::from(SIDE))
        };
        let (x, y) = (at(0, k % SIDE, 0.37), at(1, k / SIDE, 0.59));
        rows.extend(truth.at(x, y).into_iter().map(|t| {
            json!({
                "x": x,
                "y": y,
                "class": t.class.to_string(),
                "E": t.irradiance.value,
                "error_bound": t.irradiance.error,
                "roots": t.irradiance.roots,
            })
        }));
    }
    json!({
        "schema": SCHEMA,
        "command": "nephroid golden --update",
        "scene": entry.name,
        "values": rows,
    })
}

impl Artifact for ValueTable {
    fn file(&self, entry: &Entry) -> Option<PathBuf> {
        FloorTruth::new(entry)?;
        Some(Path::new("values").join(format!("{}.json", entry.name)))
    }

    fn write(&self, entry: &Entry, target: &Path) -> Result<(), Error> {
        match FloorTruth::new(entry) {
            Some(truth) => write_text(target, &format!("{:#}\n", table(entry, &truth))),
            None => Ok(()),
        }
    }

    fn compare(&self, entry: &Entry, stored: &Path) -> Result<Comparison, Error> {
        let shown = stored.display().to_string();
        let text = std::fs::read_to_string(stored).map_err(|e| Error::read(&shown, e))?;
        let content = |message: String| Error::Content {
            file: shown.clone(),
            message,
            help: "allowed: what `nephroid golden --update` writes".to_owned(),
        };
        let stored: Value = serde_json::from_str(&text).map_err(|e| content(e.to_string()))?;
        let Some(truth) = FloorTruth::new(entry) else {
            return Err(content("the scene has no floor".to_owned()));
        };
        let computed = table(entry, &truth);
        if stored == computed {
            return Ok(Comparison::Same);
        }
        let rows = |v: &Value| v["values"].as_array().cloned().unwrap_or_default();
        let (stored, computed) = (rows(&stored), rows(&computed));
        if stored.len() != computed.len() {
            let message = format!("{} values, {} computed", stored.len(), computed.len());
            return Ok(Comparison::Different(message));
        }
        let mut worst = 0.0_f64;
        for (s, c) in stored.iter().zip(&computed) {
            let number = |v: &Value, key: &str| v[key].as_f64().unwrap_or(f64::INFINITY);
            let difference = (number(s, "E") - number(c, "E")).abs();
            let part = difference / (number(s, "error_bound") + number(c, "error_bound"));
            let place = ["x", "y", "class", "roots"].iter().all(|&k| s[k] == c[k]);
            // 0/0, where there is no light, is no difference.
            if !place || part > 1.0 || (part.is_nan() && difference != 0.0) {
                return Ok(Comparison::Different(format!("{s} stored, {c} computed")));
            }
            worst = worst.max(part);
        }
        Ok(Comparison::WithinBounds(worst))
    }
}
