//! Images that other renderers write: read, checked and turned into layers of one number per pixel.
//!
//! Formats: OpenEXR (half and float, scan lines and tiles, any number of layers and parts, crops) and PFM. What cannot be
//! read, or read in full, is an error that names file, channel and what is allowed: nothing is guessed, and no file makes
//! the program panic or allocate more than its own size and the expected image justify.
//!
//! Scenes are monochrome. Of a colour layer the mean of R, G and B counts: all three should be equal, so any weights that
//! add up to 1 would do, and these have the least noise. What is not grey beyond rounding is reported.

pub mod channels;
pub mod exr_input;
pub mod lpe;
pub mod monochrome;
pub mod names;
pub mod pfm;
pub mod picture;

pub use picture::{Layer, Picture, Variance, read};
