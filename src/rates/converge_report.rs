//! A study of convergence as a table and as JSON.

use core::fmt::Write as _;

use serde_json::{Value, json};

use super::bias::CONFIDENCE;
use super::classes::Skipped;
use super::converge::Study;
use super::report::{Heading, interval, number, paths, range, remarkable, tests_json};

/// Paragraphs and a table for each class.
pub fn converge_table(heading: &Heading, studies: &[Study], skipped: &[Skipped]) -> String {
    let Heading {
        scene, integrator, ..
    } = heading;
    let schedule = heading.schedule.unwrap_or_default();
    let mut out = String::new();
    for s in studies {
        let technique = s.technique.map_or("without bias".to_owned(), |t| {
            format!("technique {t}, schedule {schedule}")
        });
        let _ = writeln!(
            out,
            "{scene}, {integrator}, {}: {technique}, {} paths in an iteration, {} in all\nregion: {} ({})\nsharp truth {:.9e} W/(m² sr)\n",
            s.class,
            s.paths_per_iteration,
            paths(s.paths as f64),
            s.view.name,
            s.view.reason,
            s.sharp.value
        );
        let _ = writeln!(
            out,
            "{:>6} {:>9} {:>11} {:>11} {:>11} {:>9} {:>11} {:>11} {:>17} {:>15} {:>7}",
            "n",
            "bandwidth",
            "variance",
            "predicted",
            "bias",
            "±",
            "predicted",
            "bias²",
            "events/expected",
            "empty/expected",
            "median"
        );
        for p in &s.points {
            let dash = || "-".to_owned();
            let events = p
                .events
                .map_or_else(dash, |e| format!("{}/{:.1}", e.count, e.expected));
            let empty = p
                .events
                .map_or_else(dash, |e| format!("{}/{:.1}", e.empty, e.expected_empty));
            let _ = writeln!(
                out,
                "{:>6} {:>9} {:>11.4e} {:>11} {:>11.3e} {:>9.1e} {:>11.3e} {:>11.2e} {:>17} {:>15} {:>7.4}",
                p.iterations,
                p.bandwidth.map_or_else(dash, |b| format!("{b:.4}")),
                p.variance,
                p.predicted_variance
                    .map_or_else(dash, |v| format!("{v:.4e}")),
                p.bias,
                p.half_interval,
                p.predicted_bias,
                p.squared_bias,
                events,
                empty,
                p.median
            );
        }
        out.push('\n');
        let confidence = 100.0 * CONFIDENCE;
        if let Some((slope, predicted)) = &s.variance {
            let _ = writeln!(
                out,
                "slope of the variance: fitted {:.4}, {confidence} % interval {}, predicted {predicted:.4}",
                slope.fitted,
                range(slope.interval)
            );
        }
        if let Some((exponent, predicted)) = &s.bias {
            let _ = writeln!(
                out,
                "slope of the squared bias: fitted {:.4}, {confidence} % interval {}, predicted {:.4}",
                2.0 * exponent.fitted,
                range(exponent.interval.map(|v| 2.0 * v)),
                2.0 * predicted
            );
        }
        let _ = writeln!(
            out,
            "1/(V·T) {:.3e} per second of one thread\n{}",
            s.efficiency, s.state
        );
        for remark in &s.remarks {
            let _ = writeln!(out, "  {remark}");
        }
        remarkable(&mut out, &s.tests);
        out.push('\n');
    }
    heading.skipped(&mut out, skipped);
    out.trim_end().to_owned()
}

/// The schema `nephroid-converge/1`.
pub fn converge_json(heading: &Heading, studies: &[Study], skipped: &[Skipped]) -> Value {
    let classes = studies.iter().map(class).collect();
    heading.document("nephroid-converge/1", classes, skipped)
}

fn class(s: &Study) -> Value {
    let points: Vec<Value> = s
        .points
        .iter()
        .map(|p| {
            let events = p.events.map(|e| {
                json!({
                    "count": e.count, "expected": e.expected,
                    "empty_replicates": e.empty, "expected_empty_replicates": e.expected_empty,
                })
            });
            json!({
                "iterations": p.iterations,
                "bandwidth": p.bandwidth,
                "mean": number(p.mean),
                "expectation": p.expected.value,
                "expectation_bound": p.expected.error,
                "variance": number(p.variance),
                "predicted_variance": p.predicted_variance,
                "variance_relative_error": p.variance_error,
                "bias": number(p.bias),
                "interval": interval([p.bias - p.half_interval, p.bias + p.half_interval]),
                "predicted_bias": p.predicted_bias,
                "squared_bias": number(p.squared_bias),
                "events": events,
                "median_over_truth": number(p.median),
            })
        })
        .collect();
    let variance = s.variance.map(|(slope, predicted)| {
        json!({
            "fitted": number(slope.fitted), "predicted": predicted,
            "interval": interval(slope.interval), "half_width": number(slope.half_width()),
        })
    });
    let bias = s.bias.map(|(exponent, predicted)| {
        json!({
            "fitted": number(2.0 * exponent.fitted), "predicted": number(2.0 * predicted),
            "interval": interval(exponent.interval.map(|v| 2.0 * v)),
            "half_width": number(2.0 * exponent.half_width()),
        })
    });
    json!({
        "class": s.class.to_string(),
        "technique": s.technique.map(|t| t.name()),
        "region": s.view.name,
        "region_reason": s.view.reason,
        "camera": s.view.entry.camera,
        "sharp": s.sharp.value,
        "sharp_bound": s.sharp.error,
        "state": s.state.name(),
        "variance": variance,
        "squared_bias": bias,
        "remarks": s.remarks,
        "efficiency": number(s.efficiency),
        "paths_per_iteration": s.paths_per_iteration,
        "paths": s.paths,
        "seconds": s.seconds,
        "points": points,
        "tests": tests_json(&s.tests),
    })
}
