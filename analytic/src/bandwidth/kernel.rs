//! Kernels, exactly normalised, and their averages over a list of bandwidths.
//!
//! An expectation is linear in the kernel, and a second moment in its square. So a schedule α₁ … α_n costs one quadrature
//! with φ̄ = (1/n) Σ φ_{α_i} (and (1/n) Σ φ²_{α_i}). Between two neighbouring bandwidths both are polynomials, and all
//! pieces of φ̄ together are one weight function on [0, α_max]: its interpolatory rule is made once, so that a long
//! schedule costs little more per point than a single bandwidth.

use libm::{exp, expm1, sin, sqrt};

use super::Kernel;
use super::quadrature::{ORDERS, Pair, error_of_better, gauss_rules, legendre_values};
use crate::pixel::rule::Rule;

const PI: f64 = core::f64::consts::PI;

/// Coefficients of a polynomial in the level (angle or distance); the square of the biweight has degree 8.
type Polynomial = [f64; 9];

fn evaluate(p: &Polynomial, x: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Normaliser of the cone: 1/(2π(1 − cos a)).
pub(super) fn cone_height(a: f64) -> f64 {
    let s = sin(0.5 * a);
    1.0 / (4.0 * PI * s * s)
}

/// Normaliser N of the angular Epanechnikov kernel N(1 − g²/a²): 1/N = 2π ∫₀ᵃ (1 − g²/a²) sin g dg, summed as a power
/// series, which has none of the cancellation of the closed form at small a.
pub(super) fn epanechnikov_height(a: f64) -> f64 {
    let a2 = a * a;
    let (mut term, mut sum) = (a2, 0.0);
    for k in 0..24 {
        let n = 2.0 * f64::from(k);
        sum += term * 2.0 / ((n + 2.0) * (n + 4.0));
        term *= -a2 / ((n + 2.0) * (n + 3.0));
    }
    1.0 / (2.0 * PI * sum)
}

/// Concentration k = 4/α² of the von Mises–Fisher kernel and its normaliser k/(2π(1 − e^{−2k})).
pub(super) fn von_mises_fisher(alpha: f64) -> (f64, f64) {
    let k = 4.0 / (alpha * alpha);
    (k, k / (-2.0 * PI * expm1(-2.0 * k)))
}

/// Beyond k(1 − cos g) = 40 the von Mises–Fisher kernel is below 1e-17 of its top.
const NEGLIGIBLE: f64 = 40.0;

/// exp(−k(1 − cos g)).
fn von_mises_fisher_shape(k: f64, g: f64) -> f64 {
    let s = sin(0.5 * g);
    exp(-2.0 * k * s * s)
}

/// Polynomial coefficients of one kernel inside its support.
fn polynomial(kernel: Kernel, angular: bool, b: f64) -> Polynomial {
    let mut p = [0.0; 9];
    let t2 = 1.0 / (b * b);
    match (kernel, angular) {
        (Kernel::Cone, true) => p[0] = cone_height(b),
        (Kernel::Epanechnikov, true) => {
            let n = epanechnikov_height(b);
            (p[0], p[2]) = (n, -n * t2);
        }
        (Kernel::Cone, false) => {
            let n = 3.0 * t2 / PI;
            (p[0], p[1]) = (n, -n / b);
        }
        (Kernel::Epanechnikov, false) => {
            let n = 2.0 * t2 / PI;
            (p[0], p[2]) = (n, -n * t2);
        }
        (Kernel::Biweight, _) => {
            let n = 3.0 * t2 / PI;
            (p[0], p[2], p[4]) = (n, -2.0 * n * t2, n * t2 * t2);
        }
        (Kernel::Disc | Kernel::VonMisesFisher, _) => p[0] = t2 / PI,
    }
    p
}

fn squared(p: &Polynomial) -> Polynomial {
    let mut q = [0.0; 9];
    for (i, a) in p.iter().enumerate().take(5) {
        for (j, b) in p.iter().enumerate().take(5) {
            q[i + j] += a * b;
        }
    }
    q
}

/// The averaged kernel and the averaged squared kernel between two neighbouring edges.
#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    to: f64,
    mean: Polynomial,
    square: Polynomial,
}

/// Several neighbouring pieces with an interpolatory rule of each order for the whole of them.
#[derive(Clone, Debug)]
struct Cell {
    from: f64,
    to: f64,
    pieces: core::ops::Range<usize>,
    // weights[order] = (for the mean, for the second moment); empty for a single piece.
    weights: Vec<(Vec<f64>, Vec<f64>)>,
}

/// The kernel averaged over a list of bandwidths.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    rules: Vec<Rule>,
    pieces: Vec<Piece>,
    cells: Vec<Cell>,
    // Von Mises–Fisher: (k, normaliser / n, normaliser² / n) per bandwidth; otherwise empty.
    smooth: Vec<(f64, f64, f64)>,
    /// φ̄ and φ̄² at the top.
    top: [f64; 2],
    /// Where the kernel ends.
    pub end: f64,
    /// Levels at which the kernel jumps or kinks, ascending; the end is the last.
    pub edges: Vec<f64>,
}

impl Profile {
    /// Averages a kernel over bandwidths that have passed [`super::check`].
    pub fn new(kernel: Kernel, angular: bool, bandwidths: &[f64]) -> Profile {
        let mut sorted = bandwidths.to_vec();
        sorted.sort_by(f64::total_cmp);
        if kernel == Kernel::VonMisesFisher {
            return Profile::von_mises_fisher(&sorted);
        }
        let share = 1.0 / sorted.len() as f64;
        let mut pieces: Vec<Piece> = Vec::new();
        // From the widest kernel inwards, each bandwidth adds to everything inside it.
        let (mut mean, mut square) = ([0.0; 9], [0.0; 9]);
        for (i, &b) in sorted.iter().enumerate().rev() {
            let p = polynomial(kernel, angular, b);
            let q = squared(&p);
            for k in 0..9 {
                mean[k] += share * p[k];
                square[k] += share * q[k];
            }
            let from = if i == 0 { 0.0 } else { sorted[i - 1] };
            if from < b {
                pieces.push(Piece {
                    from,
                    to: b,
                    mean,
                    square,
                });
            }
        }
        pieces.reverse();
        let edges: Vec<f64> = pieces.iter().map(|p| p.to).collect();
        let mut profile = Profile {
            rules: gauss_rules(),
            cells: Vec::new(),
            smooth: Vec::new(),
            top: [0.0; 2],
            end: edges.last().copied().unwrap_or(0.0),
            edges,
            pieces,
        };
        profile.make_cells();
        profile.with_top()
    }

    fn von_mises_fisher(sorted: &[f64]) -> Profile {
        let share = 1.0 / sorted.len() as f64;
        let smooth: Vec<_> = sorted
            .iter()
            .map(|&a| {
                let (k, n) = von_mises_fisher(a);
                (k, share * n, share * n * n)
            })
            .collect();
        // Pieces of a few widths each, finer towards the narrowest kernel, so that a Gauss rule sees a smooth function.
        let width = |a: f64| a / core::f64::consts::SQRT_2;
        let end = |a: f64| {
            let s2 = NEGLIGIBLE * a * a / 8.0;
            if s2 < 1.0 {
                2.0 * libm::asin(sqrt(s2))
            } else {
                PI
            }
        };
        let (narrow, wide) = (
            sorted.first().copied().unwrap_or(1.0),
            sorted.last().copied().unwrap_or(1.0),
        );
        let last = end(wide);
        let mut edges = vec![width(narrow).min(last)];
        while let Some(&e) = edges.last().filter(|e| **e < last) {
            let step = (1.5 * e).min((1.5 * width(wide)).max(e * 0.25));
            let next = e + step;
            edges.push(if next > last - 0.25 * step {
                last
            } else {
                next
            });
        }
        let pieces: Vec<Piece> = edges
            .iter()
            .enumerate()
            .map(|(i, &to)| Piece {
                from: if i == 0 { 0.0 } else { edges[i - 1] },
                to,
                mean: [0.0; 9],
                square: [0.0; 9],
            })
            .collect();
        let cells = pieces
            .iter()
            .enumerate()
            .map(|(i, p)| Cell {
                from: p.from,
                to: p.to,
                pieces: i..i + 1,
                weights: Vec::new(),
            })
            .collect();
        Profile {
            rules: gauss_rules(),
            cells,
            smooth,
            top: [0.0; 2],
            end: last,
            edges: Vec::new(),
            pieces,
        }
        .with_top()
    }

    fn with_top(mut self) -> Profile {
        self.top = match self.pieces.first() {
            Some(p) => self.heights(p, 0.0),
            None => [0.0; 2],
        };
        self
    }

    fn make_cells(&mut self) {
        let n = self.pieces.len();
        // Whole cells cost one rule, the two that an edge of the domain cuts cost a rule per piece: √n balances them.
        let per_cell = if n <= 8 {
            1
        } else {
            sqrt(n as f64) as usize * 2
        };
        let mut values = Vec::new();
        let mut start = 0;
        while start < n {
            let stop = (start + per_cell).min(n);
            let (from, to) = (self.pieces[start].from, self.pieces[stop - 1].to);
            let mut weights = Vec::new();
            if stop - start > 1 {
                for rule in &self.rules {
                    let m = rule.iter().count();
                    // Moments of the averaged kernel against Legendre polynomials of the cell, piece by piece, exactly.
                    let exact = &self.rules[ORDERS
                        .iter()
                        .position(|&o| 2 * o > m + 9)
                        .unwrap_or(ORDERS.len() - 1)];
                    let mut moments = vec![[0.0; 2]; m];
                    for p in &self.pieces[start..stop] {
                        let length = p.to - p.from;
                        for (x, w) in exact.iter() {
                            let g = p.from + length * x;
                            legendre_values(m, (2.0 * g - from - to) / (to - from), &mut values);
                            let (a, b) = (evaluate(&p.mean, g), evaluate(&p.square, g));
                            for (moment, v) in moments.iter_mut().zip(&values) {
                                moment[0] += length * w * a * v;
                                moment[1] += length * w * b * v;
                            }
                        }
                    }
                    let mut pair = (vec![0.0; m], vec![0.0; m]);
                    for (i, (x, weight)) in rule.iter().enumerate() {
                        legendre_values(m, 2.0 * x - 1.0, &mut values);
                        for (k, v) in values.iter().enumerate() {
                            let c = weight * (2.0 * k as f64 + 1.0) * v;
                            pair.0[i] += c * moments[k][0];
                            pair.1[i] += c * moments[k][1];
                        }
                    }
                    weights.push(pair);
                }
            }
            self.cells.push(Cell {
                from,
                to,
                pieces: start..stop,
                weights,
            });
            start = stop;
        }
    }

    /// Levels at which the kernel jumps or kinks, ascending, and its end.
    pub fn levels(&self) -> Vec<f64> {
        if self.edges.is_empty() {
            vec![self.end]
        } else {
            self.edges.clone()
        }
    }

    /// φ̄ and φ̄² at a level between the levels `ring - 1` and `ring`.
    pub fn in_ring(&self, ring: usize, g: f64) -> [f64; 2] {
        let last = self.pieces.len().saturating_sub(1);
        match self.pieces.get(ring.min(last)) {
            Some(piece) => self.heights(piece, g),
            None => [0.0; 2],
        }
    }

    /// φ̄²/φ̄ at the top.
    pub fn ratio(&self) -> f64 {
        let [mean, square] = self.top;
        if mean > 0.0 { square / mean } else { 0.0 }
    }

    fn heights(&self, piece: &Piece, g: f64) -> [f64; 2] {
        if self.smooth.is_empty() {
            return [evaluate(&piece.mean, g), evaluate(&piece.square, g)];
        }
        let mut sum = [0.0; 2];
        for &(k, n, n2) in &self.smooth {
            let e = von_mises_fisher_shape(k, g);
            sum[0] += n * e;
            sum[1] += n2 * e * e;
        }
        sum
    }

    /// ∫ φ̄(g) w₀(g) dg and ∫ φ̄²(g) w₁(g) dg over [from, to], w = `density(g)` smooth, to a relative tolerance.
    pub fn integrate(
        &self,
        from: f64,
        to: f64,
        tolerance: f64,
        density: &mut impl FnMut(f64) -> [f64; 2],
    ) -> Pair {
        let mut sum = Pair::default();
        let mut start = 1;
        for cell in &self.cells {
            let (a, b) = (from.max(cell.from), to.min(cell.to));
            if !(a < b) {
                continue;
            }
            if !cell.weights.is_empty() && a == cell.from && b == cell.to {
                let whole = |order: usize, density: &mut dyn FnMut(f64) -> [f64; 2]| {
                    let mut r = ([0.0; 2], [0.0; 2]);
                    let w = &cell.weights[order];
                    for (i, (x, _)) in self.rules[order].iter().enumerate() {
                        let v = density(a + (b - a) * x);
                        for (k, weight) in [w.0[i], w.1[i]].into_iter().enumerate() {
                            r.0[k] += weight * v[k];
                            r.1[k] += (weight * v[k]).abs();
                        }
                    }
                    r
                };
                if let Some(r) =
                    escalate(&mut start, tolerance, &sum, [0.0; 2], |o| whole(o, density))
                {
                    sum.add(&r);
                    continue;
                }
            }
            for piece in &self.pieces[cell.pieces.clone()] {
                let (a, b) = (a.max(piece.from), b.min(piece.to));
                if a < b {
                    self.piece(piece, a, b, tolerance, &mut start, 16, density, &mut sum);
                }
            }
        }
        sum
    }

    fn piece(
        &self,
        piece: &Piece,
        a: f64,
        b: f64,
        tolerance: f64,
        start: &mut usize,
        depth: u32,
        density: &mut impl FnMut(f64) -> [f64; 2],
        sum: &mut Pair,
    ) {
        // Near its end a kernel is a small difference of large terms: rounding of the size of its top.
        let (top, middle) = (self.top, density(0.5 * (a + b)));
        let noise =
            core::array::from_fn(|k| 4.0 * f64::EPSILON * top[k] * (b - a) * middle[k].abs());
        let result = escalate(start, tolerance, sum, noise, |order| {
            gauss(&self.rules[order], a, b, |g| {
                let (h, v) = (self.heights(piece, g), density(g));
                [h[0] * v[0], h[1] * v[1]]
            })
        });
        match result {
            Some(r) => sum.add(&r),
            None if depth > 0 => {
                let mid = 0.5 * (a + b);
                self.piece(piece, a, mid, tolerance, start, depth - 1, density, sum);
                self.piece(piece, mid, b, tolerance, start, depth - 1, density, sum);
            }
            None => {
                let (value, absolute) = gauss(&self.rules[ORDERS.len() - 1], a, b, |g| {
                    let (h, v) = (self.heights(piece, g), density(g));
                    [h[0] * v[0], h[1] * v[1]]
                });
                sum.add(&Pair {
                    value,
                    error: absolute,
                });
            }
        }
    }
}

/// One Gauss rule on [a, b]: the integrals and those of the absolute values.
pub(super) fn gauss(
    rule: &Rule,
    a: f64,
    b: f64,
    mut f: impl FnMut(f64) -> [f64; 2],
) -> ([f64; 2], [f64; 2]) {
    let length = b - a;
    let mut r = ([0.0; 2], [0.0; 2]);
    for (x, w) in rule.iter() {
        let v = f(a + length * x);
        for (k, v) in v.into_iter().enumerate() {
            let c = length * w * v;
            r.0[k] += c;
            r.1[k] += c.abs();
        }
    }
    r
}

/// Raises the order until two neighbouring rules agree to a part of what is integrated here or was (`sum`) before, or to
/// the rounding of the integrand (`noise`); `start` remembers the order that was enough last time. `None` if the highest order is not enough.
pub(super) fn escalate(
    start: &mut usize,
    tolerance: f64,
    sum: &Pair,
    noise: [f64; 2],
    mut rule: impl FnMut(usize) -> ([f64; 2], [f64; 2]),
) -> Option<Pair> {
    let first = (*start).clamp(1, ORDERS.len() - 1);
    let mut before = rule(first - 1).0;
    for order in first..ORDERS.len() {
        let (value, absolute) = rule(order);
        let error: [f64; 2] =
            core::array::from_fn(|k| error_of_better((value[k] - before[k]).abs(), absolute[k]));
        let scale = |k: usize| absolute[k].max(sum.value[k].abs());
        if (0..2).all(|k| error[k] <= tolerance * scale(k) + noise[k] + f64::MIN_POSITIVE)
            || (order + 1 == ORDERS.len() && (0..2).all(|k| error[k] <= 1e-13 * absolute[k]))
        {
            *start = order;
            let error = core::array::from_fn(|k| error[k] + noise[k]);
            return Some(Pair { value, error });
        }
        before = value;
    }
    *start = 1;
    None
}
