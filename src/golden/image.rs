//! Truth images: what `nephroid render ENTRY --size 48x48 --tolerance 1e-9` writes.

use std::path::{Path, PathBuf};

use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use nephroid_analytic::scene::Entry;

use super::{Artifact, Comparison};
use crate::error::Error;
use crate::exr_output::{metadata, rounding_error, write_exr};
use crate::truth;

/// Pixels on a side.
const SIDE: u32 = 48;
/// Relative tolerance.
const TOLERANCE: f64 = 1e-9;

pub(super) struct TruthFile;

fn sized(entry: &Entry) -> Entry {
    let mut entry = entry.clone();
    (entry.camera.width, entry.camera.height) = (SIDE, SIDE);
    entry
}

impl Artifact for TruthFile {
    fn file(&self, entry: &Entry) -> Option<PathBuf> {
        Some(Path::new("images").join(format!("{}.exr", entry.name)))
    }

    fn write(&self, entry: &Entry, target: &Path) -> Result<(), Error> {
        let entry = sized(entry);
        let channels = truth::image(&entry, TOLERANCE).channels();
        let layers: Vec<_> = channels
            .iter()
            .map(|(name, values)| (name.clone(), values.as_slice()))
            .collect();
        write_exr(target, SIDE, SIDE, &layers, &metadata(&entry))
    }

    fn compare(&self, entry: &Entry, stored: &Path) -> Result<Comparison, Error> {
        let shown = stored.display().to_string();
        let content = |message: String| Error::Content {
            file: shown.clone(),
            message,
            help: "allowed: what `nephroid golden --update` writes".to_owned(),
        };
        std::fs::metadata(stored).map_err(|e| Error::read(&shown, e))?;
        let file = read_all_flat_layers_from_file(stored)
            .map_err(|e| content(format!("not a readable OpenEXR file: {e}")))?;
        let [layer] = &file.layer_data[..] else {
            return Err(content("several parts".to_owned()));
        };
        let image = truth::image(&sized(entry), TOLERANCE);
        let (_, bounds) = image.total();
        let (mut same, mut worst) = (true, 0.0_f64);
        let channels = image.channels();
        if layer.channel_data.list.len() != channels.len() {
            let found = layer.channel_data.list.len();
            let message = format!("{found} channels, {} computed", channels.len());
            return Ok(Comparison::Different(message));
        }
        for (name, values) in &channels {
            let list = &layer.channel_data.list;
            let Some(channel) = list.iter().find(|c| c.name.to_string() == *name) else {
                return Ok(Comparison::Different(format!("no channel {name}")));
            };
            let FlatSamples::F32(found) = &channel.sample_data else {
                return Err(content(format!("channel {name} is not of 32-bit floats")));
            };
            if found.len() != values.len() {
                return Ok(Comparison::Different("another size".to_owned()));
            }
            for (k, (&found, &value)) in found.iter().zip(values).enumerate() {
                if found == value as f32 {
                    continue;
                }
                same = false;
                if name == "error.Y" {
                    continue;
                }
                // Both were computed, and both were rounded.
                let bound =
                    2.0 * (bounds[k] + rounding_error(value)) + value * f64::from(f32::EPSILON);
                let part = (f64::from(found) - value).abs() / bound;
                if !(part <= 1.0) {
                    let (column, row) = (k % SIDE as usize, k / SIDE as usize);
                    return Ok(Comparison::Different(format!(
                        "{name} at column {column}, row {row}: {found:e} stored, {value:e} computed"
                    )));
                }
                worst = worst.max(part);
            }
        }
        Ok(if same {
            Comparison::Same
        } else {
            Comparison::WithinBounds(worst)
        })
    }
}
