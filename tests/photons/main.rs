//! The photon family: kernels, radii that pixels choose, statistics of pixels, vertex connection and merging, selected bandwidths.
//!
//! Where random figures are compared, `Replicates::check` allows z = 6.2 standard errors of m = 32 replicates plus the error of the expectation: with
//! Student's t on 31 degrees of freedom a false alarm has probability 7e-7 per figure. Seeds are fixed. Each line says how large a bias
//! would have been caught.

mod adaptive;
mod kernels;
mod selection;
mod statistics;
mod vcm;

use nephroid::film::Film;
use nephroid::integrators::{Run, Settings, by_name};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

/// m.
pub const REPLICATES: u64 = 32;
/// z.
pub const STANDARD_ERRORS: f64 = 6.2;

/// Independent figures.
pub struct Replicates(pub Vec<f64>);

impl Replicates {
    /// Their mean.
    pub fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len() as f64
    }

    /// Its standard error.
    pub fn standard_error(&self) -> f64 {
        let (m, mean) = (self.0.len() as f64, self.mean());
        let squares = self.0.iter().map(|x| (x - mean) * (x - mean));
        (squares.sum::<f64>() / (m * (m - 1.0))).sqrt()
    }

    /// Distance from an expectation in standard errors.
    pub fn t(&self, expected: f64) -> f64 {
        (self.mean() - expected) / self.standard_error()
    }

    /// Asserts that the mean is what is expected, and that a bias of `weakest` times it would have been caught.
    pub fn check(&self, what: &str, expected: f64, error: f64, weakest: f64) {
        let (mean, se) = (self.mean(), self.standard_error());
        let allowed = STANDARD_ERRORS * se + error;
        println!(
            "{what}: {mean:.6e} expected {expected:.6e} ({:+.1} se), catches a bias of {:.2} %",
            self.t(expected),
            100.0 * (allowed + STANDARD_ERRORS * se) / expected
        );
        assert!(se > 0.0 && expected > 0.0, "{what}: nothing there");
        assert!(
            (mean - expected).abs() <= allowed,
            "{what}: {mean:e}, expected {expected:e} ± {allowed:e}"
        );
        assert!(
            allowed <= weakest * expected,
            "{what}: too weak, {allowed:e} of {expected:e}"
        );
    }
}

/// Class means of replicates of `iterations` iterations.
pub fn class_means(
    name: &str,
    settings: &Settings,
    entry: &Entry,
    iterations: u32,
    paths: u64,
    bandwidth: f64,
) -> Vec<(PathClass, Replicates)> {
    let prepared = by_name(name, settings).unwrap().prepare(entry);
    let classes = entry.kind.classes();
    let mut figures: Vec<_> = classes.iter().map(|&c| (c, Replicates(vec![]))).collect();
    for seed in 0..REPLICATES {
        let mut film = Film::new(entry.camera.width, entry.camera.height, classes);
        let mut run = Run::of(prepared.as_ref());
        for i in 0..iterations {
            run.iterate(4100 + seed, i, paths, bandwidth, &mut film);
        }
        for (figure, mean) in figures.iter_mut().zip(film.class_means()) {
            figure.1.0.push(mean);
        }
    }
    figures
}

/// The figures of a class.
pub fn of(figures: &[(PathClass, Replicates)], class: PathClass) -> &Replicates {
    &figures.iter().find(|f| f.0 == class).unwrap().1
}

/// The scene seen by a camera of few pixels that looks straight at a floor point from above, over a square of side 2·10⁻³ m.
pub fn close_up(entry: &Entry, [x, y]: [f64; 2], height: f64, pixels: u32) -> Entry {
    let mut entry = entry.clone();
    let camera = &mut entry.camera;
    camera.position = [x, y, height];
    camera.look_at = [x, y, 0.0];
    camera.up = [0.0, 1.0, 0.0];
    camera.field_of_view_degrees = (2.0 * libm::atan(1e-3 / height)).to_degrees();
    (camera.width, camera.height) = (pixels, pixels);
    entry
}
