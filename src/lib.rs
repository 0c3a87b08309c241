//! nephroid: a test oracle for light transport that ordinary tests cannot judge.

pub mod entry;
pub mod error;
pub mod film;
pub mod integrators;
