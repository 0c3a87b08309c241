//! `nephroid probe --certify`: intervals from the decimals of the scene's file and of the points.

use nephroid_analytic::certificate::Certified;
use nephroid_analytic::certificate::entry::CertifiedEntry;
use nephroid_analytic::certificate::source::Source;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::enclosure::Enclosure;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::scene::Entry;
use serde_json::{Value, json};
use toml::de::{DeTable, DeValue};

use crate::entry;
use crate::error::Error;

/// A TOML document as a source of decimals; a dot in a key goes one table, or one place of an array, down.
struct Decimals<'a>(&'a DeTable<'a>);

fn written(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::Float(f) => Some(f.as_str().to_owned()),
        DeValue::Integer(i) if i.radix() == 10 => Some(i.as_str().to_owned()),
        DeValue::String(s) => Some(s.to_string()),
        _ => None,
    }
}

impl Source for Decimals<'_> {
    fn text(&self, key: &str, indices: &[usize]) -> Option<String> {
        let mut steps = key.split('.');
        let mut at = self.0.get(steps.next()?)?.get_ref();
        for step in steps {
            at = match at {
                DeValue::Table(table) => table.get(step)?.get_ref(),
                DeValue::Array(array) => array.get(step.parse::<usize>().ok()?)?.get_ref(),
                _ => return None,
            };
        }
        for &i in indices {
            at = at.as_array()?.get(i)?.get_ref();
        }
        written(at)
    }
}

/// What is proven of the irradiance of a class at a point.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    enclosure: Option<[f64; 2]>,
    roots: Option<u32>,
    /// Why value or number of rays are not proven; `None` if they are.
    missing: Option<&'static str>,
}

impl Proof {
    /// The columns of [`Self::fields`].
    pub const HEADER: &'static str = ",low,high,proven_roots,certified";

    fn none(why: &'static str) -> Self {
        Proof {
            enclosure: None,
            roots: None,
            missing: Some(why),
        }
    }

    fn of(certified: Certified) -> Self {
        let value = certified.value;
        let missing = if certified.is_proven() {
            None
        } else if value.is_finite() {
            Some("the edge of a shadow or a mirror is within rounding")
        } else {
            Some("a fold or focus is within rounding")
        };
        Proof {
            enclosure: Some([value.low(), value.high()]),
            roots: (!certified.undecided).then_some(certified.roots),
            missing,
        }
    }

    /// Adds the keys `enclosure`, `proven_roots`, `certified` and, if that is false, `not_certified` with the reason.
    pub fn add_to(&self, answer: &mut Value) {
        let end = |v: f64| if v.is_finite() { json!(v) } else { Value::Null };
        answer["enclosure"] = self
            .enclosure
            .map_or(Value::Null, |[low, high]| json!([end(low), end(high)]));
        answer["proven_roots"] = json!(self.roots);
        answer["certified"] = json!(self.missing.is_none());
        if let Some(why) = self.missing {
            answer["not_certified"] = json!(why);
        }
    }

    /// The fields of [`Self::HEADER`], each after a comma.
    pub fn fields(&self) -> String {
        let [low, high] = match self.enclosure {
            Some(ends) => ends.map(|v| format!("{v:e}")),
            None => [String::new(), String::new()],
        };
        let roots = self.roots.map_or(String::new(), |r| r.to_string());
        match self.missing {
            None => format!(",{low},{high},{roots},certified"),
            Some(why) => format!(",{low},{high},{roots},not certified: {why}"),
        }
    }
}

/// The certificates of an entry.
pub struct Certifier {
    entry: Option<CertifiedEntry>,
}

impl Certifier {
    /// For a scene that has been loaded as `entry`.
    ///
    /// # Errors
    /// If the scene's file can no longer be read.
    pub fn new(scene: &str, entry: &Entry) -> Result<Self, Error> {
        let (_, text) = entry::source(scene)?;
        let document = DeTable::parse(&text).ok();
        let read = |table: &DeTable<'_>| CertifiedEntry::read(entry, &Decimals(table));
        Ok(Certifier {
            entry: document.and_then(|d| read(d.get_ref())),
        })
    }

    /// The proof for each of `classes` at the floor point with these decimals.
    pub fn at(&self, decimals: &[String; 2], classes: &[PathClass]) -> Vec<Proof> {
        let none = |why| vec![Proof::none(why); classes.len()];
        let Some(entry) = &self.entry else {
            return none("this scene has no certificate");
        };
        let number = |text: &String| Enclosure::from_decimal(text);
        let (Some(x), Some(y)) = (number(&decimals[0]), number(&decimals[1])) else {
            return none("the point is not written in decimals");
        };
        let claims = entry.classes_enclosed(x, y, classes);
        let proof = |claim: Option<Certified>| {
            claim.map_or(Proof::none("this class has no certificate here"), Proof::of)
        };
        claims.into_iter().map(proof).collect()
    }
}
