//! `nephroid probe`: truth at a list of floor points.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::entry::{EntryExpectation, Estimator};
use nephroid_analytic::bandwidth::{
    self, Convention, Expectation, Kernel, Moments, PlanarSetting, Technique, UnknownName,
};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::entries::{FloorTruth, State};
use nephroid_analytic::kinds::singularity::Singularity;
use nephroid_analytic::scene::{InvalidParameter, Kind};
use serde_json::{Value, json};

use super::probe_certify::{Certifier, Proof};
use crate::error::Error;
use crate::{entry, exit};

/// Print the exact light at a list of floor points, per path class.
///
/// The CSV file has the header x,y,z and one point per line, in metres; the points must lie on the scene's floor, z = 0.
/// Answers per point and class: irradiance E, radiance L = albedo E/pi, the error bound of E, the number of specular
/// roots, and the distance to the nearest caustic fold where the scene has one. Points are numbered from 1.
///
/// With --technique and --bandwidth the caustic class is answered as a regularized estimator of that bandwidth converges
/// to, together with the second moment of one of its samples, in irradiance.
///
/// With --certify an interval that provably contains E, from the decimals in both files, and the number of rays that is
/// proven; or why there is none.
#[derive(clap::Args)]
pub struct Args {
    /// Catalogue name or TOML file.
    scene: String,
    /// Points: a CSV file with the header x,y,z.
    #[arg(value_name = "POINTS.csv")]
    points: PathBuf,
    /// Expectation of a regularized technique: camera, light, symmetric, merge or linked.
    #[arg(long, value_name = "T", requires = "bandwidth")]
    technique: Option<String>,
    /// Bandwidth: an angle in radians (camera, light, symmetric) or a radius in metres (merge, linked); several,
    /// separated by commas, are averaged.
    #[arg(long, value_name = "A", requires = "technique", value_delimiter = ',')]
    bandwidth: Vec<f64>,
    /// Kernel: cone, epanechnikov, vmf, disc or biweight (default: cone, or disc for merge).
    #[arg(long, value_name = "K", requires = "technique")]
    kernel: Option<String>,
    /// Distance d from which a linked bandwidth atan(r/d) is found: exact (along the exact ray to the floor), vertex (to the
    /// connected point) or light.
    #[arg(
        long,
        value_name = "C",
        requires = "technique",
        default_value = "exact"
    )]
    convention: String,
    /// Side from which a linked path is built: light, or camera (then `exact` ends at what the exact ray meets first, on its way past
    /// the light, and `vertex` at the floor point).
    #[arg(
        long,
        value_name = "SIDE",
        requires = "technique",
        default_value = "light"
    )]
    side: Side,
    /// Cross-section over which the photons of parallel light are uniform, in square metres: second moments of light, linked
    /// and merge are proportional to it.
    #[arg(long, value_name = "A", requires = "technique", default_value_t = 1.0)]
    beam_area: f64,
    /// Add to every E an interval that provably contains the true one, and the number of rays that is proven.
    #[arg(long, conflicts_with = "technique")]
    certify: bool,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Where a linked path begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Side {
    /// At the light.
    Light,
    /// At the floor point.
    Camera,
}

/// One line of the answer.
struct Answer {
    id: usize,
    class: String,
    irradiance: f64,
    radiance: f64,
    error_bound: f64,
    roots: u32,
    singularity: Option<Singularity<f64>>,
    strength: Option<f64>,
    state: State,
    second_moment: Option<f64>,
    proof: Option<Proof>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let file = args.points.display().to_string();
    let text = std::fs::read_to_string(&args.points).map_err(|e| Error::read(&file, e))?;
    let Some(truth) = FloorTruth::new(&entry) else {
        return Err(Error::Parameter {
            file: args.scene.clone(),
            key: "kind".to_owned(),
            found: entry.kind.name().to_owned(),
            allowed: "a scene with a floor".to_owned(),
        });
    };
    let regularized = regularized(args, &entry)?;
    let certifier = args
        .certify
        .then(|| Certifier::new(&args.scene, &entry))
        .transpose()?;
    let mut answers = vec![];
    for (n, point) in read_points(&file, &text)?.into_iter().enumerate() {
        check_on_floor(&file, &entry, &truth, &point)?;
        let [x, y, _] = point.at;
        let light = truth.at(x, y);
        let proofs = certifier.as_ref().map(|c| {
            let classes: Vec<_> = light.iter().map(|t| t.class).collect();
            c.at(&point.decimals, &classes)
        });
        answers.extend(light.into_iter().enumerate().map(|(k, t)| {
            let moments = match &regularized {
                Some(e) if t.class.is_caustic() => e.at(t.class, [x, y]),
                _ => None,
            };
            let irradiance = moments.map_or(t.irradiance.value, |m| m.mean.value);
            Answer {
                id: n + 1,
                class: t.class.to_string(),
                irradiance,
                radiance: truth.albedo() * irradiance / core::f64::consts::PI,
                error_bound: moments.map_or(t.irradiance.error, |m| m.mean.error),
                roots: t.irradiance.roots,
                singularity: truth.singularity(x, y, k),
                strength: truth.strength(x, y, k).map(|s| s.value),
                // A regularized estimator has an expectation everywhere.
                state: moments.map_or_else(|| truth.state(x, y, k, &t), |_| State::Regular),
                second_moment: moments.map(|m| m.second_moment.value),
                proof: proofs.as_ref().and_then(|p| p.get(k).copied()),
            }
        }));
    }
    super::print(&if args.json {
        as_json(&entry.name, args, &answers)
    } else {
        as_csv(&answers, args)
    });
    Ok(exit::PASS)
}

/// Relative tolerance of an expectation in a plane mirror, and in general.
const TOLERANCE: f64 = 1e-12;
const TOLERANCE_CURVED: f64 = 1e-10;

/// The expectation of a regularized estimator.
enum Regularized {
    Planar(Box<Expectation>),
    General(Box<EntryExpectation>),
}

impl Regularized {
    fn at(&self, class: PathClass, [x, y]: [f64; 2]) -> Option<Moments> {
        match self {
            Regularized::Planar(e) => Some(e.at([x, y, 0.0], TOLERANCE)),
            Regularized::General(e) => {
                let position = e.classes().iter().position(|c| *c == class)?;
                Some(e.at(x, y, TOLERANCE_CURVED)[position])
            }
        }
    }
}

/// The expectation that the options ask for; `None` without them, or where the scene has no regularized class.
fn regularized(
    args: &Args,
    entry: &nephroid_analytic::scene::Entry,
) -> Result<Option<Regularized>, Error> {
    let Some(name) = &args.technique else {
        return Ok(None);
    };
    let unknown = |what, e: UnknownName| Error::UnknownName {
        what,
        found: e.found,
        allowed: e.allowed,
    };
    let technique: Technique = name.parse().map_err(|e| unknown("technique", e))?;
    let kernel = match &args.kernel {
        Some(k) => k.parse::<Kernel>().map_err(|e| unknown("kernel", e))?,
        None => technique.default_kernel(),
    };
    let convention: Convention = args
        .convention
        .parse()
        .map_err(|e| unknown("convention", e))?;
    let option = |e: InvalidParameter| Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{}", e.key.replace('_', "-")),
        found: e.found,
        allowed: e.allowed,
    };
    bandwidth::check(technique, kernel, &args.bandwidth).map_err(option)?;
    if !(args.beam_area > 0.0 && args.beam_area <= 1e12) {
        return Err(option(InvalidParameter {
            key: "beam_area".to_owned(),
            found: args.beam_area.to_string(),
            allowed: "greater than 0, up to 1e12 square metres".to_owned(),
        }));
    }
    if args.side == Side::Camera && technique != Technique::Linked {
        return Err(option(InvalidParameter {
            key: "side".to_owned(),
            found: format!("camera with {technique}"),
            allowed: "camera with the technique linked".to_owned(),
        }));
    }
    Ok(match &entry.kind {
        Kind::Diffuse(_) => None,
        _ if args.side == Side::Camera => {
            let radii = &args.bandwidth;
            let e = EntryExpectation::linked_from_camera(entry, kernel, convention, radii);
            Some(Regularized::General(Box::new(e.map_err(option)?)))
        }
        Kind::PlanarMirror(_) if convention == Convention::Exact => {
            let setting = PlanarSetting::of_entry(entry).map_err(option)?;
            setting
                .map(|s| Expectation::new(s, technique, kernel, &args.bandwidth).map_err(option))
                .transpose()?
                .map(|e| Regularized::Planar(Box::new(e)))
        }
        _ => {
            let estimator = Estimator {
                technique,
                kernel,
                convention,
                bandwidths: &args.bandwidth,
            };
            let e = EntryExpectation::new(entry, estimator, args.beam_area).map_err(option)?;
            Some(Regularized::General(Box::new(e)))
        }
    })
}

/// The floor points of a CSV file.
pub(super) fn floor_points(
    path: &std::path::Path,
    entry: &nephroid_analytic::scene::Entry,
    truth: &FloorTruth,
) -> Result<Vec<[f64; 2]>, Error> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|e| Error::read(&file, e))?;
    let points = read_points(&file, &text)?;
    points
        .iter()
        .map(|p| {
            check_on_floor(&file, entry, truth, p)?;
            Ok([p.at[0], p.at[1]])
        })
        .collect()
}

/// A point and the line it stands on.
struct Point {
    line: usize,
    at: [f64; 3],
    /// x and y as they are written.
    decimals: [String; 2],
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
                decimals: [x.to_owned(), y.to_owned()],
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
    let range = |i: usize| {
        let [low, high] = truth.range(i);
        format!("{low} to {high}")
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

impl Answer {
    /// A value of the answer, or null on a singularity.
    fn number(&self, value: f64) -> Value {
        match self.state {
            State::Regular => finite(value),
            _ => Value::Null,
        }
    }

    /// A value of the answer, or the word for the singularity that it is on.
    fn text(&self, value: f64) -> String {
        match self.state {
            State::Regular => format!("{value:e}"),
            state => state.name().to_owned(),
        }
    }
}

/// A number, or null where it is not finite: JSON has no infinity.
fn finite(value: f64) -> Value {
    if value.is_finite() {
        json!(value)
    } else {
        Value::Null
    }
}

fn as_json(scene: &str, args: &Args, answers: &[Answer]) -> String {
    let answers: Vec<_> = answers
        .iter()
        .map(|a| {
            let mut answer = json!({
                "id": a.id,
                "class": a.class,
                "E": a.number(a.irradiance),
                "L": a.number(a.radiance),
                "error_bound": finite(a.error_bound),
                "roots": a.roots,
                "singularity": a.singularity.map_or(Value::Null, |s| finite(s.distance)),
                "singularity_type": a.singularity.map(|s| s.kind.name()),
                "strength": a.strength,
                "state": a.state.name(),
            });
            if args.technique.is_some() {
                answer["second_moment"] = a.second_moment.map_or(Value::Null, finite);
            }
            if let Some(proof) = &a.proof {
                proof.add_to(&mut answer);
            }
            answer
        })
        .collect();
    let mut top = json!({ "schema": "nephroid-probe/1", "scene": scene });
    if let Some(technique) = &args.technique {
        top["technique"] = json!(technique);
        top["bandwidths"] = json!(args.bandwidth);
        top["kernel"] = json!(args.kernel);
        top["convention"] = json!(args.convention);
        top["side"] = json!(match args.side {
            Side::Light => "light",
            Side::Camera => "camera",
        });
        top["beam_area"] = json!(args.beam_area);
    }
    top["answers"] = json!(answers);
    top.to_string()
}

fn as_csv(answers: &[Answer], args: &Args) -> String {
    let regularized = args.technique.is_some();
    let mut header =
        "id,class,E,L,error_bound,roots,singularity,singularity_type,strength,state".to_owned();
    if regularized {
        header += ",second_moment";
    }
    if args.certify {
        header += Proof::HEADER;
    }
    let mut lines = vec![header];
    lines.extend(answers.iter().map(|a| {
        let optional = |v: Option<f64>| v.map_or(String::new(), |s| format!("{s:e}"));
        let mut line = format!(
            "{},{},{},{},{:.1e},{},{},{},{},{}",
            a.id,
            a.class,
            a.text(a.irradiance),
            a.text(a.radiance),
            a.error_bound,
            a.roots,
            optional(a.singularity.map(|s| s.distance)),
            a.singularity.map_or("", |s| s.kind.name()),
            optional(a.strength),
            a.state.name(),
        );
        if regularized {
            line += &format!(",{}", optional(a.second_moment));
        }
        if let Some(proof) = &a.proof {
            line += &proof.fields();
        }
        line
    }));
    lines.join("\n")
}
