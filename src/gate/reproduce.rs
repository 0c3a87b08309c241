//! The command that gives the same verdicts again.

use super::request::{Images, LEVEL, MARGIN, Request};
use crate::verify::run::quoted;

/// The command line, with what is not the default.
pub fn command(request: &Request) -> String {
    let mut text = format!("nephroid gate {}", quoted(&request.argument));
    let mut add = |option: &str, value: String| {
        text.push_str(&format!(" {option} {value}"));
    };
    match &request.images {
        Images::Files(files) => {
            for file in files {
                add(&quoted(&file.display().to_string()), String::new());
            }
        }
        Images::Command(command, most) => {
            add("--command", quoted(command.text()));
            if command.is_shell() {
                add("--shell", String::new());
            }
            add("--budget", most.to_string());
            add("--seed", request.seed.to_string());
        }
    }
    if request.margin != MARGIN {
        add("--margin", request.margin.to_string());
    }
    if request.level != LEVEL {
        add("--level", request.level.to_string());
    }
    for &class in &request.cannot {
        add("--cannot", request.entry.kind.classes()[class].to_string());
    }
    if let Some(how) = request.regularization {
        add("--technique", how.technique.to_string());
        add("--bandwidth", how.bandwidth.to_string());
        add("--kernel", how.kernel.to_string());
    }
    if request.gain != 1.0 {
        add("--gain", request.gain.to_string());
    }
    if request.offset != [0.0; 2] {
        add(
            "--offset",
            format!("{},{}", request.offset[0], request.offset[1]),
        );
    }
    if let Some(mask) = &request.mask {
        add("--mask", quoted(mask.file()));
    }
    if let Some(exported) = &request.exported {
        add("--exported", quoted(&exported.directory()));
    }
    if let Some(samples) = request.samples {
        add("--spp", samples.to_string());
    }
    let words: Vec<&str> = text.split_inclusive(' ').collect();
    // Options without a value leave two blanks.
    words.concat().replace("  ", " ").trim_end().to_owned()
}
