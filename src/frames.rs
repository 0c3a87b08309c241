//! Expected means over the areas of an image at finite bandwidth, for any kind with a floor: tiles of the picture, sampled
//! and split side by side (see [`nephroid_analytic::bandwidth::tile`]).

use core::ops::Range;

use nephroid_analytic::bandwidth::entry::Estimator;
use nephroid_analytic::bandwidth::frame::FrameExpectation;
use nephroid_analytic::bandwidth::tile::{self, Sampled, Tile, refine, together};
use nephroid_analytic::bandwidth::{Bounded, Convention, Kernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter};
use rayon::prelude::*;

use crate::regions::{Area, MOST_LEVELS, Regions, SMALLEST_TILE};
use crate::scattered;
use crate::truth::{self, TruthImage};

/// Tiles sampled at most for one class.
const MOST: usize = 20_000;
/// Part of the tolerance that a sample is known to.
const SAMPLES: f64 = 0.2;
/// Tolerance of the first look, which tells how bright the picture is.
const FIRST: f64 = 1e-2;
/// Finest tolerance of a row of pixels that are covered with tiles.
const ROWS: f64 = 1e-2;
/// Cross-section [m²] of parallel light to which second moments of photons refer.
const BEAM: f64 = 1.0;

/// The film of an estimator.
///
/// # Errors
/// What [`FrameExpectation::new`] finds.
pub fn prepared(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> Result<FrameExpectation, InvalidParameter> {
    let estimator = Estimator {
        technique,
        kernel,
        convention: Convention::Exact,
        bandwidths,
    };
    FrameExpectation::new(entry, estimator, BEAM)
}

/// See [`crate::expectation::area_moments`], with one kernel for all bandwidths. Second moments of the photons of parallel light are
/// those of a beam of one square metre.
///
/// # Errors
/// What [`FrameExpectation::new`] finds.
pub fn area_moments(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: [f64; 2],
    regions: &Regions,
) -> Result<Vec<(PathClass, Vec<Moments>)>, InvalidParameter> {
    let frame = prepared(entry, technique, kernel, bandwidths)?;
    let areas: Vec<Vec<bool>> = (regions.areas().iter())
        .map(|area| selected(area, frame.size()))
        .collect();
    let used = |tile: &Tile| overlaps(tile, &areas[0], frame.size().0);
    let of_class = |class: usize| -> Vec<Moments> {
        if frame.scatters(class) {
            return scattered::areas(&frame, class, &areas, tolerance);
        }
        let start = tiles(frame.size(), MOST_LEVELS).into_iter().filter(used);
        let found = cover(&frame, class, start.collect(), tolerance);
        (areas.iter())
            .map(|area| moments(&found, area, frame.size().0))
            .collect()
    };
    Ok((frame.classes().into_iter().enumerate())
        .map(|(k, class)| (class, of_class(k)))
        .collect())
}

/// The exact image at finite bandwidth: regular classes as they are, the others as the estimator has them on average. Pixels of
/// these are known to `tolerance` of the class's mean or to what a budget of points gives; the errors tell, and are estimates.
///
/// # Errors
/// What [`FrameExpectation::new`] finds.
pub fn image(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidth: f64,
    tolerance: f64,
) -> Result<TruthImage, InvalidParameter> {
    let frame = prepared(entry, technique, kernel, &[bandwidth])?;
    let mut image = truth::image(entry, tolerance);
    let (width, height) = frame.size();
    for (k, class) in frame.classes().into_iter().enumerate() {
        let pixels = if frame.scatters(k) {
            scattered::pixels(&frame, k, tolerance)
        } else {
            let rows: Vec<Vec<Bounded>> = (0..height)
                .into_par_iter()
                .map(|j| {
                    let floor = [0.0, f64::INFINITY];
                    let row = frame.pixels(k, 0..width, j..j + 1, tolerance.max(ROWS), floor);
                    row.into_iter().map(|m| m.mean).collect()
                })
                .collect();
            rows.concat()
        };
        if let Some(layer) = image.classes.iter().position(|&c| c == class) {
            image.layers[layer] = pixels.iter().map(|b| b.value).collect();
            image.errors[layer] = pixels.iter().map(|b| b.error).collect();
        }
    }
    Ok(image)
}

/// Moments of a class summed over a rectangle of pixels, each to a tolerance relative to itself.
pub fn region(
    frame: &FrameExpectation,
    class: usize,
    columns: Range<u32>,
    rows: Range<u32>,
    tolerance: [f64; 2],
) -> Moments {
    let size = (columns.len() as u32, rows.len() as u32);
    let offset = [f64::from(columns.start), f64::from(rows.start)];
    let moved = |t: Tile| Tile {
        low: [0, 1].map(|k| t.low[k] + offset[k]),
        high: [0, 1].map(|k| t.high[k] + offset[k]),
    };
    let start = tiles(size, MOST_LEVELS).into_iter().map(moved).collect();
    tile::total(&cover(frame, class, start, tolerance))
}

/// Samples a class on tiles, and on parts of them until the sum over all is known to the tolerances; an infinite one asks for nothing.
fn cover(
    frame: &FrameExpectation,
    class: usize,
    start: Vec<Tile>,
    tolerance: [f64; 2],
) -> Vec<Sampled> {
    let only_asked = |values: [f64; 2]| {
        [0, 1].map(|k| {
            if tolerance[k].is_infinite() {
                f64::INFINITY
            } else {
                values[k]
            }
        })
    };
    let sample = |tiles: &[Tile], tolerance: f64, floor: [f64; 2]| -> Vec<Sampled> {
        let one = |t: &Tile| frame.sample(class, *t, tolerance, floor);
        tiles.par_iter().map(one).collect()
    };
    // The first look is at all of them together.
    let edge = |pick: fn(&Tile) -> f64, choose: fn(f64, f64) -> f64| {
        start.iter().map(pick).reduce(choose).unwrap_or(0.0)
    };
    let all = Tile {
        low: [edge(|t| t.low[0], f64::min), edge(|t| t.low[1], f64::min)],
        high: [edge(|t| t.high[0], f64::max), edge(|t| t.high[1], f64::max)],
    };
    let area = (all.high[0] - all.low[0]) * (all.high[1] - all.low[1]);
    let parts = all.parts().unwrap_or_default();
    let first = total(&sample(&parts, FIRST, only_asked([0.0; 2])));
    let typical = first.map(|s| s.abs() / area.max(f64::MIN_POSITIVE));
    let finest = tolerance[0].min(tolerance[1]);
    let goal = |sum: [f64; 2]| only_asked([0, 1].map(|k| tolerance[k] * sum[k]));
    refine(start, MOST, goal, |tiles| {
        sample(tiles, SAMPLES * finest, only_asked(typical))
    })
}

/// The tiles of a quadtree's level, or of the last one of which they are large enough.
fn tiles((width, height): (u32, u32), level: u32) -> Vec<Tile> {
    let fits = |level: &u32| width.min(height) >> level >= SMALLEST_TILE;
    let parts = 1 << (0..=level).take_while(fits).last().unwrap_or(0);
    let cut = |length: u32, i: u32| {
        f64::from((u64::from(length) * u64::from(i) / u64::from(parts)) as u32)
    };
    let tile = |k: u32| {
        let (i, j) = (k % parts, k / parts);
        Tile {
            low: [cut(width, i), cut(height, j)],
            high: [cut(width, i + 1), cut(height, j + 1)],
        }
    };
    (0..parts * parts).map(tile).collect()
}

fn total(tiles: &[Sampled]) -> [f64; 2] {
    tiles.iter().fold([0.0; 2], |sum, s| {
        let value = s.sum();
        [sum[0] + value[0], sum[1] + value[1]]
    })
}

/// The pixels of an area.
fn selected(area: &Area, (width, height): (u32, u32)) -> Vec<bool> {
    let pixels = width as usize * height as usize;
    match area {
        Area::Image => vec![true; pixels],
        Area::Tile {
            x,
            y,
            width: columns,
            height: rows,
            ..
        } => (0..pixels as u32)
            .map(|k| {
                let (i, j) = (k % width, k / width);
                *x <= i && i < x + columns && *y <= j && j < y + rows
            })
            .collect(),
        Area::Mask(list) => {
            let mut mask = vec![false; pixels];
            for &k in list {
                mask[k as usize] = true;
            }
            mask
        }
    }
}

/// Whether a tile has a pixel of an area.
fn overlaps(tile: &Tile, area: &[bool], width: u32) -> bool {
    let range = |k: usize| tile.low[k] as usize..libm::ceil(tile.high[k]) as usize;
    range(1).any(|j| range(0).any(|i| area[j * width as usize + i]))
}

/// The mean over the pixels of an area.
fn moments(tiles: &[Sampled], area: &[bool], width: u32) -> Moments {
    let pixels = area.iter().filter(|a| **a).count() as f64;
    let mut sum = Moments::default();
    let mut errors = Vec::new();
    for s in tiles {
        let (mut value, mut inside) = ([0.0; 2], 0);
        for (k, pixel) in s.pixels.iter().enumerate() {
            let (i, j) = (k as u32 % s.count[0], k as u32 / s.count[0]);
            if area[((s.first[1] + j) * width + s.first[0] + i) as usize] {
                inside += 1;
                value = [value[0] + pixel[0], value[1] + pixel[1]];
            }
        }
        if inside == 0 {
            continue;
        }
        let error = if inside == s.pixels.len() {
            s.error
        } else {
            s.uneven
        };
        sum.mean.value += value[0] / pixels;
        sum.second_moment.value += value[1] / pixels;
        errors.push(error);
    }
    let error = [0, 1].map(|k| together(errors.iter().map(|e| e[k])) / pixels);
    (sum.mean.error, sum.second_moment.error) = (error[0], error[1]);
    sum
}
