//! What a file holds before anything is known of what its channels mean.

use crate::error::Error;

/// The channels of a file, each over the whole frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Raw {
    /// The channels, in the order of the file.
    pub channels: Vec<Channel>,
    /// The pixels that the file covers, row by row from the top; `None` if it covers the frame.
    pub covered: Option<Vec<bool>>,
    /// Samples in a pixel, if the file says so.
    pub samples_per_pixel: Option<f64>,
    /// Channels that hold no light: whole numbers.
    pub skipped: Vec<String>,
}

/// One channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its full name: `LSDE.Y`, with the name of its part if the file has several.
    pub name: String,
    /// Whether it is stored in 16 bits.
    pub is_half: bool,
    /// `[row * width + column]`, row 0 at the top; zero where the file covers nothing.
    pub values: Vec<f32>,
}

/// An error about a file's contents.
pub fn content(file: &str, message: impl Into<String>, help: impl Into<String>) -> Error {
    Error::Content {
        file: file.to_owned(),
        message: message.into(),
        help: help.into(),
    }
}

/// The error for an image of another size.
pub fn wrong_size(file: &str, (width, height): (u64, u64), (columns, rows): (u32, u32)) -> Error {
    content(
        file,
        format!("the image has {width} x {height} pixels"),
        format!(
            "{columns} x {rows} pixels, as the scene's camera; a crop needs a display window of that size"
        ),
    )
}
