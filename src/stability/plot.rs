//! The study as a picture: one panel per sweep, relative error against the parameter, both logarithmic.

use std::fmt::Write as _;

use super::{Outcome, Precision, Row};
use crate::svg::Sheet;

/// Panels in a row.
const COLUMNS: usize = 4;
/// Size of a panel, and of the plot in it [px].
const PANEL: [f64; 2] = [300.0, 210.0];
const PLOT: [f64; 4] = [46.0, 34.0, 240.0, 132.0];
/// Decades of the relative error: from 1e-17 to 1.
const DECADES: f64 = 17.0;

fn color(precision: Precision) -> &'static str {
    match precision {
        Precision::Single => "#b5541c",
        Precision::Double => "#1c5fb5",
    }
}

/// The study as an SVG document: solid lines are errors, dashed ones the conditioning times the unit of rounding. Rows of
/// the same sweep share a panel.
pub fn svg(rows: &[Row]) -> String {
    let mut panels: Vec<Vec<&Row>> = Vec::new();
    for row in rows {
        match panels.last_mut() {
            Some(p) if p[0].kind == row.kind && p[0].danger == row.danger => p.push(row),
            _ => panels.push(vec![row]),
        }
    }
    let mut sheet = Sheet::new(PANEL, COLUMNS, panels.len());
    for (k, panel) in panels.iter().enumerate() {
        let origin = sheet.origin(k);
        draw(&mut sheet.out, origin, panel);
    }
    let mut x = 16.0;
    let y = sheet.legend();
    for precision in Precision::ALL {
        let (stroke, name) = (color(precision), precision.name());
        for (dash, what) in [("", "relative error"), ("4 3", "conditioning × unit")] {
            let _ = writeln!(
                sheet.out,
                "<path d=\"M{x} {} h26\" stroke=\"{stroke}\" stroke-width=\"1.6\" stroke-dasharray=\"{dash}\"/>\
                 <text x=\"{}\" y=\"{y}\">{name}: {what}</text>",
                y - 4.0,
                x + 32.0
            );
            x += 190.0;
        }
    }
    sheet.finish()
}

fn draw(out: &mut String, [left, top]: [f64; 2], panel: &[&Row]) {
    let [px, py, w, h] = [left + PLOT[0], top + PLOT[1], PLOT[2], PLOT[3]];
    let first = panel[0];
    let ts = || first.steps.iter().map(|s| libm::log10(s.t));
    let (low, high) = (
        ts().fold(f64::INFINITY, f64::min),
        ts().fold(f64::NEG_INFINITY, f64::max),
    );
    // Towards the danger is to the right.
    let falling = first.steps.first().map(|s| s.t) > first.steps.last().map(|s| s.t);
    let x = |t: f64| {
        let part = (libm::log10(t) - low) / (high - low);
        px + w * if falling { 1.0 - part } else { part }
    };
    let y = |e: f64| py + h * (-libm::log10(e) / DECADES).clamp(0.0, 1.0);
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}: {}</text>",
        left + 10.0,
        top + 20.0,
        first.kind,
        first.danger
    );
    let _ = writeln!(
        out,
        "<rect x=\"{px}\" y=\"{py}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#999\"/>"
    );
    for decade in [0, -4, -8, -12, -16] {
        let at = y(libm::pow(10.0, f64::from(decade)));
        let _ = writeln!(
            out,
            "<path d=\"M{px} {at:.1} h{w}\" stroke=\"#e4e4e4\"/>\
             <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">1e{decade}</text>",
            px - 4.0,
            at + 4.0
        );
    }
    let (start, end) = if falling { (high, low) } else { (low, high) };
    for (at, decade, anchor) in [(px, start, "start"), (px + w, end, "end")] {
        let _ = writeln!(
            out,
            "<text x=\"{at}\" y=\"{}\" text-anchor=\"{anchor}\" fill=\"#555\">1e{decade:.0}</text>",
            py + h + 14.0
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{}</text>",
        px + 0.5 * w,
        py + h + 28.0,
        first.parameter
    );
    for row in panel {
        let (mut errors, mut allowed) = (String::new(), String::new());
        for step in &row.steps {
            let Outcome::Compared {
                error,
                conditioning,
                ..
            } = step.outcome
            else {
                continue;
            };
            let at = x(step.t);
            let unit = row.precision.unit() * conditioning.max(1.0);
            for (path, value) in [(&mut errors, error), (&mut allowed, unit)] {
                let command = if path.is_empty() { 'M' } else { 'L' };
                let _ = write!(path, "{command}{at:.1} {:.1}", y(value));
            }
        }
        let stroke = color(row.precision);
        let _ = writeln!(
            out,
            "<path d=\"{errors}\" fill=\"none\" stroke=\"{stroke}\" stroke-width=\"1.6\"/>\
             <path d=\"{allowed}\" fill=\"none\" stroke=\"{stroke}\" stroke-dasharray=\"4 3\"/>"
        );
    }
}
