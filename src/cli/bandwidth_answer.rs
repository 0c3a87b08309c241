//! What `nephroid bandwidth` prints.

use nephroid_analytic::bandwidth::law::Place;
use nephroid_analytic::bandwidth::optimum::{Best, Curve};
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::scene::Entry;
use serde_json::{Value, json};

use super::bandwidth::{Args, Row, Whole};

fn number(v: Option<f64>) -> String {
    v.map_or("-".to_owned(), |v| format!("{v:.4e}"))
}

pub(super) fn as_text(
    args: &Args,
    (technique, kernel): (Technique, Kernel),
    rows: &[Row],
    wholes: &[Whole],
) -> String {
    let unit = if technique.bandwidth_is_angle() {
        "rad"
    } else {
        "m"
    };
    let mut lines = vec![
        format!(
            "{technique}, {kernel}, {} paths per point; bandwidths in {unit}, irradiances in W/m²",
            args.paths
        ),
        format!(
            "{:<8} {:>8} {:>8} {:<11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>7} {:>11} {:>11} {:>11}",
            "class",
            "x",
            "y",
            "place",
            "E",
            "best",
            "bias",
            "sd",
            "rmse",
            "lambda",
            "first",
            "rmse",
            "preview"
        ),
    ];
    for r in rows {
        let f = |g: fn(&Best) -> f64| r.fixed.as_ref().map(g);
        let p = |g: fn(&Best) -> f64| r.progressive.as_ref().map(g);
        lines.push(format!(
            "{:<8} {:>8.4} {:>8.4} {:<11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>7} {:>11} {:>11} {:>11}",
            r.law.class.to_string(),
            r.point[0],
            r.point[1],
            r.law.place.name(),
            number(r.truth),
            number(f(|b| b.bandwidth)),
            number(f(|b| b.bias)),
            number(f(|b| b.deviation)),
            number(f(|b| b.rmse)),
            r.decay.map_or("-".to_owned(), |d| format!("{d:.4}")),
            number(p(|b| b.bandwidth)),
            number(p(|b| b.rmse)),
            number(r.preview),
        ));
    }
    for w in wholes {
        let f = |g: fn(&Best) -> f64| w.fixed.as_ref().map(g);
        let p = |g: fn(&Best) -> f64| w.progressive.as_ref().map(g);
        lines.push(format!(
            "{:<8} {:>17} {:<11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>7} {:>11} {:>11}",
            w.class,
            format!("{} points", w.points),
            "picture",
            "",
            number(f(|b| b.bandwidth)),
            number(f(|b| b.bias)),
            number(f(|b| b.deviation)),
            number(f(|b| b.rmse)),
            "0.1667",
            number(p(|b| b.bandwidth)),
            number(p(|b| b.rmse)),
        ));
    }
    for r in rows.iter().filter(|r| r.fixed.is_none()) {
        lines.push(format!(
            "({}, {}) {}: {}",
            r.point[0],
            r.point[1],
            r.law.class,
            match r.law.place {
                Place::Dark => format!("dark: exactly 0 below {:.4e} {unit}", r.law.reach),
                Place::Edge =>
                    "on an edge: the limit is not the irradiance of either side".to_owned(),
                _ => format!(
                    "on a caustic: the mean grows like {:.4e} alpha^{:.4}",
                    r.law.coefficient,
                    r.law.order.unwrap_or(0.0)
                ),
            }
        ));
    }
    lines.push(format!(
        "MSE of the best at smooth points falls like N^(-2/3); preview: all paths miss with probability {:e} at most",
        args.epsilon
    ));
    lines.join("\n")
}

fn best_json(b: Option<&Best>) -> Value {
    b.map_or(Value::Null, |b| {
        json!({
            "bandwidth": b.bandwidth,
            "bias": b.bias,
            "standard_deviation": b.deviation,
            "rmse": b.rmse,
            "at_largest": b.at_largest,
        })
    })
}

fn finite(v: f64) -> Option<f64> {
    Some(v).filter(|v| v.is_finite())
}

pub(super) fn as_json(
    args: &Args,
    entry: &Entry,
    (technique, kernel): (Technique, Kernel),
    rows: &[Row],
    wholes: &[Whole],
) -> Value {
    let row = |r: &Row| {
        let l = &r.law;
        json!({
            "class": l.class.to_string(),
            "x": r.point[0],
            "y": r.point[1],
            "E": r.truth,
            "law": {
                "place": l.place.name(),
                "limit": l.limit,
                "order": l.order,
                "coefficient": l.coefficient,
                "second_moment_order": -l.squared_order,
                "second_moment_coefficient": l.squared,
                "reach": finite(l.reach),
                "roots": l.roots,
            },
            "best": best_json(r.fixed.as_ref()),
            "lambda": r.decay,
            "progressive": best_json(r.progressive.as_ref()),
            "mse_rate": r.decay.and_then(|d| Some(-2.0 * l.order? * d)),
            "preview": r.preview,
            "largest_bandwidth": r.curve.as_ref().map(Curve::high),
        })
    };
    let whole = |w: &Whole| {
        json!({
            "class": w.class,
            "points": w.points,
            "best": best_json(w.fixed.as_ref()),
            "lambda": 1.0 / 6.0,
            "progressive": best_json(w.progressive.as_ref()),
        })
    };
    json!({
        "schema": "nephroid-bandwidth/1",
        "scene": entry.name,
        "technique": technique.name(),
        "kernel": kernel.name(),
        "convention": (technique == Technique::Linked).then_some(&args.convention),
        "beam_area": args.beam_area,
        "paths": args.paths,
        "epsilon": args.epsilon,
        "probes": rows.iter().map(row).collect::<Vec<_>>(),
        "picture": wholes.iter().map(whole).collect::<Vec<_>>(),
    })
}
