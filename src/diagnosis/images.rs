//! Images of replicates: their mean, and how much they scatter.

use rayon::prelude::*;

use crate::film::{Film, compensated_sum};
use crate::integrators::{Prepared, Run};
use crate::verify::replicates::{Canvas, Seeds, Shape};

/// Replicates that are held in memory at a time.
const AT_A_TIME: u32 = 32;

/// The mean of some replicates' images of the sum of some layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Images {
    /// Mean radiance of each pixel [W m⁻² sr⁻¹].
    pub mean: Vec<f64>,
    /// Variance of one replicate's pixel.
    pub variance: Vec<f64>,
    /// Mean over the image, by replicate.
    pub means: Vec<f64>,
    /// Contributions that are not zero.
    pub contributions: u64,
    /// The same of all layers.
    pub arrived: u64,
    /// A pixel that is not a number, infinite or negative in some replicate, with its value there.
    pub impossible: Option<(usize, f64)>,
}

impl Images {
    /// Replicates.
    pub fn replicates(&self) -> f64 {
        self.means.len() as f64
    }

    /// Mean over the image and its standard error.
    pub fn image_mean(&self) -> [f64; 2] {
        let (mean, variance) = crate::judge::evidence::moments(&self.means);
        [mean, libm::sqrt(variance / self.replicates())]
    }
}

/// Draws replicates `0 .. replicates` of a phase.
pub fn sample(
    prepared: &dyn Prepared,
    canvas: Canvas,
    layers: &[usize],
    shape: &Shape,
    seeds: Seeds,
    phase: u32,
    replicates: u32,
) -> Images {
    let pixels = canvas.width as usize * canvas.height as usize;
    let mut images = Images {
        mean: vec![0.0; pixels],
        variance: vec![0.0; pixels],
        means: Vec::with_capacity(replicates as usize),
        contributions: 0,
        arrived: 0,
        impossible: None,
    };
    let film = || Film::new(canvas.width, canvas.height, canvas.classes);
    for start in (0..replicates).step_by(AT_A_TIME as usize) {
        let end = (start + AT_A_TIME).min(replicates);
        let drawn: Vec<_> = (start..end)
            .into_par_iter()
            .map_init(film, |film, k| {
                film.clear();
                let seed = seeds.replicate(phase, k);
                let mut run = Run::of(prepared);
                for (i, &bandwidth) in (0..).zip(&shape.bandwidths) {
                    run.iterate(seed, i, shape.paths_per_iteration, bandwidth, film);
                }
                let scale = 1.0 / film.paths as f64;
                let value = |p| layers.iter().map(|&l| film.layers[l][p]).sum::<f64>() * scale;
                let contributions: u64 = layers.iter().map(|&l| film.nonzero[l]).sum();
                let arrived: u64 = film.nonzero.iter().sum();
                (
                    (0..pixels).map(value).collect::<Vec<f64>>(),
                    contributions,
                    arrived,
                )
            })
            .collect();
        for (image, contributions, arrived) in drawn {
            images.arrived += arrived;
            images.means.push(compensated_sum(&image) / pixels as f64);
            images.contributions += contributions;
            if images.impossible.is_none() {
                let is_bad = |v: &f64| !(v.is_finite() && *v >= 0.0);
                images.impossible = image.iter().position(is_bad).map(|p| (p, image[p]));
            }
            // Welford's update, replicate by replicate in their order.
            let n = images.means.len() as f64;
            let sums = images.mean.iter_mut().zip(&mut images.variance);
            for ((mean, squares), x) in sums.zip(image) {
                let off = x - *mean;
                *mean += off / n;
                *squares += off * (x - *mean);
            }
        }
    }
    let dof = (images.replicates() - 1.0).max(1.0);
    images.variance.iter_mut().for_each(|v| *v /= dof);
    images
}
