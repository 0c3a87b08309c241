//! `nephroid golden`: the truth as stored bytes.

use std::path::PathBuf;

use crate::error::Error;
use crate::exit;
use crate::golden::{Comparison, check, update};

/// Compare the stored truth of the catalogue with what is computed now, or store it anew.
///
/// An image (48×48 pixels, tolerance 1e-9) and a table of values for every entry. Other bits are not different as long as
/// every value is within both sides' error bounds; exit code 1 if one is not.
#[derive(clap::Args)]
#[command(group = clap::ArgGroup::new("action").required(true).args(["check", "update"]))]
pub struct Args {
    /// Recompute and compare.
    #[arg(long)]
    check: bool,
    /// Recompute and write. Refused where the environment variable CI is set.
    #[arg(long)]
    update: bool,
    /// Only this entry of the catalogue; may be given several times.
    #[arg(long, value_name = "SCENE")]
    scene: Vec<String>,
    /// The folder of the golden files.
    #[arg(long, value_name = "DIR", default_value = "golden")]
    directory: PathBuf,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    if args.update {
        if std::env::var_os("CI").is_some_and(|v| !v.is_empty()) {
            return Err(Error::Parameter {
                file: "command line".to_owned(),
                key: "--update".to_owned(),
                found: "given where CI is set".to_owned(),
                allowed: "--check in CI; --update where a person reads the difference".to_owned(),
            });
        }
        let written = update(&args.directory, &args.scene)?;
        super::print(&format!(
            "{written} files written to {}",
            args.directory.display()
        ));
        return Ok(exit::PASS);
    }
    let outcomes = check(&args.directory, &args.scene)?;
    let (mut same, mut different) = (0, 0);
    for outcome in &outcomes {
        let file = outcome.file.display();
        match &outcome.comparison {
            Comparison::Same => same += 1,
            Comparison::WithinBounds(part) => {
                super::print(&format!(
                    "{file}: other bits, {part:.2} of the bounds at most"
                ));
            }
            Comparison::Different(what) => {
                different += 1;
                super::print(&format!("{file}: different: {what}"));
            }
        }
    }
    super::print(&format!(
        "{} files: {same} the same to the bit, {different} different",
        outcomes.len()
    ));
    Ok(if different > 0 {
        exit::DIFFERENT
    } else {
        exit::PASS
    })
}
