//! Where certificates take their numbers from: decimal texts, under the names of the reference tables.

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
