//! Pictures for a report: the images of a renderer beside what they should be. They decide nothing.

use super::checks::Check;
use super::images::Images;
use super::judged::FEWEST_IMAGES;
use super::truths::Truth;
use crate::judge::evidence::moments;
use crate::regions::Regions;
use crate::report::comparison::{Cells, Comparison, Grid};

/// Most cells in a row or column of a map.
const MOST_CELLS: usize = 512;

/// What a picture is made of.
pub struct Material<'a> {
    /// What the renderer is called.
    pub renderer: &'a str,
    /// What should be.
    pub truth: &'a Truth,
    /// The regions.
    pub regions: &'a Regions,
    /// Pixels that are looked at.
    pub covered: &'a [bool],
    /// The images.
    pub layers: &'a [Images],
    /// What is checked.
    pub checks: &'a [Check],
}

impl Material<'_> {
    /// A picture of each layer that is judged as it is.
    pub fn draw(&self) -> Vec<Comparison> {
        let is_whole = |c: &&Check| !c.is_separated;
        self.checks
            .iter()
            .filter(is_whole)
            .map(|c| self.one(c))
            .collect()
    }

    fn one(&self, check: &Check) -> Comparison {
        let Material {
            truth,
            regions,
            covered,
            ..
        } = self;
        let stack = &self.layers[check.images].stack;
        let count = stack.images.len();
        let (width, height) = (truth.image.width, truth.image.height);
        let [columns, rows] = [width, height].map(|n| n as usize);
        let [mut pixels, _] = truth.pixels(&check.classes);
        pixels
            .iter_mut()
            .zip(*covered)
            .for_each(|(v, c)| *v = if *c { *v } else { 0.0 });
        let observed = stack.mean();
        let is_exact = truth.has_pixels(&check.classes);
        let is_whole = !covered.contains(&false);
        let mut about = vec![match count {
            1 => "One image.".to_owned(),
            n => format!("The mean of {n} images."),
        }];
        let cells = if is_exact {
            let grid = Grid::of_pixels(columns, rows, MOST_CELLS);
            let seen = grid.means(&observed, Some(covered));
            let expected = grid.means(&pixels, Some(covered));
            let variance = self.variance(check, grid);
            if variance.is_none() {
                about.push(
                    "So few images do not tell their noise: there is no map of z.".to_owned(),
                );
            }
            Some(Cells::new(grid, &seen, &expected, variance.as_deref()))
        } else if is_whole {
            about.push(
                "Regularized: the picture of the truth is that at bandwidth 0, the maps compare with the exact expectation."
                    .to_owned(),
            );
            let grid = Grid::of_tiles(columns, rows, regions);
            let areas = truth.areas(&check.classes, regions);
            let first = areas.len() - grid.cells();
            let expected: Vec<f64> = areas[first..].iter().map(|a| a.value).collect();
            let variance = self.variance(check, grid);
            Some(Cells::new(
                grid,
                &grid.means(&observed, None),
                &expected,
                variance.as_deref(),
            ))
        } else {
            about.push("Regularized: nothing is known of parts of the mask.".to_owned());
            None
        };
        if !is_whole {
            about.push("Pixels that are not judged are black, and grey in the maps.".to_owned());
        }
        let names: Vec<String> = check
            .classes
            .iter()
            .map(|&c| truth.classes()[c].to_string())
            .collect();
        Comparison {
            scene: truth.entry().name.clone(),
            integrator: self.renderer.to_owned(),
            content: names.join(" + "),
            width,
            height,
            truth: pixels,
            observed,
            cells,
            about,
        }
    }

    /// Variances of the cells' means: from image to image, or from the files' own where cells are pixels.
    fn variance(&self, check: &Check, grid: Grid) -> Option<Vec<f64>> {
        let stack = &self.layers[check.images].stack;
        let count = stack.images.len();
        if count >= FEWEST_IMAGES {
            let means: Vec<Vec<f64>> = stack
                .images
                .iter()
                .map(|image| grid.means(image, Some(self.covered)))
                .collect();
            let cell = |c: usize| {
                let values: Vec<f64> = means.iter().map(|m| m[c]).collect();
                moments(&values).1 / count as f64
            };
            return Some((0..grid.cells()).map(cell).collect());
        }
        let variances = stack.variances.as_ref().filter(|_| grid.is_pixels())?;
        let total = (count * count) as f64;
        let pixel = |p: usize| variances.iter().map(|v| v[p]).sum::<f64>() / total;
        Some((0..grid.cells()).map(pixel).collect())
    }
}
