//! Photons on the floor, sorted into a grid: the sum of flux times kernel around a point.
//!
//! Cells are squares at least as wide as the radius, row by row, so that the photons near a point are in three runs of
//! consecutive photons, one per row. The sort is stable and sums have a fixed order (eight partial sums by position in
//! the run), so the bits do not depend on the machine. A query costs the photons of nine cells.

use super::kernel::{Profile, RadiusKernel};

/// Partial sums of a query.
const LANES: usize = 8;
/// Cells per photon, at most: bounds memory and set-up where the radius is tiny.
const CELLS_PER_PHOTON: f64 = 2.0;

/// Photons in the order in which they were traced.
#[derive(Clone, Debug, Default)]
pub(super) struct Photons {
    /// Landing points [m] and fluxes.
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) flux: Vec<f64>,
}

impl Photons {
    pub(super) fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.flux.clear();
    }

    /// Smallest and largest x, smallest and largest y; infinite, the wrong way round, without a photon.
    fn bounds(&self) -> [f64; 4] {
        let of = |v: &[f64]| {
            let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            v.iter().fold((low, high), |(low, high), &c| {
                (
                    if c < low { c } else { low },
                    if c > high { c } else { high },
                )
            })
        };
        let ((x0, x1), (y0, y1)) = (of(&self.x), of(&self.y));
        [x0, x1, y0, y1]
    }

    /// Area of the bounding box [m²].
    pub(super) fn area(&self) -> f64 {
        let [x0, x1, y0, y1] = self.bounds();
        (x1 - x0) * (y1 - y0)
    }

    #[inline(always)]
    pub(super) fn push(&mut self, x: f64, y: f64, flux: f64) {
        self.x.push(x);
        self.y.push(y);
        self.flux.push(flux);
    }
}

/// The grid. Rebuilt for every batch of photons; keeps its memory.
#[derive(Debug, Default)]
pub(super) struct PhotonGrid {
    sorted: Photons,
    /// `starts[cell]`: first photon of the cell; one more entry than cells.
    starts: Vec<u32>,
    cell_of: Vec<u32>,
    low: [f64; 2],
    inverse_cell: f64,
    columns: usize,
    rows: usize,
}

impl PhotonGrid {
    /// Sorts photons for queries of this radius.
    pub(super) fn build(&mut self, photons: &Photons, radius: f64) {
        let n = photons.x.len();
        let [x0, x1, y0, y1] = photons.bounds();
        if n == 0 {
            (self.columns, self.rows) = (0, 0);
            return;
        }
        // A little wider than the radius, so that rounding cannot push a neighbour two cells away.
        let widest = if x1 - x0 > y1 - y0 { x1 - x0 } else { y1 - y0 };
        let bounded = widest / f64::sqrt(CELLS_PER_PHOTON * n as f64);
        let cell = if radius > bounded { radius } else { bounded } * (1.0 + 1e-9);
        self.inverse_cell = if cell > 0.0 { 1.0 / cell } else { 0.0 };
        self.low = [x0, y0];
        self.columns = ((x1 - x0) * self.inverse_cell) as usize + 1;
        self.rows = ((y1 - y0) * self.inverse_cell) as usize + 1;
        // Counting sort: count, prefix sums, stable scatter.
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
        self.cell_of.clear();
        for i in 0..n {
            let column = ((photons.x[i] - x0) * self.inverse_cell) as usize;
            let row = ((photons.y[i] - y0) * self.inverse_cell) as usize;
            let cell = row.min(self.rows - 1) * self.columns + column.min(self.columns - 1);
            self.cell_of.push(cell as u32);
            self.starts[cell + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        for v in [
            &mut self.sorted.x,
            &mut self.sorted.y,
            &mut self.sorted.flux,
        ] {
            v.clear();
            v.resize(n, 0.0);
        }
        for i in 0..n {
            // `starts` serves as the cursor of its cell, and ends as the start of the next one.
            let cursor = &mut self.starts[self.cell_of[i] as usize];
            let to = *cursor as usize;
            *cursor += 1;
            self.sorted.x[to] = photons.x[i];
            self.sorted.y[to] = photons.y[i];
            self.sorted.flux[to] = photons.flux[i];
        }
        // Undo the shift by one cell that the cursors made.
        self.starts.copy_within(0..self.columns * self.rows, 1);
        self.starts[0] = 0;
    }

    /// Sum over the photons of flux × profile for d² < r²: the irradiance, divided by the kernel's value at its
    /// centre. `reach` is how many cells below and above the point's own are looked at: one.
    #[inline(always)]
    pub(super) fn gather(&self, x: f64, y: f64, kernel: &RadiusKernel, reach: [i64; 2]) -> f64 {
        match kernel.profile {
            Profile::Parabola => {
                let slope = kernel.slope;
                self.sum(x, y, kernel.radius, reach, |d2, flux| {
                    flux * (1.0 + slope * d2)
                })
            }
            Profile::Square | Profile::Linear => self.gather_steeper(x, y, kernel, reach),
        }
    }

    /// The same for kernels that are not a parabola, compiled once.
    #[inline(never)]
    fn gather_steeper(&self, x: f64, y: f64, kernel: &RadiusKernel, reach: [i64; 2]) -> f64 {
        let (slope, inverse) = (kernel.slope, 1.0 / kernel.radius);
        match kernel.profile {
            Profile::Linear => self.sum(x, y, kernel.radius, reach, |d2, flux| {
                flux * (1.0 - f64::sqrt(d2) * inverse)
            }),
            _ => self.sum(x, y, kernel.radius, reach, |d2, flux| {
                let parabola = 1.0 + slope * d2;
                flux * (parabola * parabola)
            }),
        }
    }

    /// Sum over the photons with d² < r² of a function of d² and flux.
    #[inline(always)]
    pub(super) fn sum(
        &self,
        x: f64,
        y: f64,
        radius: f64,
        reach: [i64; 2],
        of: impl Fn(f64, f64) -> f64,
    ) -> f64 {
        // Converted to whole numbers, which saturate, so that a point far away is simply outside.
        let column = f64::floor((x - self.low[0]) * self.inverse_cell) as i64;
        let row = f64::floor((y - self.low[1]) * self.inverse_cell) as i64;
        let (columns, rows) = (self.columns as i64, self.rows as i64);
        if column < -1 || column > columns || row < -1 || row > rows || columns == 0 {
            return 0.0;
        }
        let clamp = |v: i64, end: i64| v.clamp(0, end - 1) as usize;
        let [below, above] = reach;
        let (first, last) = (
            clamp(column - below, columns),
            clamp(column + above, columns),
        );
        let square = radius * radius;
        let mut sums = [0.0; LANES];
        for row in clamp(row - below, rows)..=clamp(row + above, rows) {
            let start = self.starts[row * self.columns + first] as usize;
            let end = self.starts[row * self.columns + last + 1] as usize;
            let (px, py) = (&self.sorted.x[start..end], &self.sorted.y[start..end]);
            let flux = &self.sorted.flux[start..end];
            let term = |px: f64, py: f64, flux: f64| {
                let (dx, dy) = (px - x, py - y);
                let d2 = dx * dx + dy * dy;
                let value = of(d2, flux);
                if d2 < square { value } else { 0.0 }
            };
            let (ax, bx) = px.as_chunks::<LANES>();
            let (ay, by) = py.as_chunks::<LANES>();
            let (af, bf) = flux.as_chunks::<LANES>();
            for ((cx, cy), cf) in ax.iter().zip(ay).zip(af) {
                for k in 0..LANES {
                    sums[k] += term(cx[k], cy[k], cf[k]);
                }
            }
            for (k, ((&cx, &cy), &cf)) in bx.iter().zip(by).zip(bf).enumerate() {
                sums[k] += term(cx, cy, cf);
            }
        }
        let [a, b, c, d, e, f, g, h] = sums;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::Kernel;
    use crate::stream::{philox, uniform};

    fn numbers(i: u32) -> [f64; 4] {
        let [a, b, c, d] = philox([i, 0, 0, 9], [7, 7]);
        [a, b, c, d].map(|bits| uniform(bits, 0))
    }

    #[test]
    fn a_query_is_the_sum_over_all_photons() {
        for (n, radius) in [
            (0, 0.2),
            (1, 0.3),
            (7, 0.5),
            (2000, 0.07),
            (2000, 1e-4),
            (300, 5.0),
        ] {
            let mut photons = Photons::default();
            for i in 0..n {
                let [u, v, w, _] = numbers(i);
                photons.push(3.0 * u - 1.0, 0.4 * v, 0.5 + w);
            }
            let mut grid = PhotonGrid::default();
            for name in [
                Kernel::Disc,
                Kernel::Epanechnikov,
                Kernel::Biweight,
                Kernel::Cone,
            ] {
                let kernel = RadiusKernel::new(name, radius, None);
                grid.build(&photons, radius);
                for i in 0..500 {
                    let [u, v, _, _] = numbers(10_000 + i);
                    // Some queries at a photon, most anywhere, also off the grid.
                    let (x, y) = if i % 5 == 0 && n > 0 {
                        let j = (i % n) as usize;
                        (photons.x[j] + 0.3 * radius, photons.y[j])
                    } else {
                        (6.0 * u - 2.5, 2.0 * v - 0.8)
                    };
                    let expected: f64 = (0..n as usize)
                        .map(|j| {
                            let (dx, dy) = (photons.x[j] - x, photons.y[j] - y);
                            let d2 = dx * dx + dy * dy;
                            let inside = d2 < radius * radius;
                            let parabola = 1.0 - d2 / (radius * radius);
                            let shape = match name {
                                Kernel::Disc => 1.0,
                                Kernel::Epanechnikov => parabola,
                                Kernel::Biweight => parabola * parabola,
                                _ => 1.0 - d2.sqrt() / radius,
                            };
                            if inside { photons.flux[j] * shape } else { 0.0 }
                        })
                        .sum();
                    let found = grid.gather(x, y, &kernel, [1, 1]);
                    assert!(
                        (found - expected).abs() <= 1e-12 * (1.0 + expected),
                        "{n} {radius}"
                    );
                }
            }
        }
    }

    #[test]
    fn photons_in_one_point_and_far_queries_are_harmless() {
        let mut photons = Photons::default();
        for _ in 0..20 {
            photons.push(1.0, 2.0, 1.0);
        }
        let mut grid = PhotonGrid::default();
        grid.build(&photons, 0.1);
        let kernel = RadiusKernel::new(Kernel::Disc, 0.1, None);
        assert_eq!(grid.gather(1.0, 2.05, &kernel, [1, 1]), 20.0);
        for far in [1e300, -1e300, f64::INFINITY, f64::NAN] {
            assert_eq!(grid.gather(far, 2.0, &kernel, [1, 1]), 0.0);
        }
    }
}
