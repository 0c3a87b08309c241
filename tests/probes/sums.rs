//! Sums over a mirror in the plainest terms, and their comparison with a probe.

use nephroid::integrators::probes::{Estimator, Sums};

pub type V = [f64; 3];

pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

pub fn along(a: V, d: V, t: f64) -> V {
    [a[0] + t * d[0], a[1] + t * d[1], a[2] + t * d[2]]
}

/// `d` reflected at a plane with unit normal `n`.
pub fn mirrored(d: V, n: V) -> V {
    along(d, n, -2.0 * dot(d, n))
}

pub fn angle(a: V, b: V) -> f64 {
    let cosine = dot(a, b) / (length(a) * length(b));
    libm::acos(cosine.clamp(-1.0, 1.0))
}

/// Kernels on the sphere, by their definitions.
pub fn cone(g: f64, alpha: f64) -> f64 {
    if g < alpha {
        1.0 / (core::f64::consts::TAU * (1.0 - libm::cos(alpha)))
    } else {
        0.0
    }
}

pub fn epanechnikov(g: f64, alpha: f64) -> f64 {
    let mass =
        1.0 - 2.0 * libm::sin(alpha) / alpha + 2.0 * (1.0 - libm::cos(alpha)) / (alpha * alpha);
    if g < alpha {
        (1.0 - g * g / (alpha * alpha)) / (core::f64::consts::TAU * mass)
    } else {
        0.0
    }
}

/// Mean and second moment.
pub type Moments = [f64; 2];

/// Compares 32 replicates of a probe, aimed, with mean and second moment of two sums of different fineness. With
/// Student's t on 31 degrees of freedom, 6.2 standard errors are a false alarm of 7e-7 a figure. Returns
/// what it would catch, relative.
pub fn compare(
    what: &str,
    estimator: &Estimator,
    paths: u64,
    bandwidth: f64,
    point: [f64; 2],
    [coarse, fine]: [Moments; 2],
) -> f64 {
    let aim = estimator.aim(bandwidth, point).unwrap();
    // Second moments of a path without an aim.
    let scale = [1.0, 1.0 / aim.share(0)];
    let run = |k| estimator.run_aimed(77, k, paths, bandwidth, point, &aim);
    let runs: Vec<Sums> = (0..32).map(|k| run(k).unwrap()[0]).collect();
    let n = runs.len() as f64;
    let figure = |of: fn(&Sums) -> f64| {
        let mean = runs.iter().map(of).sum::<f64>() / n;
        let square = |r: &Sums| (of(r) - mean) * (of(r) - mean);
        let variance = runs.iter().map(square).sum::<f64>() / (n - 1.0);
        (mean, (variance / n).sqrt())
    };
    let mut worst = 0.0_f64;
    for (k, (found, error)) in [figure(Sums::mean), figure(Sums::second_moment)]
        .into_iter()
        .enumerate()
    {
        let (found, error) = (found * scale[k], error * scale[k]);
        let allowed = 6.2 * error + (fine[k] - coarse[k]).abs();
        println!(
            "{what} {k}: {:.5} ± {:.5}, sums {:.5}",
            found / fine[k],
            error / fine[k],
            coarse[k] / fine[k]
        );
        assert!(
            (found - fine[k]).abs() <= allowed,
            "{what} {k}: {found} ± {error} for {} {}",
            coarse[k],
            fine[k]
        );
        worst = worst.max(allowed / fine[k]);
    }
    worst
}
