//! A file as the judgement sees it: layers of light, each one number per pixel, with their variances where the file has them.

use std::path::Path;

use nephroid_analytic::class::PathClass;

use super::channels::{Channel, Raw, content};
use super::exr_input::{MAGIC, read_channels};
use super::monochrome::{Tint, combine};
use super::names::{Meaning, meaning, split};
use super::pfm;
use crate::error::Error;

/// Files above this are not read.
const LARGEST_FILE: u64 = 1 << 32;

/// An image of another renderer.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// The file, as it was named.
    pub file: String,
    /// The layers of light: the image first, if there is one, then those of classes.
    pub layers: Vec<Layer>,
    /// The pixels that the file covers; `None` for all.
    pub covered: Option<Vec<bool>>,
    /// Layers that hold nothing that is judged.
    pub ignored: Vec<String>,
}

/// A layer of light.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its name in the file; empty for an image without a name.
    pub name: String,
    /// The classes whose sum it is, by position; `None` for all light.
    pub classes: Option<Vec<usize>>,
    /// `[row * width + column]`: radiance, in the renderer's unit.
    pub values: Vec<f64>,
    /// Variance of each pixel's value, where the file tells it.
    pub variance: Option<Variance>,
    /// How far it is from grey, if it is.
    pub tint: Option<Tint>,
}

/// What a file tells of the noise in a layer.
#[derive(Clone, Debug, PartialEq)]
pub enum Variance {
    /// The variance of each pixel's value.
    OfPixel(Vec<f64>),
    /// That of one sample, of which the file does not say how many a pixel has.
    OfSample(Vec<f64>),
}

/// Reads an image of the expected size, of a scene with these classes.
///
/// # Errors
/// [`Error::Io`] for a file that cannot be read, [`Error::Content`] for one whose contents cannot be used.
pub fn read(path: &Path, size: (u32, u32), classes: &[PathClass]) -> Result<Picture, Error> {
    let file = path.display().to_string();
    let io = |e| Error::read(&file, e);
    let length = std::fs::metadata(path).map_err(io)?.len();
    if length > LARGEST_FILE {
        return Err(content(
            &file,
            format!("{length} bytes"),
            format!("at most {LARGEST_FILE} bytes"),
        ));
    }
    let bytes = std::fs::read(path).map_err(io)?;
    of_bytes(&file, &bytes, size, classes)
}

/// The same for a file's bytes.
///
/// # Errors
/// [`Error::Content`] for contents that cannot be used.
pub fn of_bytes(
    file: &str,
    bytes: &[u8],
    size: (u32, u32),
    classes: &[PathClass],
) -> Result<Picture, Error> {
    let raw = if bytes.starts_with(&MAGIC) {
        read_channels(file, bytes, size)?
    } else if bytes.starts_with(b"PF") || bytes.starts_with(b"Pf") {
        pfm::read(file, bytes, size)?
    } else {
        let what = if bytes.is_empty() {
            "an empty file"
        } else {
            "neither OpenEXR nor PFM"
        };
        return Err(content(file, what, "linear radiance as OpenEXR or PFM"));
    };
    picture(file, raw, size.0, classes)
}

/// Channels that belong together, by the name of their layer.
struct Group<'a> {
    name: &'a str,
    components: Vec<(&'a str, &'a Channel)>,
    meaning: Meaning,
}

fn picture(file: &str, raw: Raw, width: u32, classes: &[PathClass]) -> Result<Picture, Error> {
    let mut groups = groups(&raw.channels, classes);
    let is_light = |g: &Group| {
        matches!(
            g.meaning,
            Meaning::Beauty | Meaning::Classes(_) | Meaning::Times(..)
        )
    };
    if !groups.iter().any(is_light) {
        // An image under a name of its own: Mitsuba gives its nested integrators' images theirs.
        let is_colour = |g: &&mut Group| {
            g.meaning == Meaning::Unknown
                && ["R", "G", "B"]
                    .iter()
                    .all(|c| g.components.iter().any(|(n, _)| n == c))
        };
        let mut candidates: Vec<_> = groups.iter_mut().filter(is_colour).collect();
        if let [only] = candidates.as_mut_slice() {
            only.meaning = Meaning::Beauty;
        }
    }
    let covered = raw.covered.as_deref();
    let values_of = |name: &str| -> Result<Option<Vec<f64>>, Error> {
        let Some(group) = groups.iter().find(|g| g.name == name) else {
            return Ok(None);
        };
        Ok(combine(file, width, &group.components, covered)?.map(|m| m.values))
    };
    let mut layers: Vec<Layer> = Vec::new();
    let mut ignored = raw.skipped;
    for group in &groups {
        let (listed, factor) = match &group.meaning {
            Meaning::Beauty => (None, None),
            Meaning::Classes(list) => (Some(list.clone()), None),
            Meaning::Times(list, factor) => (Some(list.clone()), Some(factor)),
            Meaning::Variance { .. } | Meaning::SecondMoment(_) => continue,
            Meaning::Unknown => {
                ignored.push(group.name.to_owned());
                continue;
            }
        };
        let Some(mut found) = combine(file, width, &group.components, covered)? else {
            ignored.push(group.name.to_owned());
            continue;
        };
        if let Some(factor) = factor {
            let Some(by) = values_of(factor)? else {
                ignored.push(format!("{} (without {factor})", group.name));
                continue;
            };
            found.values.iter_mut().zip(&by).for_each(|(v, f)| *v *= f);
        }
        if listed.is_none() && layers.iter().any(|l| l.classes.is_none()) {
            // RGB and RGB_IMAGEPIPELINE, or several view layers: the first counts.
            ignored.push(group.name.to_owned());
            continue;
        }
        layers.push(Layer {
            name: group.name.to_owned(),
            classes: listed,
            values: found.values,
            variance: None,
            tint: found.tint,
        });
    }
    if layers.is_empty() {
        let names: Vec<_> = raw.channels.iter().map(|c| c.name.as_str()).collect();
        return Err(content(
            file,
            format!("no channel of light among {}", names.join(", ")),
            "R, G, B or Y; <CLASS>.Y for a path class; a light path expression; names of Mitsuba, pbrt, LuxCore or Cycles",
        ));
    }
    for group in &groups {
        attach(
            file,
            width,
            group,
            covered,
            raw.samples_per_pixel,
            &mut layers,
        )?;
    }
    layers.sort_by_key(|l| l.classes.is_some());
    Ok(Picture {
        width,
        file: file.to_owned(),
        layers,
        covered: raw.covered,
        ignored,
    })
}

fn groups<'a>(channels: &'a [Channel], classes: &[PathClass]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group> = Vec::new();
    for channel in channels {
        let (name, component) = split(&channel.name);
        match groups.iter_mut().find(|g| g.name == name) {
            Some(group) => group.components.push((component, channel)),
            None => groups.push(Group {
                name,
                components: vec![(component, channel)],
                meaning: meaning(name, classes),
            }),
        }
    }
    groups
}

/// Attaches a layer of variances or second moments to the layer that it is about.
fn attach(
    file: &str,
    width: u32,
    group: &Group,
    covered: Option<&[bool]>,
    samples: Option<f64>,
    layers: &mut [Layer],
) -> Result<(), Error> {
    let target = match &group.meaning {
        Meaning::Variance { .. } => layers.iter_mut().find(|l| l.classes.is_none()),
        Meaning::SecondMoment(of) => {
            let named = layers.iter().position(|l| l.name == *of);
            named
                .or_else(|| layers.iter().position(|l| l.classes.is_none()))
                .map(|i| &mut layers[i])
        }
        _ => return Ok(()),
    };
    let Some(layer) = target else {
        return Ok(());
    };
    let Some(found) = combine(file, width, &group.components, covered)? else {
        return Ok(());
    };
    let mut values = found.values;
    let mut of_sample = true;
    match group.meaning {
        Meaning::Variance { of_sample: single } => of_sample = single,
        // E x² - (E x)², not below zero where rounding makes it so.
        _ => values
            .iter_mut()
            .zip(&layer.values)
            .for_each(|(v, m)| *v = (*v - m * m).max(0.0)),
    }
    layer.variance = Some(match (of_sample, samples) {
        (false, _) => Variance::OfPixel(values),
        (true, Some(n)) => Variance::OfPixel(values.into_iter().map(|v| v / n).collect()),
        (true, None) => Variance::OfSample(values),
    });
    Ok(())
}
