//! Error against CPU time as pictures: a panel for each scene and class, a curve for each integrator, both axes logarithmic.

use core::fmt::Write as _;

use super::{Curve, PairResult, TARGET};
use crate::svg::Sheet;

/// Size of a panel, and of the plot in it [px].
const PANEL: [f64; 2] = [400.0, 290.0];
const PLOT: [f64; 4] = [58.0, 30.0, 322.0, 210.0];
/// One for each integrator, in their order, and again from the start.
const COLOURS: [&str; 9] = [
    "#1c5fb5", "#b5541c", "#2f8f4e", "#8a3fa0", "#c22f5a", "#6b6b1f", "#1f8a8a", "#5a4632",
    "#444444",
];

/// What is drawn in a panel: integrator and curve.
type Lines<'a> = Vec<(&'static str, &'a Curve)>;

/// The plot of all results.
pub fn svg(results: &[PairResult]) -> String {
    let mut panels: Vec<(String, Lines)> = Vec::new();
    for result in results {
        for class in &result.classes {
            let title = format!("{}, {}", result.scene, class.class);
            let Some(curve) = class.shown() else {
                continue;
            };
            match panels.iter_mut().find(|p| p.0 == title) {
                Some(panel) => panel.1.push((result.integrator, curve)),
                None => panels.push((title, vec![(result.integrator, curve)])),
            }
        }
    }
    let mut names: Vec<&'static str> = Vec::new();
    for result in results {
        if !names.contains(&result.integrator) {
            names.push(result.integrator);
        }
    }
    let colour = |name: &str| {
        let at = names.iter().position(|n| *n == name).unwrap_or(0);
        COLOURS[at % COLOURS.len()]
    };
    let mut sheet = Sheet::new(PANEL, panels.len().clamp(1, 2), panels.len());
    for (k, (title, lines)) in panels.iter().enumerate() {
        let origin = sheet.origin(k);
        draw(&mut sheet.out, origin, title, lines, &colour);
    }
    let y = sheet.legend();
    for (k, name) in names.iter().enumerate() {
        let x = 16.0 + 84.0 * k as f64;
        let _ = writeln!(
            sheet.out,
            "<path d=\"M{x} {} h18\" stroke=\"{}\" stroke-width=\"2\"/><text x=\"{}\" y=\"{y}\">{name}</text>",
            y - 4.0,
            colour(name),
            x + 22.0
        );
    }
    sheet.finish()
}

/// CPU seconds and relative root mean square error.
fn points(curve: &Curve) -> impl Iterator<Item = (f64, f64)> + '_ {
    curve
        .checkpoints
        .iter()
        .map(|c| (f64::from(c.iterations) * curve.seconds, c.error.sqrt()))
        .filter(|p| p.1 > 0.0 && p.1.is_finite())
}

/// Whole decades around values.
fn decades(values: impl Iterator<Item = f64>) -> Option<[i32; 2]> {
    let logs = values.map(libm::log10);
    let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| {
        (l.min(v), h.max(v))
    });
    let (low, high) = (libm::floor(low), libm::ceil(high));
    (low <= high).then_some([low as i32, (high as i32).max(low as i32 + 1)])
}

fn draw(
    out: &mut String,
    [left, top]: [f64; 2],
    title: &str,
    lines: &Lines,
    colour: &dyn Fn(&str) -> &'static str,
) {
    let [px, py, w, h] = [left + PLOT[0], top + PLOT[1], PLOT[2], PLOT[3]];
    let all = || lines.iter().flat_map(|l| points(l.1));
    let (Some(xs), Some(ys)) = (
        decades(all().map(|p| p.0)),
        decades(all().map(|p| p.1).chain([TARGET])),
    ) else {
        return;
    };
    let part =
        |v: f64, [low, high]: [i32; 2]| (libm::log10(v) - f64::from(low)) / f64::from(high - low);
    let x = |v: f64| px + w * part(v, xs);
    let y = |v: f64| py + h * (1.0 - part(v, ys));
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{title}</text>\n\
         <rect x=\"{px}\" y=\"{py}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#999\"/>",
        left + 10.0,
        top + 18.0
    );
    let power = |d: i32| libm::pow(10.0, f64::from(d));
    for d in xs[0]..=xs[1] {
        let at = x(power(d));
        let _ = writeln!(
            out,
            "<path d=\"M{at:.1} {py} v{h}\" stroke=\"#e4e4e4\"/>\
             <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">1e{d}</text>",
            py + h + 14.0
        );
    }
    for d in ys[0]..=ys[1] {
        let at = y(power(d));
        let _ = writeln!(
            out,
            "<path d=\"M{px} {at:.1} h{w}\" stroke=\"#e4e4e4\"/>\
             <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">1e{d}</text>",
            px - 4.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        out,
        "<path d=\"M{px} {:.1} h{w}\" stroke=\"#777\" stroke-dasharray=\"4 3\"/>\
         <text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">CPU time [s]</text>\
         <text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" fill=\"#555\">RMS error / mean</text>",
        y(TARGET),
        px + 0.5 * w,
        py + h + 30.0,
        left + 14.0,
        py + 0.5 * h
    );
    for (name, curve) in lines {
        let mut path = String::new();
        for (a, b) in points(curve) {
            let command = if path.is_empty() { 'M' } else { 'L' };
            let _ = write!(path, "{command}{:.1} {:.1}", x(a), y(b));
        }
        let _ = writeln!(
            out,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"><title>{name}{}</title></path>",
            colour(name),
            curve
                .bandwidth
                .map_or(String::new(), |b| format!(", bandwidth {b}"))
        );
    }
}
