//! The outcome of a suite as text, JSON, JUnit XML and Markdown: pure functions of it.

pub mod json;
pub mod junit;
pub mod markdown;
pub mod text;
