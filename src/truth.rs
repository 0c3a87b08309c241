//! The exact image of an entry, computed in parallel.

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::Entry;
use rayon::prelude::*;

use crate::exr_output::{rounded_up, rounding_error};
use crate::film::compensated_sum;
use crate::regions::Regions;

/// The default relative tolerance of images.
pub const DEFAULT_TOLERANCE: f64 = 1e-6;

/// Mean radiance over every pixel, per path class, with error bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthImage {
    /// Columns.
    pub width: u32,
    /// Rows; row 0 is the top.
    pub height: u32,
    /// The classes of the layers.
    pub classes: &'static [PathClass],
    /// `layers[class][row * width + column]`: mean radiance over the pixel [W m⁻² sr⁻¹].
    pub layers: Vec<Vec<f64>>,
    /// Absolute error bounds, in the same order.
    pub errors: Vec<Vec<f64>>,
}

impl TruthImage {
    /// Mean radiance of each class over the whole image; the pixels' error bounds are added up, not in quadrature.
    pub fn class_means(&self) -> Vec<Bounded> {
        let pixels = f64::from(self.width) * f64::from(self.height);
        let mean = |layer: &Vec<f64>| compensated_sum(layer) / pixels;
        let layers = self.layers.iter().zip(&self.errors);
        layers
            .map(|(values, errors)| {
                let value = mean(values);
                Bounded {
                    value,
                    error: mean(errors) + 4.0 * f64::EPSILON * value.abs(),
                }
            })
            .collect()
    }

    /// Mean radiance of a layer over each area.
    pub fn area_means(&self, layer: usize, regions: &Regions) -> Vec<Bounded> {
        let sums = |values: &[f64]| regions.reduce(values);
        let (values, errors) = (sums(&self.layers[layer]), sums(&self.errors[layer]));
        let areas = values.iter().zip(&errors).zip(regions.pixels());
        areas
            .map(|((&(value, _), &(error, _)), pixels)| {
                let value = value / pixels as f64;
                // Up to 2¹⁶ additions of a row or a tile, in eight sums.
                let rounding = 1e4 * f64::EPSILON * value.abs();
                Bounded {
                    value,
                    error: error / pixels as f64 + rounding,
                }
            })
            .collect()
    }

    /// The channels of the image's file: `<CLASS>.Y` per class, and `error.Y`, a bound on the error of the sum of the
    /// layers as stored, rounding to f32 included.
    pub fn channels(&self) -> Vec<(String, Vec<f64>)> {
        let (_, mut error) = self.total();
        for layer in &self.layers {
            for (e, &v) in error.iter_mut().zip(layer) {
                *e += rounding_error(v);
            }
        }
        error.iter_mut().for_each(|e| *e = rounded_up(*e));
        let classes = self.classes.iter().zip(&self.layers);
        classes
            .map(|(class, layer)| (format!("{class}.Y"), layer.clone()))
            .chain([("error.Y".to_owned(), error)])
            .collect()
    }

    /// The sum of the classes, and of their error bounds, per pixel.
    pub fn total(&self) -> (Vec<f64>, Vec<f64>) {
        let sum = |layers: &[Vec<f64>]| {
            let mut total = vec![0.0; self.width as usize * self.height as usize];
            for layer in layers {
                total.iter_mut().zip(layer).for_each(|(t, v)| *t += v);
            }
            total
        };
        (sum(&self.layers), sum(&self.errors))
    }
}

/// Computes the image to a relative tolerance. The same bits for any number of threads: pixels do not depend on each
/// other.
///
/// # Panics
/// If the entry does not pass [`Entry::validate`]; what [`crate::entry::load`] returns does.
pub fn image(entry: &Entry, tolerance: f64) -> TruthImage {
    let truth = match PixelTruth::new(entry) {
        Ok(truth) => truth,
        Err(e) => panic!("the entry has not been validated: {e}"),
    };
    let classes = truth.classes();
    let (width, height) = (entry.camera.width, entry.camera.height);
    let rows: Vec<_> = (0..height)
        .into_par_iter()
        .map(|j| truth.row(j, tolerance))
        .collect();
    let collect = |field: fn(&Bounded) -> f64| -> Vec<Vec<f64>> {
        let layer = |c: usize| rows.iter().flat_map(|r| r[c].iter().map(field)).collect();
        (0..classes.len()).map(layer).collect()
    };
    TruthImage {
        width,
        height,
        classes,
        layers: collect(|b| b.value),
        errors: collect(|b| b.error),
    }
}
