//! Evidence: what is left of a replicate once its film has been reduced to regions.
//!
//! A replicate is an independent repetition with its own seed. A region is an area of the image, of one path class or of
//! the sum of several. Only the mean of each replicate enters the tests; their spread is the only variance that is used.
//!
//! A film counts its contributions, but not where they fell. In a part of the image they are at least as many as pixels
//! that are not zero; and of N independent paths, each of which contributes x ≥ 0, not zero with probability p,
//! (E x)² ≤ p E x² [Cauchy-Schwarz], so that the relative variance v of their mean is at least (1/p - 1)/N and
//!
//! > N p ≥ N / (1 + N v).
//!
//! Paths that are correlated as in a photon map make v larger and the bound smaller.

use super::tails::Tail;
use crate::film::{Film, compensated_sum};
use crate::regions::{Area, Regions};

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
    pub fn of_layer(layer: &[f64], width: u32) -> Self {
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

/// What one replicate says about each path class in each area of the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Replicate {
    areas: usize,
    /// Paths drawn.
    paths: u64,
    /// Per area, whether its contributions were counted.
    counted: Vec<bool>,
    /// `[layer * areas + area]`: mean radiance over the area [W m⁻² sr⁻¹].
    means: Vec<f64>,
    /// Contributions that are not zero, in the same order: exact for the whole image; at least so many in a part of it.
    contributions: Vec<u64>,
    /// Pixels that cannot be, per layer.
    pub invalid: Vec<Invalid>,
    /// The largest pixel of each layer [W m⁻² sr⁻¹].
    pub largest: Vec<f64>,
}

impl Replicate {
    /// Reduces a film. A film without paths has means that are not a number, and says so in `invalid` only if a
    /// pixel does.
    pub fn of_film(film: &Film, regions: &Regions) -> Self {
        let areas = regions.areas();
        let pixels = regions.pixels();
        let paths = film.paths as f64;
        let mut replicate = Replicate {
            areas: areas.len(),
            paths: film.paths,
            counted: areas.iter().map(|a| *a == Area::Image).collect(),
            means: Vec::with_capacity(areas.len() * film.layers.len()),
            contributions: Vec::with_capacity(areas.len() * film.layers.len()),
            invalid: Vec::new(),
            largest: Vec::new(),
        };
        for (layer, &nonzero) in film.layers.iter().zip(&film.nonzero) {
            for (k, (sum, seen)) in regions.reduce(layer).into_iter().enumerate() {
                replicate.means.push(sum / (paths * pixels[k] as f64));
                // A pixel that is not zero has had one at least.
                let count = if replicate.counted[k] { nonzero } else { seen };
                replicate.contributions.push(count);
            }
            replicate.invalid.push(Invalid::of_layer(layer, film.width));
            replicate
                .largest
                .push(layer.iter().fold(0.0, |a: f64, &v| a.max(v)) / paths);
        }
        replicate
    }

    /// Mean radiance of a layer over an area [W m⁻² sr⁻¹].
    pub fn mean(&self, layer: usize, area: usize) -> f64 {
        self.means[layer * self.areas + area]
    }

    /// Contributions that are not zero, or a lower bound of their number.
    pub fn contributions(&self, layer: usize, area: usize) -> u64 {
        self.contributions[layer * self.areas + area]
    }
}

/// What replicates say about one check in one area: a running sample, one replicate after the other in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    count: u64,
    mean: f64,
    /// Sums of the second and third powers of what is off the mean.
    powers: [f64; 2],
    /// The first and the last value, and the sum of products of neighbours, all from the first value.
    first: f64,
    last: f64,
    neighbours: f64,
    fewest: u64,
    contributions: u64,
    /// Paths of a replicate, where contributions are not counted.
    uncounted: Option<u64>,
    invalid: Invalid,
    invalid_replicate: usize,
}

impl Tally {
    /// Adds the sum of some layers of a replicate in an area.
    pub fn push(&mut self, replicate: &Replicate, layers: &[usize], area: usize) {
        let index = self.count as usize;
        let x: f64 = layers.iter().map(|&l| replicate.mean(l, area)).sum();
        let contributions = layers
            .iter()
            .map(|&l| replicate.contributions(l, area))
            .sum();
        for found in layers.iter().map(|&l| replicate.invalid[l]) {
            if self.invalid.first.is_none() && found.first.is_some() {
                (self.invalid.first, self.invalid_replicate) = (found.first, index);
            }
            self.invalid.not_finite += found.not_finite;
            self.invalid.negative += found.negative;
        }
        if index == 0 {
            self.first = x;
            self.uncounted = (!replicate.counted[area]).then_some(replicate.paths);
        }
        self.neighbours += (x - self.first) * self.last;
        self.last = x - self.first;
        // Updates of central powers [Pébay 2008].
        let before = self.count as f64;
        self.count += 1;
        let n = self.count as f64;
        let off = x - self.mean;
        let step = off / n;
        let term = off * step * before;
        self.mean += step;
        self.powers[1] += term * step * (n - 2.0) - 3.0 * step * self.powers[0];
        self.powers[0] += term;
        self.fewest = if index == 0 {
            contributions
        } else {
            self.fewest.min(contributions)
        };
        self.contributions += contributions;
    }

    /// Correlation of replicates with their predecessors: zero up to 1/√n if seeds are independent.
    pub fn correlation(&self) -> f64 {
        let n = self.count as f64;
        let off = self.mean - self.first;
        let covariance =
            self.neighbours - off * (2.0 * n * off - self.last) + (n - 1.0) * off * off;
        covariance / self.powers[0]
    }

    /// The bound of the module's head, where contributions are not counted.
    fn shown_by_spread(&self, variance: f64) -> u64 {
        let Some(paths) = self.uncounted else {
            return 0;
        };
        let paths = paths as f64;
        let relative = variance / (self.mean * self.mean);
        // A mean of zero has no relative variance: NaN becomes 0.
        (paths / (1.0 + paths * relative)) as u64
    }

    /// The sample so far.
    pub fn sample(&self) -> Sample {
        let n = self.count as f64;
        let variance = self.powers[0] / (n - 1.0);
        let skewness = self.powers[1] / n / libm::pow(self.powers[0] / n, 1.5);
        Sample {
            replicates: self.count as usize,
            mean: self.mean,
            variance,
            skewness: if skewness.is_finite() { skewness } else { 0.0 },
            skewness_error: None,
            fewest_contributions: self.fewest.max(self.shown_by_spread(variance)),
            contributions: self.contributions,
            invalid: self.invalid,
            invalid_replicate: self.invalid_replicate,
        }
    }
}

/// All replicates of one region: the sum of some classes over an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Number of replicates.
    pub replicates: usize,
    /// Mean over the replicates [W m⁻² sr⁻¹].
    pub mean: f64,
    /// Variance of one replicate, with n - 1 in the denominator.
    pub variance: f64,
    /// Skewness of one replicate: third central moment over the variance to 3/2.
    pub skewness: f64,
    /// A bound on the error of the skewness, where it is known otherwise than from the replicates' means.
    pub skewness_error: Option<f64>,
    /// Contributions that are not zero, in the replicate that has the fewest; in a part of the image a lower bound, of
    /// their number in the replicate that has the fewest or of their expectation.
    pub fewest_contributions: u64,
    /// Contributions that are not zero, in all replicates.
    pub contributions: u64,
    /// Pixels that cannot be, over all replicates and classes, and the first of them.
    pub invalid: Invalid,
    /// The replicate in which the first such pixel is.
    pub invalid_replicate: usize,
}

impl Sample {
    /// Gathers the sum of the classes at the given layer positions, in an area.
    pub fn of_layers(replicates: &[Replicate], layers: &[usize], area: usize) -> Self {
        let mut tally = Tally::default();
        for r in replicates {
            tally.push(r, layers, area);
        }
        tally.sample()
    }

    /// Standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        libm::sqrt(self.variance / self.replicates as f64)
    }

    /// The law of the Studentised mean, towards large means if `above`.
    pub fn tail(&self, above: bool) -> Tail {
        match self.skewness_error {
            Some(error) => Tail::with_error(self.replicates, self.skewness, error, above),
            None => Tail::new(self.replicates, self.skewness, above),
        }
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

    fn all() -> Regions {
        Regions::image(2, 2)
    }

    #[test]
    fn running_moments_are_those_of_two_passes() {
        let values: Vec<f64> = (0..100).map(|i| 1e6 + f64::from(i * i % 37)).collect();
        let mut tally = Tally::default();
        for &v in &values {
            let layer = film([[v * 10.0; 4], [0.0; 4]]);
            tally.push(&Replicate::of_film(&layer, &all()), &[0], 0);
        }
        let (mean, variance) = moments(&values);
        let s = tally.sample();
        let third = values
            .iter()
            .map(|v| (v - mean) * (v - mean) * (v - mean))
            .sum::<f64>()
            / 100.0;
        let skewness = third / libm::pow(0.99 * variance, 1.5);
        assert!((s.mean - mean).abs() < 1e-9 && (s.variance / variance - 1.0).abs() < 1e-9);
        assert!(
            (s.skewness - skewness).abs() < 1e-7,
            "{} {skewness}",
            s.skewness
        );
        let pairs = values.windows(2).map(|w| (w[0] - mean) * (w[1] - mean));
        let correlation = pairs.sum::<f64>() / (99.0 * variance);
        assert!((tally.correlation() - correlation).abs() < 1e-9);
    }

    #[test]
    fn what_cannot_be_is_counted_and_located() {
        let bad = film([
            [1.0, 2.0, 3.0, 4.0],
            [0.0, f64::INFINITY, f64::NAN, -1e-300],
        ]);
        let r = Replicate::of_film(&bad, &all());
        assert_eq!(r.invalid[0].pixels(), 0);
        let expected = Invalid {
            not_finite: 2,
            negative: 1,
            first: Some((1, 0)),
        };
        assert_eq!(r.invalid[1], expected);
        let good = Replicate::of_film(&film([[1.0; 4], [2.0; 4]]), &all());
        let s = Sample::of_layers(&[good.clone(), r, good], &[0, 1], 0);
        assert_eq!((s.invalid, s.invalid_replicate), (expected, 1));
    }

    #[test]
    fn regions_are_sums_of_classes() {
        let a = Replicate::of_film(&film([[1.0, 2.0, 3.0, 4.0], [2.0; 4]]), &all());
        let b = Replicate::of_film(&film([[2.0, 2.0, 3.0, 5.0], [4.0; 4]]), &all());
        let s = Sample::of_layers(&[a, b], &[0, 1], 0);
        // (10 + 8) / 40 and (12 + 16) / 40.
        assert!((s.mean - 0.575).abs() < 1e-15);
        assert!((s.variance - 0.03125).abs() < 1e-15);
        assert_eq!((s.fewest_contributions, s.contributions), (7, 14));
    }

    /// Contributions in a mask of a quarter of the image, of which three quarters of the paths miss it, with weights of 1 and
    /// 3: the bound is N (E x)²/E x² over 1 + 1/N times less, known to 20 % from 400 replicates (six standard errors of
    /// the variance); pixels alone would show 4.
    #[test]
    fn the_spread_shows_contributions_that_pixels_do_not() {
        use crate::stream::{philox, uniform};
        let mask = Regions::mask(4, 4, &core::array::from_fn::<_, 16, _>(|i| i < 4)).unwrap();
        let paths = 2000;
        let mut tally = Tally::default();
        for r in 0..400 {
            let mut film = Film::new(4, 4, CLASSES);
            film.paths = paths;
            for path in 0..paths {
                let [a, b, c, d] = philox([r, path as u32, 0, 0], [7, 8]);
                let pixel = (16.0 * uniform(a, b)) as usize;
                film.layers[0][pixel] += if c % 2 == 0 { 1.0 } else { 3.0 };
                film.nonzero[0] += u64::from(d > 0);
            }
            tally.push(&Replicate::of_film(&film, &mask), &[0], 0);
        }
        let s = tally.sample();
        // p = 1/4, (E x)² = 1/4, E x² = 5/4: v N = 5 - 1.
        let exact = paths as f64 / 5.0;
        let shown = s.fewest_contributions as f64;
        assert!((shown / exact - 1.0).abs() < 0.2, "{shown} {exact}");
        // No more than there are: 500 on average.
        assert!(shown < 500.0 && s.contributions == 4 * 400);
        let mut nothing = Tally::default();
        for _ in 0..3 {
            let film = Film::new(4, 4, CLASSES);
            nothing.push(&Replicate::of_film(&film, &mask), &[0], 0);
        }
        assert_eq!(nothing.sample().fewest_contributions, 0);
    }

    #[test]
    fn a_small_spread_about_a_large_mean_survives() {
        let (mean, variance) = moments(&[1e9 + 1.0, 1e9 + 2.0, 1e9 + 3.0]);
        assert_eq!((mean, variance), (1e9 + 2.0, 1.0));
    }
}
