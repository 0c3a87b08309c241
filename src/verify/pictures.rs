//! Pictures for a report: what each integrator draws, beside what it should. On replicates of their own, after the verdicts
//! and without any influence on them.

use rayon::prelude::*;

use super::expected::Truths;
use super::replicates::{Canvas, Seeds, Shape};
use super::run::{Request, first_shape};
use super::suite::Pair;
use super::verdicts::Outcome;
use crate::error::Error;
use crate::film::Film;
use crate::integrators::{Prepared, Run, Treatment};
use crate::judge::finding::State;
use crate::regions::Regions;
use crate::report::comparison::{Cells, Comparison, Grid};

/// Phase of the streams, apart from those of pilots, of the test and of the diagnosis.
const PHASE: u32 = 2001;
/// Replicates of a picture: enough to tell the noise of a cell.
const REPLICATES: u32 = 32;
/// Most cells in a row: of single pixels a few hundred thousand paths tell little.
const MOST_CELLS: usize = 32;

/// A picture of each pair of scene and integrator of which an unchanged scene was judged.
///
/// # Errors
/// A kernel or a bandwidth that does not fit.
pub fn draw(
    request: &Request,
    outcome: &Outcome,
    truths: &mut Truths,
) -> Result<Vec<Comparison>, Error> {
    let mut drawn: Vec<Comparison> = Vec::new();
    for v in &outcome.verdicts {
        let is_done = |c: &Comparison| c.scene == v.scene && c.integrator == v.integrator;
        let is_empty = v.finding.state == State::NotSampled || v.paths == 0;
        if v.variation.is_some() || is_empty || drawn.iter().any(is_done) {
            continue;
        }
        let scene = request.scenes.iter().position(|s| s.entry.name == v.scene);
        let integrator = request
            .integrators
            .iter()
            .position(|i| i.name() == v.integrator);
        if let (Some(scene), Some(integrator)) = (scene, integrator) {
            drawn.extend(one(request, scene, integrator, truths)?);
        }
    }
    Ok(drawn)
}

/// The picture of a pair; `None` if the method samples nothing there.
fn one(
    request: &Request,
    scene: usize,
    integrator: usize,
    truths: &mut Truths,
) -> Result<Option<Comparison>, Error> {
    let entry = &request.scenes[scene].entry;
    let method = request.integrators[integrator].as_ref();
    let plan = Pair::new(scene, entry, integrator, method).plan;
    let layers: Vec<usize> = (0..plan.len())
        .filter(|&k| plan[k].treatment != Treatment::NotSampled)
        .collect();
    if layers.is_empty() {
        return Ok(None);
    }
    let (width, height) = (entry.camera.width, entry.camera.height);
    let shape = first_shape(method, &plan, request.bandwidth, entry, request.effort);
    let is_regularized = |k: &usize| matches!(plan[*k].treatment, Treatment::Regularized(_));
    let regularized = layers.iter().any(is_regularized);
    let exact = truths.image_of(scene, entry);
    let mut truth = vec![0.0; exact.layers[0].len()];
    for &k in &layers {
        truth
            .iter_mut()
            .zip(&exact.layers[k])
            .for_each(|(t, v)| *t += v);
    }
    let regions = Regions::quadtree(width, height);
    let [columns, rows] = [width, height].map(|n| n as usize);
    let (grid, expected) = if regularized {
        let kernel = request.truth_kernel();
        let bandwidths = &shape.bandwidths;
        let found = truths.of(scene, entry, &plan, &regions, kernel, bandwidths)?;
        let grid = Grid::of_tiles(columns, rows, &regions);
        let first = regions.areas().len() - grid.cells();
        let mut sums = Some(vec![0.0; grid.cells()]);
        for &k in &layers {
            let areas = found[k].as_ref().map(|e| &e.areas()[first..]);
            sums = sums.zip(areas).map(|(mut sums, areas)| {
                sums.iter_mut().zip(areas).for_each(|(s, a)| *s += a.value);
                sums
            });
        }
        (grid, sums)
    } else {
        let grid = Grid::of_pixels(columns, rows, MOST_CELLS);
        (grid, Some(grid.means(&truth, None)))
    };
    let seeds = Seeds::new(request.seed, &entry.name, method.name());
    let canvas = Canvas {
        width,
        height,
        classes: entry.kind.classes(),
    };
    let prepared = method.prepare(entry);
    let sample = sample(prepared.as_ref(), canvas, &layers, &shape, seeds, grid);
    let names: Vec<String> = layers.iter().map(|&k| plan[k].class.to_string()).collect();
    let paths = u64::from(REPLICATES) * shape.paths();
    let mut about = vec![format!(
        "Drawn for this page with {paths} paths in {REPLICATES} replicates, seed {}: not the sample that the verdicts rest on.",
        request.seed
    )];
    if regularized {
        about.push(format!(
            "Regularized at α = r = {}: the picture of the truth is that at bandwidth 0, the maps compare with the exact \
             expectation at the bandwidth.",
            request.bandwidth
        ));
    }
    if expected.is_none() {
        about.push(
            "No expectation is known for this method: there is nothing to compare with.".to_owned(),
        );
    }
    if method.has_infinite_variance_at_folds() {
        about.push("Pixels that a fold crosses are shown, but not judged.".to_owned());
    }
    let cells =
        expected.map(|truth| Cells::new(grid, &sample.cells, &truth, Some(&sample.variance)));
    Ok(Some(Comparison {
        scene: entry.name.clone(),
        integrator: method.name().to_owned(),
        content: names.join(" + "),
        width,
        height,
        truth,
        observed: sample.pixels,
        cells,
        about,
    }))
}

/// The mean image of the replicates, their means over cells, and the variances of these.
struct Sample {
    pixels: Vec<f64>,
    cells: Vec<f64>,
    variance: Vec<f64>,
}

/// Draws the sum of some layers.
fn sample(
    prepared: &dyn Prepared,
    canvas: Canvas,
    layers: &[usize],
    shape: &Shape,
    seeds: Seeds,
    grid: Grid,
) -> Sample {
    let film = || Film::new(canvas.width, canvas.height, canvas.classes);
    let drawn: Vec<Vec<f64>> = (0..REPLICATES)
        .into_par_iter()
        .map_init(film, |film, k| {
            film.clear();
            let seed = seeds.replicate(PHASE, k);
            let mut run = Run::of(prepared);
            for (i, &bandwidth) in (0..).zip(&shape.bandwidths) {
                run.iterate(seed, i, shape.paths_per_iteration, bandwidth, film);
            }
            let scale = 1.0 / film.paths as f64;
            let value = |p| layers.iter().map(|&l| film.layers[l][p]).sum::<f64>() * scale;
            (0..film.pixels()).map(value).collect()
        })
        .collect();
    let n = f64::from(REPLICATES);
    let pixel = |p: usize| drawn.iter().map(|image| image[p]).sum::<f64>() / n;
    let pixels: Vec<f64> = (0..grid.width * grid.height).map(pixel).collect();
    let of_cells: Vec<Vec<f64>> = drawn.iter().map(|image| grid.means(image, None)).collect();
    let cell = |c: usize| {
        let values: Vec<f64> = of_cells.iter().map(|cells| cells[c]).collect();
        crate::judge::evidence::moments(&values)
    };
    let (cells, variance) = (0..grid.cells())
        .map(cell)
        .map(|(mean, variance)| (mean, variance / n))
        .unzip();
    Sample {
        pixels,
        cells,
        variance,
    }
}
