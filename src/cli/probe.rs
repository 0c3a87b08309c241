//! `nephroid probe`: truth at a list of floor points.

use std::path::PathBuf;

use nephroid_analytic::kinds::entry::FloorTruth;
use serde_json::{Value, json};

use crate::error::Error;
use crate::{entry, exit};

/// Print the exact light at a list of floor points, per path class.
///
/// The CSV file has the header x,y,z and one point per line, in metres; the points must lie on the scene's floor, z = 0.
/// Answers per point and class: irradiance E, radiance L = albedo E/pi, the error bound of E, the number of specular
/// roots, and the distance to the nearest caustic fold where the scene has one. Points are numbered from 1.
#[derive(clap::Args)]
pub struct Args {
    /// Catalogue name or TOML file.
    scene: String,
    /// Points: a CSV file with the header x,y,z.
    #[arg(value_name = "POINTS.csv")]
    points: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// One line of the answer.
struct Answer {
    id: usize,
    class: String,
    irradiance: f64,
    radiance: f64,
    error_bound: f64,
    roots: u32,
    singularity: Option<f64>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let file = args.points.display().to_string();
    let text = std::fs::read_to_string(&args.points).map_err(|e| Error::read(&file, e))?;
    let truth = FloorTruth::new(&entry);
    let mut answers = vec![];
    for (n, point) in read_points(&file, &text)?.into_iter().enumerate() {
        check_on_floor(&file, &entry, &truth, &point)?;
        let [x, y, _] = point.at;
        answers.extend(truth.at(x, y).into_iter().map(|t| Answer {
            id: n + 1,
            class: t.class.to_string(),
            irradiance: t.irradiance.value,
            radiance: truth.albedo() * t.irradiance.value / core::f64::consts::PI,
            error_bound: t.irradiance.error,
            roots: t.irradiance.roots,
            singularity: t.singularity,
        }));
    }
    super::print(&if args.json {
        as_json(&entry.name, &answers)
    } else {
        as_csv(&answers)
    });
    Ok(exit::PASS)
}

/// A point and the line it stands on.
struct Point {
    line: usize,
    at: [f64; 3],
}

fn content(file: &str, message: String, help: &str) -> Error {
    Error::Content {
        file: file.to_owned(),
        message,
        help: help.to_owned(),
    }
}

fn read_points(file: &str, text: &str) -> Result<Vec<Point>, Error> {
    const HEADER: &str = "allowed: a CSV file with the header x,y,z";
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .filter(|(_, l)| !l.trim().is_empty());
    let (_, header) = lines
        .next()
        .ok_or_else(|| content(file, "the file is empty".into(), HEADER))?;
    if !header.split(',').map(str::trim).eq(["x", "y", "z"]) {
        let shown: String = header.chars().take(60).collect();
        return Err(content(file, format!("the header is `{shown}`"), HEADER));
    }
    lines
        .map(|(n, line)| {
            let line_number = n + 1;
            let fields: Vec<&str> = line.split(',').map(str::trim).collect();
            let shown: String = line.chars().take(60).collect();
            let [x, y, z] = fields[..] else {
                let message = format!("line {line_number}: found `{shown}`");
                return Err(content(file, message, "allowed: three numbers x,y,z"));
            };
            let mut at = [0.0; 3];
            for (value, (name, field)) in at.iter_mut().zip([("x", x), ("y", y), ("z", z)]) {
                *value = field
                    .parse()
                    .ok()
                    .filter(|v: &f64| v.is_finite())
                    .ok_or_else(|| {
                        let shown: String = field.chars().take(40).collect();
                        let message = format!("line {line_number}: `{name}` is `{shown}`");
                        content(file, message, "allowed: a finite number of metres")
                    })?;
            }
            Ok(Point {
                line: line_number,
                at,
            })
        })
        .collect()
}

fn check_on_floor(
    file: &str,
    entry: &nephroid_analytic::scene::Entry,
    truth: &FloorTruth,
    point: &Point,
) -> Result<(), Error> {
    let [x, y, z] = point.at;
    if f64::abs(z) <= 1e-9 && truth.is_on_floor(x, y) {
        return Ok(());
    }
    let floor = entry.kind.floor();
    let range = |i: usize| {
        let (c, w) = (floor.center[i], floor.half_width[i]);
        format!("{} to {}", c - w, c + w)
    };
    let help = format!(
        "allowed: points of the floor of `{}`: x from {}, y from {}, z = 0",
        entry.name,
        range(0),
        range(1)
    );
    let message = format!("line {}: ({x}, {y}, {z}) is not on the floor", point.line);
    Err(content(file, message, &help))
}

/// A number, or null where it is not finite: JSON has no infinity.
fn finite(value: f64) -> Value {
    if value.is_finite() {
        json!(value)
    } else {
        Value::Null
    }
}

fn as_json(scene: &str, answers: &[Answer]) -> String {
    let answers: Vec<_> = answers
        .iter()
        .map(|a| {
            json!({
                "id": a.id,
                "class": a.class,
                "E": finite(a.irradiance),
                "L": finite(a.radiance),
                "error_bound": finite(a.error_bound),
                "roots": a.roots,
                "singularity": a.singularity.map_or(Value::Null, finite),
            })
        })
        .collect();
    json!({ "schema": "nephroid-probe/1", "scene": scene, "answers": answers }).to_string()
}

fn as_csv(answers: &[Answer]) -> String {
    let mut lines = vec!["id,class,E,L,error_bound,roots,singularity".to_owned()];
    lines.extend(answers.iter().map(|a| {
        let singularity = a.singularity.map_or(String::new(), |s| format!("{s:e}"));
        format!(
            "{},{},{:e},{:e},{:.1e},{},{singularity}",
            a.id, a.class, a.irradiance, a.radiance, a.error_bound, a.roots
        )
    }));
    lines.join("\n")
}
