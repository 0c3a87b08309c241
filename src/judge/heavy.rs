//! Heavy tails: Hill's estimate of the tail index, and whether it can be believed.
//!
//! If P(X > x) falls as x^(-a), the k largest of n values give [Hill 1975]
//!
//! > 1/a ≈ (1/k) Σ_{i ≤ k} log(X_(i) / X_(k+1)),   with standard error a/√k.
//!
//! Variance is infinite for a ≤ 2. An estimator that reaches a caustic's fold without bias has contributions of the order
//! δ^(-1/2) at distance δ, thus index 2 exactly: a t test is not valid on pixels that the fold crosses. The estimate depends on k: it
//! is taken for k from √n to n/10 and called stable if the values agree within their errors.

use libm::{log, sqrt};

/// Fewest values from which an index is estimated.
pub const FEWEST_VALUES: usize = 256;

/// An estimated tail index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TailIndex {
    /// The index a: moments of order a and above are infinite.
    pub index: f64,
    /// Its standard error.
    pub error: f64,
    /// Whether estimates from fewer and from more of the largest values agree with it within three standard errors.
    pub is_stable: bool,
}

impl TailIndex {
    /// Whether the variance is infinite as far as can be told: a stable index that is not above 2 by two standard
    /// errors.
    pub fn variance_is_in_doubt(&self) -> bool {
        self.is_stable && self.index - 2.0 * self.error <= 2.0
    }
}

/// Hill's estimate from values of which those that are not positive are left out; `None` if too few are left.
pub fn hill(values: &[f64]) -> Option<TailIndex> {
    let mut logs: Vec<f64> = values
        .iter()
        .filter(|v| **v > 0.0 && v.is_finite())
        .map(|&v| log(v))
        .collect();
    if logs.len() < FEWEST_VALUES {
        return None;
    }
    logs.sort_by(|a, b| b.total_cmp(a));
    let of = |k: usize| {
        let spacings = logs[..k].iter().map(|l| l - logs[k]).sum::<f64>();
        k as f64 / spacings
    };
    let n = logs.len() as f64;
    let (fewest, most) = (sqrt(n) as usize, (n / 10.0) as usize);
    let middle = (sqrt((fewest * most) as f64) as usize).max(8);
    let index = of(middle);
    // All of the largest equal: clamped, or discrete. There is no tail.
    if !index.is_finite() {
        return None;
    }
    let agrees = |k: usize| {
        let other = of(k.max(4));
        let error = other / sqrt(k as f64);
        (other - index).abs() <= 3.0 * error.max(index / sqrt(middle as f64))
    };
    Some(TailIndex {
        index,
        error: index / sqrt(middle as f64),
        is_stable: agrees(fewest) && agrees(most),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::{philox, uniform};

    fn draw(n: u32, f: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n)
            .map(|i| {
                let [a, b, ..] = philox([i, 0, 2, 0], [21, 0]);
                f(1.0 - uniform(a, b))
            })
            .collect()
    }

    #[test]
    fn pareto_tails_have_their_index() {
        for a in [1.0, 1.5, 2.0, 3.0] {
            let found = hill(&draw(20_000, |u| libm::pow(u, -1.0 / a))).unwrap();
            // Five standard errors.
            assert!(
                (found.index - a).abs() < 5.0 * found.error,
                "{a}: {found:?}"
            );
            assert!(found.is_stable);
            assert_eq!(found.variance_is_in_doubt(), a <= 2.0, "{a}: {found:?}");
        }
    }

    /// Contributions of an unbiased estimator near a fold: δ^(-1/2), δ uniform.
    #[test]
    fn a_fold_has_index_two() {
        let found = hill(&draw(20_000, |u| 0.3 / sqrt(u))).unwrap();
        assert!((found.index - 2.0).abs() < 5.0 * found.error);
        assert!(found.variance_is_in_doubt());
    }

    #[test]
    fn light_tails_are_not_taken_for_heavy_ones() {
        let exponential = hill(&draw(20_000, |u| -log(u))).unwrap();
        assert!(!exponential.variance_is_in_doubt(), "{exponential:?}");
        let uniform = hill(&draw(20_000, |u| u)).unwrap();
        assert!(!uniform.variance_is_in_doubt());
        assert_eq!(hill(&[1.0; 1000]), None);
        assert_eq!(hill(&[1.0; 100]), None);
    }
}
