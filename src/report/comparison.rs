//! What a person looks at: an image beside what it should be. Decides nothing.

use crate::regions::Regions;

/// A division of an image into cells, rows of cells from the top; their sizes differ by a pixel at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Columns of the image.
    pub width: usize,
    /// Rows of the image.
    pub height: usize,
    /// Cells in a row.
    pub columns: usize,
    /// Cells in a column.
    pub rows: usize,
}

impl Grid {
    /// A grid whose cells are single pixels, or larger where there would be more than so many in a row or column.
    pub fn of_pixels(width: usize, height: usize, most: usize) -> Self {
        let side = width.max(height).div_ceil(most.max(1)).max(1);
        Grid {
            width,
            height,
            columns: width.div_ceil(side).max(1),
            rows: height.div_ceil(side).max(1),
        }
    }

    /// The smallest tiles of a quadtree, in the order of its areas.
    pub fn of_tiles(width: usize, height: usize, regions: &Regions) -> Self {
        let (mut parts, mut all) = (1, 1);
        while all < regions.areas().len() {
            parts *= 2;
            all += parts * parts;
        }
        Grid {
            width,
            height,
            columns: parts,
            rows: parts,
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether a cell is a pixel.
    pub fn is_pixels(&self) -> bool {
        self.columns == self.width && self.rows == self.height
    }

    /// The size of a cell in words.
    pub fn words(&self) -> String {
        if self.is_pixels() {
            return "single pixels".to_owned();
        }
        let across = self.width.div_ceil(self.columns);
        let down = self.height.div_ceil(self.rows);
        format!("cells of {across} × {down} pixels")
    }

    /// Means over the cells. What is not covered is left out; a cell of which nothing is covered is not a number.
    pub fn means(&self, image: &[f64], covered: Option<&[bool]>) -> Vec<f64> {
        let cut = |length: usize, i: usize, parts: usize| length * i / parts;
        let mut means = Vec::with_capacity(self.cells());
        for j in 0..self.rows {
            let rows = cut(self.height, j, self.rows)..cut(self.height, j + 1, self.rows);
            for i in 0..self.columns {
                let columns =
                    cut(self.width, i, self.columns)..cut(self.width, i + 1, self.columns);
                let (mut sum, mut count) = (0.0, 0.0);
                for row in rows.clone() {
                    for p in row * self.width + columns.start..row * self.width + columns.end {
                        if covered.is_none_or(|c| c[p]) {
                            sum += image[p];
                            count += 1.0;
                        }
                    }
                }
                means.push(sum / count);
            }
        }
        means
    }
}

/// What is known of each cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// Where they are.
    pub grid: Grid,
    /// Difference of the observed from the truth over the image's mean truth; `None` where nothing is compared.
    pub difference: Vec<Option<f64>>,
    /// The same over its standard error; `None` where nothing tells the error.
    pub z: Vec<Option<f64>>,
}

impl Cells {
    /// From means over cells, of the observed and of the truth, and the variances of the former.
    pub fn new(grid: Grid, observed: &[f64], truth: &[f64], variance: Option<&[f64]>) -> Self {
        let lit: Vec<f64> = truth.iter().copied().filter(|t| *t > 0.0).collect();
        let scale = lit.iter().sum::<f64>() / lit.len() as f64;
        let finite = |v: f64| v.is_finite().then_some(v);
        let off = || observed.iter().zip(truth).map(|(o, t)| o - t);
        let difference = off().map(|d| finite(d / scale)).collect();
        let z_of = |(d, v): (f64, f64)| match d {
            // Both are black.
            0.0 => Some(0.0),
            // No variance is no evidence.
            _ if !(v > 0.0) => None,
            _ => finite(d / libm::sqrt(v)),
        };
        let z = match variance {
            Some(variance) => off().zip(variance.iter().copied()).map(z_of).collect(),
            None => vec![None; observed.len()],
        };
        Cells {
            grid,
            difference,
            z,
        }
    }
}

/// An image beside what it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The scene's name.
    pub scene: String,
    /// The integrator's or the renderer's name.
    pub integrator: String,
    /// What the image holds: the classes in it, or the layer's name.
    pub content: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// What it should be [W m⁻² sr⁻¹]; at bandwidth 0 where it is regularized.
    pub truth: Vec<f64>,
    /// What it is.
    pub observed: Vec<f64>,
    /// What differs; `None` where no part of the truth is known.
    pub cells: Option<Cells>,
    /// How the image was made and what it is compared with, sentences for a person.
    pub about: Vec<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_means_and_their_tiles_are_those_of_the_regions() {
        let regions = Regions::quadtree(70, 64);
        let grid = Grid::of_tiles(70, 64, &regions);
        assert_eq!([grid.columns, grid.rows], [4, 4]);
        let image: Vec<f64> = (0..70 * 64).map(f64::from).collect();
        let means = grid.means(&image, None);
        let areas = regions.reduce(&image);
        for (k, mean) in means.iter().enumerate() {
            let area = areas.len() - 16 + k;
            let expected = areas[area].0 / regions.pixels_of(area) as f64;
            assert!((mean - expected).abs() < 1e-9 * expected, "{k}");
        }
        assert!(Grid::of_pixels(5, 4, 128).is_pixels());
        assert_eq!(Grid::of_pixels(128, 96, 32).columns, 32);
    }

    #[test]
    fn no_variance_is_no_evidence_and_what_is_not_covered_is_not_compared() {
        let grid = Grid::of_pixels(2, 2, 128);
        let covered = [true, true, true, false];
        let observed = grid.means(&[1.0, 0.0, 3.0, 9.0], Some(&covered));
        let cells = Cells::new(grid, &observed, &[2.0; 4], Some(&[0.25, 0.0, 1.0, 1.0]));
        assert_eq!(cells.z, [Some(-2.0), None, Some(1.0), None]);
        assert_eq!(cells.difference, [Some(-0.5), Some(-1.0), Some(0.5), None]);
    }
}
