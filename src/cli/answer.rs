//! What `verify` and `gate` write: text, JSON, JUnit XML, Markdown, and the report.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::output::write_text;
use crate::report::{self, comparison::Comparison};
use crate::verify::verdicts::Outcome;

/// Where the answer goes.
#[derive(clap::Args)]
pub struct Outputs {
    /// Write a page for a person to DIR/report.html, with pictures, and what CI reads beside it: JSON, JUnit XML and Markdown, named
    /// after the command.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Write JSON to a file, or to standard output (then nothing else is printed there).
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    json: Option<PathBuf>,
    /// Write JUnit XML to a file.
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write a Markdown summary to a file.
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
}

impl Outputs {
    /// Prints and writes. The pictures are for the report only.
    pub fn write(&self, outcome: &Outcome, pictures: &[Comparison]) -> Result<(), Error> {
        let json = format!("{:#}\n", report::json::outcome(outcome));
        match &self.json {
            Some(file) if file == Path::new("-") => super::print(json.trim_end()),
            Some(file) => write_text(file, &json)?,
            None => {}
        }
        if self.json.as_deref() != Some(Path::new("-")) {
            super::print(&report::text::outcome(outcome));
        }
        if let Some(file) = &self.junit {
            write_text(file, &junit(outcome, file)?)?;
        }
        if let Some(file) = &self.markdown {
            write_text(file, &report::markdown::outcome(outcome))?;
        }
        if let Some(directory) = &self.report {
            std::fs::create_dir_all(directory)
                .map_err(|e| Error::read(&directory.display().to_string(), e))?;
            let file =
                |ending: &str| directory.join(format!("{}.{ending}", outcome.program.name()));
            write_text(&file("md"), &report::markdown::outcome(outcome))?;
            write_text(&file("json"), &json)?;
            write_text(&file("xml"), &junit(outcome, &file("xml"))?)?;
            let target = directory.join("report.html");
            let page = report::html::page(outcome, pictures)
                .map_err(|message| cannot_write(&target, message))?;
            write_text(&target, &page)?;
        }
        Ok(())
    }
}

fn junit(outcome: &Outcome, file: &Path) -> Result<String, Error> {
    report::junit::outcome(outcome).map_err(|message| cannot_write(file, message))
}

fn cannot_write(file: &Path, message: String) -> Error {
    Error::Content {
        file: file.display().to_string(),
        message,
        help: "scene names of printable characters".to_owned(),
    }
}
