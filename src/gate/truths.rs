//! What an image should be: exact pixels of every class, where the renderer's frame is moved as it says it is, and exact
//! means of the classes that it regularizes, where it says how.

use std::sync::OnceLock;

use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::exported::brightest_about;
use crate::error::Error;
use crate::expectation;
use crate::regions::Regions;
use crate::truth::{self, TruthImage};

/// Offsets are multiples of one over this.
const STEPS: f64 = 4.0;
/// The farthest offset [pixels].
pub const FARTHEST: f64 = 8.0;
/// Relative tolerance of the fine image that residuals are compared with.
const FINE_TOLERANCE: f64 = 1e-3;

/// How a renderer regularizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regularization {
    /// Which vertex, and how.
    pub technique: Technique,
    /// The mollifier.
    pub kernel: Kernel,
    /// Angle [rad] or radius [m].
    pub bandwidth: f64,
}

/// What an image should be.
pub struct Truth {
    entry: Entry,
    /// The exact image, moved by the offset.
    pub image: TruthImage,
    /// Pixels of which it is known: all, unless the frame is moved.
    pub shown: Vec<bool>,
    offset: [f64; 2],
    /// By class, means over the regions where they are regularized.
    finite: Vec<Option<Vec<Bounded>>>,
    fine: OnceLock<TruthImage>,
}

/// Whether an offset can be applied exactly.
pub fn is_offset(offset: f64) -> bool {
    offset.abs() <= FARTHEST && (STEPS * offset).fract() == 0.0
}

fn at_size(entry: &Entry, times: u32) -> Entry {
    let mut fine = entry.clone();
    fine.camera.width *= times;
    fine.camera.height *= times;
    fine
}

impl Truth {
    /// The exact image of an entry to a relative tolerance, moved by columns to the right and rows down, which pass
    /// [`is_offset`].
    pub fn new(entry: &Entry, tolerance: f64, offset: [f64; 2]) -> Self {
        let (width, height) = (entry.camera.width as usize, entry.camera.height as usize);
        let finest = [1, 2, 4]
            .into_iter()
            .find(|&k| offset.iter().all(|o| (o * f64::from(k)).fract() == 0.0));
        let times = finest.unwrap_or(STEPS as u32);
        let (image, shown) = if offset == [0.0; 2] {
            (truth::image(entry, tolerance), vec![true; width * height])
        } else {
            moved(
                &truth::image(&at_size(entry, times), tolerance),
                times as usize,
                offset,
            )
        };
        Truth {
            finite: vec![None; image.classes.len()],
            entry: entry.clone(),
            image,
            shown,
            offset,
            fine: OnceLock::new(),
        }
    }

    /// Allows for the meshes of an exported scene: a pixel may be off by so much of the brightest about it.
    pub fn allow_for(&mut self, pixel_error: f64) {
        let TruthImage {
            width,
            layers,
            errors,
            ..
        } = &mut self.image;
        for (layer, errors) in layers.iter().zip(errors) {
            let about = brightest_about(layer, *width as usize);
            errors
                .iter_mut()
                .zip(about)
                .for_each(|(e, b)| *e += pixel_error * b);
        }
    }

    /// Replaces what a technique regularizes by its exact expectation over the regions.
    ///
    /// # Errors
    /// A kernel, a bandwidth or a kind of scene of which the technique knows nothing.
    pub fn regularize(
        &mut self,
        how: Regularization,
        tolerance: f64,
        regions: &Regions,
    ) -> Result<(), Error> {
        let Regularization {
            technique,
            kernel,
            bandwidth,
        } = how;
        let tolerances = [tolerance, f64::INFINITY];
        let found = expectation::area_moments(
            &self.entry,
            technique,
            kernel,
            &[bandwidth],
            tolerances,
            regions,
        );
        let found = found.map_err(|e| Error::Parameter {
            file: "command line".to_owned(),
            key: format!("--{}", e.key),
            found: e.found,
            allowed: e.allowed,
        })?;
        for (class, areas) in found {
            if let Some(layer) = self.image.classes.iter().position(|&c| c == class) {
                self.finite[layer] = Some(areas.iter().map(|m| m.mean).collect());
            }
        }
        Ok(())
    }

    /// Whether every pixel of these classes is known.
    pub fn has_pixels(&self, classes: &[usize]) -> bool {
        classes.iter().all(|&c| self.finite[c].is_none())
    }

    /// Means of the sum of some classes over the areas.
    pub fn areas(&self, classes: &[usize], regions: &Regions) -> Vec<Bounded> {
        let mut sums = vec![Bounded::default(); regions.areas().len()];
        for &class in classes {
            let exact = self.image.area_means(class, regions);
            let areas = match &self.finite[class] {
                None => exact,
                // Meshes do to the regularized image what they do to the exact one.
                Some(finite) => finite
                    .iter()
                    .zip(exact)
                    .map(|(f, e)| Bounded {
                        value: f.value,
                        error: f.error + e.error,
                    })
                    .collect(),
            };
            for (sum, area) in sums.iter_mut().zip(areas) {
                sum.value += area.value;
                sum.error += area.error;
            }
        }
        sums
    }

    /// Pixels of the sum of some classes, and bounds on their errors.
    pub fn pixels(&self, classes: &[usize]) -> [Vec<f64>; 2] {
        [
            sum(&self.image.layers, classes),
            sum(&self.image.errors, classes),
        ]
    }

    /// The sum of some classes with twice the columns and rows, for comparison with what has moved, to a thousandth.
    pub fn fine(&self, classes: &[usize]) -> Vec<f64> {
        let image = self
            .fine
            .get_or_init(|| truth::image(&at_size(&self.entry, 2), FINE_TOLERANCE));
        sum(&image.layers, classes)
    }

    /// By how much the frame is moved.
    pub fn offset(&self) -> [f64; 2] {
        self.offset
    }

    /// The scene's classes.
    pub fn classes(&self) -> &'static [PathClass] {
        self.image.classes
    }

    /// The scene.
    pub fn entry(&self) -> &Entry {
        &self.entry
    }
}

fn sum(layers: &[Vec<f64>], classes: &[usize]) -> Vec<f64> {
    let mut total = vec![0.0; layers.first().map_or(0, Vec::len)];
    for &class in classes {
        total
            .iter_mut()
            .zip(&layers[class])
            .for_each(|(t, v)| *t += v);
    }
    total
}

/// An image of the size of the frame from one that is `times` finer, and the pixels that lie wholly in the finer one.
fn moved(fine: &TruthImage, times: usize, offset: [f64; 2]) -> (TruthImage, Vec<bool>) {
    let (width, height) = (fine.width as usize / times, fine.height as usize / times);
    let first =
        |position: usize, offset: f64| (position * times) as i64 - (offset * times as f64) as i64;
    let starts = |i: usize| {
        let start = [first(i % width, offset[0]), first(i / width, offset[1])];
        let size = [fine.width, fine.height].map(i64::from);
        let is_inside = (0..2).all(|k| start[k] >= 0 && start[k] + times as i64 <= size[k]);
        is_inside.then(|| start.map(|s| s as usize))
    };
    let boxed = |layer: &Vec<f64>| -> Vec<f64> {
        let pixel = |i: usize| {
            let Some([x, y]) = starts(i) else {
                return 0.0;
            };
            let row = |y: usize| {
                layer[y * fine.width as usize + x..][..times]
                    .iter()
                    .sum::<f64>()
            };
            (y..y + times).map(row).sum::<f64>() / (times * times) as f64
        };
        (0..width * height).map(pixel).collect()
    };
    let image = TruthImage {
        width: width as u32,
        height: height as u32,
        classes: fine.classes,
        layers: fine.layers.iter().map(boxed).collect(),
        errors: fine.errors.iter().map(boxed).collect(),
    };
    (
        image,
        (0..width * height).map(|i| starts(i).is_some()).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moved_image_is_cut_where_it_is_not_known() {
        let fine = TruthImage {
            width: 4,
            height: 4,
            classes: &[PathClass::LDE],
            layers: vec![(0..16).map(f64::from).collect()],
            errors: vec![vec![0.0; 16]],
        };
        // Half a pixel to the right is one column of the finer image.
        let (image, shown) = moved(&fine, 2, [0.5, 0.0]);
        assert_eq!(shown, [false, true, false, true]);
        assert_eq!(image.layers[0], [0.0, 3.5, 0.0, 11.5]);
        let (image, shown) = moved(&fine, 2, [0.0, -1.0]);
        assert_eq!(shown, [true, true, false, false]);
        assert_eq!(image.layers[0], [10.5, 12.5, 0.0, 0.0]);
        assert!(is_offset(-1.25) && !is_offset(0.3) && !is_offset(9.0));
    }
}
