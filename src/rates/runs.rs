//! Replicates of a region: at given bandwidths, and along a schedule.

use std::time::Instant;

use rayon::prelude::*;

use super::region::View;
use crate::film::{Film, compensated_sum};
use crate::integrators::Prepared;
use crate::verify::replicates::Seeds;

/// Seeds are taken from phases that nothing else uses: this one for a schedule, those above for the bandwidths one by one.
const PHASE: u32 = 1 << 16;

/// The mean radiance of a region in a film that is sums over `paths`.
fn mean(film: &Film, layer: usize, view: &View, paths: f64) -> f64 {
    let width = film.width as usize;
    let columns = view.columns.start as usize..view.columns.end as usize;
    let rows: Vec<f64> = view
        .rows
        .clone()
        .map(|j| {
            let row = &film.layers[layer][j as usize * width..];
            compensated_sum(&row[columns.clone()])
        })
        .collect();
    compensated_sum(&rows) / (paths * view.area())
}

/// A film for replicates of a view.
fn film_of(view: &View) -> Film {
    let camera = &view.entry.camera;
    Film::new(camera.width, camera.height, view.entry.kind.classes())
}

/// What a replicate says at each bandwidth.
#[derive(Clone, Debug)]
pub struct AtBandwidths {
    /// The region's mean.
    pub means: Vec<f64>,
    /// Seconds.
    pub seconds: Vec<f64>,
}

/// Runs replicates, each with `paths[i]` paths at `bandwidths[i]`, independently. The same bits (but for the seconds) for any number
/// of threads.
pub fn at_bandwidths(
    prepared: &dyn Prepared,
    view: &View,
    layer: usize,
    bandwidths: &[f64],
    paths: &[u64],
    seeds: Seeds,
    count: u32,
) -> Vec<AtBandwidths> {
    (0..count)
        .into_par_iter()
        .map_init(
            || film_of(view),
            |film, k| {
                let (mut means, mut seconds) = (Vec::new(), Vec::new());
                for (i, (&bandwidth, &paths)) in (1..).zip(bandwidths.iter().zip(paths)) {
                    film.clear();
                    let started = Instant::now();
                    let seed = seeds.replicate(PHASE + i, k);
                    prepared.iterate(seed, 0, paths, bandwidth, film);
                    means.push(mean(film, layer, view, paths as f64));
                    seconds.push(started.elapsed().as_secs_f64());
                }
                AtBandwidths { means, seconds }
            },
        )
        .collect()
}

/// What a replicate says along a schedule, at n = 1, 2, 4, ….
#[derive(Clone, Debug, Default)]
pub struct Along {
    /// The running mean of the first n iterations.
    pub means: Vec<f64>,
    /// Contributions that are not zero, and iterations that have any, since the n before (for n = 1: in it).
    pub contributions: Vec<u64>,
    /// See `contributions`.
    pub alive: Vec<u64>,
    /// Seconds in all.
    pub seconds: f64,
}

/// Runs replicates along a schedule, whose length is a power of two: each iteration has as many paths and its own bandwidth.
pub fn along(
    prepared: &dyn Prepared,
    view: &View,
    layer: usize,
    schedule: &[f64],
    paths: u64,
    seeds: Seeds,
    count: u32,
) -> Vec<Along> {
    (0..count)
        .into_par_iter()
        .map_init(
            || film_of(view),
            |film, k| {
                film.clear();
                let started = Instant::now();
                let seed = seeds.replicate(PHASE, k);
                let mut result = Along::default();
                let (mut alive, mut before) = (0, 0);
                for (i, &bandwidth) in (0..).zip(schedule) {
                    let seen = film.nonzero[layer];
                    prepared.iterate(seed, i, paths, bandwidth, film);
                    alive += u64::from(film.nonzero[layer] > seen);
                    let n = u64::from(i) + 1;
                    if n.is_power_of_two() {
                        result
                            .means
                            .push(mean(film, layer, view, n as f64 * paths as f64));
                        result.contributions.push(film.nonzero[layer] - before);
                        result.alive.push(alive);
                        (alive, before) = (0, film.nonzero[layer]);
                    }
                }
                result.seconds = started.elapsed().as_secs_f64();
                result
            },
        )
        .collect()
}
