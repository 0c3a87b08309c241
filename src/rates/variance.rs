//! Variances: against the exact second moment, and their slope in the number of iterations.

use libm::{exp, log, sqrt};

use crate::judge::distributions::{student_quantile, student_survival};
use crate::judge::evidence::moments;

/// A sample variance beside what it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VarianceTest {
    /// Sample variance over exact variance.
    pub ratio: f64,
    /// Effective degrees of freedom: fewer where the values are spiky.
    pub dof: f64,
    /// Bound of the two-sided p-value.
    pub p: f64,
}

/// Tests the sample variance of independent values against an exact variance.
///
/// A sample variance of R values with excess kurtosis κ has the relative variance 2/(R−1) + κ/R; it is taken as a χ² variable of
/// so many degrees of freedom [Box 1953]. P(χ²_ν ≥ ν r), and P(≤) for r < 1, are at most exp(−ν (r − 1 − ln r)/2) (Chernoff).
/// `kurtosis` is the least that is assumed; a larger one in the sample is used.
pub fn variance_test(values: &[f64], exact: f64, kurtosis: f64) -> VarianceTest {
    let count = values.len() as f64;
    let (mean, variance) = moments(values);
    let fourth = values
        .iter()
        .map(|v| (v - mean) * (v - mean) * (v - mean) * (v - mean));
    let sample = fourth.sum::<f64>() / count / (variance * variance) - 3.0;
    let excess = kurtosis.max(sample).max(0.0);
    let dof = 2.0 / (2.0 / (count - 1.0) + excess / count);
    let ratio = variance / exact;
    let p = if ratio > 0.0 {
        (2.0 * exp(-0.5 * dof * (ratio - 1.0 - log(ratio)))).min(1.0)
    } else {
        0.0
    };
    VarianceTest { ratio, dof, p }
}

/// A slope of ln(variance) over ln(n).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slope {
    /// By least squares, all n alike.
    pub fitted: f64,
    /// Jackknife standard error.
    pub standard_error: f64,
    /// Interval at the level asked.
    pub interval: [f64; 2],
    /// Degrees of freedom.
    pub dof: f64,
}

impl Slope {
    /// Two-sided p-value of a slope.
    pub fn p_value(&self, slope: f64) -> f64 {
        2.0 * student_survival((self.fitted - slope).abs() / self.standard_error, self.dof)
    }

    /// Half of the interval's width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }
}

/// The coefficients of the least-squares slope over ln(x).
pub fn slope_contrast(x: &[f64]) -> Vec<f64> {
    let logs: Vec<f64> = x.iter().map(|&x| log(x)).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let norm: f64 = logs.iter().map(|l| (l - mean) * (l - mean)).sum();
    logs.iter().map(|l| (l - mean) / norm).collect()
}

/// The slope of ln(variance) over ln(x), the variances being those over replicates (`replicates[k][i]` at x_i).
///
/// Running means at different n share their samples, so errors of the variances are correlated: the error of the slope is that of
/// the whole fit when one replicate at a time is left out (jackknife).
pub fn variance_slope(x: &[f64], replicates: &[Vec<f64>], level: f64) -> Slope {
    let a = slope_contrast(x);
    let count = replicates.len() as f64;
    let columns: Vec<(f64, f64)> = (0..x.len())
        .map(|i| moments(&replicates.iter().map(|r| r[i]).collect::<Vec<f64>>()))
        .collect();
    let fitted: f64 = a.iter().zip(&columns).map(|(a, (_, v))| a * log(*v)).sum();
    // Without the value y: (R − 1) v − R/(R − 1) (y − m)², over R − 2.
    let without: Vec<f64> = replicates
        .iter()
        .map(|r| {
            let term = |i: usize| {
                let (mean, variance) = columns[i];
                let d = r[i] - mean;
                a[i] * log(
                    ((count - 1.0) * variance - count / (count - 1.0) * d * d) / (count - 2.0)
                )
            };
            (0..x.len()).map(term).sum()
        })
        .collect();
    let (_, spread) = moments(&without);
    let standard_error = sqrt(spread * (count - 1.0) * (count - 1.0) / count);
    let dof = count - 1.0;
    let t = student_quantile(0.5 * level, dof);
    Slope {
        fitted,
        standard_error,
        interval: [fitted - t * standard_error, fitted + t * standard_error],
        dof,
    }
}
