//! One self-contained page for a person: the verdict in words, pictures, every figure and the command that gives it again.
//!
//! No script, no network: style and pictures are part of the file. It holds no times, so the same verdicts are the same
//! bytes.

mod histogram;
mod pictures;
mod table;
pub(super) mod words;

use core::fmt::Write as _;

use super::comparison::Comparison;
use super::text;
use crate::verify::verdicts::{Outcome, Program, Verdict};

const STYLE: &str = include_str!("style.css");

/// The whole page.
///
/// # Errors
/// What the writer of pictures says.
pub fn page(o: &Outcome, comparisons: &[Comparison]) -> Result<String, String> {
    let name = o.program.name();
    let (state, verdict) = words::verdict(o);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <title>nephroid {name}: {}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <a class=\"skip\" href=\"#pairs\">Skip to the pictures</a>\n<main>\n<header>\n<h1>nephroid {name}</h1>\n\
         <p id=\"verdict\" class=\"verdict {state}\">{}</p>\n",
        escaped(&verdict),
        escaped(&verdict)
    );
    for line in words::certainty(o) {
        let _ = writeln!(page, "<p class=\"small\">{}</p>", escaped(&line));
    }
    page += &words::found(o);
    let groups = groups(o);
    if groups.len() > 1 {
        page += "<nav aria-label=\"Scenes\"><ul>\n";
        for g in &groups {
            let worst = words::worst(g);
            let _ = writeln!(
                page,
                "<li><a href=\"#{}\">{}</a> <span class=\"small {worst}\">{worst}</span></li>",
                anchor(&g[0]),
                escaped(&title(&g[0])),
            );
        }
        page += "</ul></nav>\n";
    }
    page += "</header>\n<div id=\"pairs\">\n";
    for g in &groups {
        page += &section(g, comparisons)?;
    }
    page += "</div>\n";
    page += &histogram::section(o);
    page += &list("Not run", &text::grouped(&o.not_run));
    page += &list("Notes", &o.notes);
    page += &provenance(o);
    page += "</main>\n</body>\n</html>\n";
    Ok(page)
}

/// Verdicts of the same scene, integrator and change of the scene.
fn groups(o: &Outcome) -> Vec<&[Verdict]> {
    let same = |a: &Verdict, b: &Verdict| {
        a.scene == b.scene && a.integrator == b.integrator && a.variation == b.variation
    };
    o.verdicts.chunk_by(same).collect()
}

fn title(v: &Verdict) -> String {
    match &v.variation {
        Some(variation) => format!("{}, {variation} · {}", v.scene, v.integrator),
        None => format!("{} · {}", v.scene, v.integrator),
    }
}

/// An id that names the group, of letters that need no quoting.
fn anchor(v: &Verdict) -> String {
    let text = title(v);
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() {
            c.to_string()
        } else {
            format!("-{:x}", c as u32)
        }
    };
    format!(
        "at-{}",
        text.replace(" · ", "_")
            .chars()
            .map(plain)
            .collect::<String>()
    )
}

/// All about one pair.
fn section(group: &[Verdict], comparisons: &[Comparison]) -> Result<String, String> {
    let first = &group[0];
    let id = anchor(first);
    let worst = words::worst(group);
    let mut out = format!(
        "<section aria-labelledby=\"{id}\">\n<h2 id=\"{id}\">{} <span class=\"state {worst}\">{worst}</span></h2>\n",
        escaped(&title(first))
    );
    let is_this = |c: &&Comparison| {
        c.scene == first.scene && c.integrator == first.integrator && first.variation.is_none()
    };
    for c in comparisons.iter().filter(is_this) {
        out += &pictures::figures(c)?;
    }
    out += &table::table(group);
    out += "</section>\n";
    Ok(out)
}

fn list(title: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let mut out = format!(
        "<h2>{title}</h2>\n<details{}><summary>{} {}</summary>\n<ul class=\"small\">\n",
        if lines.len() > 4 { "" } else { " open" },
        lines.len(),
        if lines.len() == 1 { "line" } else { "lines" }
    );
    for line in lines {
        let _ = writeln!(out, "<li>{}</li>", escaped(line));
    }
    out += "</ul></details>\n";
    out
}

/// What made this page.
fn provenance(o: &Outcome) -> String {
    let mut out = "<h2>Provenance</h2>\n<dl>\n".to_owned();
    let mut add = |term: &str, value: String| {
        let _ = writeln!(out, "<dt>{term}</dt><dd>{}</dd>", escaped(&value));
    };
    add(
        "program",
        format!(
            "nephroid {}, {}",
            env!("CARGO_PKG_VERSION"),
            o.program.name()
        ),
    );
    add(
        "machine",
        format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
    );
    if let Some(effort) = o.effort {
        add("effort", effort.to_string());
    }
    add("seed", o.seed.to_string());
    if let Some(bandwidth) = o.bandwidth {
        add("bandwidth", format!("α = r = {bandwidth} (rad, m)"));
    }
    add(
        "margin",
        format!("{} of the truth", text::percent(o.margin)),
    );
    add(
        "level of “different”",
        format!("{:e}, shared by {} checks", o.level, o.checks),
    );
    add(
        "level of “equivalent”",
        format!("{:e}", o.equivalence_level),
    );
    if o.program == Program::Gate {
        let images = o.verdicts.first().map_or(0, |v| v.replicates);
        add("images", images.to_string());
    }
    add("exit code", o.exit_code().to_string());
    out += "</dl>\n";
    out
}

/// Text as HTML shows it, in an element or in an attribute in double quotes.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() && c != '\n' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
