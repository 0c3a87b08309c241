//! Pixels of any cell, slice by slice.
//!
//! On a slice (b constant) floor point and flux are polynomials of a. The zeros of the film lines' linear functions cut it
//! into intervals, each inside one pixel, whose flux is a difference of values of the primitive. So a slice holds no
//! quadrature, and folds and cusps need no care: what is integrated over b is analytic except where a film line enters or
//! leaves through a side (zeros of polynomials), where two lines cross in the slice and where the slice touches a line
//! (bisected between slices on which the order of the lines differs).

use core::cell::Cell;

use crate::camera::Bounded;
use crate::flux::cells::Cell as Piece;
use crate::flux::lens::{Lens, Linear};
use crate::flux::poly::{N, value, zeros};
use crate::pixel::rule::Rule;

/// Gauss rules over the slices.
#[derive(Clone, Debug)]
pub struct Slices {
    rules: Vec<Rule>,
}

impl Default for Slices {
    fn default() -> Self {
        Slices {
            rules: [3, 5, 8, 12, 17].map(Rule::gauss).into(),
        }
    }
}

/// Columns at a time.
pub const WINDOW: usize = 16;
/// Crossings of a slice, at most.
const CROSSINGS: usize = 48;
/// Samples between the events of the sides.
const SAMPLES: u32 = 8;
/// Halvings of a panel, at most.
const DEEPEST: u32 = 24;
/// Slices of a cell and a row, about: enough for any geometry that rounding does not blur.
const MOST: u32 = 40_000;

/// What a slice gives to each column, and the order of the lines on it.
#[derive(Clone, Copy, Debug)]
struct Slice {
    columns: [f64; WINDOW],
    /// The largest term of the sum.
    size: f64,
    /// Number of the order, and of crossings.
    label: u64,
    crossings: usize,
}

/// A break point, and whether the integral has a square root there.
#[derive(Clone, Copy, Debug)]
struct Event {
    b: f64,
    root: bool,
}

struct Task<'a> {
    cell: &'a Piece,
    lens: &'a Lens,
    rules: &'a [Rule],
    lines: Vec<Linear>,
    row: f64,
    first: i64,
    /// Error of a column over a panel of length 2.
    tolerance: f64,
    /// How far a break point may be off.
    slack: f64,
    /// Slices so far.
    count: Cell<u32>,
}

/// Adds row `j` of a cell to `out`, the pixels from `columns[0]` on (at most [`WINDOW`]).
pub fn row(
    cell: &Piece,
    lens: &Lens,
    slices: &Slices,
    j: i64,
    columns: [i64; 2],
    (tolerance, absolute): (f64, f64),
    out: &mut [Bounded],
) {
    let mut lines = vec![lens.row(j), lens.row(j + 1)];
    lines.extend((columns[0]..=columns[1] + 1).map(|i| lens.column(i)));
    let task = Task {
        cell,
        lens,
        rules: &slices.rules,
        lines,
        row: j as f64,
        first: columns[0],
        tolerance: 0.5 * absolute,
        slack: 1e-3 * libm::cbrt(tolerance * tolerance),
        count: Cell::new(0),
    };
    let mut sums = [Bounded::default(); WINDOW];
    let events = task.events();
    for pair in events.windows(2) {
        task.search(pair[0], pair[1], DEEPEST, &mut sums);
    }
    for (out, sum) in out.iter_mut().zip(sums) {
        out.value += sum.value;
        out.error += sum.error;
    }
}

impl Task<'_> {
    /// Where a line enters or leaves through the sides a = ±1, with both ends.
    fn events(&self) -> Vec<Event> {
        let event = |b| Event { b, root: false };
        let mut events = vec![event(-1.0), event(1.0)];
        for a in [-1.0, 1.0] {
            let (x, y) = (self.cell.x.along_b(a), self.cell.y.along_b(a));
            for line in &self.lines {
                let c = combined(line, &x, &y);
                events.extend(zeros(&c).as_slice().iter().copied().map(event));
            }
        }
        events.sort_by(|p, q| p.b.total_cmp(&q.b));
        events.dedup_by(|q, p| q.b - p.b < 1e-14);
        events
    }

    fn slice(&self, b: f64) -> Slice {
        self.count.set(self.count.get() + 1);
        let (x, y) = (self.cell.x.along_a(b), self.cell.y.along_a(b));
        let mut cuts = [(1.0, 0_u64); CROSSINGS];
        let mut count = 0;
        for (id, line) in self.lines.iter().enumerate() {
            for &a in zeros(&combined(line, &x, &y)).as_slice() {
                if count + 1 < CROSSINGS {
                    let mut k = count;
                    while k > 0 && cuts[k - 1].0 > a {
                        cuts[k] = cuts[k - 1];
                        k -= 1;
                    }
                    cuts[k] = (a, id as u64 + 1);
                    count += 1;
                }
            }
        }
        cuts[count] = (1.0, 0);
        let flux = self.cell.flux.along_a(b);
        let primitive = |a: f64| a * value(&flux, a);
        let mut slice = Slice {
            columns: [0.0; WINDOW],
            size: 0.0,
            label: 0,
            crossings: count,
        };
        let mut low = -1.0;
        let mut at_low = primitive(low);
        for &(high, id) in &cuts[..=count] {
            slice.label = slice.label.wrapping_mul(1_000_003).wrapping_add(id);
            let at_high = primitive(high);
            let middle = 0.5 * (low + high);
            let film = self.lens.film(value(&x, middle), value(&y, middle));
            if film[1].floor() == self.row {
                let column = film[0].floor() as i64 - self.first;
                let known = usize::try_from(column).ok();
                if let Some(sum) = known.and_then(|k| slice.columns.get_mut(k)) {
                    *sum += at_high - at_low;
                    slice.size = slice.size.max(at_high.abs());
                }
            }
            (low, at_low) = (high, at_high);
        }
        slice
    }

    /// Finds the break points between two, and integrates between them.
    fn search(&self, low: Event, high: Event, depth: u32, sums: &mut [Bounded; WINDOW]) {
        let length = high.b - low.b;
        if !(length > 1e-14) {
            return;
        }
        let inset = (1e-3 * length).min(self.slack);
        let at = |k: u32| {
            let b = low.b + length * f64::from(k) / f64::from(SAMPLES);
            b.clamp(low.b + inset, high.b - inset)
        };
        let mut from = low;
        let mut left = self.slice(at(0));
        for k in 1..=SAMPLES {
            let right = self.slice(at(k));
            let mut x = at(k - 1);
            let mut rounds = 0;
            while left.label != right.label && rounds < 8 {
                let (mut a, mut b) = (x, at(k));
                let mut after = right;
                while b - a > self.slack {
                    let middle = 0.5 * (a + b);
                    if !(middle > a && middle < b) {
                        break;
                    }
                    let slice = self.slice(middle);
                    if slice.label == left.label {
                        a = middle;
                    } else {
                        (b, after) = (middle, slice);
                    }
                }
                let root = after.crossings.abs_diff(left.crossings) > 1;
                // A square root must not begin after its start.
                let event = Event {
                    b: if after.crossings > left.crossings {
                        a
                    } else {
                        b
                    },
                    root,
                };
                self.panel(from, event, left.label, depth, sums);
                (from, x, left) = (event, b, after);
                rounds += 1;
            }
            left = right;
        }
        self.panel(from, high, left.label, depth, sums);
    }

    /// Integrates between two break points.
    fn panel(&self, low: Event, high: Event, label: u64, depth: u32, sums: &mut [Bounded; WINDOW]) {
        let length = high.b - low.b;
        if !(length > 0.0) {
            return;
        }
        let depth = if self.count.get() > MOST { 0 } else { depth };
        let mut before = [f64::INFINITY; WINDOW];
        let mut worst = f64::INFINITY;
        let mut missed = None;
        for rule in self.rules {
            let mut now = [0.0; WINDOW];
            let mut size = 0.0_f64;
            for (t, w) in rule.iter() {
                // A square root at an end is taken out by a substitution that is flat there.
                let (s, ds) = match (low.root, high.root) {
                    (false, false) => (t, 1.0),
                    (true, false) => (t * t, 2.0 * t),
                    (false, true) => (t * (2.0 - t), 2.0 - 2.0 * t),
                    (true, true) => (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t)),
                };
                let slice = self.slice(low.b + length * s);
                let inner = length * s.min(1.0 - s) > 2.0 * self.slack;
                if slice.label != label && inner && missed.is_none() {
                    missed = Some(low.b + length * s);
                }
                let weight = w * ds * length;
                for (now, y) in now.iter_mut().zip(slice.columns) {
                    *now += weight * y;
                }
                size = size.max(slice.size * length);
            }
            if let Some(b) = missed.filter(|_| depth > 0) {
                let event = Event { b, root: false };
                self.search(low, event, depth - 1, sums);
                self.search(event, high, depth - 1, sums);
                return;
            }
            worst = 0.0;
            let rounding = 4.0 * f64::EPSILON * size;
            for (now, before) in now.iter().zip(before) {
                let difference = f64::abs(now - before);
                if difference > worst {
                    worst = difference;
                }
            }
            let share = (self.tolerance * 0.5 * length).max(0.02 * self.tolerance);
            let enough = worst <= share.max(rounding);
            if enough || (depth == 0 && rule.nodes.len() == 17) {
                for ((sum, now), before) in sums.iter_mut().zip(now).zip(before) {
                    let difference = f64::abs(now - before);
                    sum.value += now;
                    sum.error += if now != 0.0 || difference > 0.0 {
                        difference + rounding
                    } else {
                        0.0
                    };
                }
                return;
            }
            before = now;
        }
        if !(worst > 0.0) {
            return;
        }
        let middle = 0.5 * (low.b + high.b);
        let event = Event {
            b: middle,
            root: false,
        };
        if middle > low.b && middle < high.b {
            self.panel(low, event, label, depth.saturating_sub(1), sums);
            self.panel(event, high, label, depth.saturating_sub(1), sums);
        }
    }
}

/// A film line's function on a slice.
#[inline]
fn combined(line: &Linear, x: &[f64; N], y: &[f64; N]) -> [f64; N] {
    let mut c: [f64; N] = core::array::from_fn(|k| line.a * x[k] + line.b * y[k]);
    c[0] += line.c;
    c
}
