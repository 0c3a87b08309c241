//! From errors at checkpoints to the time at which the target is reached.
//!
//! Without bias the squared error is V/n. At a fixed bandwidth it is B² + V/n, and at a given target some bandwidth is
//! soonest: V and B² are powers of it, V fitted to all bandwidths that were run, B² to the two smallest at which it is
//! established against the noise (the smaller a bandwidth, the larger V, and the smaller B²: most are not). With a bandwidth that
//! shrinks the squared error is a power of n, fitted to the last three checkpoints of each.

use super::{Checkpoint, Curve, TARGET};

/// When a class is as exact as the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// After so many CPU seconds, at a bandwidth where there is one.
    After(f64, Option<f64>),
    /// Not known: the bias is not established at two bandwidths, or the error falls too irregularly.
    Unknown,
}

impl Reached {
    /// The CPU seconds, if it is known.
    pub fn seconds(&self) -> Option<f64> {
        match self {
            Reached::After(seconds, _) => Some(*seconds),
            Reached::Unknown => None,
        }
    }

    /// The bandwidth, if there is one.
    pub fn bandwidth(&self) -> Option<f64> {
        match self {
            Reached::After(_, bandwidth) => *bandwidth,
            Reached::Unknown => None,
        }
    }
}

/// The slowest fall of a squared error, as an exponent of the number of iterations, that is extrapolated.
const SLOWEST: f64 = 0.3;
/// Standard errors above zero at which a squared bias is established.
const ESTABLISHED: f64 = 6.0;
/// Bandwidths are tried in steps of this factor, down to this part of the largest.
const STEP: f64 = 0.93;
const SMALLEST: f64 = 1e-3;

/// When the target is reached: of a method without bias, from its only curve.
pub(super) fn unbiased(curve: &Curve) -> Reached {
    match curve.checkpoints.last() {
        Some(last) => {
            let n = f64::from(last.iterations) * last.variance / (TARGET * TARGET);
            Reached::After(n * curve.seconds, None)
        }
        None => Reached::Unknown,
    }
}

/// The same at a bandwidth that is fixed, the best one.
pub(super) fn fixed(curves: &[Curve]) -> Reached {
    let target = TARGET * TARGET;
    let last = |c: &Curve| c.checkpoints.last().copied().zip(c.bandwidth);
    let ends: Vec<(Checkpoint, f64)> = curves.iter().filter_map(last).collect();
    let variance: Vec<_> = ends
        .iter()
        .map(|(c, b)| (*b, c.variance * f64::from(c.iterations)))
        .collect();
    let mut bias: Vec<_> = ends
        .iter()
        .filter(|(c, _)| c.squared_bias > ESTABLISHED * c.bias_error)
        .map(|(c, b)| (*b, c.squared_bias))
        .collect();
    bias.sort_by(|a, b| a.0.total_cmp(&b.0));
    bias.truncate(2);
    let (Some(variance), Some(bias)) = (power(&variance), power(&bias)) else {
        return Reached::Unknown;
    };
    let largest = ends.iter().map(|e| e.1).fold(0.0, f64::max);
    let seconds = curves.iter().map(|c| c.seconds).sum::<f64>() / curves.len() as f64;
    let mut best = Reached::Unknown;
    let mut bandwidth = largest;
    while bandwidth > SMALLEST * largest {
        let left = target - bias(bandwidth);
        if left > 0.0 {
            let time = seconds * variance(bandwidth) / left;
            if best.seconds().is_none_or(|t| time < t) {
                best = Reached::After(time, Some(bandwidth));
            }
        }
        bandwidth *= STEP;
    }
    best
}

/// The same at bandwidths that shrink, the best first one of those that were run.
pub(super) fn shrinking(curves: &[Curve]) -> Reached {
    let time = |c: &Curve| {
        let last = c.checkpoints.len().saturating_sub(3);
        let points: Vec<_> = c.checkpoints[last..]
            .iter()
            .map(|p| (p.error, f64::from(p.iterations)))
            .collect();
        let exponent = slope(&points)?;
        (exponent < 0.0 && exponent > -1.0 / SLOWEST)
            .then(|| power(&points))
            .flatten()
            .map(|n| (n(TARGET * TARGET) * c.seconds, c.bandwidth))
    };
    let best = curves
        .iter()
        .filter_map(time)
        .min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(Reached::Unknown, |(t, b)| Reached::After(t, b))
}

/// Exponent of the power that fits points by least squares of logarithms.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    if points.len() < 2 || points.iter().any(|p| !(p.0 > 0.0 && p.1 > 0.0)) {
        return None;
    }
    let logs = || points.iter().map(|p| (libm::log(p.0), libm::log(p.1)));
    let n = points.len() as f64;
    let (x, y) = logs().fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
    let covariance: f64 = logs().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let square: f64 = logs().map(|p| (p.0 - x) * (p.0 - x)).sum();
    (square > 0.0).then(|| covariance / square)
}

/// The power that fits points.
fn power(points: &[(f64, f64)]) -> Option<impl Fn(f64) -> f64 + use<>> {
    let slope = slope(points)?;
    let n = points.len() as f64;
    let middle =
        |of: fn(&(f64, f64)) -> f64| points.iter().map(|p| libm::log(of(p))).sum::<f64>() / n;
    let (x, y) = (middle(|p| p.0), middle(|p| p.1));
    Some(move |at: f64| libm::exp(y + slope * (libm::log(at) - x)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(bandwidth: Option<f64>, seconds: f64, of: impl Fn(f64) -> (f64, f64)) -> Curve {
        let checkpoints = [1, 2, 4, 8].map(|iterations| {
            let (squared_bias, variance) = of(f64::from(iterations));
            Checkpoint {
                iterations,
                error: squared_bias + variance,
                variance,
                squared_bias,
                bias_error: 0.01 * variance,
            }
        });
        Curve {
            bandwidth,
            checkpoints: checkpoints.to_vec(),
            seconds,
        }
    }

    fn near(reached: Reached, seconds: f64, tolerance: f64) {
        let found = reached.seconds().unwrap();
        assert!(
            (found / seconds - 1.0).abs() < tolerance,
            "{found} {seconds}"
        );
    }

    #[test]
    fn the_target_is_where_error_laws_cross_it() {
        // V/n = 1e-4 at n = 5000, at 0.25 s an iteration.
        let exact = curve(None, 0.25, |n| (0.0, 0.5 / n));
        near(unbiased(&exact), 1250.0, 1e-12);
        // B² = b⁴, V = 1e-3 b⁻²: V/(t - B²) is least where B² = t/3, so b = (t/3)^(1/4).
        let law = |b: f64| move |n: f64| (b * b * b * b, 1e-3 / (b * b) / n);
        let curves = [0.4, 0.2, 0.1, 0.05].map(|b| curve(Some(b), 2.0, law(b)));
        let best = libm::sqrt(libm::sqrt(1e-4 / 3.0));
        let reached = fixed(&curves);
        near(reached, 2.0 * 1e-3 / (best * best) / (2e-4 / 3.0), 0.01);
        assert!((reached.bandwidth().unwrap() / best - 1.0).abs() < 0.08);
        // n^(-2/3) from 0.1; the other one does not fall.
        let falls = curve(Some(0.2), 1.0, |n| (0.1 * libm::pow(n, -2.0 / 3.0), 0.0));
        let flat = curve(Some(0.1), 1.0, |_| (0.1, 0.0));
        near(
            shrinking(&[flat.clone(), falls]),
            libm::pow(1000.0, 1.5),
            1e-9,
        );
        assert_eq!(shrinking(&[flat]), Reached::Unknown);
        // Noise alone establishes no bias.
        let noise = [0.2, 0.1].map(|b| curve(Some(b), 1.0, |n| (1e-3 / n, 0.5 / n)));
        assert_eq!(fixed(&noise), Reached::Unknown);
    }
}
