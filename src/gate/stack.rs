//! The images of one layer, one for each seed, and what their spread says.

use rayon::prelude::*;

use crate::judge::evidence::{Invalid, Sample, moments};
use crate::regions::Regions;

/// Side of the blocks of pixels from which the skewness is estimated: noise that pixels share is seen up to this size.
const BLOCK: usize = 4;

/// Images of one layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stack {
    /// Columns.
    pub width: usize,
    /// `[image][row * width + column]`: radiance [W m⁻² sr⁻¹].
    pub images: Vec<Vec<f64>>,
    /// Variance of each pixel's value, by image, where all files tell it.
    pub variances: Option<Vec<Vec<f64>>>,
}

/// What all samples of a stack share.
#[derive(Clone, Debug, PartialEq)]
pub struct Shared {
    /// See [`Stack::third_moments`].
    pub thirds: Vec<f64>,
    /// See [`Stack::invalid`].
    pub invalid: (Invalid, usize),
}

/// A linear function of an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Functional {
    /// The mean over an area of the regions.
    Area(usize),
    /// A weighted sum of the pixels.
    Weighted(Vec<f64>),
}

impl Functional {
    /// Values for some images, in their order, and the fewest and all pixels that are not zero in what they look at.
    fn values(&self, images: &[Vec<f64>], regions: &Regions) -> (Vec<f64>, u64, u64) {
        let one = |image: &Vec<f64>| match self {
            Functional::Area(k) => {
                let (sum, seen) = regions.reduce_area(*k, image);
                (sum / regions.pixels_of(*k) as f64, seen)
            }
            Functional::Weighted(weights) => {
                let sum = weights.iter().zip(image).map(|(w, v)| w * v).sum();
                let is_seen = |(w, v): &(&f64, &f64)| **w != 0.0 && **v != 0.0;
                (
                    sum,
                    weights.iter().zip(image).filter(is_seen).count() as u64,
                )
            }
        };
        let found: Vec<(f64, u64)> = images.iter().map(one).collect();
        let fewest = found.iter().map(|f| f.1).min().unwrap_or(0);
        let all = found.iter().map(|f| f.1).sum();
        (found.into_iter().map(|f| f.0).collect(), fewest, all)
    }

    /// Sum of a function of the pixels with the `power` of the weights.
    fn sum_of_powers(&self, layer: &[f64], power: i32, regions: &Regions) -> f64 {
        match self {
            Functional::Area(k) => {
                let scale = libm::pow(regions.pixels_of(*k) as f64, -f64::from(power));
                regions.reduce_area(*k, layer).0 * scale
            }
            Functional::Weighted(weights) => {
                let raised = |w: f64| if power == 2 { w * w } else { w * w * w };
                weights.iter().zip(layer).map(|(&w, v)| raised(w) * v).sum()
            }
        }
    }
}

impl Stack {
    /// The mean image.
    pub fn mean(&self) -> Vec<f64> {
        let pixels = self.images.first().map_or(0, Vec::len);
        let count = self.images.len() as f64;
        let pixel = |i: usize| self.images.iter().map(|image| image[i]).sum::<f64>() / count;
        (0..pixels).map(pixel).collect()
    }

    /// Variance of each pixel of the mean image: from image to image; of a single one, from the file's own or from what
    /// neighbours differ.
    pub fn variance_of_mean(&self, truth: &[f64]) -> Vec<f64> {
        let count = self.images.len() as f64;
        if self.images.len() >= 4 {
            let pixel = |i: usize| {
                let values: Vec<f64> = self.images.iter().map(|image| image[i]).collect();
                moments(&values).1 / count
            };
            return (0..truth.len()).map(pixel).collect();
        }
        if let Some(variances) = &self.variances {
            let pixel = |i: usize| variances.iter().map(|v| v[i]).sum::<f64>() / (count * count);
            return (0..truth.len()).map(pixel).collect();
        }
        let mean = self.mean();
        let off = |i: usize| mean[i] - truth[i];
        let pixel = |i: usize| {
            let j = if (i + 1).is_multiple_of(self.width) {
                i.saturating_sub(1)
            } else {
                i + 1
            };
            let d = off(i) - off(j.min(truth.len() - 1));
            0.5 * d * d
        };
        (0..truth.len()).map(pixel).collect()
    }

    /// Third central moments of pixels, so that their sum over an area is that of the area's sum if blocks do not depend on
    /// each other.
    pub fn third_moments(&self) -> Vec<f64> {
        let pixels = self.images.first().map_or(0, Vec::len);
        let count = self.images.len();
        let mut thirds = vec![0.0; pixels];
        if count < 3 || self.width == 0 {
            return thirds;
        }
        let n = count as f64;
        let scale = n / ((n - 1.0) * (n - 2.0));
        let height = pixels / self.width;
        let rows: Vec<(usize, Vec<f64>)> = (0..height.div_ceil(BLOCK))
            .into_par_iter()
            .map(|row| (row, self.thirds_of_row(row, height, scale)))
            .collect();
        for (row, values) in rows {
            for (column, third) in values.into_iter().enumerate() {
                for y in row * BLOCK..((row + 1) * BLOCK).min(height) {
                    for x in column * BLOCK..((column + 1) * BLOCK).min(self.width) {
                        thirds[y * self.width + x] = third;
                    }
                }
            }
        }
        thirds
    }

    /// For each block of a row of blocks, the third moment of its sum over its number of pixels.
    fn thirds_of_row(&self, row: usize, height: usize, scale: f64) -> Vec<f64> {
        let block = |column: usize| {
            let rows = row * BLOCK..((row + 1) * BLOCK).min(height);
            let columns = column * BLOCK..((column + 1) * BLOCK).min(self.width);
            let sum = |image: &Vec<f64>| -> f64 {
                rows.clone()
                    .map(|y| {
                        image[y * self.width + columns.start..y * self.width + columns.end]
                            .iter()
                            .sum::<f64>()
                    })
                    .sum()
            };
            let sums: Vec<f64> = self.images.iter().map(sum).collect();
            let (mean, _) = moments(&sums);
            let third: f64 = sums
                .iter()
                .map(|s| (s - mean) * (s - mean) * (s - mean))
                .sum();
            scale * third / (rows.len() * columns.len()) as f64
        };
        (0..self.width.div_ceil(BLOCK)).map(block).collect()
    }

    /// What all samples share.
    pub fn shared(&self) -> Shared {
        Shared {
            thirds: self.third_moments(),
            invalid: self.invalid(),
        }
    }

    /// Values that cannot be, and the image with the first.
    pub fn invalid(&self) -> (Invalid, usize) {
        let mut all = Invalid::default();
        let mut first = 0;
        for (k, image) in self.images.iter().enumerate() {
            let found = Invalid::of_layer(image, self.width as u32);
            if all.first.is_none() && found.first.is_some() {
                (all.first, first) = (found.first, k);
            }
            all.not_finite += found.not_finite;
            all.negative += found.negative;
        }
        (all, first)
    }

    /// What the images say about a linear function of them. Its skewness comes from the pixels: of so few means it cannot
    /// be known; as much again is allowed for its error.
    pub fn sample(&self, functional: &Functional, shared: &Shared, regions: &Regions) -> Sample {
        let Shared { thirds, invalid } = shared;
        let (values, fewest, contributions) = functional.values(&self.images, regions);
        let (mean, variance) = moments(&values);
        let (invalid, invalid_replicate) = *invalid;
        let skewness = functional.sum_of_powers(thirds, 3, regions) / libm::pow(variance, 1.5);
        let skewness = if skewness.is_finite() { skewness } else { 0.0 };
        // Each pixel has had a path at least: the bound of `evidence`.
        let paths = thirds.len() as f64;
        let shown = paths / (1.0 + paths * variance / (mean * mean));
        Sample {
            replicates: values.len(),
            mean,
            variance,
            skewness,
            skewness_error: Some(skewness.abs()),
            fewest_contributions: fewest.max(shown as u64),
            contributions,
            invalid,
            invalid_replicate,
        }
    }

    /// The same from the files' own variances, pixels taken as independent: as good as so many replicates. `None` if the
    /// files do not tell them.
    pub fn sample_by_variances(
        &self,
        functional: &Functional,
        regions: &Regions,
    ) -> Option<Sample> {
        const AS_GOOD_AS: usize = 1024;
        let variances = self.variances.as_ref()?;
        let (values, fewest, contributions) = functional.values(&self.images, regions);
        let count = values.len() as f64;
        let total: f64 = variances
            .iter()
            .map(|v| functional.sum_of_powers(v, 2, regions))
            .sum();
        let (invalid, invalid_replicate) = self.invalid();
        Some(Sample {
            replicates: AS_GOOD_AS,
            mean: values.iter().sum::<f64>() / count,
            variance: total / (count * count) * AS_GOOD_AS as f64,
            skewness: 0.0,
            skewness_error: None,
            fewest_contributions: fewest,
            contributions,
            invalid,
            invalid_replicate,
        })
    }
}
