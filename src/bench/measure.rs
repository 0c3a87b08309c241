//! The replicates of one integrator at one bandwidth.

use rayon::prelude::*;

use super::clock::Clock;
use super::{Checkpoint, ITERATIONS, REPLICATES, Subject};
use crate::film::{Film, compensated_sum};
use crate::integrators::Integrator;

/// What came of it.
pub(super) struct Run {
    /// CPU seconds of an iteration, mean of all.
    pub seconds: f64,
    /// By layer.
    pub checkpoints: Vec<Vec<Checkpoint>>,
}

/// A replicate's images at the checkpoints, divided by the class's mean, and its time.
struct Replicate {
    seconds: f64,
    /// `images[checkpoint][layer]`: the pixels that count.
    images: Vec<Vec<Vec<f64>>>,
}

/// Runs the replicates, each on one thread; the same errors whatever the number of threads.
pub(super) fn run(
    subject: &Subject,
    integrator: &dyn Integrator,
    paths: u64,
    bandwidth: f64,
    seed: u64,
) -> Run {
    let Subject {
        entry,
        counts,
        truth,
    } = subject;
    let prepared = integrator.prepare(entry);
    let schedule = integrator.schedule(bandwidth);
    let kept = |pixels: &[f64]| -> Vec<f64> {
        let all = pixels.iter().zip(counts);
        all.filter(|(_, counts)| **counts)
            .map(|(v, _)| *v)
            .collect()
    };
    let truths: Vec<Vec<f64>> = truth.layers.iter().map(|l| kept(l)).collect();
    let replicate = |replicate: u32| {
        let camera = &entry.camera;
        let mut film = Film::new(camera.width, camera.height, entry.kind.classes());
        let (mut images, mut seconds) = (Vec::new(), 0.0);
        for iteration in 0..ITERATIONS {
            let clock = Clock::start();
            let seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ u64::from(replicate);
            prepared.iterate(
                seed,
                iteration,
                paths,
                schedule.bandwidth(iteration),
                &mut film,
            );
            seconds += clock.seconds();
            if (iteration + 1).is_power_of_two() {
                let scale = 1.0 / film.paths as f64;
                let image = |layer: &Vec<f64>| kept(layer).into_iter().map(|v| v * scale).collect();
                images.push(film.layers.iter().map(image).collect());
            }
        }
        Replicate { seconds, images }
    };
    let replicates: Vec<Replicate> = (0..REPLICATES).into_par_iter().map(replicate).collect();
    let checkpoints = (0..truths.len())
        .map(|layer| {
            (0..replicates[0].images.len())
                .map(|k| {
                    let images: Vec<&[f64]> = replicates
                        .iter()
                        .map(|r| r.images[k][layer].as_slice())
                        .collect();
                    checkpoint(1 << k, &images, &truths[layer])
                })
                .collect()
        })
        .collect();
    let seconds: f64 = replicates.iter().map(|r| r.seconds).sum();
    Run {
        seconds: seconds / f64::from(REPLICATES * ITERATIONS),
        checkpoints,
    }
}

fn checkpoint(iterations: u32, images: &[&[f64]], truth: &[f64]) -> Checkpoint {
    let n = images.len() as f64;
    let mut errors = Vec::with_capacity(truth.len());
    let mut variances = Vec::with_capacity(truth.len());
    let mut biases = Vec::with_capacity(truth.len());
    for (pixel, &t) in truth.iter().enumerate() {
        let mean = images.iter().map(|i| i[pixel]).sum::<f64>() / n;
        let square = |about: f64| -> f64 {
            let of = |i: &&[f64]| (i[pixel] - about) * (i[pixel] - about);
            images.iter().map(of).sum()
        };
        errors.push(square(t) / n);
        let variance = square(mean) / (n - 1.0);
        variances.push(variance);
        biases.push((mean - t) * (mean - t) - variance / n);
    }
    let pixels = truth.len() as f64;
    let mean = compensated_sum(truth) / pixels;
    let relative = |squares: &[f64]| compensated_sum(squares) / pixels / (mean * mean);
    let squared_bias = relative(&biases);
    let about = squared_bias * mean * mean;
    let spread: Vec<f64> = biases.iter().map(|b| (b - about) * (b - about)).collect();
    Checkpoint {
        iterations,
        error: relative(&errors),
        variance: relative(&variances),
        squared_bias,
        bias_error: f64::sqrt(relative(&spread) / pixels) / mean,
    }
}
