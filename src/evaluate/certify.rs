//! Certificates for the values of a report: an interval that provably contains each true value.
//!
//! The enclosures come from the decimal texts in the file, not from the numbers that the closed forms were given, and share
//! no formula with them. A JSON number counts as the shortest decimal that is read as the same double: longer decimals must
//! be strings.

use std::collections::BTreeSet;

use nephroid_analytic::certificate::claims::Claim;
use nephroid_analytic::certificate::scene::Scene;
use nephroid_analytic::certificate::source::Source;
use serde_json::Value;

use super::REFERENCE;
use super::report::{Item, Report};

/// What is proven of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// No true value is below this.
    pub low: f64,
    /// No true value is above this; may be infinite.
    pub high: f64,
    /// The number of rays that certainly contribute.
    pub roots: u32,
    /// Whether the number of rays is proven too: `false` on a fold or a shadow's edge to within rounding.
    pub certified: bool,
}

/// A JSON object as a source of decimals; a dot in a key goes one object down.
struct Json<'a>(&'a Value);

impl Source for Json<'_> {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        let at = key.split('.').try_fold(self.0, |v, k| v.get(k))?;
        match indices.iter().try_fold(at, |v, i| v.get(i))? {
            Value::String(s) => Some(s.clone()),
            Value::Number(n) => Some(n.to_string()),
            _ => None,
        }
    }
}

/// Adds certificates to the values of the report of a file of schema [`REFERENCE`], as far as there are any.
pub(super) fn certify(text: &str, report: &mut Report) {
    let Ok(file) = serde_json::from_str::<Value>(text) else {
        return;
    };
    if report.schema != REFERENCE {
        return;
    }
    let list = |v: &Value, key: &str| -> Vec<Value> {
        let array = v.get(key).and_then(Value::as_array);
        array.cloned().unwrap_or_default()
    };
    for (c, configuration) in list(&file, "configurations")
        .iter()
        .zip(&mut report.configurations)
    {
        let Some(parameters) = c.get("parameters") else {
            continue;
        };
        let Some(scene) = Scene::read(&report.scene, &Json(parameters)) else {
            continue;
        };
        let scene = scene.listing(interactions(&configuration.items));
        // Items are points, then views.
        let (points, views) = (list(c, "points"), list(c, "views"));
        let mut items = configuration.items.iter_mut();
        for point in points {
            attach(items.next(), &scene.point_enclosed(&Json(&point)));
        }
        for view in views {
            attach(items.next(), &scene.view_enclosed(&Json(&view)));
        }
    }
}

/// The numbers of specular interactions of all classes in a configuration.
fn interactions(items: &[Item]) -> Vec<u32> {
    let classes = items.iter().flat_map(|i| &i.roots);
    let numbers: BTreeSet<u32> = classes
        .map(|(class, _)| class.matches('S').count() as u32)
        .collect();
    numbers.into_iter().collect()
}

fn attach(item: Option<&mut Item>, claims: &[Claim]) {
    for row in item.into_iter().flat_map(|i| &mut i.rows) {
        let claim = claims.iter().find(|c| c.key == row.key);
        row.certificate = claim.map(|c| Certificate {
            low: c.certified.value.low(),
            high: c.certified.value.high(),
            roots: c.certified.roots,
            certified: c.certified.is_proven(),
        });
    }
}
