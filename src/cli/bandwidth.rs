//! `nephroid bandwidth`: which bandwidth is best for a number of paths.

use std::path::PathBuf;

use nephroid_analytic::bandwidth::law::{Law, Place};
use nephroid_analytic::bandwidth::optimum::{Best, Curve, Study, fixed, progressive};
use nephroid_analytic::bandwidth::{self, Convention, Kernel, Technique, UnknownName};
use nephroid_analytic::camera::Film;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::{Entry, InvalidParameter};
use rayon::prelude::*;

use super::bandwidth_answer::{as_json, as_text};
use crate::error::Error;
use crate::{entry, exit};

/// Tell which bandwidth has the least error for a number of paths, from exact expectations and variances.
///
/// Per path class and floor point: the best single bandwidth with the bias and the standard deviation that it leads to, the
/// best first bandwidth of a progressive average alpha_k = alpha_1 k^(-lambda) with the best exponent lambda, and the preview
/// bandwidth at which no path is missed: the smallest at which all N paths miss with probability epsilon at most. The
/// last line minimises the sum of the squared errors over a grid of points of the picture. At a point on a caustic or on an
/// edge no bandwidth is best; the order of the error is told.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// Number of paths that reach for each point.
    #[arg(long, value_name = "N", value_parser = super::count)]
    pub(super) paths: u64,
    /// camera, light, symmetric, merge or linked. Default: camera, or merge for chains of interactions.
    #[arg(long, value_name = "T")]
    technique: Option<String>,
    /// Kernel: cone, epanechnikov, vmf, disc or biweight (default: cone, or disc for merge).
    #[arg(long, value_name = "K")]
    kernel: Option<String>,
    /// How a linked bandwidth atan(r/d) finds d: exact, vertex or light.
    #[arg(long, value_name = "C", default_value = "exact")]
    pub(super) convention: String,
    /// Floor points: a CSV file with the header x,y,z. Default: three lit points of the picture.
    #[arg(long, value_name = "FILE.csv")]
    points: Option<PathBuf>,
    /// Probability of a miss that a preview may have, 1e-12 to 0.5.
    #[arg(long, value_name = "P", default_value_t = 1e-3)]
    pub(super) epsilon: f64,
    /// Cross-section over which the photons of parallel light are uniform, in square metres.
    #[arg(long, value_name = "A", default_value_t = 1.0)]
    pub(super) beam_area: f64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What is told of a point and a class.
pub(super) struct Row {
    pub point: [f64; 2],
    pub law: Law,
    pub truth: Option<f64>,
    pub curve: Option<Curve>,
    pub fixed: Option<Best>,
    pub progressive: Option<Best>,
    pub decay: Option<f64>,
    pub preview: Option<f64>,
}

/// What is told of a class over the picture.
pub(super) struct Whole {
    pub class: String,
    pub points: usize,
    pub fixed: Option<Best>,
    pub progressive: Option<Best>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let file = &args.scene;
    let refused = |key: &str, found: String, allowed: &str| Error::Parameter {
        file: "command line".to_owned(),
        key: key.to_owned(),
        found,
        allowed: allowed.to_owned(),
    };
    if !(args.epsilon >= 1e-12 && args.epsilon <= 0.5) {
        return Err(refused(
            "--epsilon",
            args.epsilon.to_string(),
            "1e-12 to 0.5",
        ));
    }
    if !(args.beam_area > 0.0 && args.beam_area <= 1e12) {
        return Err(refused(
            "--beam-area",
            args.beam_area.to_string(),
            "more than 0, up to 1e12 m²",
        ));
    }
    let Some(truth) = FloorTruth::new(&entry) else {
        return Err(Error::Parameter {
            file: file.clone(),
            key: "kind".to_owned(),
            found: entry.kind.name().to_owned(),
            allowed: "a scene with a floor".to_owned(),
        });
    };
    let (study, technique, kernel) = study(args, &entry)?;
    let points = match &args.points {
        Some(path) => super::probe::floor_points(path, &entry, &truth)?,
        None => Vec::new(),
    };
    let grid = grid(&entry, &truth);
    let points = if args.points.is_some() {
        points
    } else {
        typical(&grid, &truth)
    };

    let rows: Vec<Row> = points
        .par_iter()
        .flat_map_iter(|&x| rows_of(args, &study, &truth, x))
        .collect();
    let wholes = whole(args, &study, &grid);
    super::print(&if args.json {
        as_json(args, &entry, (technique, kernel), &rows, &wholes).to_string()
    } else {
        as_text(args, (technique, kernel), &rows, &wholes)
    });
    Ok(if rows.is_empty() && wholes.is_empty() {
        exit::NOTHING_RAN
    } else {
        exit::PASS
    })
}

fn study(args: &Args, entry: &Entry) -> Result<(Study, Technique, Kernel), Error> {
    let unknown = |what, e: UnknownName| Error::UnknownName {
        what,
        found: e.found,
        allowed: e.allowed,
    };
    let option = |e: InvalidParameter| Error::Parameter {
        file: "command line".to_owned(),
        key: format!("--{}", if e.key == "kind" { "technique" } else { &e.key }),
        found: e.found,
        allowed: e.allowed,
    };
    let convention: Convention = args
        .convention
        .parse()
        .map_err(|e| unknown("convention", e))?;
    let kernel = |technique: Technique| match &args.kernel {
        Some(k) => k.parse::<Kernel>().map_err(|e| unknown("kernel", e)),
        None => Ok(technique.default_kernel()),
    };
    let techniques = match &args.technique {
        Some(name) => vec![name.parse().map_err(|e| unknown("technique", e))?],
        None => vec![Technique::Camera, Technique::Merge],
    };
    let mut last = None;
    for technique in techniques {
        let kernel = kernel(technique)?;
        // Any bandwidth: whether the kernel fits the technique.
        bandwidth::check(technique, kernel, &[0.1]).map_err(option)?;
        match Study::new(entry, technique, kernel, convention, args.beam_area) {
            Ok(study) => return Ok((study, technique, kernel)),
            Err(e) => last = Some(e),
        }
    }
    Err(option(last.unwrap_or(InvalidParameter {
        key: "technique".to_owned(),
        found: String::new(),
        allowed: "camera, light, symmetric, merge, linked".to_owned(),
    })))
}

/// Columns and rows of the grid of points.
const GRID: u32 = 5;

/// Floor points that a grid of film points sees directly; where it sees fewer than three lit ones, a grid of the floor.
fn grid(entry: &Entry, truth: &FloorTruth) -> Vec<[f64; 2]> {
    let film = Film::new(&entry.camera);
    let at = |k: u32, n: u32| f64::from(n) * (f64::from(k) + 0.5) / f64::from(GRID);
    let cells = || (0..GRID * GRID).map(|k| [k % GRID, k / GRID]);
    let seen: Vec<[f64; 2]> = cells()
        .filter_map(|[i, j]| {
            let d = film.direction(at(i, film.width), at(j, film.height));
            let t = -film.position.z / d.z;
            let p = [film.position.x + t * d.x, film.position.y + t * d.y];
            (t > 0.0 && t.is_finite() && truth.is_on_floor(p[0], p[1])).then_some(p)
        })
        .collect();
    if seen.iter().filter(|p| light(truth, **p) > 0.0).count() >= 3 {
        return seen;
    }
    cells()
        .map(|cell| {
            [0, 1].map(|axis| {
                let [low, high] = truth.range(axis);
                low + (high - low) * (f64::from(cell[axis]) + 0.5) / f64::from(GRID)
            })
        })
        .collect()
}

/// Irradiance by specular surfaces.
fn light(truth: &FloorTruth, [x, y]: [f64; 2]) -> f64 {
    truth
        .at(x, y)
        .iter()
        .filter(|t| t.class.is_caustic() && t.is_finite())
        .map(|t| t.irradiance.value)
        .sum()
}

/// Three lit points of the grid: at the quartiles of the irradiance.
fn typical(grid: &[[f64; 2]], truth: &FloorTruth) -> Vec<[f64; 2]> {
    let mut lit: Vec<([f64; 2], f64)> = grid
        .iter()
        .map(|p| (*p, light(truth, *p)))
        .filter(|(_, e)| *e > 0.0)
        .collect();
    lit.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut chosen: Vec<usize> = [1, 2, 3]
        .map(|k| k * lit.len().saturating_sub(1) / 4)
        .into();
    chosen.dedup();
    chosen.iter().filter_map(|&k| Some(lit.get(k)?.0)).collect()
}

/// λ = 1/(d + 2p).
fn decay(law: &Law) -> Option<f64> {
    let p = law.order.filter(|p| *p > 0.0)?;
    Some(1.0 / (law.squared_order + 2.0 * p))
}

fn rows_of(args: &Args, study: &Study, truth: &FloorTruth, x: [f64; 2]) -> Vec<Row> {
    let paths = args.paths as f64;
    let light = truth.at(x[0], x[1]);
    let laws = study.laws(x[0], x[1]).into_iter().enumerate();
    laws.filter_map(|(class, law)| {
        let law = law?;
        let curve = study.curve_of(law, class, x);
        let one = curve.as_ref().map(|c| [c]);
        let decay = decay(&law).filter(|_| law.place == Place::Smooth);
        Some(Row {
            point: x,
            law,
            truth: light
                .iter()
                .find(|t| t.class == law.class && t.is_finite())
                .map(|t| t.irradiance.value),
            fixed: one.and_then(|c| fixed(&c, paths)),
            progressive: one.and_then(|c| progressive(&c, args.paths, decay?)),
            preview: study.preview(class, x, paths, args.epsilon),
            decay,
            curve,
        })
    })
    .collect()
}

/// The best for the grid: the sum of the squared errors over all points with a curve.
fn whole(args: &Args, study: &Study, grid: &[[f64; 2]]) -> Vec<Whole> {
    (0..study.classes().len())
        .filter_map(|class| {
            let curves: Vec<Curve> = grid
                .par_iter()
                .filter_map(|&x| study.curve(class, x))
                .collect();
            let lit: Vec<&Curve> = curves.iter().collect();
            Some(Whole {
                class: study.classes().get(class)?.to_string(),
                points: lit.len(),
                fixed: fixed(&lit, args.paths as f64),
                progressive: progressive(&lit, args.paths, 1.0 / 6.0),
            })
        })
        .collect()
}
