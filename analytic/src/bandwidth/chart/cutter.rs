//! Integrals over the part of a rectangle of parameters where a kernel reaches, on cells on which everything is a polynomial.
//!
//! Parameters are halved until, on each cell, every margin and every edge of the kernel is decided; where the zero of one
//! crosses a cell, the cell ends at that curve, which is itself a polynomial of the other coordinate. So the kernel may have
//! any shape in the parameters: several parts, parts that merge near a fold, a part without a root beside one, a focus where
//! it covers everything, and pieces that the mirror's edge cuts off. On the cells that are left the integrand is smooth and
//! its interpolant converges geometrically; those whose last coefficients are largest are halved first until their sum is
//! below the tolerance.

use std::collections::{BinaryHeap, VecDeque};

use super::{Integrand, MARGINS, Node};
use crate::bandwidth::quadrature::Pair;
use crate::flux::border::{self, Border, Part};
use crate::flux::chart::Chart;
use crate::flux::poly::{Chebyshev, Grid, N, nodes};

/// Halvings, at most: to 1e-9 of the domain along both axes and then some.
const DEEPEST: u32 = 72;
/// Halvings after which samples that do not exist are believed not to, where that cannot be proven.
const DARK: u32 = 12;
/// Cells looked at, at most.
const MOST: usize = 40_000;
/// Halvings after which pieces that carry less than this part of the tolerance are left out.
const SMALL: u32 = 16;
const NEGLIGIBLE: f64 = 1e-4;
/// What an interpolant misses, in units of its last two orders.
const REMAINDER: f64 = 6.0;

/// The integrand at the nodes of a piece, `[b][a]`, with the area of parameters per area of the chart.
type Samples = [[(Node, f64); N]; N];

/// A piece to be looked at.
#[derive(Clone, Debug)]
struct Task {
    chart: Chart,
    /// Margins known to hold.
    settled: u32,
    /// First and last ring of the kernel that it may touch: ring k is between the edges k - 1 and k, the last is beyond them all.
    rings: [usize; 2],
    depth: u32,
}

/// A piece on which everything is decided.
#[derive(Debug)]
struct Leaf {
    task: Task,
    pair: Pair,
    /// The axis along which the interpolant is worse.
    axis: usize,
    /// Its error in units of the tolerance, by which leaves are ordered.
    urgency: f64,
}

impl PartialEq for Leaf {
    fn eq(&self, o: &Self) -> bool {
        self.urgency.total_cmp(&o.urgency).is_eq()
    }
}
impl Eq for Leaf {}
impl PartialOrd for Leaf {
    fn partial_cmp(&self, o: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(o))
    }
}
impl Ord for Leaf {
    fn cmp(&self, o: &Self) -> core::cmp::Ordering {
        self.urgency.total_cmp(&o.urgency)
    }
}

struct Cutter<'a, I> {
    integrand: &'a I,
    /// How well curves are known, in half widths of a cell.
    fit: f64,
    /// Largest absolute value of each margin in a first look: the scale of its rounding.
    scales: [f64; MARGINS],
    queue: VecDeque<Task>,
    leaves: Vec<Leaf>,
    /// Of pieces that were left undecided.
    lost: [f64; 2],
    /// What the leaves carry, and the part of it below which an undecided piece is left out.
    carried: [f64; 2],
    negligible: f64,
    looks: usize,
}

/// ∫∫ of the integrand over rectangles of parameters, to `tolerance × max(|value + others|, floor)`.
pub(in crate::bandwidth) fn integrate<I: Integrand>(
    integrand: &I,
    rectangles: &[[[f64; 2]; 2]],
    tolerance: f64,
    others: [f64; 2],
    floor: [f64; 2],
) -> Pair {
    let mut cutter = Cutter {
        integrand,
        fit: border::EXACT.max(0.02 * tolerance),
        scales: [1.0; MARGINS],
        queue: VecDeque::new(),
        leaves: Vec::new(),
        lost: [0.0; 2],
        carried: others.map(f64::abs),
        negligible: NEGLIGIBLE * tolerance,
        looks: 0,
    };
    let whole = integrand.domain();
    cutter.first_look(&Chart::new(whole));
    for rectangle in rectangles {
        // As many cells as the whole has, by its share of it.
        let share = |k: usize| {
            let part = (rectangle[k][1] - rectangle[k][0]) / (whole[k][1] - whole[k][0]);
            libm::ceil(part * f64::from(integrand.coarse()[k]) - 1e-9).max(1.0)
        };
        let counts = [share(0), share(1)];
        let chart = Chart::new(*rectangle);
        for k in 0..(counts[0] * counts[1]) as u32 {
            let at = [
                f64::from(k) % counts[0],
                libm::floor(f64::from(k) / counts[0]),
            ];
            let range = [0, 1].map(|k| {
                let low = -1.0 + 2.0 * at[k] / counts[k];
                [low, low + 2.0 / counts[k]]
            });
            cutter.queue.push_back(Task {
                chart: chart.part(range),
                settled: 0,
                rings: [0, integrand.edges().len()],
                depth: 0,
            });
        }
    }
    cutter.drain();
    cutter.refine(tolerance, others, floor)
}

impl<I: Integrand> Cutter<'_, I> {
    fn node(&self, chart: &Chart, p: [f64; 2]) -> (Node, f64) {
        let (u, area) = chart.at(p);
        (self.integrand.node(u), area)
    }

    fn first_look(&mut self, chart: &Chart) {
        const M: u32 = 8;
        let at = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(M) - 1.0;
        for k in 0..M * M {
            let (u, _) = chart.at([at(k % M), at(k / M)]);
            for (scale, g) in self.scales.iter_mut().zip(self.integrand.margins(u)) {
                if f64::abs(g) > *scale && g.is_finite() {
                    *scale = f64::abs(g);
                }
            }
        }
    }

    fn drain(&mut self) {
        while let Some(task) = self.queue.pop_front() {
            if self.looks >= MOST {
                self.lose(&task);
            } else {
                self.looks += 1;
                self.visit(task);
            }
        }
    }

    /// Halves the worst leaves until all errors together are small enough.
    fn refine(&mut self, tolerance: f64, others: [f64; 2], floor: [f64; 2]) -> Pair {
        let mut total = Pair::default();
        for leaf in &self.leaves {
            total.add(&leaf.pair);
        }
        let target =
            |total: &Pair, k: usize| tolerance * (total.value[k] + others[k]).abs().max(floor[k]);
        let urgency = |pair: &Pair, total: &Pair| {
            (0..2)
                .map(|k| pair.error[k] / target(total, k).max(f64::MIN_POSITIVE))
                .fold(0.0, f64::max)
        };
        let mut heap = BinaryHeap::new();
        for mut leaf in core::mem::take(&mut self.leaves) {
            leaf.urgency = urgency(&leaf.pair, &total);
            heap.push(leaf);
        }
        while (0..2).any(|k| total.error[k] > target(&total, k)) && self.looks < MOST {
            let Some(worst) = heap.pop() else { break };
            // What rounding has decided does not get better.
            let rounding = |k: usize| {
                worst.pair.error[k] <= self.integrand.rounding() * worst.pair.value[k].abs()
            };
            if worst.task.depth >= DEEPEST || (0..2).all(rounding) {
                heap.push(Leaf {
                    urgency: 0.0,
                    ..worst
                });
                if heap.peek().is_none_or(|l| l.urgency == 0.0) {
                    break;
                }
                continue;
            }
            total.add(&worst.pair.scaled(-1.0));
            self.halve(worst.task, worst.axis);
            self.drain();
            for mut leaf in core::mem::take(&mut self.leaves) {
                total.add(&leaf.pair);
                leaf.urgency = urgency(&leaf.pair, &total);
                heap.push(leaf);
            }
        }
        // Summed again, without what subtraction has left.
        let mut sum = Pair {
            value: [0.0; 2],
            error: self.lost,
        };
        for leaf in heap.into_sorted_vec() {
            sum.add(&leaf.pair);
        }
        sum
    }

    /// Leaves a piece out: what it can carry, from the samples that exist, becomes an error.
    fn lose(&mut self, task: &Task) {
        let x = nodes();
        let samples: Samples = core::array::from_fn(|l| {
            core::array::from_fn(|k| self.node(&task.chart, [x[k], x[l]]))
        });
        let most = self.most(task, &samples);
        self.leave(most);
    }

    fn leave(&mut self, most: [f64; 2]) {
        for (lost, most) in self.lost.iter_mut().zip(most) {
            *lost += 4.0 * most;
        }
    }

    /// The largest integrand per chart area at the nodes, as if kernel and path existed at all of them.
    fn most(&self, task: &Task, samples: &Samples) -> [f64; 2] {
        let edges = self.integrand.edges();
        let mut most = [0.0_f64; 2];
        for (node, area) in samples.iter().flatten() {
            let reached = edges.iter().position(|e| node.level < *e);
            let [first, last] = task.rings;
            let ring = reached
                .unwrap_or(edges.len())
                .clamp(first, last)
                .min(edges.len() - 1);
            let kernel = self.integrand.kernel(ring, node);
            for (most, (d, k)) in most.iter_mut().zip(node.density.iter().zip(kernel)) {
                let v = f64::abs(d * k * area);
                if v.is_finite() {
                    *most = most.max(v);
                }
            }
        }
        most
    }

    fn halve(&mut self, task: Task, axis: usize) {
        if task.depth >= DEEPEST {
            self.lose(&task);
            return;
        }
        for chart in task.chart.halves(axis) {
            self.queue.push_back(Task {
                chart,
                depth: task.depth + 1,
                ..task
            });
        }
    }

    fn visit(&mut self, mut task: Task) {
        let x = nodes();
        let samples: Samples = core::array::from_fn(|l| {
            core::array::from_fn(|k| self.node(&task.chart, [x[k], x[l]]))
        });
        let grid = |f: &dyn Fn(&Node) -> f64| -> Grid {
            core::array::from_fn(|l| core::array::from_fn(|k| f(&samples[l][k].0)))
        };
        let finite = |g: &Grid| g.iter().flatten().all(|v| v.is_finite());

        // The kernel first: most of the parameters are out of its reach.
        let mut level = None;
        let edges = self.integrand.edges();
        let undecided = |rings: [usize; 2]| rings[0] < rings[1];
        if undecided(task.rings) {
            let least = grid(&|n| n.least);
            if finite(&least) {
                let c = Chebyshev::new(&least);
                let [p, q] = c.tails();
                let bottom = c.c[0][0] - c.spread() - REMAINDER * (p + q);
                if edges.last().is_none_or(|e| bottom >= *e) {
                    return;
                }
            }
            let g = grid(&|n| n.level);
            if finite(&g) {
                let c = Chebyshev::new(&g);
                let [p, q] = c.tails();
                let spread = c.spread() + REMAINDER * (p + q);
                for (k, e) in edges.iter().enumerate() {
                    if c.c[0][0] - spread >= *e {
                        task.rings[0] = task.rings[0].max(k + 1);
                    } else if c.c[0][0] + spread <= *e {
                        task.rings[1] = task.rings[1].min(k);
                    }
                }
                if undecided(task.rings) {
                    let middle = (task.rings[0] + task.rings[1] - 1) / 2;
                    level = Some((middle, g, c));
                }
            }
        }
        if task.rings[0] >= edges.len() {
            return;
        }

        // Margins: violated everywhere, satisfied everywhere, or neither. One that is not a number somewhere may be so because
        // another is violated there, which then comes first.
        let (mut mixed, mut unknown, mut dark) = (None, None, false);
        for m in 0..MARGINS {
            if task.settled & (1 << m) != 0 {
                continue;
            }
            let g = grid(&|n| n.margins[m]);
            // Conditions that a surface does not have.
            if g[0][0] > 0.0 && g.iter().flatten().all(|v| *v == g[0][0]) {
                task.settled |= 1 << m;
                continue;
            }
            if !finite(&g) {
                dark |= task.depth >= DARK && g.iter().flatten().all(|v| !(*v >= 0.0));
                unknown = unknown.or(Some((m, g, None)));
                continue;
            }
            let c = Chebyshev::new(&g);
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
        if task.depth >= SMALL && (level.is_some() || mixed.is_some() || unknown.is_some()) {
            let most = self.most(&task, &samples);
            if (0..2).all(|k| 4.0 * most[k] <= self.negligible * self.carried[k]) {
                self.leave(most);
                return;
            }
        }
        // A kernel that is much smaller than the cell is approached by halving; what it does not reach is never cut.
        if let Some((edge, g, c)) = level {
            self.cut_kernel(task, edge, &g, &c);
            return;
        }
        if let Some((m, g, c)) = mixed.or(unknown) {
            let value = |chart: &Chart, p: [f64; 2]| self.integrand.margins(chart.at(p).0)[m];
            let found = border::find(
                &task.chart,
                &g,
                c.as_ref(),
                task.depth,
                self.scales[m],
                true,
                self.fit,
                &value,
            );
            self.follow(&task, found, m);
            return;
        }
        if undecided(task.rings) {
            let axis = (task.depth % 2) as usize;
            self.halve(task, axis);
            return;
        }
        let ring = task.rings[0];
        self.keep(task, ring, &samples);
    }

    /// Cuts a piece along an edge of the kernel.
    fn cut_kernel(&mut self, task: Task, edge: usize, g: &Grid, c: &Chebyshev) {
        let (at, top) = (
            self.integrand.edges()[edge],
            self.integrand.edges().len() - 1,
        );
        // Rounding of the level, in units of the edge.
        let size = 1.0 + self.integrand.rounding() / f64::EPSILON;
        let mut parts = Vec::new();
        for inside in [true, false] {
            if !inside && edge == top {
                continue;
            }
            let sign = if inside { -1.0 / at } else { 1.0 / at };
            let offset = if inside { 1.0 } else { -1.0 };
            let g: Grid = g.map(|row| row.map(|v| offset + sign * v));
            let c = c.combined(sign, c, 0.0, offset);
            let value = |chart: &Chart, p: [f64; 2]| offset + sign * self.node(chart, p).0.level;
            let depth = task.depth;
            match border::find(
                &task.chart,
                &g,
                Some(&c),
                depth,
                size,
                false,
                self.fit,
                &value,
            ) {
                Border::Halve(axis) => {
                    self.halve(task, axis);
                    return;
                }
                Border::Parts(found) => parts.extend(found.into_iter().map(|p| (p, inside))),
            }
        }
        // Parts of which nothing is known would be found from both sides.
        if edge < top && parts.iter().any(|((_, part), _)| *part == Part::Unknown) {
            let axis = (task.depth % 2) as usize;
            self.halve(task, axis);
            return;
        }
        for ((chart, part), inside) in parts {
            let [first, last] = task.rings;
            let rings = match (part, inside) {
                (Part::Unknown, _) => [first, last],
                (_, true) => [first, edge],
                (_, false) => [edge + 1, last],
            };
            let task = Task {
                rings,
                ..task.clone()
            };
            self.push(&task, chart, None);
        }
    }

    fn follow(&mut self, task: &Task, found: Border, margin: usize) {
        match found {
            Border::Halve(axis) => self.halve(task.clone(), axis),
            Border::Parts(parts) => {
                for (chart, part) in parts {
                    let done = (part != Part::Unknown).then_some(margin);
                    self.push(task, chart, done);
                }
            }
        }
    }

    fn push(&mut self, task: &Task, chart: Chart, margin: Option<usize>) {
        let task = Task {
            chart,
            settled: task.settled | margin.map_or(0, |m| 1 << m),
            rings: task.rings,
            depth: task.depth + 1,
        };
        if task.depth >= DEEPEST {
            self.lose(&task);
        } else {
            self.queue.push_back(task);
        }
    }

    fn keep(&mut self, task: Task, ring: usize, samples: &Samples) {
        let at = |l: usize, i: usize| {
            let (node, area) = &samples[l][i];
            let kernel = self.integrand.kernel(ring, node);
            [0, 1].map(|k| node.density[k] * kernel[k] * area)
        };
        let mut pair = Pair::default();
        let mut tails = [0.0; 2];
        // Of a sliver beside a border one sample says enough.
        if task.depth >= SMALL {
            let middle = at(N / 2, N / 2).map(|v| 4.0 * v);
            if (0..2).all(|k| f64::abs(middle[k]) <= self.negligible * self.carried[k]) {
                self.leaves.push(Leaf {
                    task,
                    pair: Pair {
                        value: middle,
                        error: middle.map(f64::abs),
                    },
                    axis: 0,
                    urgency: 0.0,
                });
                return;
            }
        }
        let values: [[[f64; 2]; N]; N] =
            core::array::from_fn(|l| core::array::from_fn(|i| at(l, i)));
        for k in 0..2 {
            let g: Grid = values.map(|row| row.map(|v| v[k]));
            if !g.iter().flatten().all(|v| v.is_finite()) {
                let axis = (task.depth % 2) as usize;
                self.halve(task, axis);
                return;
            }
            let c = Chebyshev::new(&g);
            let [p, q] = c.tails();
            pair.value[k] = c.integral();
            // A curved end that is off by the fit changes the piece by as much.
            pair.error[k] =
                c.integral_error() + (self.fit - border::EXACT) * f64::abs(pair.value[k]);
            let scale = c.c[0][0].abs().max(f64::MIN_POSITIVE);
            tails = [tails[0] + p / scale, tails[1] + q / scale];
        }
        for (carried, value) in self.carried.iter_mut().zip(pair.value) {
            *carried += f64::abs(value);
        }
        self.leaves.push(Leaf {
            task,
            pair,
            axis: usize::from(tails[1] > tails[0]),
            urgency: 0.0,
        });
    }
}
