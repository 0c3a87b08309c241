//! Golden files: the truth as stored bytes, so that a change of a value is seen, whatever made it.
//!
//! For every entry of the catalogue a small image and a table of values at floor points. They are recomputed and compared:
//! equal, or within what both sides' error bounds allow, or different. They guard against change; what is right is told by
//! `golden/reference`, which this project's code did not make.

mod image;
mod values;

use std::path::{Path, PathBuf};

use nephroid_analytic::scene::Entry;

use crate::entry;
use crate::error::Error;

/// How a stored file compares with what is computed now.
#[derive(Clone, Debug, PartialEq)]
pub enum Comparison {
    /// The same to the last bit.
    Same,
    /// Other bits, but every value within both sides' bounds; the largest difference as a part of its bound.
    WithinBounds(f64),
    /// What differs.
    Different(String),
}

/// One stored file.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The file, relative to the folder of golden files.
    pub file: PathBuf,
    /// How it compares.
    pub comparison: Comparison,
}

/// What makes and compares one kind of file.
trait Artifact {
    /// The file of an entry, relative to the folder of golden files; `None` if the entry has no such file.
    fn file(&self, entry: &Entry) -> Option<PathBuf>;

    /// Computes the file and writes it.
    fn write(&self, entry: &Entry, target: &Path) -> Result<(), Error>;

    /// Reads the file and compares it with what is computed now.
    fn compare(&self, entry: &Entry, stored: &Path) -> Result<Comparison, Error>;
}

const ARTIFACTS: [&dyn Artifact; 2] = [&image::TruthFile, &values::ValueTable];

fn for_each(
    directory: &Path,
    scenes: &[String],
    mut action: impl FnMut(&dyn Artifact, &Entry, &Path, PathBuf) -> Result<(), Error>,
) -> Result<(), Error> {
    for name in names(scenes)? {
        let entry = entry::load(name)?;
        for artifact in ARTIFACTS {
            if let Some(file) = artifact.file(&entry) {
                action(artifact, &entry, &directory.join(&file), file)?;
            }
        }
    }
    Ok(())
}

/// The entries that are asked for: all of them if none is named.
fn names(scenes: &[String]) -> Result<Vec<&'static str>, Error> {
    if let Some(unknown) = scenes.iter().find(|s| !entry::names().any(|n| n == *s)) {
        return Err(Error::UnknownName {
            what: "entry of the catalogue",
            found: unknown.clone(),
            allowed: entry::names().collect::<Vec<_>>().join(", "),
        });
    }
    Ok(entry::names()
        .filter(|n| scenes.is_empty() || scenes.iter().any(|s| s == n))
        .collect())
}

/// Recomputes and compares the files of some entries, or of all if `scenes` is empty.
///
/// # Errors
/// [`Error::UnknownName`] for a name that the catalogue does not have; [`Error::Io`] for a file that is missing or unreadable, [`Error::Content`] for one that is not what it should be.
pub fn check(directory: &Path, scenes: &[String]) -> Result<Vec<Outcome>, Error> {
    let mut outcomes = vec![];
    for_each(directory, scenes, |artifact, entry, path, file| {
        let comparison = artifact.compare(entry, path)?;
        outcomes.push(Outcome { file, comparison });
        Ok(())
    })?;
    Ok(outcomes)
}

/// Recomputes and writes the files of some entries, or of all if `scenes` is empty; returns how many.
///
/// # Errors
/// [`Error::UnknownName`] for a name that the catalogue does not have; [`Error::Io`] if a file cannot be written.
pub fn update(directory: &Path, scenes: &[String]) -> Result<usize, Error> {
    let mut written = 0;
    for_each(directory, scenes, |artifact, entry, path, _| {
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)
                .map_err(|e| Error::read(&parent.display().to_string(), e))?;
        }
        artifact.write(entry, path)?;
        written += 1;
        Ok(())
    })?;
    Ok(written)
}
