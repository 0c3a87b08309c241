//! A part of a film on which a function is one polynomial, and what of it is seen.
//!
//! The function f is sampled at 4×4 Gauss points of a tile (beyond an edge it takes what a plane through the others would have there: it
//! may be something else) and written as Legendre polynomials,
//!
//! ```text
//! c_pq = (2p + 1)(2q + 1) Σ w_i w_j f(a_i, b_j) P_p(a_i) P_q(b_j),     p, q ≤ 3
//! ```
//!
//! and each pixel's part is the integral of that polynomial over what is seen of the pixel: exactly where all of it is, and from
//! 8×8 points where an edge crosses it. So edges of any shape cost nothing but their own question, and c_00 is Gauss' rule
//! of degree 7 on tiles without edges.
//!
//! **Accuracy**: the error is an estimate. The last order c_3 is what a rule of degree 5 misses; the rule of degree 7 is better by the
//! square root of its relative size (QUADPACK's reasoning, with a factor for kinks), an interpolant beside an edge is not.

use libm::{ceil, floor, sqrt};

use super::Moments;
use super::quadrature::Pair;
use crate::pixel::rule::Rule;

/// Nodes along an axis.
const NODES: usize = 4;
/// Points along an axis of a pixel that an edge crosses.
const POINTS: u32 = 8;
/// Relative size of the last order above which no better is expected of the whole rule.
const KINKED: f64 = 100.0;
/// Standard deviation of the area that the points of a pixel with an edge find: 0.3 points for each of the row that it crosses.
const EDGE: f64 = 0.3 / 22.6;
/// Fewest samples through which a plane is laid, and the relative change of a function of which there are fewer.
const FEWEST: usize = 5;
const UNKNOWN: f64 = 0.05;
/// Errors of tiles have any sign: so many standard deviations of their sum, and this part of the sum of their sizes.
const DEVIATIONS: f64 = 3.0;
const COHERENT: f64 = 0.1;
/// Tiles are not halved below this [pixels].
const SMALLEST: f64 = 1.0 / 16.0;

/// A rectangle of the film [pixels].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Left and top.
    pub low: [f64; 2],
    /// Right and bottom.
    pub high: [f64; 2],
}

/// What a tile adds to its pixels.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Where.
    pub tile: Tile,
    /// First column and row of pixels that it has a part of, and their numbers.
    pub first: [u32; 2],
    /// See `first`.
    pub count: [u32; 2],
    /// Integrals of both functions over what is seen, pixel by pixel, row by row.
    pub pixels: Vec<[f64; 2]>,
    /// Error of their sums.
    pub error: [f64; 2],
    /// Error of the sums of a half of them, about.
    pub uneven: [f64; 2],
}

impl Tile {
    /// Four parts, or fewer where a side is a pixel and the other is not; `None` where it is too small. Cut between pixels where there are several.
    pub fn parts(&self) -> Option<Vec<Tile>> {
        let cut = |k: usize| {
            let (low, high) = (self.low[k], self.high[k]);
            let middle = 0.5 * (low + high);
            let whole = floor(middle);
            if whole > low { whole } else { middle }
        };
        let cuts = [cut(0), cut(1)];
        let size = |k: usize| self.high[k] - self.low[k];
        if size(0).max(size(1)) <= SMALLEST {
            return None;
        }
        let sides = |k: usize| {
            // A side that is much shorter than the other is left alone.
            if size(k) < 0.5 * size(1 - k) || size(k) <= SMALLEST {
                vec![[self.low[k], self.high[k]]]
            } else {
                vec![[self.low[k], cuts[k]], [cuts[k], self.high[k]]]
            }
        };
        let mut parts = Vec::new();
        for y in sides(1) {
            for x in sides(0) {
                parts.push(Tile {
                    low: [x[0], y[0]],
                    high: [x[1], y[1]],
                });
            }
        }
        Some(parts)
    }
}

impl Sampled {
    /// The sums over all pixels.
    pub fn sum(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for p in &self.pixels {
            sum = [sum[0] + p[0], sum[1] + p[1]];
        }
        sum
    }

    /// Samples two functions on a tile.
    pub(super) fn new(
        tile: Tile,
        sees: impl Fn(f64, f64) -> bool,
        at: impl Fn(f64, f64) -> Pair,
    ) -> Self {
        let first = tile.low.map(|l| floor(l) as u32);
        let count: [u32; 2] =
            core::array::from_fn(|k| (ceil(tile.high[k]) as u32).saturating_sub(first[k]));
        let cells = cells(&tile, first, count, &sees);
        let seen: f64 = cells.iter().map(Cell::area).sum();
        let mut sampled = Sampled {
            tile,
            first,
            count,
            pixels: vec![[0.0; 2]; cells.len()],
            error: [0.0; 2],
            uneven: [0.0; 2],
        };
        if seen == 0.0 {
            return sampled;
        }
        let cut = cells
            .iter()
            .filter(|c| matches!(c, Cell::Cut { .. }))
            .count() as f64;
        let area = (tile.high[0] - tile.low[0]) * (tile.high[1] - tile.low[1]);
        let fits = Fit::both(&tile, &cells, &sees, &at);
        for (k, fit) in fits.iter().enumerate() {
            for (out, cell) in sampled.pixels.iter_mut().zip(&cells) {
                out[k] = cell.integral(fit, &tile);
            }
            let last = fit.last_order() + fit.filled;
            let better = sqrt(KINKED * last / fit.largest.max(f64::MIN_POSITIVE)).min(1.0);
            let whole = if cut == 0.0 && seen > area * (1.0 - 1e-9) {
                better
            } else {
                1.0
            };
            let edge = EDGE * sqrt(cut) * fit.largest;
            sampled.error[k] = seen * (last * whole + fit.inner) + edge;
            sampled.uneven[k] = seen * (last + fit.inner) + edge;
            if !sampled.error[k].is_finite() {
                // A sample that does not exist: nothing is known but of smaller tiles.
                sampled.pixels.iter_mut().for_each(|p| p[k] = 0.0);
                (sampled.error[k], sampled.uneven[k]) = (f64::INFINITY, f64::INFINITY);
            }
        }
        sampled
    }
}

/// What is seen of a pixel's part in a tile.
enum Cell {
    Dark,
    Whole { low: [f64; 2], high: [f64; 2] },
    Cut { area: f64, points: Vec<[f64; 2]> },
}

impl Cell {
    fn area(&self) -> f64 {
        match self {
            Cell::Dark => 0.0,
            Cell::Whole { low, high } => (high[0] - low[0]) * (high[1] - low[1]),
            Cell::Cut { area, points } => area * points.len() as f64,
        }
    }

    fn integral(&self, fit: &Fit, tile: &Tile) -> f64 {
        match self {
            Cell::Dark => 0.0,
            Cell::Whole { low, high } => {
                // Two points along each axis are exact for a cubic.
                const G: f64 = 0.211_324_865_405_187_1;
                let mut sum = 0.0;
                for s in [G, 1.0 - G] {
                    for t in [G, 1.0 - G] {
                        let p = [s, t];
                        let u: [f64; 2] =
                            core::array::from_fn(|k| low[k] + p[k] * (high[k] - low[k]));
                        sum += 0.25 * fit.value(tile, u);
                    }
                }
                sum * self.area()
            }
            Cell::Cut { area, points } => points.iter().map(|u| area * fit.value(tile, *u)).sum(),
        }
    }
}

/// Asks at nine places of each pixel, and at 8×8 where they do not agree.
fn cells(
    tile: &Tile,
    first: [u32; 2],
    count: [u32; 2],
    sees: &impl Fn(f64, f64) -> bool,
) -> Vec<Cell> {
    let mut cells = Vec::with_capacity((count[0] * count[1]) as usize);
    for j in 0..count[1] {
        for i in 0..count[0] {
            let pixel = [first[0] + i, first[1] + j].map(f64::from);
            let low: [f64; 2] = core::array::from_fn(|k| pixel[k].max(tile.low[k]));
            let high: [f64; 2] = core::array::from_fn(|k| (pixel[k] + 1.0).min(tile.high[k]));
            let at = |s: f64, t: f64| {
                [
                    low[0] + s * (high[0] - low[0]),
                    low[1] + t * (high[1] - low[1]),
                ]
            };
            let mut seen = 0;
            for n in 0..9 {
                let [u, v] = at(0.5 * f64::from(n % 3), 0.5 * f64::from(n / 3));
                seen += u32::from(sees(u, v));
            }
            cells.push(match seen {
                0 => Cell::Dark,
                9 => Cell::Whole { low, high },
                _ => {
                    let step = 1.0 / f64::from(POINTS);
                    let places = (0..POINTS * POINTS).map(|n| {
                        let (s, t) = (f64::from(n % POINTS), f64::from(n / POINTS));
                        at((s + 0.5) * step, (t + 0.5) * step)
                    });
                    let points: Vec<[f64; 2]> = places.filter(|p| sees(p[0], p[1])).collect();
                    let area = (high[0] - low[0]) * (high[1] - low[1]) * step * step;
                    Cell::Cut { area, points }
                }
            });
        }
    }
    cells
}

/// A polynomial of degree 3 along both axes.
struct Fit {
    /// `[q][p]`.
    c: [[f64; NODES]; NODES],
    /// Largest sample.
    largest: f64,
    /// Mean error of the samples.
    inner: f64,
    /// What samples that were not taken may change.
    filled: f64,
}

/// The middle of what is seen.
fn middle(cells: &[Cell]) -> [f64; 2] {
    // Of the pixel of which most is seen the point in the middle of the list: it is one that is seen.
    let most = cells.iter().max_by(|a, b| a.area().total_cmp(&b.area()));
    match most {
        Some(Cell::Whole { low, high }) => [0, 1].map(|k| 0.5 * (low[k] + high[k])),
        Some(Cell::Cut { points, .. }) => points
            .get(points.len() / 2)
            .copied()
            .unwrap_or([f64::NAN; 2]),
        _ => [f64::NAN; 2],
    }
}

/// The plane c0 + c1 a + c2 b of least squares; a constant where there are fewer samples than [`FEWEST`].
fn plane(known: &[([f64; 2], f64)]) -> [f64; 3] {
    let n = known.len().max(1) as f64;
    let mean = known.iter().map(|(_, v)| v).sum::<f64>() / n;
    let center = [0, 1].map(|k| known.iter().map(|(a, _)| a[k]).sum::<f64>() / n);
    if known.len() < FEWEST {
        return [mean, 0.0, 0.0];
    }
    let mut m = [0.0; 3];
    let mut r = [0.0; 2];
    for (a, v) in known {
        let d = [a[0] - center[0], a[1] - center[1]];
        m = [m[0] + d[0] * d[0], m[1] + d[0] * d[1], m[2] + d[1] * d[1]];
        r = [r[0] + d[0] * (v - mean), r[1] + d[1] * (v - mean)];
    }
    let det = m[0] * m[2] - m[1] * m[1];
    // All in one row.
    if !(det > 1e-3 * (m[0] + m[2]) * (m[0] + m[2])) {
        return [mean, 0.0, 0.0];
    }
    let slope = [
        (m[2] * r[0] - m[1] * r[1]) / det,
        (m[0] * r[1] - m[1] * r[0]) / det,
    ];
    [
        mean - slope[0] * center[0] - slope[1] * center[1],
        slope[0],
        slope[1],
    ]
}

impl Fit {
    /// Samples both functions at the nodes that are seen; the others get what a plane through those would have there.
    fn both(
        tile: &Tile,
        cells: &[Cell],
        sees: &impl Fn(f64, f64) -> bool,
        at: &impl Fn(f64, f64) -> Pair,
    ) -> [Fit; 2] {
        let rule = Rule::gauss(NODES);
        let mut nodes = Vec::with_capacity(NODES * NODES);
        for (t, wt) in rule.iter() {
            for (s, ws) in rule.iter() {
                nodes.push(([2.0 * s - 1.0, 2.0 * t - 1.0], ws * wt));
            }
        }
        let place = |k: usize, a: f64| tile.low[k] + 0.5 * (1.0 + a) * (tile.high[k] - tile.low[k]);
        let samples: Vec<Option<Pair>> = nodes
            .iter()
            .map(|([a, b], _)| {
                let (u, v) = (place(0, *a), place(1, *b));
                sees(u, v).then(|| at(u, v))
            })
            .collect();
        let count = samples.iter().flatten().count();
        // A corner that no node is in: one sample says what is there.
        let lone = (count == 0).then(|| {
            let [u, v] = middle(cells);
            at(u, v)
        });
        [0, 1].map(|k| {
            let known: Vec<([f64; 2], f64)> = (nodes.iter().zip(&samples))
                .filter_map(|((a, _), s)| s.map(|s| (*a, s.value[k])))
                .collect();
            let errors = || samples.iter().flatten().chain(&lone).map(|s| s.error[k]);
            let plane = match &lone {
                Some(lone) => [lone.value[k], 0.0, 0.0],
                None => plane(&known),
            };
            let value = |j: usize| {
                let [a, b] = nodes[j].0;
                let filled = plane[0] + plane[1] * a + plane[2] * b;
                samples[j].map_or(filled, |s| s.value[k])
            };
            let mut fit = Fit {
                c: [[0.0; NODES]; NODES],
                largest: 0.0,
                inner: errors().sum::<f64>() / count.max(1) as f64,
                filled: 0.0,
            };
            for (j, (node, weight)) in nodes.iter().enumerate() {
                let (a, b) = (legendre(node[0]), legendre(node[1]));
                let value = value(j);
                for (q, row) in fit.c.iter_mut().enumerate() {
                    for (p, c) in row.iter_mut().enumerate() {
                        let scale = (2 * p + 1) as f64 * (2 * q + 1) as f64;
                        *c += scale * weight * value * a[p] * b[q];
                    }
                }
                fit.largest = if value.is_nan() {
                    f64::NAN
                } else {
                    fit.largest.max(value.abs())
                };
            }
            if count < FEWEST {
                // Nothing tells how much the function changes.
                fit.filled = UNKNOWN * fit.largest;
            }
            fit
        })
    }

    /// Size of what is of the highest order along an axis.
    fn last_order(&self) -> f64 {
        let n = NODES - 1;
        let mut sum = f64::abs(self.c[n][n]);
        for k in 0..n {
            sum += f64::abs(self.c[n][k]) + f64::abs(self.c[k][n]);
        }
        sum
    }

    fn value(&self, tile: &Tile, u: [f64; 2]) -> f64 {
        let [a, b] = [0, 1]
            .map(|k| legendre(2.0 * (u[k] - tile.low[k]) / (tile.high[k] - tile.low[k]) - 1.0));
        let mut sum = 0.0;
        for (row, bq) in self.c.iter().zip(&b) {
            for (c, ap) in row.iter().zip(&a) {
                sum += c * ap * bq;
            }
        }
        sum
    }
}

/// P_0 to P_3.
fn legendre(x: f64) -> [f64; NODES] {
    [1.0, x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x]
}

/// The error of a sum of parts from their errors: they are as likely too large as too small, but where kinks lie alike in many.
pub fn together(errors: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut squares) = (0.0, 0.0);
    for e in errors {
        sum += e;
        squares += e * e;
    }
    // Of one or a few the sum of sizes is the better bound.
    (DEVIATIONS * sqrt(squares) + COHERENT * sum).min(sum)
}

/// Moments summed over tiles, with the error of the sum.
pub fn total(tiles: &[Sampled]) -> Moments {
    let mut sum = Moments::default();
    for s in tiles {
        let value = s.sum();
        sum.mean.value += value[0];
        sum.second_moment.value += value[1];
    }
    let error = [0, 1].map(|k| together(tiles.iter().map(|s| s.error[k])));
    (sum.mean.error, sum.second_moment.error) = (error[0], error[1]);
    sum
}

/// Splits tiles until the sum of their errors is small: `goal` tells from the sums of all what is allowed, `sample` samples several
/// (in their order, perhaps side by side). At most `most` tiles are sampled.
pub fn refine(
    tiles: Vec<Tile>,
    most: usize,
    goal: impl Fn([f64; 2]) -> [f64; 2],
    sample: impl Fn(&[Tile]) -> Vec<Sampled>,
) -> Vec<Sampled> {
    let mut list = sample(&tiles);
    let mut looks = list.len();
    loop {
        let mut sum = [0.0; 2];
        for s in &list {
            let value = s.sum();
            for k in 0..2 {
                sum[k] += f64::abs(value[k]);
            }
        }
        let error = [0, 1].map(|k| together(list.iter().map(|s| s.error[k])));
        let mut goal = goal(sum).map(|g| g.max(f64::MIN_POSITIVE));
        if error[0].is_finite() && !error[1].is_finite() {
            // Second moments of photons of which the weights are not known.
            goal[1] = f64::INFINITY;
        }
        if (0..2).all(|k| error[k] <= goal[k]) || looks >= most {
            return list;
        }
        // Those are split without which the others are allowed half of the goal.
        let part = |s: &Sampled| (0..2).map(|k| s.error[k] / goal[k]).fold(0.0, f64::max);
        let mut order: Vec<usize> = (0..list.len()).collect();
        order.sort_by(|&a, &b| part(&list[a]).total_cmp(&part(&list[b])).then(a.cmp(&b)));
        let mut split = vec![false; list.len()];
        let (mut left, mut squares) = (0.0, 0.0);
        for &k in &order {
            let error = part(&list[k]);
            left += error;
            squares += error * error;
            split[k] = (DEVIATIONS * sqrt(squares) + COHERENT * left).min(left) > 0.5;
        }
        let (mut kept, mut new) = (Vec::new(), Vec::new());
        for (s, split) in list.into_iter().zip(split) {
            match s.tile.parts().filter(|_| split) {
                Some(parts) => new.extend(parts),
                None => kept.push(s),
            }
        }
        if new.is_empty() {
            return kept;
        }
        looks += new.len();
        kept.extend(sample(&new));
        list = kept;
    }
}
