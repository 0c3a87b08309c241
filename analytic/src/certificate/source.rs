//! Where certificates take their numbers from: decimal texts, under the names of the reference tables.

use std::collections::BTreeMap;

use crate::certificate::radiometry::Point;
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// Named decimal numbers: the parameters of a configuration, a point or a view of a reference table.
pub trait Source {
    /// The text under `key`, and under `indices` of the (nested) array there; `None` if there is none.
    ///
    /// A number counts as its text; a dot in `key` goes one object down.
    fn text(&self, key: &str, indices: &[usize]) -> Option<String>;

    /// The tightest interval around a number.
    fn number(&self, key: &str) -> Option<Enclosure> {
        Enclosure::from_decimal(&self.text(key, &[])?)
    }

    /// The tightest interval around a number of an array.
    fn entry(&self, key: &str, indices: &[usize]) -> Option<Enclosure> {
        Enclosure::from_decimal(&self.text(key, indices)?)
    }

    /// A whole number.
    fn whole(&self, key: &str) -> Option<u32> {
        self.text(key, &[])?.parse().ok()
    }

    /// A point or direction in space.
    fn point(&self, key: &str) -> Option<Point> {
        Some(vec3(
            self.entry(key, &[0])?,
            self.entry(key, &[1])?,
            self.entry(key, &[2])?,
        ))
    }

    /// Whether anything stands under `key`.
    fn has(&self, key: &str) -> bool {
        self.text(key, &[]).is_some() || self.text(key, &[0]).is_some()
    }
}

/// Parameters of a reference table that are enclosed rather than written.
#[derive(Clone, Debug, Default)]
pub(super) struct Values {
    numbers: BTreeMap<(String, usize), Enclosure>,
    words: BTreeMap<String, String>,
}

impl Values {
    /// Puts a number, or the numbers of an array, under a key.
    pub(super) fn set(&mut self, key: &str, values: &[Enclosure]) -> &mut Self {
        for (i, v) in values.iter().enumerate() {
            self.numbers.insert((key.to_owned(), i), *v);
        }
        self
    }

    /// Puts a word or a whole number under a key.
    pub(super) fn word(&mut self, key: &str, word: impl ToString) -> &mut Self {
        self.words.insert(key.to_owned(), word.to_string());
        self
    }
}

impl Source for Values {
    fn text(&self, key: &str, _: &[usize]) -> Option<String> {
        self.words.get(key).cloned()
    }

    fn number(&self, key: &str) -> Option<Enclosure> {
        self.entry(key, &[0])
    }

    fn entry(&self, key: &str, indices: &[usize]) -> Option<Enclosure> {
        let index = indices.first().copied().unwrap_or(0);
        self.numbers.get(&(key.to_owned(), index)).copied()
    }

    fn has(&self, key: &str) -> bool {
        self.words.contains_key(key) || self.number(key).is_some()
    }
}
