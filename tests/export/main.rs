//! Scenes for other renderers: every entry in every format, parsed back, with the geometry that the closed forms mean.

mod commands;
mod files;
mod geometry;

use nephroid::entry;
use nephroid::export::{Export, Format, export};
use nephroid_analytic::scene::Entry;

fn load(name: &str) -> Entry {
    entry::load(name).unwrap()
}

fn exported(name: &str, format: Format) -> Export {
    export(&load(name), format).unwrap()
}

/// The text of an exported file.
fn text(export: &Export, file: &str) -> String {
    let found = export.files.iter().find(|(name, _)| name == file);
    let (_, bytes) = found.unwrap_or_else(|| panic!("no {file}"));
    String::from_utf8(bytes.clone()).unwrap()
}
