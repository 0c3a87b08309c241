//! The gate: images of any renderer, judged against the exact image of the scene.
//!
//! Files are replicates with seeds of their own. What is tested are linear functions of an image: its mean, the means of its
//! tiles, how far it has moved, and, where the image holds all light, the factor of each path class in it. A linear function
//! of a right image has a known expectation, and its spread from image to image is the only noise that is used, so that
//! correlation between pixels does no harm. The verdicts are those of [`crate::judge`].

pub mod blocks;
pub mod calibration;
pub mod checks;
pub mod command;
pub mod exported;
pub mod fit;
pub mod hypotheses;
pub mod images;
pub mod judged;
pub mod pictures;
mod reproduce;
pub mod request;
pub mod stack;
pub mod truths;

pub use request::{Images, Request, run, run_and_draw};
