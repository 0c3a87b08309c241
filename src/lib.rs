//! nephroid: a test oracle for light transport that ordinary tests cannot judge.

pub mod cli;
pub mod entry;
pub mod error;
pub mod exit;
pub mod film;
pub mod geometry;
pub mod integrators;
pub mod output;
pub mod stream;
