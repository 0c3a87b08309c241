//! `nephroid gate` from outside: images of a renderer that is right, or wrong in a known way, and every bad file.

mod command;
mod exported;
mod files;
mod formats;
mod mistakes;
mod support;
