//! Studies as pictures: prediction as a curve, measurements as points with interval bars, both axes logarithmic.

use core::fmt::Write as _;

use super::bias::Study as BiasStudy;
use super::converge::Study as ConvergeStudy;
use super::report::{Heading, range};
use crate::svg::Sheet;

/// Size of a panel, and of the plot in it [px].
const PANEL: [f64; 2] = [430.0, 310.0];
const PLOT: [f64; 4] = [64.0, 40.0, 340.0, 208.0];
/// Measured and predicted.
const MEASURED: &str = "#b5541c";
const PREDICTED: &str = "#1c5fb5";
/// A bar that reaches zero or below goes down to the bottom.
const MARGIN: f64 = 0.06;

/// A measured value with its interval.
struct Measured {
    x: f64,
    y: f64,
    interval: [f64; 2],
}

struct Panel {
    title: String,
    subtitle: String,
    x_label: String,
    y_label: String,
    curve: Vec<(f64, f64)>,
    points: Vec<Measured>,
}

/// The bias against the bandwidth, a panel for each class.
pub fn bias_svg(heading: &Heading, studies: &[BiasStudy]) -> String {
    let Heading {
        scene, integrator, ..
    } = heading;
    let panels: Vec<Panel> = studies
        .iter()
        .map(|s| {
            // Relative to the truth, with the sign of the prediction.
            let sign = s.curve.last().map_or(1.0, |c| c.1.signum());
            let scale = sign / s.sharp.value;
            let unit = if s.technique.bandwidth_is_angle() {
                "alpha [rad]"
            } else {
                "r [m]"
            };
            Panel {
                title: format!("{scene}, {integrator}, {}", s.class),
                subtitle: format!(
                    "order {:.3} {}, predicted {:.3}: {}",
                    s.exponent.fitted,
                    range(s.exponent.interval),
                    s.predicted,
                    s.state
                ),
                x_label: unit.to_owned(),
                y_label: format!("{}bias / truth", if sign < 0.0 { "−" } else { "" }),
                curve: s.curve.iter().map(|(x, y)| (*x, y * scale)).collect(),
                points: s
                    .points
                    .iter()
                    .map(|p| Measured {
                        x: p.bandwidth,
                        y: p.bias * scale,
                        interval: [-1.0, 1.0]
                            .map(|k| p.bias * scale + k * p.half_interval / s.sharp.value),
                    })
                    .collect(),
            }
        })
        .collect();
    document(&panels)
}

/// Variance and bias against the number of iterations, two panels for each class (one if it has no bias).
pub fn converge_svg(heading: &Heading, studies: &[ConvergeStudy]) -> String {
    let Heading {
        scene, integrator, ..
    } = heading;
    let mut panels = Vec::new();
    for s in studies {
        let square = s.sharp.value * s.sharp.value;
        let n = |p: &super::converge::Point| f64::from(p.iterations);
        let verdict = s
            .variance
            .map_or("not fitted".to_owned(), |(slope, predicted)| {
                format!(
                    "slope {:.3} {}, predicted {predicted:.3}",
                    slope.fitted,
                    range(slope.interval)
                )
            });
        let law = |p: &super::converge::Point| {
            let first = s.points.first().map_or(0.0, |p| p.variance);
            p.predicted_variance.unwrap_or(first / n(p))
        };
        let has_law =
            s.points.iter().all(|p| p.predicted_variance.is_some()) || s.technique.is_none();
        panels.push(Panel {
            title: format!("{scene}, {integrator}, {}: variance", s.class),
            subtitle: format!("{verdict}: {}", s.state),
            x_label: "iterations".to_owned(),
            y_label: "variance / truth²".to_owned(),
            curve: s
                .points
                .iter()
                .filter(|_| has_law)
                .map(|p| (n(p), law(p) / square))
                .collect(),
            points: s
                .points
                .iter()
                .map(|p| {
                    let v = p.variance / square;
                    let error = 2.0 * p.variance_error.unwrap_or(0.0);
                    Measured {
                        x: n(p),
                        y: v,
                        interval: [v * (1.0 - error), v * (1.0 + error)],
                    }
                })
                .collect(),
        });
        let Some((exponent, predicted)) = s.bias else {
            continue;
        };
        let sign = s.points.first().map_or(1.0, |p| p.predicted_bias.signum());
        let scale = sign / s.sharp.value;
        panels.push(Panel {
            title: format!("{scene}, {integrator}, {}: bias", s.class),
            subtitle: format!(
                "slope {:.3} {}, predicted {predicted:.3}",
                exponent.fitted,
                range(exponent.interval)
            ),
            x_label: "iterations".to_owned(),
            y_label: format!("{}bias / truth", if sign < 0.0 { "−" } else { "" }),
            curve: s
                .points
                .iter()
                .map(|p| (n(p), p.predicted_bias * scale))
                .collect(),
            points: s
                .points
                .iter()
                .map(|p| Measured {
                    x: n(p),
                    y: p.bias * scale,
                    interval: [-1.0, 1.0]
                        .map(|k| p.bias * scale + k * p.half_interval / s.sharp.value),
                })
                .collect(),
        });
    }
    document(&panels)
}

fn document(panels: &[Panel]) -> String {
    let mut sheet = Sheet::new(PANEL, panels.len().clamp(1, 2), panels.len());
    for (k, panel) in panels.iter().enumerate() {
        let origin = sheet.origin(k);
        draw(&mut sheet.out, origin, panel);
    }
    let y = sheet.legend();
    let _ = writeln!(
        sheet.out,
        "<path d=\"M16 {0} h26\" stroke=\"{PREDICTED}\" stroke-width=\"1.6\"/><text x=\"48\" y=\"{y}\">predicted: exact</text>\
         <path d=\"M176 {1} v12\" stroke=\"{MEASURED}\"/><circle cx=\"176\" cy=\"{0}\" r=\"3\" fill=\"{MEASURED}\"/>\
         <text x=\"188\" y=\"{y}\">measured, 95 % interval</text>",
        y - 4.0,
        y - 10.0
    );
    sheet.finish()
}

/// The logarithmic range of values, widened a little; `None` where there is none.
fn log_range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for v in values.filter(|v| *v > 0.0 && v.is_finite()) {
        let l = libm::log10(v);
        (low, high) = (low.min(l), high.max(l));
    }
    let room = (MARGIN * (high - low)).max(0.05);
    (low <= high).then_some([low - room, high + room])
}

/// Places and texts of the marks of a logarithmic axis: powers of ten, and 2 and 5 times these on a short axis.
fn marks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let factors: &[f64] = if high - low < 2.5 {
        &[1.0, 2.0, 5.0]
    } else {
        &[1.0]
    };
    let mut marks = Vec::new();
    for decade in libm::floor(low) as i32..=libm::ceil(high) as i32 {
        for f in factors {
            let at = f64::from(decade) + libm::log10(*f);
            if (low..=high).contains(&at) {
                let text = if (-2..=3).contains(&decade) {
                    format!(
                        "{}",
                        (f * libm::pow(10.0, f64::from(decade)) * 1e6).round() / 1e6
                    )
                } else {
                    format!("{f}e{decade}")
                };
                marks.push((at, text));
            }
        }
    }
    marks
}

fn draw(out: &mut String, [left, top]: [f64; 2], panel: &Panel) {
    let [px, py, w, h] = [left + PLOT[0], top + PLOT[1], PLOT[2], PLOT[3]];
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text><text x=\"{}\" y=\"{}\" fill=\"#555\">{}</text>\n\
         <rect x=\"{px}\" y=\"{py}\" width=\"{w}\" height=\"{h}\" fill=\"none\" stroke=\"#999\"/>",
        left + 10.0,
        top + 18.0,
        panel.title,
        left + 10.0,
        top + 33.0,
        panel.subtitle
    );
    let xs = log_range(
        panel
            .curve
            .iter()
            .map(|c| c.0)
            .chain(panel.points.iter().map(|p| p.x)),
    );
    let ys = log_range(
        panel
            .curve
            .iter()
            .map(|c| c.1)
            .chain(panel.points.iter().flat_map(|p| [p.y, p.interval[1]])),
    );
    let (Some(xs), Some(ys)) = (xs, ys) else {
        return;
    };
    let x = |v: f64| px + w * (libm::log10(v) - xs[0]) / (xs[1] - xs[0]);
    let y = |v: f64| {
        let part = if v > 0.0 {
            (libm::log10(v) - ys[0]) / (ys[1] - ys[0])
        } else {
            0.0
        };
        py + h * (1.0 - part.clamp(0.0, 1.0))
    };
    for (at, text) in marks(xs) {
        let at = px + w * (at - xs[0]) / (xs[1] - xs[0]);
        let _ = writeln!(
            out,
            "<path d=\"M{at:.1} {py} v{h}\" stroke=\"#e4e4e4\"/>\
             <text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{text}</text>",
            py + h + 14.0
        );
    }
    for (at, text) in marks(ys) {
        let at = py + h * (1.0 - (at - ys[0]) / (ys[1] - ys[0]));
        let _ = writeln!(
            out,
            "<path d=\"M{px} {at:.1} h{w}\" stroke=\"#e4e4e4\"/>\
             <text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#555\">{text}</text>",
            px - 4.0,
            at + 4.0
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{}</text>\
         <text transform=\"translate({} {}) rotate(-90)\" text-anchor=\"middle\" fill=\"#555\">{}</text>",
        px + 0.5 * w,
        py + h + 30.0,
        panel.x_label,
        left + 14.0,
        py + 0.5 * h,
        panel.y_label
    );
    let mut path = String::new();
    for (a, b) in panel.curve.iter().filter(|c| c.1 > 0.0) {
        let command = if path.is_empty() { 'M' } else { 'L' };
        let _ = write!(path, "{command}{:.1} {:.1}", x(*a), y(*b));
    }
    if !path.is_empty() {
        let _ = writeln!(
            out,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{PREDICTED}\" stroke-width=\"1.6\"/>"
        );
    }
    for p in &panel.points {
        let (at, [low, high]) = (x(p.x), p.interval.map(&y));
        // A bar that ends below zero has no foot.
        let foot = if p.interval[0] > 0.0 {
            format!("M{:.1} {low:.1} h6 ", at - 3.0)
        } else {
            String::new()
        };
        if p.interval[1] > 0.0 {
            let _ = writeln!(
                out,
                "<path d=\"M{at:.1} {low:.1} V{high:.1} {foot}M{:.1} {high:.1} h6\" stroke=\"{MEASURED}\"/>",
                at - 3.0
            );
        }
        if p.y > 0.0 {
            let _ = writeln!(
                out,
                "<circle cx=\"{at:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{MEASURED}\"/>",
                y(p.y)
            );
        }
    }
}
