//! Many iterations at a time, with the bits of one after the other.
//!
//! An iteration draws into a film of its own; films are added in the order of the iterations. The number of threads
//! decides how many are drawn at a time, and nothing else. Memory is one film per thread and one for the sum, less where
//! films are large.

use rayon::prelude::*;

use crate::film::Film;

use super::{Prepared, Schedule};

/// Paths of an iteration unless the film is large.
const PATHS: u64 = 1 << 18;
/// Films that are drawn at a time take at most this many bytes, or are one.
const FILM_BYTES: usize = 1 << 29;

/// Paths per iteration for a film of so many pixels: 262144, or four per pixel if that is more, so that adding films is
/// never the larger part of the work.
pub fn paths_per_iteration(pixels: usize) -> u64 {
    PATHS.max(4 * pixels as u64)
}

/// Draws `paths` paths, in iterations of `per_iteration` (the last one may be shorter), each at its bandwidth of the
/// schedule, and adds them to the film. `done` is told the number of paths drawn so far.
///
/// A method whose iterations learn from each other takes them one by one, on one thread; then the film must be empty.
///
/// Iterations beyond 2³² would repeat their random numbers: `paths` must not exceed 2³² `per_iteration`.
pub fn accumulate(
    prepared: &dyn Prepared,
    schedule: &Schedule,
    seed: u64,
    paths: u64,
    per_iteration: u64,
    film: &mut Film,
    done: impl Fn(u64),
) {
    let per_iteration = per_iteration.max(1);
    if let Some(mut run) = prepared.learner() {
        for iteration in 0..paths.div_ceil(per_iteration) {
            let n = (paths - iteration * per_iteration).min(per_iteration);
            let bandwidth = schedule.bandwidth(iteration as u32);
            run.iterate(seed, iteration as u32, n, bandwidth, film);
            done(film.paths);
        }
        return;
    }
    let bytes = (film.pixels() * film.classes.len() * size_of::<f64>()).max(1);
    let at_a_time = rayon::current_num_threads().min(FILM_BYTES / bytes).max(1);
    let mut films: Vec<Film> = (0..at_a_time)
        .map(|_| Film::new(film.width, film.height, film.classes))
        .collect();
    let iterations = paths.div_ceil(per_iteration);
    for wave in (0..iterations).step_by(at_a_time) {
        films.par_iter_mut().enumerate().for_each(|(k, film)| {
            film.clear();
            let iteration = wave + k as u64;
            let left = paths.saturating_sub(iteration * per_iteration);
            if left > 0 {
                let (iteration, n) = (iteration as u32, left.min(per_iteration));
                prepared.iterate(seed, iteration, n, schedule.bandwidth(iteration), film);
            }
        });
        // Films that had nothing left to draw are empty.
        for drawn in films.iter().filter(|f| f.paths > 0) {
            film.add(drawn);
        }
        done(film.paths);
    }
}
