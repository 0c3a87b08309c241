//! How the p-values of "different" are spread.

use core::fmt::Write as _;

use crate::verify::verdicts::Outcome;

const BINS: usize = 20;
const WIDTH: f64 = 420.0;
const HEIGHT: f64 = 150.0;
const LEFT: f64 = 30.0;
const FOOT: f64 = 34.0;
const TOP: f64 = 10.0;

/// The histogram with its words; nothing where there is no p-value.
pub fn section(o: &Outcome) -> String {
    let values: Vec<f64> = o
        .verdicts
        .iter()
        .filter_map(|v| v.finding.p_different)
        .filter(|p| p.is_finite())
        .collect();
    if values.is_empty() {
        return String::new();
    }
    let mut bins = [0_usize; BINS];
    for p in &values {
        let bin = (p.clamp(0.0, 1.0) * BINS as f64) as usize;
        bins[bin.min(BINS - 1)] += 1;
    }
    let most = bins.iter().copied().max().unwrap_or(1).max(1);
    let mut out = format!(
        "<h2>p-values of “different”</h2>\n<p class=\"small\">Of {} checks. Each is corrected for its regions and looks and cut at 1: right \
         images pile up there; a bias piles up at 0.</p>\n\
         <svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" role=\"img\" \
         aria-label=\"Histogram of {} p-values: {} below 0.05\" font-size=\"12\">\n",
        values.len(),
        values.len(),
        bins[0]
    );
    let base = HEIGHT - FOOT;
    let step = (WIDTH - LEFT - 10.0) / BINS as f64;
    for (k, count) in bins.iter().enumerate() {
        let height = (base - TOP) * *count as f64 / most as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{height:.1}\" style=\"fill:var(--bar)\"/>",
            LEFT + step * k as f64 + 1.0,
            base - height,
            step - 2.0
        );
    }
    let right = LEFT + step * BINS as f64;
    let _ = writeln!(
        out,
        "<path d=\"M{LEFT} {base}H{right:.1}\" style=\"stroke:var(--muted)\"/>\n\
         <g style=\"fill:var(--muted)\" text-anchor=\"middle\"><text x=\"{LEFT}\" y=\"{y}\">0</text>\
         <text x=\"{:.1}\" y=\"{y}\">0.5</text><text x=\"{right:.1}\" y=\"{y}\">1</text>\
         <text x=\"{:.1}\" y=\"{:.1}\">p</text><text x=\"14\" y=\"{}\">{most}</text></g>\n</svg>",
        0.5 * (LEFT + right),
        0.5 * (LEFT + right),
        HEIGHT - 4.0,
        TOP + 8.0,
        y = base + 15.0,
    );
    out
}
