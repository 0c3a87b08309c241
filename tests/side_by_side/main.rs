//! Methods beside the regularized ones: the minimal path tracer of the slides, specular manifold sampling, chains of which every
//! vertex is mollified, and what they cost.
//!
//! Unless a test says otherwise, a figure is the mean of 32 replicates, and must be within 6.2 standard errors (plus a
//! stated error of what it is compared with) of the expectation: Student's t on 31 degrees of freedom exceeds that with
//! probability 7e-7. Seeds are fixed.

mod bench;
mod every_vertex;
mod manifold;
mod minimal;
#[allow(dead_code)]
#[path = "../../examples/minimal_regularized_pt.rs"]
mod minimal_regularized_pt;

use nephroid::film::Film;
use nephroid::integrators::Prepared;
use nephroid_analytic::scene::{Camera, Entry};

/// The z of this file's head.
const STANDARD_ERRORS: f64 = 6.2;
const REPLICATES: u64 = 32;

/// The entry seen through a camera of one pixel that looks at next to nothing but a floor point, from where its own camera
/// is.
fn at_point(entry: &Entry, [x, y]: [f64; 2]) -> Entry {
    let mut entry = entry.clone();
    entry.camera = Camera {
        look_at: [x, y, 0.0],
        field_of_view_degrees: 1e-3,
        width: 1,
        height: 1,
        ..entry.camera
    };
    entry
}

/// Means and standard errors of each layer of a one-pixel film, and the mean of squares of a path's value estimated from
/// the spread of `replicates` replicates.
struct Measured {
    mean: Vec<f64>,
    error: Vec<f64>,
    second_moment: Vec<f64>,
}

fn measure(
    prepared: &dyn Prepared,
    entry: &Entry,
    bandwidth: f64,
    replicates: u64,
    paths: u64,
) -> Measured {
    let layers = entry.kind.classes().len();
    let (mut sums, mut squares) = (vec![0.0; layers], vec![0.0; layers]);
    for replicate in 0..replicates {
        let mut film = Film::new(1, 1, entry.kind.classes());
        prepared.iterate(0x5eed_0000 + replicate, 0, paths, bandwidth, &mut film);
        for (k, layer) in film.layers.iter().enumerate() {
            let mean = layer[0] / paths as f64;
            sums[k] += mean;
            squares[k] += mean * mean;
        }
    }
    let n = replicates as f64;
    let mean: Vec<f64> = sums.iter().map(|s| s / n).collect();
    let spread = |k: usize| (squares[k] / n - mean[k] * mean[k]).max(0.0) * n / (n - 1.0);
    Measured {
        error: (0..layers).map(|k| (spread(k) / n).sqrt()).collect(),
        second_moment: (0..layers)
            .map(|k| spread(k) * paths as f64 + mean[k] * mean[k])
            .collect(),
        mean,
    }
}
