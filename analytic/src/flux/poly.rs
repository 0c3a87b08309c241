//! Polynomials of degree 8 on [-1, 1], in one and two variables.
//!
//! A smooth map on a small box is its Chebyshev interpolant to within rounding. The Chebyshev coefficients tell whether
//! it is (the last ones vanish) and bound ranges and derivatives (|T_k| ≤ 1, |T_k'| ≤ k²); powers are what is evaluated.

use core::f64::consts::PI;
use std::sync::OnceLock;

use libm::{acos, cos};

/// Nodes, and coefficients, per variable.
pub const N: usize = 9;

/// Values at the tensor grid of nodes, or coefficients of the tensor products of Chebyshev polynomials: `[b][a]`.
pub type Grid = [[f64; N]; N];

struct Tables {
    nodes: [f64; N],
    /// Values at the nodes to Chebyshev coefficients.
    transform: [[f64; N]; N],
    /// Chebyshev coefficients to those of the lower and of the upper half.
    halves: [[[f64; N]; N]; 2],
    /// T_k in powers.
    powers: [[f64; N]; N],
}

fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let angle = |n: usize| (n as f64 + 0.5) * PI / N as f64;
        let nodes: [f64; N] = core::array::from_fn(|n| -cos(angle(n)));
        let transform: [[f64; N]; N] = core::array::from_fn(|k| {
            let scale = if k == 0 { 1.0 } else { 2.0 } / N as f64;
            // Nodes ascend: T_k(-x) = (-1)^k T_k(x).
            let sign = if k.is_multiple_of(2) { scale } else { -scale };
            core::array::from_fn(|n| sign * cos(k as f64 * angle(n)))
        });
        let mut powers = [[0.0; N]; N];
        powers[0][0] = 1.0;
        powers[1][1] = 1.0;
        for k in 2..N {
            for p in 0..N {
                let shifted = if p > 0 { powers[k - 1][p - 1] } else { 0.0 };
                powers[k][p] = 2.0 * shifted - powers[k - 2][p];
            }
        }
        // T_k at the nodes of a half, interpolated.
        let halves = [-0.5, 0.5].map(|center| {
            let mut matrix = [[0.0; N]; N];
            for k in 0..N {
                let values = nodes.map(|x: f64| cos(k as f64 * acos(center + 0.5 * x)));
                for (row, t) in matrix.iter_mut().zip(&transform) {
                    let t: &[f64; N] = t;
                    row[k] = t.iter().zip(&values).map(|(t, v)| t * v).sum();
                }
            }
            matrix
        });
        Tables {
            nodes,
            transform,
            halves,
            powers,
        }
    })
}

/// The nodes, ascending, none at an end.
pub fn nodes() -> &'static [f64; N] {
    &tables().nodes
}

/// Chebyshev coefficients of the interpolant.
pub fn chebyshev(values: &[f64; N]) -> [f64; N] {
    let t = &tables().transform;
    core::array::from_fn(|k| (0..N).map(|n| t[k][n] * values[n]).sum())
}

/// Chebyshev coefficients to powers.
pub fn powers(coefficients: &[f64; N]) -> [f64; N] {
    let t = &tables().powers;
    core::array::from_fn(|p| (0..N).map(|k| coefficients[k] * t[k][p]).sum())
}

/// The grid with the variables exchanged.
pub fn transposed(g: &Grid) -> Grid {
    core::array::from_fn(|l| core::array::from_fn(|k| g[k][l]))
}

/// Chebyshev coefficients of a function of two variables.
#[derive(Clone, Copy, Debug)]
pub struct Chebyshev {
    /// `c[l][k]` belongs to T_k(a) T_l(b).
    pub c: Grid,
}

impl Chebyshev {
    /// The interpolant of values `[b][a]`.
    pub fn new(values: &Grid) -> Self {
        let rows: Grid = core::array::from_fn(|l| chebyshev(&values[l]));
        let columns = transposed(&rows);
        let done: Grid = core::array::from_fn(|k| chebyshev(&columns[k]));
        Chebyshev {
            c: transposed(&done),
        }
    }

    /// `sum of weight(k, l) |c|` over all terms.
    pub fn sum(&self, weight: impl Fn(usize, usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for (l, row) in self.c.iter().enumerate() {
            for (k, c) in row.iter().enumerate() {
                sum += weight(k, l) * c.abs();
            }
        }
        sum
    }

    /// Bound of the distance from the mean.
    pub fn spread(&self) -> f64 {
        self.sum(|k, l| if k + l > 0 { 1.0 } else { 0.0 })
    }

    /// Size of the last two orders along a and along b: what the interpolant misses, and a little more.
    pub fn tails(&self) -> [f64; 2] {
        let last = |k: usize| if k >= N - 2 { 1.0 } else { 0.0 };
        [self.sum(|k, _| last(k)), self.sum(|_, l| last(l))]
    }

    /// `p self + q other + r`.
    pub fn combined(&self, p: f64, other: &Self, q: f64, r: f64) -> Self {
        let mut c: Grid = core::array::from_fn(|l| {
            core::array::from_fn(|k| p * self.c[l][k] + q * other.c[l][k])
        });
        c[0][0] += r;
        Chebyshev { c }
    }

    /// The same function on the lower or upper half along an axis.
    pub fn half(&self, axis: usize, upper: bool) -> Self {
        let matrix = &tables().halves[usize::from(upper)];
        let apply = |row: &[f64; N]| -> [f64; N] {
            core::array::from_fn(|k| (0..N).map(|n| matrix[k][n] * row[n]).sum())
        };
        let c = if axis == 0 {
            self.c.map(|row| apply(&row))
        } else {
            transposed(&transposed(&self.c).map(|row| apply(&row)))
        };
        Chebyshev { c }
    }

    /// The integral over [-1, 1]²: ∫ T_k = 2/(1 - k²) for even k, 0 for odd.
    pub fn integral(&self) -> f64 {
        let weight = |k: usize| {
            if k.is_multiple_of(2) {
                2.0 / (1.0 - (k * k) as f64)
            } else {
                0.0
            }
        };
        let mut sum = 0.0;
        for (l, row) in self.c.iter().enumerate() {
            let inner: f64 = row.iter().enumerate().map(|(k, c)| weight(k) * c).sum();
            sum += weight(l) * inner;
        }
        sum
    }

    /// What the integral over [-1, 1]² misses if the coefficients go on as their last two orders: those of order k are weighted by
    /// 2/(k² - 1), so that a kink costs the integral much less than the interpolant.
    pub fn integral_error(&self) -> f64 {
        let weight = |k: usize| match k {
            0 => 2.0,
            1 => 2.0 / 3.0,
            _ => 2.0 / ((k * k - 1) as f64),
        };
        let last = |k: usize, l: usize| k >= N - 2 || l >= N - 2;
        4.0 * self.sum(|k, l| {
            if last(k, l) {
                weight(k) * weight(l)
            } else {
                0.0
            }
        })
    }

    /// The same with the variables exchanged.
    pub fn exchanged(&self) -> Self {
        Chebyshev {
            c: transposed(&self.c),
        }
    }

    /// In powers.
    pub fn polynomial(&self) -> Polynomial {
        let rows: Grid = core::array::from_fn(|l| powers(&self.c[l]));
        let columns = transposed(&rows);
        let done: Grid = core::array::from_fn(|k| powers(&columns[k]));
        Polynomial {
            c: transposed(&done),
        }
    }
}

/// A polynomial in two variables.
#[derive(Clone, Copy, Debug)]
pub struct Polynomial {
    /// `c[l][k]` belongs to a^k b^l.
    pub c: Grid,
}

impl Polynomial {
    /// The polynomial in a at a fixed b.
    #[inline]
    pub fn along_a(&self, b: f64) -> [f64; N] {
        let mut out = self.c[N - 1];
        for row in self.c[..N - 1].iter().rev() {
            for k in 0..N {
                out[k] = out[k] * b + row[k];
            }
        }
        out
    }

    /// The polynomial in b at a fixed a.
    pub fn along_b(&self, a: f64) -> [f64; N] {
        core::array::from_fn(|l| value(&self.c[l], a))
    }

    /// Value and both derivatives.
    #[inline]
    pub fn gradient(&self, a: f64, b: f64) -> [f64; 3] {
        let mut out = self.c[N - 1];
        let mut slope = [0.0; N];
        for row in self.c[..N - 1].iter().rev() {
            for k in 0..N {
                slope[k] = slope[k] * b + out[k];
                out[k] = out[k] * b + row[k];
            }
        }
        let [f, fa] = with_slope(&out, a);
        [f, fa, value(&slope, a)]
    }

    /// Value.
    #[inline]
    pub fn at(&self, a: f64, b: f64) -> f64 {
        value(&self.along_a(b), a)
    }
}

/// Value of a polynomial.
#[inline]
pub fn value(c: &[f64; N], x: f64) -> f64 {
    let mut f = c[N - 1];
    for k in (0..N - 1).rev() {
        f = f * x + c[k];
    }
    f
}

/// Value and derivative of a polynomial.
#[inline]
pub fn with_slope(c: &[f64; N], x: f64) -> [f64; 2] {
    let (mut f, mut d) = (c[N - 1], 0.0);
    for k in (0..N - 1).rev() {
        d = d * x + f;
        f = f * x + c[k];
    }
    [f, d]
}

/// Zeros found on [-1, 1].
#[derive(Clone, Copy, Debug, Default)]
pub struct Zeros {
    zeros: [f64; N],
    count: usize,
}

impl Zeros {
    /// The zeros, ascending.
    pub fn as_slice(&self) -> &[f64] {
        &self.zeros[..self.count]
    }

    fn push(&mut self, x: f64) {
        if self.count < N {
            self.zeros[self.count] = x;
            self.count += 1;
        }
    }
}

/// All points of [-1, 1] where a polynomial changes sign: between neighbouring zeros of the derivative it is monotone.
pub fn zeros(c: &[f64; N]) -> Zeros {
    let mut found = Zeros::default();
    let (mut reach, mut bend) = (0.0, 0.0);
    for (k, c) in c.iter().enumerate().skip(1) {
        reach += c.abs();
        if k > 1 {
            bend += k as f64 * c.abs();
        }
    }
    if !(c[0].abs() <= reach) {
        return found;
    }
    let mut cuts = [1.0; N + 1];
    let mut count = 0;
    if !(c[1].abs() > bend) {
        let derivative = core::array::from_fn(|k| {
            if k + 1 < N {
                (k + 1) as f64 * c[k + 1]
            } else {
                0.0
            }
        });
        let turns = zeros(&derivative);
        count = turns.count;
        cuts[..count].copy_from_slice(turns.as_slice());
    }
    let mut low = -1.0;
    let mut at_low = value(c, low);
    for &high in &cuts[..=count] {
        let at_high = value(c, high);
        if (at_low > 0.0) != (at_high > 0.0) {
            found.push(bracketed(c, low, high, at_low, at_high));
        }
        (low, at_low) = (high, at_high);
    }
    found
}

/// Newton's method inside a bracket.
fn bracketed(c: &[f64; N], mut low: f64, mut high: f64, at_low: f64, at_high: f64) -> f64 {
    let rising = at_high > 0.0;
    let mut x = low - at_low * (high - low) / (at_high - at_low);
    if !(x >= low && x <= high) {
        x = 0.5 * (low + high);
    }
    for round in 0..80 {
        let [f, d] = with_slope(c, x);
        if (f > 0.0) == rising {
            high = x;
        } else {
            low = x;
        }
        let newton = x - f / d;
        let next = if newton >= low && newton <= high && round < 12 {
            newton
        } else {
            0.5 * (low + high)
        };
        let step = (next - x).abs();
        x = next;
        if step <= 2e-16 {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolant_of_a_smooth_function() {
        let f = |a: f64, b: f64| libm::exp(0.2 * a - 0.1 * b) / (3.0 + a * b);
        let x = nodes();
        let values: Grid = core::array::from_fn(|l| core::array::from_fn(|k| f(x[k], x[l])));
        let c = Chebyshev::new(&values);
        let p = c.polynomial();
        for (a, b) in [(0.3, -0.7), (1.0, 1.0), (-1.0, 0.4)] {
            let [v, da, db] = p.gradient(a, b);
            assert!((v - f(a, b)).abs() < 1e-6);
            let h = 1e-5;
            assert!((da - (f(a + h, b) - f(a - h, b)) / (2.0 * h)).abs() < 3e-5);
            assert!((db - (f(a, b + h) - f(a, b - h)) / (2.0 * h)).abs() < 3e-5);
            assert!((value(&p.along_b(a), b) - v).abs() < 1e-14);
        }
        assert!(
            c.tails()[0] < 1e-5 && c.tails()[0] > 1e-9,
            "{:?}",
            c.tails()
        );
    }

    #[test]
    fn all_zeros_of_a_product() {
        let wanted = [-0.9, -0.3, -0.299, 0.1, 0.85, 1.4];
        let mut c = [0.0; N];
        c[0] = 1.0;
        for z in wanted {
            for k in (0..N).rev() {
                c[k] = if k > 0 { c[k - 1] } else { 0.0 } - z * c[k];
            }
        }
        let found = zeros(&c);
        assert_eq!(found.as_slice().len(), 5, "{found:?}");
        for (f, w) in found.as_slice().iter().zip(wanted) {
            assert!((f - w).abs() < 1e-11, "{f} {w}");
        }
    }
}
