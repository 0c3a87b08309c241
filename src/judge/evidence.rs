//! Evidence: what is left of a replicate once its film has been reduced to regions.
//!
//! A replicate is an independent repetition with its own seed. A region is the whole image of one path class, or of the
//! sum of several. Only the mean of each replicate enters the tests; their spread is the only variance that is used.

use crate::film::{Film, compensated_sum};

/// Below this many contributions that are not zero, a replicate's mean is too far from normal.
pub const FEWEST_CONTRIBUTIONS: u64 = 200;
/// Fewest replicates that a test accepts.
pub const FEWEST_REPLICATES: usize = 32;

/// Pixels that hold what no correct estimator of radiance can hold: not a number, infinite or negative.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Invalid {
    /// Pixels that are not a number or infinite.
    pub not_finite: u64,
    /// Pixels that are negative.
    pub negative: u64,
    /// The first of them, as (column, row) from the top left.
    pub first: Option<(u32, u32)>,
}

impl Invalid {
    /// Looks through a layer whose rows have `width` pixels.
    fn of_layer(layer: &[f64], width: u32) -> Self {
        let mut found = Invalid::default();
        for (i, &v) in layer.iter().enumerate() {
            if v.is_finite() && v >= 0.0 {
                continue;
            }
            if v.is_finite() {
                found.negative += 1;
            } else {
                found.not_finite += 1;
            }
            if found.first.is_none() {
                let width = width as usize;
                found.first = Some(((i % width) as u32, (i / width) as u32));
            }
        }
        found
    }

    /// Number of such pixels.
    pub const fn pixels(&self) -> u64 {
        self.not_finite + self.negative
    }
}

/// What one replicate says about each path class, in the order of the film's layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicate {
    /// Mean radiance over the image [W m⁻² sr⁻¹].
    pub means: Vec<f64>,
    /// Contributions that are not zero.
    pub contributions: Vec<u64>,
    /// Pixels that cannot be.
    pub invalid: Vec<Invalid>,
}

impl Replicate {
    /// Reduces a film. A film without paths has means that are not a number, and says so in `invalid` only if a
    /// pixel does.
    pub fn of_film(film: &Film) -> Self {
        Replicate {
            means: film.class_means(),
            contributions: film.nonzero.clone(),
            invalid: film
                .layers
                .iter()
                .map(|l| Invalid::of_layer(l, film.width))
                .collect(),
        }
    }
}

/// All replicates of one region: the sum of some classes over the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of replicates.
    pub replicates: usize,
    /// Mean over the replicates [W m⁻² sr⁻¹].
    pub mean: f64,
    /// Variance of one replicate, with n - 1 in the denominator.
    pub variance: f64,
    /// Contributions that are not zero, in the replicate that has the fewest.
    pub fewest_contributions: u64,
    /// Contributions that are not zero, in all replicates.
    pub contributions: u64,
    /// Pixels that cannot be, over all replicates and classes, and the first of them.
    pub invalid: Invalid,
    /// The replicate in which the first such pixel is.
    pub invalid_replicate: usize,
}

impl Sample {
    /// Gathers the region that is the sum of the classes at the given layer positions.
    pub fn of_layers(replicates: &[Replicate], layers: &[usize]) -> Self {
        let means: Vec<f64> = replicates
            .iter()
            .map(|r| layers.iter().map(|&l| r.means[l]).sum())
            .collect();
        let counts = replicates
            .iter()
            .map(|r| layers.iter().map(|&l| r.contributions[l]).sum::<u64>());
        let (mut invalid, mut invalid_replicate) = (Invalid::default(), 0);
        for (k, r) in replicates.iter().enumerate() {
            for found in layers.iter().map(|&l| r.invalid[l]) {
                if invalid.first.is_none() && found.first.is_some() {
                    (invalid.first, invalid_replicate) = (found.first, k);
                }
                invalid.not_finite += found.not_finite;
                invalid.negative += found.negative;
            }
        }
        let (mean, variance) = moments(&means);
        Sample {
            replicates: replicates.len(),
            mean,
            variance,
            fewest_contributions: counts.clone().min().unwrap_or(0),
            contributions: counts.sum(),
            invalid,
            invalid_replicate,
        }
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        libm::sqrt(self.variance / self.replicates as f64)
    }

    /// Degrees of freedom of the t tests.
    pub fn dof(&self) -> f64 {
        self.replicates.saturating_sub(1) as f64
    }
}

/// Mean and variance (n - 1 in the denominator), in two passes so that a small spread about a large mean survives.
pub fn moments(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = compensated_sum(values) / n;
    let squares: Vec<f64> = values.iter().map(|v| (v - mean) * (v - mean)).collect();
    (mean, compensated_sum(&squares) / (n - 1.0))
}

#[cfg(test)]
mod tests {
    use nephroid_analytic::class::PathClass;

    use super::*;

    const CLASSES: &[PathClass] = &[PathClass::LDE, PathClass::LSDE];

    fn film(values: [[f64; 4]; 2]) -> Film {
        let mut film = Film::new(2, 2, CLASSES);
        film.paths = 10;
        for (layer, v) in film.layers.iter_mut().zip(values) {
            layer.copy_from_slice(&v);
        }
        film.nonzero = vec![4, 3];
        film
    }

    #[test]
    fn what_cannot_be_is_counted_and_located() {
        let bad = film([
            [1.0, 2.0, 3.0, 4.0],
            [0.0, f64::INFINITY, f64::NAN, -1e-300],
        ]);
        let r = Replicate::of_film(&bad);
        assert_eq!(r.invalid[0].pixels(), 0);
        let expected = Invalid {
            not_finite: 2,
            negative: 1,
            first: Some((1, 0)),
        };
        assert_eq!(r.invalid[1], expected);
        let good = Replicate::of_film(&film([[1.0; 4], [2.0; 4]]));
        let s = Sample::of_layers(&[good.clone(), r, good], &[0, 1]);
        assert_eq!((s.invalid, s.invalid_replicate), (expected, 1));
    }

    #[test]
    fn regions_are_sums_of_classes() {
        let a = Replicate::of_film(&film([[1.0, 2.0, 3.0, 4.0], [2.0; 4]]));
        let b = Replicate::of_film(&film([[2.0, 2.0, 3.0, 5.0], [4.0; 4]]));
        let s = Sample::of_layers(&[a, b], &[0, 1]);
        // (10 + 8) / 40 and (12 + 16) / 40.
        assert!((s.mean - 0.575).abs() < 1e-15);
        assert!((s.variance - 0.03125).abs() < 1e-15);
        assert_eq!((s.fewest_contributions, s.contributions), (7, 14));
    }

    #[test]
    fn a_small_spread_about_a_large_mean_survives() {
        let (mean, variance) = moments(&[1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0]);
        assert_eq!((mean, variance), (1e9 + 2.0, 1.0));
    }
}
