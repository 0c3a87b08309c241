//! nephroid: a test oracle for light transport that ordinary tests cannot judge.

pub mod cli;
pub mod entry;
pub mod error;
pub mod evaluate;
pub mod exit;
pub mod expectation;
pub mod film;
pub mod integrators;
pub mod output;
