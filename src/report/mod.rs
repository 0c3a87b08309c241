//! The outcome of a suite as text, JSON, JUnit XML, Markdown and a page: pure functions of it.

pub mod comparison;
pub mod html;
pub mod json;
pub mod junit;
pub mod markdown;
pub mod text;
