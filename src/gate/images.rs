//! Files as replicates: they must have the same layers and differ by their noise.

use crate::error::Error;
use crate::foreign::channels::content;
use crate::foreign::{Picture, Variance};

use super::stack::Stack;

/// One layer of all files.
#[derive(Clone, Debug, PartialEq)]
pub struct Images {
    /// Its name in the files.
    pub name: String,
    /// The classes whose sum it is, by position; `None` for all light.
    pub classes: Option<Vec<usize>>,
    /// The images.
    pub stack: Stack,
}

/// Refuses files that are no replicates of each other.
///
/// # Errors
/// [`Error::Content`] for a file with other layers or another crop than the first, or the same image as another one.
pub fn check(pictures: &[Picture]) -> Result<(), Error> {
    let Some((first, others)) = pictures.split_first() else {
        return Ok(());
    };
    let shape = |p: &Picture| -> Vec<String> { p.layers.iter().map(|l| shown(&l.name)).collect() };
    for other in others {
        if shape(other) != shape(first) {
            return Err(content(
                &other.file,
                format!(
                    "its layers are {}; those of {} are {}",
                    shape(other).join(", "),
                    first.file,
                    shape(first).join(", ")
                ),
                "files of the same renderer with the same settings",
            ));
        }
        if other.covered != first.covered {
            return Err(content(
                &other.file,
                format!("covers other pixels of the frame than {}", first.file),
                "files with the same crop",
            ));
        }
    }
    let is_same = |a: &Picture, b: &Picture| {
        a.layers
            .iter()
            .zip(&b.layers)
            .all(|(a, b)| a.values == b.values)
    };
    let all_same = others.iter().all(|o| is_same(first, o));
    // A method without noise gives the same image each time: that is no mistake, nor evidence.
    for (k, a) in pictures.iter().enumerate().filter(|_| !all_same) {
        if let Some(b) = pictures[..k].iter().find(|b| is_same(a, b)) {
            return Err(content(
                &a.file,
                format!("the same image as {}", b.file),
                "a seed of its own for each file: what is counted twice looks more certain than it is",
            ));
        }
    }
    Ok(())
}

/// A layer's name for a person.
fn shown(name: &str) -> String {
    if name.is_empty() {
        "the image".to_owned()
    } else {
        name.to_owned()
    }
}

/// The layers of all files in the scene's unit, zero where they are not looked at. `samples` is the number of samples in a
/// pixel, where the files do not say it themselves.
pub fn stacks(
    pictures: &[Picture],
    gain: f64,
    samples: Option<f64>,
    covered: &[bool],
) -> Vec<Images> {
    let Some(first) = pictures.first() else {
        return Vec::new();
    };
    let width = |p: &Picture| p.width as usize;
    let kept = |values: &[f64], scale: f64| -> Vec<f64> {
        values
            .iter()
            .zip(covered)
            .map(|(v, c)| if *c { v * scale } else { 0.0 })
            .collect()
    };
    let layer = |k: usize| {
        let images = pictures
            .iter()
            .map(|p| kept(&p.layers[k].values, 1.0 / gain))
            .collect();
        let variance = |p: &Picture| match (&p.layers[k].variance, samples) {
            (Some(Variance::OfPixel(v)), _) => Some(kept(v, 1.0 / (gain * gain))),
            (Some(Variance::OfSample(v)), Some(n)) => Some(kept(v, 1.0 / (gain * gain * n))),
            _ => None,
        };
        Images {
            name: first.layers[k].name.clone(),
            classes: first.layers[k].classes.clone(),
            stack: Stack {
                width: width(first),
                images,
                variances: pictures.iter().map(variance).collect(),
            },
        }
    };
    (0..first.layers.len()).map(layer).collect()
}

/// What a person should know of how the files were read.
pub fn notes(pictures: &[Picture], samples: Option<f64>) -> Vec<String> {
    let mut notes = Vec::new();
    let Some(first) = pictures.first() else {
        return notes;
    };
    for layer in &first.layers {
        if let Some(tint) = &layer.tint {
            notes.push(format!("{}, {}: {tint}", first.file, shown(&layer.name)));
        }
        if matches!(layer.variance, Some(Variance::OfSample(_))) && samples.is_none() {
            notes.push(format!(
                "{}, {}: the variance is that of one sample, and is used with --spp only",
                first.file,
                shown(&layer.name)
            ));
        }
    }
    if let Some(covered) = &first.covered {
        let count = covered.iter().filter(|c| **c).count();
        notes.push(format!(
            "{}: a crop, {count} of {} pixels",
            first.file,
            covered.len()
        ));
    }
    if !first.ignored.is_empty() {
        notes.push(format!(
            "layers that are not judged: {}",
            first.ignored.join(", ")
        ));
    }
    notes
}
