//! `nephroid export`: a scene for another renderer.

use std::path::PathBuf;

use crate::error::Error;
use crate::export::{self, Format};
use crate::{entry, exit};

/// Write a scene for another renderer: a directory with scene file, meshes, README.md and export.json.
///
/// Seed, paths per pixel and integrator are that renderer's own parameters; the README says how to give them, which path classes
/// the renderer's integrators can sample, and which path depth makes the comparison fair. The same bytes every time.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// The renderer.
    #[arg(long, value_enum)]
    format: Format,
    /// The directory to make. An earlier export is replaced; anything else is left alone.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let export = export::export(&entry, args.format)?;
    export::write(&export, &args.output)?;
    let bytes: usize = export.files.iter().map(|(_, b)| b.len()).sum();
    super::print(&format!(
        "{}: {} files, {:.1} MB; start with README.md",
        args.output.display(),
        export.files.len(),
        bytes as f64 / 1e6
    ));
    if export.pixel_error() > 0.0 {
        super::print(&format!(
            "  meshes change a pixel by at most {:.1e} of the brightest of it and its neighbours",
            export.pixel_error()
        ));
    }
    Ok(exit::PASS)
}
