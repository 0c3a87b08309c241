//! A bundle cut into cells on which everything is a polynomial.
//!
//! Parameters are halved until, on each cell, floor point and flux are their interpolants to rounding, no margin changes
//! sign, and the floor map is either one-to-one with a Jacobian that hardly varies (*regular*) or lands in about one pixel
//! (*folded*). Where a margin does change sign the cell ends at that curve: it is itself a polynomial of the other
//! coordinate, so an edge of the light costs no subdivision.

use core::f64::consts::PI;
use std::collections::VecDeque;

use crate::flux::border::{self, Border, Part};
use crate::flux::chart::{Chart, Edge};
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
    pub(super) lens: &'a Lens,
    floor: &'a Floor,
    /// About the radiance of a pixel, at least.
    pub(super) typical: f64,
    /// Largest absolute value of each condition in a first look: the scale of its rounding.
    scales: [f64; CONDITIONS],
    pub(super) queue: VecDeque<Task>,
    pieces: Vec<Piece>,
}

/// A piece to be cut further.
#[derive(Clone, Debug)]
pub(super) struct Task {
    pub(super) chart: Chart,
    /// Conditions known to hold.
    pub(super) settled: u32,
    pub(super) depth: u32,
    /// The end that is a border, and how often the piece has been halved towards it.
    pub(super) edge: Option<(Edge, u32)>,
}

impl Task {
    /// The halves along an axis.
    pub(super) fn halves(&self, axis: usize) -> [Task; 2] {
        let [low, high] = self.chart.halves(axis);
        [(low, true), (high, false)].map(|(chart, low)| Task {
            chart,
            settled: self.settled,
            depth: self.depth + 1,
            edge: match self.edge {
                Some((edge, n)) if edge.axis == axis => {
                    (edge.above == low).then_some((edge, n + 1))
                }
                other => other,
            },
        })
    }
}

/// Coarsest cells: 2^this along both axes.
const FIRST: u32 = 3;
/// Halvings, at most.
pub(super) const DEEPEST: u32 = 64;
/// Halvings after which samples without light are believed, where that cannot be proven.
const DARK: u32 = 10;
/// Cells looked at, at most.
const MOST: usize = 60_000;
/// What an interpolant misses, in units of its last two orders: enough for a square root at an end, whose coefficients fall
/// like 1/k².
const REMAINDER: f64 = 6.0;
/// Share of a pixel's radiance that a piece may have when it is left out.
pub(super) const NEGLIGIBLE: f64 = 1e-12;
/// Cuts a bundle.
pub fn cut(bundle: &dyn Bundle, lens: &Lens, floor: &Floor) -> Vec<Piece> {
    let mut cutter = Cutter {
        bundle,
        lens,
        floor,
        typical: 0.0,
        scales: [1.0; CONDITIONS],
        queue: VecDeque::new(),
        pieces: Vec::new(),
    };
    let whole = Chart::new(bundle.domain());
    cutter.first_look(&whole);
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
                edge: None,
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

    /// Whether no point is in the frame, by the interpolants of the floor point.
    pub(super) fn out_of_frame(&self, x: &Chebyshev, y: &Chebyshev) -> bool {
        self.lens.frame().iter().any(|line| {
            let c = x.combined(line.a, y, line.b, line.c);
            let [p, q] = c.tails();
            c.c[0][0] < -(c.spread() + REMAINDER * (p + q))
        })
    }

    fn in_frame(&self, [x, y]: [f64; 2]) -> bool {
        self.lens.frame().iter().all(|l| l.at(x, y) >= 0.0)
    }

    /// Scales, from midpoints.
    fn first_look(&mut self, chart: &Chart) {
        const M: u32 = 24;
        let at = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(M) - 1.0;
        let mut sum = 0.0;
        for j in 0..M {
            for i in 0..M {
                let sample = self.sample(chart, [at(i), at(j)]);
                for (scale, g) in self.scales.iter_mut().zip(sample.conditions) {
                    if f64::abs(g) > *scale && g.is_finite() {
                        *scale = f64::abs(g);
                    }
                }
                if Self::exists(&sample) && self.in_frame(sample.floor) {
                    sum += sample.flux.abs();
                }
            }
        }
        let pixels = f64::from(self.lens.width) * f64::from(self.lens.height);
        self.typical = sum * 4.0 / f64::from(M * M) / pixels;
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

    pub(super) fn push(
        &mut self,
        range: [[f64; 2]; 2],
        total: f64,
        error: f64,
        cell: Option<Cell>,
    ) {
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

    pub(super) fn halve(&mut self, task: Task, axis: usize) {
        if task.depth >= DEEPEST {
            self.lose(&task.chart);
            return;
        }
        self.queue.extend(task.halves(axis));
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
        // One that is not a number somewhere may be so because another is violated there, which then comes first.
        let (mut mixed, mut unknown, mut dark) = (None, None, false);
        for m in 0..CONDITIONS {
            if task.settled & (1 << m) != 0 {
                continue;
            }
            let g = grid(&|s| s.conditions[m]);
            let c = finite(&g).then(|| Chebyshev::new(&g));
            let Some(c) = c else {
                dark |= task.depth >= DARK && g.iter().flatten().all(|v| !(*v >= 0.0));
                unknown = unknown.or(Some((m, g, None)));
                continue;
            };
            let [p, q] = c.tails();
            let spread = c.spread() + REMAINDER * (p + q);
            if c.c[0][0] < -spread {
                return;
            }
            if c.c[0][0] > spread {
                task.settled |= 1 << m;
            } else {
                mixed = mixed.or(Some((m, g, Some(c))));
            }
        }
        if dark && mixed.is_none() {
            return;
        }
        if let Some((x, y)) = &on_floor
            && self.out_of_frame(x, y)
        {
            return;
        }
        // What cannot matter any more.
        let finite_flux = |s: &&Sample| Self::exists(s);
        let most = samples
            .iter()
            .flatten()
            .filter(finite_flux)
            .map(|s| s.flux.abs())
            .fold(0.0, f64::max);
        if task.depth >= 2 * DARK && 4.0 * most < NEGLIGIBLE * self.typical {
            self.lose(&task.chart);
            return;
        }
        if let Some((m, g, c)) = mixed.or(unknown) {
            self.cut_border(task, m, &g, c.as_ref());
            return;
        }
        let flux = grid(&|s| s.flux);
        let Some((x, y)) = on_floor.filter(|_| finite(&flux)) else {
            let axis = (task.depth % 2) as usize;
            self.halve(task, axis);
            return;
        };
        self.keep(task, [x, y, Chebyshev::new(&flux)], 0.0);
    }

    fn cut_border(&mut self, task: Task, m: usize, g: &Grid, c: Option<&Chebyshev>) {
        if task.depth >= DEEPEST {
            self.lose(&task.chart);
            return;
        }
        let value = |chart: &Chart, p: [f64; 2]| self.sample(chart, p).conditions[m];
        let size = self.scales[m];
        let fit = border::EXACT;
        match border::find(&task.chart, g, c, task.depth, size, true, fit, &value) {
            Border::Halve(axis) => self.halve(task, axis),
            Border::Parts(parts) => {
                for (chart, part) in parts {
                    let edge = match part {
                        Part::Cut(edge) => Some((edge, 0)),
                        _ => task.edge,
                    };
                    let done = part != Part::Unknown;
                    self.queue.push_back(Task {
                        chart,
                        settled: task.settled | if done { 1 << m } else { 0 },
                        depth: task.depth + 1,
                        edge,
                    });
                }
            }
        }
    }
}
