//! Bandwidths of least mean squared error.
//!
//! ```text
//! one bandwidth     MSE = b(α)² + v(α)/n
//! α_k = α₀ k^(−λ)   MSE = (1/n Σ b(α_k))² + 1/n² Σ v(α_k)
//! ```
//!
//! b and v from exact expectations, the sums over all k. Minimised in ln α by a look at every eighth of an octave and Brent's golden
//! sections about the best, since b may change its sign and the error have several minima.

use super::curve::{Curve, Error};
use super::sums::sum;

/// A bandwidth and what it leads to: of several points, root mean squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// The bandwidth, or that of the first sample.
    pub bandwidth: f64,
    /// Expectation of the mean, minus truth.
    pub bias: f64,
    /// Standard deviation of the mean.
    pub deviation: f64,
    /// Root of the mean squared error.
    pub rmse: f64,
    /// Whether the best is the largest bandwidth that was considered.
    pub at_largest: bool,
}

/// Steps of the look per factor e.
const STEPS: f64 = 12.0;

/// Minimum of f over [a, b]: the best of a look, then golden sections.
fn minimise([a, b]: [f64; 2], f: impl Fn(f64) -> f64) -> (f64, bool) {
    let count = libm::ceil((b - a) * STEPS).max(2.0);
    let at = |k: f64| a + (b - a) * k / count;
    let mut best = (0.0, f64::INFINITY);
    let mut k = 0.0;
    while k <= count {
        let v = f(at(k));
        if v < best.1 {
            best = (k, v);
        }
        k += 1.0;
    }
    let (mut low, mut high) = (at((best.0 - 1.0).max(0.0)), at((best.0 + 1.0).min(count)));
    let golden = 0.5 * (libm::sqrt(5.0) - 1.0);
    let (mut p, mut q) = (high - golden * (high - low), low + golden * (high - low));
    let (mut fp, mut fq) = (f(p), f(q));
    // A minimum is known to the root of the rounding.
    while high - low > 1e-7 {
        if fp <= fq {
            (high, q, fq) = (q, p, fp);
            p = high - golden * (high - low);
            fp = f(p);
        } else {
            (low, p, fp) = (p, q, fq);
            q = low + golden * (high - low);
            fq = f(q);
        }
    }
    let x = 0.5 * (low + high);
    (x, b - x < 1e-6)
}

/// The error of one bandwidth or of a schedule at several points.
fn result(
    curves: &[&Curve],
    bandwidth: f64,
    at_largest: bool,
    f: impl Fn(&Curve) -> Error,
) -> Best {
    let n = curves.len() as f64;
    let (mut bias, mut variance) = (0.0, 0.0);
    for c in curves {
        let e = f(c);
        bias += e.bias * e.bias / n;
        variance += e.variance / n;
    }
    Best {
        bandwidth,
        bias: match curves {
            [one] => f(one).bias,
            _ => libm::sqrt(bias),
        },
        deviation: libm::sqrt(variance),
        rmse: libm::sqrt(bias + variance),
        at_largest,
    }
}

/// The range of ln α: up to what all curves know, down to where the variance of a mean of n samples is far beyond the truth.
fn range(curves: &[&Curve], paths: f64) -> Option<[f64; 2]> {
    let high = curves.iter().map(|c| c.high()).reduce(f64::min)?;
    let start = curves
        .iter()
        .filter_map(|c| c.law().best(paths))
        .fold(high, f64::min);
    let low = (1e-2 * start).max(crate::bandwidth::SMALLEST_BANDWIDTH);
    (low < high).then(|| [libm::log(low), libm::log(high)])
}

/// One run of `paths` samples at a single bandwidth; `None` without a curve, or where nothing is lit.
pub fn fixed(curves: &[&Curve], paths: f64) -> Option<Best> {
    let error = |c: &Curve, alpha: f64| {
        let e = c.at(alpha);
        Error {
            variance: e.variance / paths,
            ..e
        }
    };
    search(curves, paths, error)
}

/// Samples k = 1 … `paths` at the bandwidths α₀ k^(−`decay`), plain mean.
pub fn progressive(curves: &[&Curve], paths: u64, decay: f64) -> Option<Best> {
    search(curves, paths as f64, |c, alpha| {
        of_schedule(c, alpha, decay, paths)
    })
}

/// Bias and variance of the plain mean of a power schedule.
pub fn of_schedule(curve: &Curve, first: f64, decay: f64, paths: u64) -> Error {
    let n = paths as f64;
    let [bias, variance] = sum(paths, |k| {
        let e = curve.at(first * libm::pow(k, -decay));
        [e.bias, e.variance]
    });
    Error {
        bias: bias / n,
        variance: variance / (n * n),
    }
}

fn search(curves: &[&Curve], paths: f64, error: impl Fn(&Curve, f64) -> Error) -> Option<Best> {
    // Without weights there is no variance.
    let unknown = curves.iter().any(|c| c.law().squared.is_nan());
    if unknown || curves.iter().all(|c| c.law().roots == 0) {
        return None;
    }
    let total = |t: f64| {
        curves
            .iter()
            .map(|c| {
                let e = error(c, libm::exp(t));
                e.bias * e.bias + e.variance
            })
            .sum::<f64>()
    };
    let (t, at_largest) = minimise(range(curves, paths)?, total);
    let alpha = libm::exp(t);
    Some(result(curves, alpha, at_largest, |c| error(c, alpha)))
}
