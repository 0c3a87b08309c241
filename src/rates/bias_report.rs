//! A study of the bias as a table and as JSON.

use core::fmt::Write as _;

use serde_json::{Value, json};

use super::bias::{CONFIDENCE, FEWEST_CONTRIBUTIONS, Study};
use super::classes::Skipped;
use super::report::{Heading, interval, number, paths, range, remarkable, tests_json};

/// Paragraphs and a table for each class.
pub fn bias_table(heading: &Heading, studies: &[Study], skipped: &[Skipped]) -> String {
    let Heading {
        scene, integrator, ..
    } = heading;
    let mut out = String::new();
    for s in studies {
        let unit = if s.technique.bandwidth_is_angle() {
            "rad"
        } else {
            "m"
        };
        let _ = writeln!(
            out,
            "{scene}, {integrator}, {}: technique {}, kernel {}, {} paths\nregion: {} ({})\nsharp truth {:.9e} W/(m² sr)\n",
            s.class,
            s.technique,
            s.kernel,
            paths(s.paths as f64),
            s.view.name,
            s.view.reason,
            s.sharp.value
        );
        let _ = writeln!(
            out,
            "{:>10} {:>8} {:>13} {:>13} {:>8} {:>11} {:>9} {:>11} {:>11} {:>14} {:>10}",
            format!("alpha [{unit}]"),
            "paths",
            "mean",
            "expectation",
            "bound",
            "bias",
            "±",
            "predicted",
            "bias²",
            "variance/exact",
            "1/(V·T)"
        );
        for p in &s.points {
            let variance = p
                .variance
                .map_or("-".to_owned(), |v| format!("{:.3}", v.ratio));
            let _ = writeln!(
                out,
                "{:>10} {:>8} {:>13.6e} {:>13.6e} {:>8.0e} {:>11.3e} {:>9.1e} {:>11.3e} {:>11.2e} {:>14} {:>10.2e}",
                p.bandwidth,
                paths(p.paths as f64),
                p.mean,
                p.expected.value,
                p.expected.error,
                p.bias,
                p.half_interval,
                p.predicted_bias,
                p.squared_bias,
                variance,
                p.efficiency
            );
        }
        let needed = s.paths_needed.map_or(String::new(), |n| {
            format!(" (about {} paths would decide)", paths(n))
        });
        let _ = writeln!(
            out,
            "\norder of the bias: fitted {:.4}, {} % interval {}, predicted {:.4} (exact expectation, same bandwidths and weights)\n\
             size of the bias: {:.4} ± {:.4} of the predicted one\n\
             an order wrong by {:.2} would have been found with probability 0.9\n\
             {}{needed}",
            s.exponent.fitted,
            100.0 * CONFIDENCE,
            range(s.exponent.interval),
            s.predicted,
            s.scale[0],
            s.scale[1],
            s.detectable,
            s.state
        );
        let left_out = s.points.iter().filter(|p| !p.is_used).count();
        if left_out > 0 {
            let _ = writeln!(
                out,
                "  {left_out} of the bandwidths have fewer than {FEWEST_CONTRIBUTIONS} contributions and are not used: more paths"
            );
        }
        remarkable(&mut out, &s.tests);
        out.push('\n');
    }
    heading.skipped(&mut out, skipped);
    out.trim_end().to_owned()
}

/// The schema `nephroid-bias/1`.
pub fn bias_json(heading: &Heading, studies: &[Study], skipped: &[Skipped]) -> Value {
    let classes = studies.iter().map(class).collect();
    heading.document("nephroid-bias/1", classes, skipped)
}

fn class(s: &Study) -> Value {
    let points: Vec<Value> = s
        .points
        .iter()
        .map(|p| {
            json!({
                "bandwidth": p.bandwidth,
                "paths": p.paths,
                "mean": number(p.mean),
                "standard_error": number(p.standard_error),
                "expectation": p.expected.value,
                "expectation_bound": p.expected.error,
                "bias": number(p.bias),
                "interval": interval([p.bias - p.half_interval, p.bias + p.half_interval]),
                "predicted_bias": p.predicted_bias,
                "squared_bias": number(p.squared_bias),
                "used": p.is_used,
                "variance_over_exact": p.variance.map(|v| number(v.ratio)),
                "variance_p": p.variance.map(|v| number(v.p)),
                "efficiency": number(p.efficiency),
            })
        })
        .collect();
    json!({
        "class": s.class.to_string(),
        "technique": s.technique.name(),
        "kernel": s.kernel.name(),
        "region": s.view.name,
        "region_reason": s.view.reason,
        "camera": s.view.entry.camera,
        "sharp": s.sharp.value,
        "sharp_bound": s.sharp.error,
        "state": s.state.name(),
        "fitted": number(s.exponent.fitted),
        "predicted": number(s.predicted),
        "interval": interval(s.exponent.interval),
        "half_width": number(s.exponent.half_width()),
        "detectable": number(s.detectable),
        "size_of_bias": number(s.scale[0]),
        "size_of_bias_interval": interval([s.scale[0] - s.scale[1], s.scale[0] + s.scale[1]]),
        "paths": s.paths,
        "paths_needed": s.paths_needed.map(number),
        "seconds": s.seconds,
        "points": points,
        "tests": tests_json(&s.tests),
    })
}
