//! The figures of some verdicts; on a narrow screen each row is a card.

use core::fmt::Write as _;

use super::escaped;
use crate::judge::finding::State;
use crate::report::text;
use crate::verify::verdicts::Verdict;

const HEADS: [(&str, bool); 10] = [
    ("state", false),
    ("class", false),
    ("region", false),
    ("bias ± interval", true),
    ("margin", true),
    ("detectable bias", true),
    ("power", true),
    ("p different", true),
    ("replicates", true),
    ("paths", true),
];

/// The table, what the differences look like, and the commands that give the same again.
pub fn table(group: &[Verdict]) -> String {
    let mut out = "<table>\n<thead><tr>".to_owned();
    for (head, is_number) in HEADS {
        let class = if is_number { " class=\"n\"" } else { "" };
        let _ = write!(out, "<th scope=\"col\"{class}>{head}</th>");
    }
    out += "</tr></thead>\n<tbody>\n";
    for v in group {
        out += &row(v);
    }
    out += "</tbody>\n</table>\n";
    for v in group {
        out += &explanation(v);
    }
    let mut commands: Vec<&str> = group.iter().map(|v| v.command.as_str()).collect();
    commands.dedup();
    out += "<details><summary>The command that gives this again</summary>\n";
    for command in commands {
        let _ = writeln!(out, "<pre tabindex=\"0\">{}</pre>", escaped(command));
    }
    out += "</details>\n";
    out
}

fn row(v: &Verdict) -> String {
    let f = &v.finding;
    let state = f.state.word();
    let percent = |b: f64| format!("{:.2} %", 100.0 * b);
    let cells = [
        format!("<span class=\"state {state}\">{state}</span>"),
        escaped(&v.class),
        escaped(&v.region),
        text::bias(f).unwrap_or_default(),
        text::percent(v.margin),
        f.minimum_detectable_bias.map_or(String::new(), percent),
        f.power.map_or(String::new(), text::power),
        f.p_different.map_or(String::new(), |p| format!("{p:.1e}")),
        v.replicates.to_string(),
        if v.paths > 0 {
            format!("{:.1e}", v.paths as f64)
        } else {
            String::new()
        },
    ];
    let mut out = "<tr>".to_owned();
    for ((head, is_number), cell) in HEADS.into_iter().zip(cells) {
        let class = if is_number { " class=\"n\"" } else { "" };
        let _ = write!(out, "<td{class} data-label=\"{head}\">{cell}</td>");
    }
    out += "</tr>\n";
    out
}

/// Why, and what it looks like.
fn explanation(v: &Verdict) -> String {
    let f = &v.finding;
    let unbiased = f.state == State::Equivalent && !f.bias_established;
    let mut parts = Vec::new();
    if !f.reason.is_empty() && !unbiased {
        parts.push(f.reason.clone());
    }
    if let (State::Different, Some(mean), Some(truth)) = (f.state, v.mean, v.truth) {
        parts.push(format!(
            "mean {mean:.6e}, should be {:.6e} W/(m² sr)",
            truth.value
        ));
    }
    if let Some(e) = v.excluded.filter(|e| e.pixels > 0) {
        parts.push(format!(
            "{} pixels that a fold crosses are left out, with {:.2} % of the light",
            e.pixels,
            100.0 * e.energy
        ));
    }
    if let Some(paths) = v.paths_needed {
        parts.push(format!("about {:.1e} paths would decide", paths as f64));
    }
    let mut out = String::new();
    if !parts.is_empty() {
        let _ = writeln!(
            out,
            "<p class=\"small\"><strong>{}</strong>: {}.</p>",
            escaped(&v.class),
            escaped(&parts.join("; "))
        );
    }
    if let Some(looks_like) = &v.looks_like {
        let _ = writeln!(
            out,
            "<p class=\"small diagnosis\"><strong>{}, diagnosis</strong>: {}.</p>",
            escaped(&v.class),
            escaped(looks_like.trim_end_matches('.'))
        );
    }
    out
}
