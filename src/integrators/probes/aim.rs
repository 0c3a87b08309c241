//! Where in the unit square of random numbers the contributions are.
//!
//! Every technique maps a pair of uniform numbers to a path, so that equal areas of the unit square are equal solid
//! angles of emission (equal cross-sections of a beam, equal projected solid angles at the floor). Limiting the numbers to a
//! part of the square that contains all contributions multiplies every sample by the part's area, keeps the mean, and
//! multiplies second moments by the area: bandwidths become measurable at which one path in a million contributes.
//!
//! The part is found by a search over nested widths of the kernel, from one that many paths meet down to a quarter more
//! than what is asked for. At each step cells that contain a contribution are kept with their eight neighbours, and
//! quartered until there are many, before the kernel narrows. A support that narrows with its width cannot be lost unless a
//! piece of it is cut off so finely that 16 points a cell, with neighbours, miss it: by an edge of a surface, and then its
//! part of the light is as small.
//!
//! The search works on a chart of the unit square without poles, in which cells are never needles: a disc of directions
//! about each pole becomes a square by the concentric map of [Shirley & Chiu 1997], which keeps areas.

/// A part of the unit square for each class of an estimator.
#[derive(Clone, Debug)]
pub struct Aim {
    pub(super) parts: Vec<Part>,
}

impl Aim {
    /// The area of a class's part: what its second moments are multiplied by. 0 if nothing was found to contribute, 1 for a
    /// class that the estimator does not have.
    pub fn share(&self, class: usize) -> f64 {
        self.parts.get(class).map_or(1.0, Part::share)
    }
}

/// From a point of a square to a pair of uniform numbers. Areas are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::integrators) enum Chart {
    /// The point itself: a cross-section of a beam.
    #[default]
    Plane,
    /// Turns and squared radius in a disc: directions of a hemisphere.
    Disc,
    /// Two discs side by side, one for each pole: directions of the sphere by turns and height.
    Sphere,
}

impl Chart {
    /// The pair of uniform numbers of a point.
    #[inline(always)]
    fn numbers(self, a: f64, b: f64) -> (f64, f64) {
        match self {
            Chart::Plane => (a, b),
            Chart::Disc => disc(a, b),
            Chart::Sphere => {
                let upper = a >= 0.5;
                let (turn, square) = disc(if upper { 2.0 * a - 1.0 } else { 2.0 * a }, b);
                let half = 0.5 * square;
                (turn, if upper { 1.0 - half } else { half })
            }
        }
    }
}

/// Turns and squared radius by the concentric map.
#[inline(always)]
fn disc(a: f64, b: f64) -> (f64, f64) {
    let (x, y) = (2.0 * a - 1.0, 2.0 * b - 1.0);
    let (radius, turn) = if f64::abs(x) > f64::abs(y) {
        (x, 0.125 * (y / x))
    } else if y != 0.0 {
        (y, 0.25 - 0.125 * (x / y))
    } else {
        (0.0, 0.0)
    };
    let turn = if radius < 0.0 { turn + 0.5 } else { turn };
    (turn, radius * radius)
}

/// Cells of a grid of 2^level rows and columns on a chart.
#[derive(Clone, Debug, Default)]
pub(in crate::integrators) struct Part {
    chart: Chart,
    level: u32,
    cells: Vec<[u32; 2]>,
}

/// Level of the first grid.
const FIRST: u32 = 8;
/// Level of the finest grid.
const LAST: u32 = 28;
/// Points of a cell: a lattice of which no two have a coordinate in common, so that a sliver along the grid is not missed by
/// all of them.
const POINTS: u32 = 16;
const GENERATOR: u32 = 7;
/// Fewer cells than this are quartered.
const MANY: usize = 3000;
/// The width at the end of the search, in units of what is asked for.
const MARGIN: f64 = 1.25;

impl Part {
    fn side(level: u32) -> f64 {
        1.0 / f64::from(1_u32 << level)
    }

    pub(in crate::integrators) fn share(&self) -> f64 {
        let side = Part::side(self.level);
        self.cells.len() as f64 * side * side
    }

    pub(in crate::integrators) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// A pair of uniform numbers, moved into the part: the first digits of one choose the cell.
    #[inline(always)]
    pub(in crate::integrators) fn place(&self, u: f64, v: f64) -> (f64, f64) {
        let (column, row) = self.point(u, v);
        self.chart.numbers(column, row)
    }

    /// The point of the chart.
    #[inline(always)]
    fn point(&self, u: f64, v: f64) -> (f64, f64) {
        let scaled = u * self.cells.len() as f64;
        let chosen = (scaled as usize).min(self.cells.len() - 1);
        let [column, row] = self.cells[chosen];
        let side = Part::side(self.level);
        let rest = scaled - chosen as f64;
        (
            (f64::from(column) + rest) * side,
            (f64::from(row) + v) * side,
        )
    }

    /// The cells in which a point is a hit, and their neighbours.
    fn hit(&self, hit: &dyn Fn(f64, f64) -> bool) -> Self {
        let (count, side) = (1_u32 << self.level, Part::side(self.level));
        let at =
            |cell: u32, k: u32| (f64::from(cell) + (f64::from(k) + 0.5) / f64::from(POINTS)) * side;
        let mut cells = Vec::new();
        for &[column, row] in &self.cells {
            let contributes = |k: u32| {
                let (a, b) = (at(column, k), at(row, k * GENERATOR % POINTS));
                let (u, v) = self.chart.numbers(a, b);
                hit(u, v)
            };
            if (0..POINTS).any(contributes) {
                let around = |c: u32| c.saturating_sub(1)..=(c + 1).min(count - 1);
                cells.extend(around(column).flat_map(|c| around(row).map(move |r| [c, r])));
            }
        }
        cells.sort_unstable();
        cells.dedup();
        Part {
            chart: self.chart,
            level: self.level,
            cells,
        }
    }

    fn quartered(&self) -> Self {
        let quarters = |&[column, row]: &[u32; 2]| {
            let (c, r) = (2 * column, 2 * row);
            [[c, r], [c + 1, r], [c, r + 1], [c + 1, r + 1]]
        };
        Part {
            chart: self.chart,
            level: self.level + 1,
            cells: self.cells.iter().flat_map(quarters).collect(),
        }
    }
}

/// The part of the unit square in which paths contribute at the width `target`. `hits` makes the test of a pair of numbers
/// at a width; what it accepts must shrink with the width. The search begins at `widest`.
pub(in crate::integrators) fn search<'a>(
    chart: Chart,
    target: f64,
    widest: f64,
    hits: impl Fn(f64) -> Box<dyn Fn(f64, f64) -> bool + 'a>,
) -> Part {
    let last = MARGIN * target;
    let mut width = if widest > last { widest } else { last };
    let count = 1_u32 << FIRST;
    let mut part = Part {
        chart,
        level: FIRST,
        cells: (0..count)
            .flat_map(|column| (0..count).map(move |row| [column, row]))
            .collect(),
    };
    loop {
        part = part.hit(&hits(width));
        let few = !part.is_empty() && part.cells.len() < MANY;
        if few && part.level < LAST {
            part = part.quartered();
        } else if width <= last || part.is_empty() {
            return part;
        } else {
            width = if 0.5 * width > last {
                0.5 * width
            } else {
                last
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every point of two discs in the square is in the part, and numbers moved into the part are uniform over it.
    #[test]
    fn the_part_covers_the_support_and_little_else() {
        let centers = [(0.993, 0.4), (0.3, 0.77)];
        let inside = move |width: f64, u: f64, v: f64| {
            centers
                .iter()
                .any(|&(cu, cv)| (u - cu) * (u - cu) + (v - cv) * (v - cv) < width * width)
        };
        let target = 2e-3;
        let hits = |width: f64| -> Box<dyn Fn(f64, f64) -> bool> {
            Box::new(move |u, v| inside(width, u, v))
        };
        let part = search(Chart::Plane, target, 1.0, hits);
        let area = 2.0 * core::f64::consts::PI * target * target;
        let share = part.share() / area;
        assert!(share > 1.0 && share < 3.0, "{share}");
        let side = Part::side(part.level);
        let n = 200;
        for (cu, cv) in centers {
            for k in 0..n * n {
                let at = |c: f64, k: i32| c + target * (f64::from(2 * k) / f64::from(n) - 1.0);
                let (u, v) = (at(cu, k % n), at(cv, k / n));
                let cell = [(u / side) as u32, (v / side) as u32];
                assert!(!inside(target, u, v) || part.cells.binary_search(&cell).is_ok());
            }
        }
        // Midpoints of a fine grid, placed: the same number in every cell.
        let mut counts = vec![0; part.cells.len()];
        let fine = 8 * part.cells.len();
        for k in 0..fine {
            let (u, v) = part.point((k as f64 + 0.5) / fine as f64, 0.5);
            let cell = [(u / side) as u32, (v / side) as u32];
            counts[part.cells.binary_search(&cell).unwrap()] += 1;
        }
        assert!(counts.iter().all(|&c| c == 8));
    }

    /// Equal areas: every box of an 8 × 8 grid of the numbers gets its share of the midpoints of a fine grid of the chart, up
    /// to the cells at its border.
    #[test]
    fn charts_keep_areas() {
        for chart in [Chart::Plane, Chart::Disc, Chart::Sphere] {
            let n = 512;
            let mut counts = [0_i32; 64];
            for k in 0..n * n {
                let at = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
                let (u, v) = chart.numbers(at(k % n), at(k / n));
                let u = u - f64::floor(u);
                assert!((0.0..1.0).contains(&u) && (0.0..=1.0).contains(&v));
                counts[(u * 8.0) as usize + 8 * ((v * 8.0) as usize).min(7)] += 1;
            }
            let each = n * n / 64;
            let off = counts.iter().map(|c| (c - each).abs()).max();
            assert!(off.is_some_and(|off| off < n), "{chart:?}: {counts:?}");
        }
    }

    #[test]
    fn nothing_to_find_is_an_empty_part() {
        let nothing = |_| -> Box<dyn Fn(f64, f64) -> bool> { Box::new(|_, _| false) };
        let part = search(Chart::Sphere, 0.1, 1.0, nothing);
        assert!(part.is_empty() && part.share() == 0.0);
    }
}
