//! Pixels of a regular cell, by Green's theorem in its coordinates.
//!
//! With F = ∫ f da a region's flux is ∮ F db along its border, counter-clockwise. A pixel's border within the cell consists
//! of pieces of film lines, whose preimages Newton's method follows, and of pieces of the cell's own sides, where the
//! integral is a polynomial. Neighbours share both, so a row of n pixels needs about 3n edges and no break points.

use crate::camera::Bounded;
use crate::flux::cells::Cell;
use crate::flux::lens::{Lens, Linear};
use crate::flux::poly::{N, value, zeros};
use crate::pixel::rule::Rule;

/// Gauss rules of an edge.
#[derive(Clone, Debug)]
pub struct Edges {
    rules: Vec<Rule>,
}

impl Default for Edges {
    fn default() -> Self {
        Edges {
            rules: [2, 3, 5, 8, 12].map(Rule::gauss).into(),
        }
    }
}

/// A point of the cell: coordinates and floor point.
#[derive(Clone, Copy, Debug)]
struct Point {
    at: [f64; 2],
    floor: [f64; 2],
    /// Film coordinate along the line.
    along: f64,
}

/// A piece of a film line inside the cell.
#[derive(Clone, Copy, Debug)]
struct Chord {
    from: Point,
    middle: [f64; 2],
    to: Point,
}

/// A side of the cell: `coordinate` ±1 of `axis`.
struct Side {
    axis: usize,
    end: f64,
    x: [f64; N],
    y: [f64; N],
}

/// What is constant for a cell and a row.
struct Task<'a> {
    cell: &'a Cell,
    lens: &'a Lens,
    rules: &'a [Rule],
    /// Newton's last step, and an edge's error.
    step: f64,
    tolerance: f64,
}

/// Adds row `j` of a cell to `out`, the pixels from column `first` on. `None`, with nothing added, if it cannot be done
/// this way.
pub fn row(
    cell: &Cell,
    lens: &Lens,
    edges: &Edges,
    j: i64,
    columns: [i64; 2],
    (tolerance, typical): (f64, f64),
    out: &mut [Bounded],
) -> Option<()> {
    let sides = [(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0)].map(|(axis, end)| {
        let of = |p: &crate::flux::poly::Polynomial| {
            if axis == 0 {
                p.along_b(end)
            } else {
                p.along_a(end)
            }
        };
        Side {
            axis,
            end,
            x: of(&cell.x),
            y: of(&cell.y),
        }
    });
    let [x, xa, xb] = cell.x.gradient(0.0, 0.0);
    let [y, ya, yb] = cell.y.gradient(0.0, 0.0);
    let det = (xa * yb - xb * ya) * lens.density(x, y);
    let sense = det.signum() * lens.sense();
    let radiance = (cell.flux.c[0][0] / det).abs();
    let task = Task {
        cell,
        lens,
        rules: &edges.rules,
        step: (0.01 * tolerance).clamp(1e-14, 1e-8),
        // Near a fold a cell is much brighter than the pixel of which it is a small part.
        tolerance: 0.05 * tolerance * radiance.min(typical),
    };
    let count = (columns[1] - columns[0] + 1) as usize;
    let mut sums = [Bounded::default(); MOST];
    let sums = sums.get_mut(..count)?;
    let add = |sums: &mut [Bounded], i: i64, sign: f64, part: Bounded| {
        if let Some(sum) = usize::try_from(i - columns[0])
            .ok()
            .and_then(|k| sums.get_mut(k))
        {
            sum.value += sign * part.value;
            sum.error += part.error;
        }
    };
    // Where the sides are cut, by any of the lines.
    let mut cuts: [Vec<f64>; 2] = [Vec::with_capacity(16), Vec::with_capacity(16)];
    for (line_row, sign) in [(j, sense), (j + 1, -sense)] {
        let line = lens.row(line_row);
        for chord in task.chords(&line, 0, &sides, &mut cuts)? {
            let (low, high) = (chord.from.along, chord.to.along);
            let first = (low.floor() as i64).max(columns[0]);
            let last = (high.floor() as i64).min(columns[1]);
            for i in first..=last {
                let part = task.edge(&chord, &line, i, [lens.column(i), lens.column(i + 1)])?;
                add(sums, i, sign, part);
            }
        }
    }
    let ends = [lens.row(j), lens.row(j + 1)];
    for i in columns[0]..=columns[1] + 1 {
        let line = lens.column(i);
        for chord in task.chords(&line, 1, &sides, &mut cuts)? {
            if chord.from.along < (j + 1) as f64 && chord.to.along > j as f64 {
                let part = task.edge(&chord, &line, j, ends)?;
                add(sums, i - 1, sense, part);
                add(sums, i, -sense, part);
            }
        }
    }
    for (side, cuts) in sides[..2].iter().zip(&mut cuts) {
        cuts.push(1.0);
        cuts.sort_by(f64::total_cmp);
        let primitive = cell.flux.along_b(side.end);
        let integral = |b: f64| {
            let mut c = primitive;
            for (l, c) in c.iter_mut().enumerate() {
                *c /= (l + 1) as f64;
            }
            // F = a times the stored polynomial, and the side at -1 runs downwards: the signs cancel.
            b * value(&c, b)
        };
        let mut low = -1.0;
        let mut at_low = integral(low);
        for &high in cuts.iter() {
            let at_high = integral(high);
            let middle = 0.5 * (low + high);
            let film = lens.film(value(&side.x, middle), value(&side.y, middle));
            if film[1].floor() == j as f64 {
                let part = Bounded {
                    value: at_high - at_low,
                    error: 0.0,
                };
                add(sums, film[0].floor() as i64, 1.0, part);
            }
            (low, at_low) = (high, at_high);
        }
    }
    for (out, sum) in out.iter_mut().zip(sums) {
        out.value += sum.value;
        out.error += sum.error;
    }
    Some(())
}

/// Columns, at most.
const MOST: usize = 20;

impl Task<'_> {
    /// The pieces of a line inside the cell, in the order of the film coordinate `axis`.
    fn chords(
        &self,
        line: &Linear,
        axis: usize,
        sides: &[Side; 4],
        cuts: &mut [Vec<f64>; 2],
    ) -> Option<Vec<Chord>> {
        let mut points: Vec<Point> = Vec::with_capacity(4);
        for (k, side) in sides.iter().enumerate() {
            let mut c: [f64; N] = core::array::from_fn(|n| line.a * side.x[n] + line.b * side.y[n]);
            c[0] += line.c;
            for &t in zeros(&c).as_slice() {
                let at = if side.axis == 0 {
                    [side.end, t]
                } else {
                    [t, side.end]
                };
                let floor = [value(&side.x, t), value(&side.y, t)];
                let along = self.lens.film(floor[0], floor[1])[axis];
                points.push(Point { at, floor, along });
                if k < 2 {
                    cuts[k].push(t);
                }
            }
        }
        points.sort_by(|p, q| p.along.total_cmp(&q.along));
        let mut chords = Vec::with_capacity(1);
        let certain = points.len() == 2;
        for pair in points.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let far = (0..2)
                .map(|k| (from.at[k] - to.at[k]).abs())
                .fold(0.0, f64::max);
            if far < 1e-12 {
                continue;
            }
            let target = [0, 1].map(|k| 0.5 * (from.floor[k] + to.floor[k]));
            let guess = [0, 1].map(|k| 0.5 * (from.at[k] + to.at[k]));
            let (middle, _) = self.newton(target, guess)?;
            if certain || middle.iter().all(|c| c.abs() <= 1.0) {
                chords.push(Chord { from, middle, to });
            }
        }
        // A single point is a corner that the line touches.
        let corner = |p: &Point| p.at.iter().all(|c| c.abs() > 1.0 - 1e-12);
        if points.len() == 1 && !corner(&points[0]) {
            return None;
        }
        Some(chords)
    }

    /// The coordinates of a floor point, and the Jacobian near it (x_a, x_b, y_a, y_b).
    #[inline]
    fn newton(&self, target: [f64; 2], mut p: [f64; 2]) -> Option<([f64; 2], [f64; 4])> {
        for _ in 0..12 {
            let [x, xa, xb] = self.cell.x.gradient(p[0], p[1]);
            let [y, ya, yb] = self.cell.y.gradient(p[0], p[1]);
            let (dx, dy) = (target[0] - x, target[1] - y);
            let scale = 1.0 / (xa * yb - xb * ya);
            let step = [(dx * yb - dy * xb) * scale, (dy * xa - dx * ya) * scale];
            p = [p[0] + step[0], p[1] + step[1]];
            let length = step[0].abs().max(step[1].abs());
            if length <= self.step {
                return Some((p, [xa, xb, ya, yb]));
            }
            if !(length < 4.0) {
                return None;
            }
        }
        None
    }

    /// ∫ F db along the part of a chord between the film lines `ends`, of which the first belongs to the smaller film
    /// coordinate `start`.
    fn edge(&self, chord: &Chord, line: &Linear, start: i64, ends: [Linear; 2]) -> Option<Bounded> {
        let d = [0, 1].map(|k| chord.to.floor[k] - chord.from.floor[k]);
        let share = |end: &Linear| {
            let [x, y] = Lens::meet(line, end);
            let along = (x - chord.from.floor[0]) * d[0] + (y - chord.from.floor[1]) * d[1];
            along / (d[0] * d[0] + d[1] * d[1])
        };
        let low = if chord.from.along < start as f64 {
            share(&ends[0])
        } else {
            0.0
        };
        let high = if chord.to.along > (start + 1) as f64 {
            share(&ends[1])
        } else {
            1.0
        };
        if !(high > low) {
            return Some(Bounded::default());
        }
        self.between(chord, d, low, high, 8)
    }

    fn between(
        &self,
        chord: &Chord,
        d: [f64; 2],
        low: f64,
        high: f64,
        depth: u32,
    ) -> Option<Bounded> {
        let (p, m, q) = (chord.from.at, chord.middle, chord.to.at);
        let mut before = f64::NAN;
        let mut result = Bounded::default();
        for rule in self.rules {
            let (mut sum, mut size) = (0.0, 0.0);
            for (x, w) in rule.iter() {
                let t = low + (high - low) * x;
                let target = [0, 1].map(|k| chord.from.floor[k] + t * d[k]);
                // The parabola through the ends and the middle.
                let weights = [
                    (1.0 - t) * (1.0 - 2.0 * t),
                    4.0 * t * (1.0 - t),
                    t * (2.0 * t - 1.0),
                ];
                let guess =
                    [0, 1].map(|k| weights[0] * p[k] + weights[1] * m[k] + weights[2] * q[k]);
                let (at, [xa, xb, ya, yb]) = self.newton(target, guess)?;
                let primitive = at[0] * self.cell.flux.at(at[0], at[1]);
                let y = w * primitive * (d[1] * xa - d[0] * ya) / (xa * yb - xb * ya);
                sum += y;
                size += y.abs();
            }
            let value = sum * (high - low);
            // The Jacobian is that of the last point but one.
            let rounding = (4.0 * f64::EPSILON + self.step) * size * (high - low);
            let difference = (value - before).abs();
            result = Bounded {
                value,
                error: difference + rounding,
            };
            if difference <= self.tolerance.max(rounding) {
                return Some(result);
            }
            before = value;
        }
        let middle = 0.5 * (low + high);
        if depth == 0 || !(middle > low && middle < high) {
            return Some(result);
        }
        let left = self.between(chord, d, low, middle, depth - 1)?;
        let right = self.between(chord, d, middle, high, depth - 1)?;
        Some(Bounded {
            value: left.value + right.value,
            error: left.error + right.error,
        })
    }
}
