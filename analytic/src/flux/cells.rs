//! A bundle cut into cells on which everything is a polynomial.
//!
//! Parameters are halved until, on each cell, floor point and flux are their interpolants to rounding, no margin changes
//! sign, and the floor map is either one-to-one with a Jacobian that hardly varies (*regular*) or lands in about one pixel
//! (*folded*). Where a margin does change sign the cell ends at that curve: it is itself a polynomial of the other
//! coordinate, so an edge of the light costs no subdivision.

use core::f64::consts::PI;
use std::collections::VecDeque;

use crate::flux::border::{self, Border};
use crate::flux::chart::Chart;
use crate::flux::lens::Lens;
use crate::flux::poly::{Chebyshev, Grid, N, Polynomial, nodes};
use crate::flux::{Bundle, MARGINS};
use crate::scene::Floor;

/// A bundle's margins, and the floor's two.
pub const CONDITIONS: usize = MARGINS + 2;

/// What a ray is to the pixels.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Floor point.
    pub floor: [f64; 2],
    /// Radiance times pixels, per area of the chart.
    pub flux: f64,
    /// Non-negative where the ray exists.
    pub conditions: [f64; CONDITIONS],
}

/// How the pixels of a cell are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One-to-one, with nearly constant Jacobian.
    Regular,
    /// About one pixel large, may be folded.
    Folded,
}

/// A piece of a bundle.
#[derive(Clone, Debug)]
pub struct Cell {
    /// x of the floor point.
    pub x: Polynomial,
    /// y of the floor point.
    pub y: Polynomial,
    /// The integral of the flux along a from 0, divided by a.
    pub flux: Polynomial,
    /// How to integrate.
    pub shape: Shape,
}

/// What a range of pixels gets.
#[derive(Clone, Debug)]
pub struct Piece {
    /// First and last column that it can touch.
    pub columns: [i64; 2],
    /// First and last row.
    pub rows: [i64; 2],
    /// Radiance summed over pixels.
    pub total: f64,
    /// What the interpolants, or what has been left out, can change of it.
    pub error: f64,
    /// `None` if all of it lands in one pixel.
    pub cell: Option<Box<Cell>>,
}

/// Everything the cutting needs.
pub struct Cutter<'a> {
    bundle: &'a dyn Bundle,
    lens: &'a Lens,
    floor: &'a Floor,
    /// Total below which a piece may be left out, into the error.
    negligible: f64,
    queue: VecDeque<Task>,
    pieces: Vec<Piece>,
}

struct Task {
    chart: Chart,
    /// Conditions known to hold.
    settled: u32,
    depth: u32,
}

/// Coarsest cells: 2^this along both axes.
const FIRST: u32 = 3;
/// Halvings, at most.
const DEEPEST: u32 = 64;
/// Halvings after which samples without light are believed.
const DARK: u32 = 10;
/// Cells looked at, at most.
const MOST: usize = 150_000;
/// Largest span of a regular and of a folded cell [pixels].
const SPAN: [f64; 2] = [12.0, 1.0];
/// Allowed error of an interpolant, relative to its variation.
const SMOOTH: f64 = 1e-12;

/// Cuts a bundle.
pub fn cut(bundle: &dyn Bundle, lens: &Lens, floor: &Floor) -> Vec<Piece> {
    let mut cutter = Cutter {
        bundle,
        lens,
        floor,
        negligible: 0.0,
        queue: VecDeque::new(),
        pieces: Vec::new(),
    };
    let whole = Chart::new(bundle.domain());
    cutter.negligible = 1e-13 * cutter.rough_total(&whole);
    let step = 2.0 / f64::from(1_u32 << FIRST);
    for j in 0..1 << FIRST {
        for i in 0..1 << FIRST {
            let range = [i, j].map(|k| {
                let low = -1.0 + step * f64::from(k);
                [low, low + step]
            });
            cutter.queue.push_back(Task {
                chart: whole.part(range),
                settled: 0,
                depth: 2 * FIRST,
            });
        }
    }
    for _ in 0..MOST {
        match cutter.queue.pop_front() {
            Some(task) => cutter.visit(task),
            None => return cutter.pieces,
        }
    }
    while let Some(task) = cutter.queue.pop_front() {
        cutter.lose(&task.chart);
    }
    cutter.pieces
}

impl Cutter<'_> {
    /// The ray at a point of a chart.
    pub fn sample(&self, chart: &Chart, p: [f64; 2]) -> Sample {
        let (u, area) = chart.at(p);
        let ray = self.bundle.ray(u);
        let [x, y] = ray.floor;
        let mut conditions = [0.0; CONDITIONS];
        conditions[..MARGINS].copy_from_slice(&ray.margins);
        for k in 0..2 {
            // Negative on both sides, and smooth through infinity.
            let half = self.floor.half_width[k];
            let s = (ray.floor[k] - self.floor.center[k]) / half;
            let t = s.abs();
            conditions[MARGINS + k] = if t > 1e8 {
                -1.0
            } else {
                (1.0 - s) * (1.0 + s) / (1.0 + s * s)
            };
        }
        Sample {
            floor: [x, y],
            flux: ray.flux * area * self.floor.albedo / PI * self.lens.density(x, y),
            conditions,
        }
    }

    fn exists(sample: &Sample) -> bool {
        sample.conditions.iter().all(|&g| g >= 0.0)
            && sample.flux.is_finite()
            && sample.floor.iter().all(|x| x.is_finite())
    }

    fn in_frame(&self, [x, y]: [f64; 2]) -> bool {
        self.lens.frame().iter().all(|l| l.at(x, y) >= 0.0)
    }

    /// Radiance summed over the pixels of the frame, from midpoints.
    fn rough_total(&self, chart: &Chart) -> f64 {
        const M: u32 = 24;
        let at = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(M) - 1.0;
        let mut sum = 0.0;
        for j in 0..M {
            for i in 0..M {
                let sample = self.sample(chart, [at(i), at(j)]);
                if Self::exists(&sample) && self.in_frame(sample.floor) {
                    sum += sample.flux.abs();
                }
            }
        }
        sum * 4.0 / f64::from(M * M)
    }

    /// Leaves a piece out: what it can carry, from the samples that exist, becomes an error of the pixels around it.
    fn lose(&mut self, chart: &Chart) {
        let (mut most, mut range) = (0.0_f64, None::<[[f64; 2]; 2]>);
        for b in nodes() {
            for a in nodes() {
                let sample = self.sample(chart, [*a, *b]);
                let [x, y] = sample.floor;
                if !Self::exists(&sample) || !(self.lens.depth(x, y) > 0.0) {
                    continue;
                }
                most = most.max(sample.flux.abs());
                let film = self.lens.film(x, y);
                let old = range.unwrap_or([[film[0]; 2], [film[1]; 2]]);
                range = Some([0, 1].map(|k| [old[k][0].min(film[k]), old[k][1].max(film[k])]));
            }
        }
        if let Some(range) = range
            && most > 0.0
        {
            self.push(range, 0.0, 4.0 * most, None);
        }
    }

    fn push(&mut self, range: [[f64; 2]; 2], total: f64, error: f64, cell: Option<Cell>) {
        // To the pixel, with what lies between the samples; never more than the frame.
        let [columns, rows] = [0, 1].map(|k| {
            let [low, high] = range[k];
            let slack = 1e-9 + 0.02 * (high - low);
            let last = [self.lens.width, self.lens.height][k];
            let clamp = |x: f64| x.floor().clamp(-1.0, f64::from(last)) as i64;
            [clamp(low - slack), clamp(high + slack)]
        });
        let frame = [i64::from(self.lens.width), i64::from(self.lens.height)];
        if columns[1] < 0 || rows[1] < 0 || columns[0] >= frame[0] || rows[0] >= frame[1] {
            return;
        }
        let single = columns[0] == columns[1] && rows[0] == rows[1];
        self.pieces.push(Piece {
            columns,
            rows,
            total,
            error,
            cell: if single { None } else { cell.map(Box::new) },
        });
    }

    fn halve(&mut self, task: Task, axis: usize) {
        if task.depth >= DEEPEST {
            self.lose(&task.chart);
            return;
        }
        for chart in task.chart.halves(axis) {
            self.queue.push_back(Task {
                chart,
                settled: task.settled,
                depth: task.depth + 1,
            });
        }
    }

    fn visit(&mut self, mut task: Task) {
        let x = nodes();
        let samples: [[Sample; N]; N] = core::array::from_fn(|l| {
            core::array::from_fn(|k| self.sample(&task.chart, [x[k], x[l]]))
        });
        let grid = |f: &dyn Fn(&Sample) -> f64| -> Grid {
            core::array::from_fn(|l| core::array::from_fn(|k| f(&samples[l][k])))
        };
        let finite = |g: &Grid| g.iter().flatten().all(|v| v.is_finite());

        let (xs, ys) = (grid(&|s| s.floor[0]), grid(&|s| s.floor[1]));
        let on_floor =
            (finite(&xs) && finite(&ys)).then(|| (Chebyshev::new(&xs), Chebyshev::new(&ys)));

        // Conditions: violated everywhere, satisfied everywhere, or neither.
        let mut mixed = None;
        for m in 0..CONDITIONS {
            if task.settled & (1 << m) != 0 {
                continue;
            }
            let g = grid(&|s| s.conditions[m]);
            let believed = task.depth >= DARK;
            if believed && g.iter().flatten().all(|v| !(*v >= 0.0)) {
                return;
            }
            let c = finite(&g).then(|| Chebyshev::new(&g));
            let Some(c) = c else {
                mixed = mixed.or(Some((m, g, None)));
                continue;
            };
            let [p, q] = c.tails();
            let spread = c.spread() + 3.0 * (p + q);
            if c.c[0][0] < -spread {
                return;
            }
            if c.c[0][0] > spread {
                task.settled |= 1 << m;
            } else {
                mixed = mixed.or(Some((m, g, Some(c))));
            }
        }
        if let Some((x, y)) = &on_floor {
            for line in self.lens.frame() {
                let c = x.combined(line.a, y, line.b, line.c);
                let [p, q] = c.tails();
                if c.c[0][0] < -(c.spread() + 3.0 * (p + q)) {
                    return;
                }
            }
        }
        // What cannot matter any more.
        let finite_flux = |s: &&Sample| Self::exists(s);
        let most = samples
            .iter()
            .flatten()
            .filter(finite_flux)
            .map(|s| s.flux.abs())
            .fold(0.0, f64::max);
        if task.depth >= 2 * DARK && 4.0 * most < self.negligible {
            self.lose(&task.chart);
            return;
        }
        if let Some((m, g, c)) = mixed {
            self.cut_border(task, m, &g, c.as_ref());
            return;
        }
        let flux = grid(&|s| s.flux);
        let Some((x, y)) = on_floor.filter(|_| finite(&flux)) else {
            let axis = (task.depth % 2) as usize;
            self.halve(task, axis);
            return;
        };
        self.finish(task, x, y, Chebyshev::new(&flux));
    }

    fn cut_border(&mut self, task: Task, m: usize, g: &Grid, c: Option<&Chebyshev>) {
        let value = |chart: &Chart, p: [f64; 2]| self.sample(chart, p).conditions[m];
        match border::find(&task.chart, g, c, task.depth, &value) {
            Border::Halve(axis) => self.halve(task, axis),
            Border::Parts(parts) => {
                for (chart, done) in parts {
                    self.queue.push_back(Task {
                        chart,
                        settled: task.settled | if done { 1 << m } else { 0 },
                        depth: task.depth + 1,
                    });
                }
            }
        }
    }

    /// All conditions hold: keep the cell if it is smooth and small enough.
    fn finish(&mut self, task: Task, x: Chebyshev, y: Chebyshev, flux: Chebyshev) {
        let (px, py) = (x.polynomial(), y.polynomial());
        let Some((range, size)) = self.film_range(&px, &py) else {
            let wider = |c: &Chebyshev| [c.c[0][1].abs(), c.c[1][0].abs()];
            let [a, b] = [0, 1].map(|k| wider(&x)[k] + wider(&y)[k]);
            self.halve(task, usize::from(b > a));
            return;
        };
        // Errors of the interpolants: of the place relative to the cell or to a thousandth of a pixel, of the flux
        // relative to itself.
        let scale = self.lens.density(px.c[0][0], py.c[0][0]);
        let pixel = 1.0 / scale.abs().sqrt();
        let place = (x.spread() + y.spread()).max(1e-3 * pixel);
        let rounding = 1e-15 * (x.c[0][0].abs() + y.c[0][0].abs() + x.spread() + y.spread());
        let amount = flux.c[0][0].abs() + flux.spread();
        let mut miss = [0.0; 2];
        for k in 0..2 {
            let in_place = (x.tails()[k] + y.tails()[k] - 30.0 * rounding).max(0.0) / place;
            let in_flux = (flux.tails()[k] - 3e-14 * amount).max(0.0) / amount.max(1e-300);
            miss[k] = in_place.max(in_flux);
        }
        let worst = miss[0].max(miss[1]);
        let total = integral(&flux);
        if worst > SMOOTH {
            if 4.0 * amount < self.negligible {
                self.push(range, 0.0, 4.0 * amount, None);
            } else {
                self.halve(task, usize::from(miss[1] > miss[0]));
            }
            return;
        }
        let error = (worst + 1e-15) * 4.0 * amount;
        let single = (0..2).all(|k| range[k][0].floor() == range[k][1].floor());
        let shape = if regular(&x, &y) {
            Shape::Regular
        } else {
            Shape::Folded
        };
        let allowed = SPAN[usize::from(shape == Shape::Folded)];
        let span = (range[0][1] - range[0][0]).max(range[1][1] - range[1][0]);
        if span > allowed && !single && task.depth < DEEPEST {
            self.halve(task, usize::from(size[1] > size[0]));
            return;
        }
        // Slices go along a: the direction in which more happens.
        let exchange = shape == Shape::Folded && size[1] > size[0];
        let order = |c: Chebyshev| {
            if exchange {
                c.exchanged().polynomial()
            } else {
                c.polynomial()
            }
        };
        let mut primitive = order(flux);
        for row in &mut primitive.c {
            for (k, c) in row.iter_mut().enumerate() {
                *c /= (k + 1) as f64;
            }
        }
        let cell = Cell {
            x: order(x),
            y: order(y),
            flux: primitive,
            shape,
        };
        self.push(range, total, error, Some(cell));
    }

    /// Range of the film coordinates, and the largest extent on the film along either axis; `None` if not all of the cell
    /// is in front of the camera.
    fn film_range(&self, x: &Polynomial, y: &Polynomial) -> Option<([[f64; 2]; 2], [f64; 2])> {
        const AT: [f64; 5] = [-1.0, -0.6, 0.0, 0.6, 1.0];
        let mut film = [[[0.0; 2]; 5]; 5];
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for (l, b) in AT.into_iter().enumerate() {
            let (cx, cy) = (x.along_a(b), y.along_a(b));
            for (k, a) in AT.into_iter().enumerate() {
                let p = [&cx, &cy].map(|c| crate::flux::poly::value(c, a));
                if !(self.lens.depth(p[0], p[1]) > 0.0) {
                    return None;
                }
                film[l][k] = self.lens.film(p[0], p[1]);
                for (range, f) in range.iter_mut().zip(film[l][k]) {
                    *range = [range[0].min(f), range[1].max(f)];
                }
            }
        }
        let mut size = [0.0_f64; 2];
        for k in 0..5 {
            for (axis, size) in size.iter_mut().enumerate() {
                let line = |n: usize| if axis == 0 { film[k][n] } else { film[n][k] };
                let mut length = 0.0;
                for n in 1..5 {
                    let (p, q) = (line(n - 1), line(n));
                    length += (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
                }
                *size = size.max(length);
            }
        }
        Some((range, size))
    }
}

/// The integral over [-1, 1]²: ∫ T_k = 2/(1 - k²) for even k, 0 for odd.
fn integral(c: &Chebyshev) -> f64 {
    let weight = |k: usize| {
        if k % 2 == 0 {
            2.0 / (1.0 - (k * k) as f64)
        } else {
            0.0
        }
    };
    let mut sum = 0.0;
    for (l, row) in c.c.iter().enumerate() {
        let inner: f64 = row.iter().enumerate().map(|(k, c)| weight(k) * c).sum();
        sum += weight(l) * inner;
    }
    sum
}

/// Whether the map is the identity plus a contraction, after its linear part is inverted: then it is one-to-one, and
/// Newton's method converges on it.
fn regular(x: &Chebyshev, y: &Chebyshev) -> bool {
    let [xa, xb] = [x.c[0][1], x.c[1][0]];
    let [ya, yb] = [y.c[0][1], y.c[1][0]];
    let det = xa * yb - xb * ya;
    if !(det.abs() > 1e-12 * (xa.abs() + ya.abs()) * (xb.abs() + yb.abs())) {
        return false;
    }
    let first = x.combined(yb / det, y, -xb / det, 0.0);
    let second = x.combined(-ya / det, y, xa / det, 0.0);
    let weight = |k: usize, l: usize| {
        if k + l > 1 {
            (k * k + l * l) as f64
        } else {
            0.0
        }
    };
    first.sum(weight) < 0.5 && second.sum(weight) < 0.5
}
