//! Bias and variance of one sample as functions of the bandwidth: exact expectations, interpolated.
//!
//! Between two bandwidths the bias over α² and the second moment times α² are interpolated in ln α by Chebyshev polynomials on pieces
//! that are halved until the last coefficients are small; below the smallest, where differences of means would be rounding,
//! they are the law's.

use core::f64::consts::PI;

use crate::bandwidth::law::Law;

/// Nodes of a piece.
const NODES: usize = 12;
/// What the last coefficients of a piece may be, relative to the largest.
const SMALL: f64 = 1e-6;
/// Halvings at most: where the kernel meets an edge the functions have a kink.
const DEEPEST: u32 = 7;

#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    to: f64,
    /// Chebyshev coefficients of bias/α² and m₂ α².
    coefficients: [[f64; 2]; NODES],
}

/// Bias and variance of one sample against the bandwidth, at one point.
#[derive(Clone, Debug)]
pub struct Curve {
    truth: f64,
    law: Law,
    low: f64,
    high: f64,
    pieces: Vec<Piece>,
}

/// Bias and variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Error {
    /// Expectation minus truth.
    pub bias: f64,
    /// Variance of one sample.
    pub variance: f64,
}

impl Curve {
    /// From exact moments (mean, second moment) at any bandwidth up to `high`; `low` is where the law takes over.
    pub(super) fn new(
        truth: f64,
        law: Law,
        [low, high]: [f64; 2],
        mut moments: impl FnMut(f64) -> [f64; 2],
    ) -> Curve {
        let mut pieces = Vec::new();
        let (a, b) = (libm::log(low), libm::log(high));
        let count = libm::ceil((b - a) / 1.4).max(1.0);
        let mut tasks: Vec<(f64, f64, u32)> = (0..count as u32)
            .rev()
            .map(|k| {
                let at = |k: f64| a + (b - a) * k / count;
                (at(f64::from(k)), at(f64::from(k) + 1.0), 0)
            })
            .collect();
        while let Some((from, to, depth)) = tasks.pop() {
            let mut values = [[0.0; 2]; NODES];
            for (k, v) in values.iter_mut().enumerate() {
                let x = libm::cos(PI * (k as f64 + 0.5) / NODES as f64);
                let alpha = libm::exp(0.5 * (from + to) + 0.5 * (to - from) * x);
                let [mean, second] = moments(alpha);
                *v = [(mean - truth) / (alpha * alpha), second * alpha * alpha];
            }
            let coefficients: [[f64; 2]; NODES] = core::array::from_fn(|j| {
                let half = if j == 0 { 1.0 } else { 2.0 };
                let mut sum = [0.0; 2];
                for (k, v) in values.iter().enumerate() {
                    let t = libm::cos(PI * j as f64 * (k as f64 + 0.5) / NODES as f64);
                    for i in 0..2 {
                        sum[i] += half / NODES as f64 * t * v[i];
                    }
                }
                sum
            });
            let smooth = (0..2).all(|i| {
                let size = coefficients.iter().map(|c| f64::abs(c[i])).sum::<f64>();
                let tail =
                    f64::abs(coefficients[NODES - 1][i]) + f64::abs(coefficients[NODES - 2][i]);
                tail <= SMALL * size
            });
            if smooth || depth == DEEPEST {
                pieces.push(Piece {
                    from,
                    to,
                    coefficients,
                });
            } else {
                let middle = 0.5 * (from + to);
                tasks.push((middle, to, depth + 1));
                tasks.push((from, middle, depth + 1));
            }
        }
        Curve {
            truth,
            law,
            low,
            high,
            pieces,
        }
    }

    /// A law and nothing else: what theory/consistency.md calls the model.
    pub fn of_law(law: Law, high: f64) -> Curve {
        Curve {
            truth: law.limit.unwrap_or(0.0),
            law,
            low: high,
            high,
            pieces: Vec::new(),
        }
    }

    /// The irradiance that is estimated [W/m²].
    pub fn truth(&self) -> f64 {
        self.truth
    }

    /// The law of small bandwidths.
    pub fn law(&self) -> &Law {
        &self.law
    }

    /// The largest bandwidth.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Bias and variance of one sample at a bandwidth up to [`Self::high`].
    pub fn at(&self, alpha: f64) -> Error {
        let (bias, second) = match self.piece(alpha) {
            Some(piece) => {
                let x = (2.0 * libm::log(alpha) - piece.from - piece.to) / (piece.to - piece.from);
                // Clenshaw's recurrence.
                let (mut b1, mut b2) = ([0.0; 2], [0.0; 2]);
                for c in piece.coefficients.iter().skip(1).rev() {
                    for i in 0..2 {
                        let next = c[i] + 2.0 * x * b1[i] - b2[i];
                        (b2[i], b1[i]) = (b1[i], next);
                    }
                }
                let v = [0, 1].map(|i| piece.coefficients[0][i] + x * b1[i] - b2[i]);
                (v[0] * alpha * alpha, v[1] / (alpha * alpha))
            }
            None => (self.law.bias(alpha), self.law.second_moment(alpha)),
        };
        let mean = self.truth + bias;
        Error {
            bias,
            variance: (second - mean * mean).max(0.0),
        }
    }

    fn piece(&self, alpha: f64) -> Option<&Piece> {
        if !(alpha >= self.low) {
            return None;
        }
        let t = libm::log(alpha);
        let k = self.pieces.partition_point(|p| p.to < t);
        self.pieces.get(k.min(self.pieces.len().wrapping_sub(1)))
    }
}
