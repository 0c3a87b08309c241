//! What the description of an exported scene (`export.json`) tells the gate: by how much its meshes change a pixel.

use std::path::{Path, PathBuf};

use nephroid_analytic::scene::Entry;
use serde_json::Value;

use crate::error::Error;

/// An exported scene from which the images were rendered.
#[derive(Clone, Debug, PartialEq)]
pub struct Exported {
    directory: PathBuf,
    /// Largest error of a pixel's radiance, relative to the brightest of the pixel and its eight neighbours.
    pub pixel_error: f64,
}

impl Exported {
    /// Reads `export.json` in a directory that `nephroid export` wrote for this entry.
    ///
    /// # Errors
    /// A file that cannot be read, is no such description, or is one of another scene.
    pub fn read(directory: &Path, entry: &Entry) -> Result<Self, Error> {
        let path = directory.join("export.json");
        let file = path.display().to_string();
        let text = std::fs::read_to_string(&path).map_err(|source| Error::Io {
            file: file.clone(),
            source,
        })?;
        let wrong = |key: &str, found: String, allowed: String| Error::Parameter {
            file: file.clone(),
            key: key.to_owned(),
            found,
            allowed,
        };
        let value: Value = serde_json::from_str(&text).map_err(|e| {
            wrong(
                "schema",
                format!("no JSON ({e})"),
                "the export.json of `nephroid export`".to_owned(),
            )
        })?;
        let is = |key: &str, expected: &str| match value[key].as_str() {
            Some(found) if found == expected => Ok(()),
            _ => Err(wrong(key, value[key].to_string(), expected.to_owned())),
        };
        is("schema", "nephroid-export/1")?;
        is("scene", &entry.name)?;
        let error = &value["tessellation"]["pixel_error"];
        let pixel_error = error.as_f64().filter(|e| (0.0..=1.0).contains(e));
        let pixel_error = pixel_error.ok_or_else(|| {
            wrong(
                "tessellation.pixel_error",
                error.to_string(),
                "a number from 0 to 1".to_owned(),
            )
        })?;
        Ok(Exported {
            directory: directory.to_owned(),
            pixel_error,
        })
    }

    /// The directory.
    pub fn directory(&self) -> String {
        self.directory.display().to_string()
    }
}

/// The largest of each value and its eight neighbours.
pub(super) fn brightest_about(layer: &[f64], width: usize) -> Vec<f64> {
    let height = layer.len() / width.max(1);
    let row_max = |j: usize| -> Vec<f64> {
        let row = &layer[j * width..(j + 1) * width];
        let about = |i: usize| &row[i.saturating_sub(1)..(i + 2).min(width)];
        (0..width)
            .map(|i| about(i).iter().copied().fold(0.0, f64::max))
            .collect()
    };
    let rows: Vec<Vec<f64>> = (0..height).map(row_max).collect();
    (0..height)
        .flat_map(|j| {
            let about = &rows[j.saturating_sub(1)..(j + 2).min(height)];
            (0..width).map(move |i| about.iter().map(|r| r[i]).fold(0.0, f64::max))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::brightest_about;

    #[test]
    fn a_pixel_has_eight_neighbours() {
        let mut layer = vec![0.0; 20];
        layer[7] = 3.0;
        let found = brightest_about(&layer, 5);
        let near: Vec<usize> = (0..20).filter(|&k| found[k] == 3.0).collect();
        assert_eq!(near, [1, 2, 3, 6, 7, 8, 11, 12, 13]);
    }
}
