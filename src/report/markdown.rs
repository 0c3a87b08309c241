//! For a reviewer: one Markdown file.

use core::fmt::Write as _;

use super::html::words;
use super::text;
use crate::verify::verdicts::{Outcome, Verdict};

/// The whole answer.
pub fn outcome(o: &Outcome) -> String {
    let mut page = format!("# nephroid {}\n\n", o.program.name());
    let _ = writeln!(page, "**{}**\n", words::verdict(o).1);
    for line in text::summary(o).lines() {
        let _ = writeln!(page, "{line}  ");
    }
    page.push_str(
        "\n| scene | integrator | class | verdict | bias | detectable | paths | why |\n\
         | --- | --- | --- | --- | ---: | ---: | ---: | --- |\n",
    );
    for v in &o.verdicts {
        let f = &v.finding;
        let detectable = f
            .minimum_detectable_bias
            .map_or(String::new(), |b| format!("{:.2} %", 100.0 * b));
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {} | {detectable} | {:.1e} | {} |",
            match &v.variation {
                Some(variation) => format!("{}, {variation}", v.scene),
                None => v.scene.clone(),
            },
            v.integrator,
            v.class,
            f.state.word(),
            text::bias(f).unwrap_or_default(),
            v.paths as f64,
            why(v)
        );
    }
    if !o.not_run.is_empty() {
        page.push_str("\n## Not run\n\n");
    }
    for line in text::grouped(&o.not_run) {
        let _ = writeln!(page, "- {line}");
    }
    if !o.notes.is_empty() {
        page.push_str("\n## Notes\n\n");
    }
    for note in &o.notes {
        let _ = writeln!(page, "- {note}");
    }
    let mut commands: Vec<_> = o.verdicts.iter().map(|v| &v.command).collect();
    commands.dedup();
    page.push_str("\n## To reproduce\n\n```\n");
    for command in commands {
        let _ = writeln!(page, "{command}");
    }
    page.push_str("```\n");
    page
}

/// The reason and what it looks like, within a cell of a table.
fn why(v: &Verdict) -> String {
    let parts = [Some(v.finding.reason.as_str()), v.looks_like.as_deref()];
    let parts: Vec<&str> = parts
        .into_iter()
        .flatten()
        .filter(|p| !p.is_empty())
        .collect();
    parts.join("; ").replace('|', "\\|").replace('\n', " ")
}
