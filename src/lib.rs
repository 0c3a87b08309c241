//! nephroid: a test oracle for light transport that ordinary tests cannot judge.

pub mod cli;
pub mod diagnosis;
pub mod entry;
pub mod error;
pub mod evaluate;
pub mod exit;
pub mod expectation;
pub mod exr_output;
pub mod extrapolation;
pub mod film;
pub mod geometry;
pub mod golden;
pub mod integrators;
pub mod judge;
pub mod museum;
pub mod output;
pub mod png_output;
pub mod rates;
pub mod regions;
pub mod report;
pub mod stability;
pub mod stream;
pub mod truth;
pub mod variation;
pub mod verify;
