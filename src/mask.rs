//! A user's mask: which pixels of an image count.

use std::io::ErrorKind;
use std::path::Path;

use image::{ImageError, ImageFormat};
use nephroid_analytic::scene::Entry;

use crate::error::Error;

/// A selection of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Mask {
    file: String,
    width: u32,
    height: u32,
    selected: Vec<bool>,
}

impl Mask {
    /// Reads a PNG: a pixel counts if it is brighter than half of white. Transparency is ignored.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, [`Error::Content`] if it is no PNG or selects nothing.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let file = path.display().to_string();
        let content = |message: String| Error::Content {
            file: file.clone(),
            message,
            help: "a PNG in which the pixels that count are white".to_owned(),
        };
        let bytes = std::fs::read(path).map_err(|e| Error::read(&file, e))?;
        let picture =
            image::load_from_memory_with_format(&bytes, ImageFormat::Png).map_err(|e| match e {
                ImageError::IoError(e) if e.kind() == ErrorKind::UnexpectedEof => {
                    content("the PNG ends too early".to_owned())
                }
                other => content(format!("not a PNG that can be read: {other}")),
            })?;
        let grey = picture.to_luma8();
        let selected: Vec<bool> = grey.as_raw().iter().map(|&v| v >= 128).collect();
        if !selected.contains(&true) {
            return Err(content(
                "no pixel is brighter than half of white".to_owned(),
            ));
        }
        let (width, height) = grey.dimensions();
        Ok(Mask {
            file,
            width,
            height,
            selected,
        })
    }

    /// Refuses an image of another size.
    ///
    /// # Errors
    /// [`Error::Parameter`], which names both sizes.
    pub fn fits(&self, entry: &Entry) -> Result<(), Error> {
        let camera = &entry.camera;
        if (self.width, self.height) == (camera.width, camera.height) {
            return Ok(());
        }
        Err(Error::Parameter {
            file: self.file.clone(),
            key: "--mask".to_owned(),
            found: format!("{} x {} pixels", self.width, self.height),
            allowed: format!(
                "{} x {} pixels, the image of {}",
                camera.width, camera.height, entry.name
            ),
        })
    }

    /// The file, as it was named.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Per pixel, row by row from the top, whether it counts.
    pub fn selected(&self) -> &[bool] {
        &self.selected
    }
}
