//! `nephroid list`: the catalogue.

use serde_json::json;

use crate::error::Error;
use crate::{entry, exit};

/// List the catalogue: scenes with known answers, and the path classes each carries.
#[derive(clap::Args)]
pub struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entries = entry::names()
        .map(entry::load)
        .collect::<Result<Vec<_>, _>>()?;
    if args.json {
        let scenes: Vec<_> = entries
            .iter()
            .map(|e| {
                let classes: Vec<_> = e.kind.classes().iter().map(ToString::to_string).collect();
                let closure = e.kind.closure();
                json!({
                    "name": e.name,
                    "kind": e.kind.name(),
                    "title": e.title,
                    "classes": classes,
                    "closure": { "longest": closure.longest, "reason": closure.reason },
                })
            })
            .collect();
        super::print(&json!({ "schema": "nephroid-list/1", "scenes": scenes }).to_string());
        return Ok(exit::PASS);
    }
    for e in &entries {
        let classes: Vec<_> = e.kind.classes().iter().map(ToString::to_string).collect();
        super::print(&format!(
            "{:<12} {:<20} {:<34} {}",
            e.name,
            e.kind.name(),
            classes.join(" "),
            e.title
        ));
    }
    Ok(exit::PASS)
}
