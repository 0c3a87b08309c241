//! The exponent of a power law y = c xᵖ from means of replicates, valid also where noise is comparable with y.
//!
//! The logarithm of a noisy y is biased, and has no value where y is negative. So the exponent is found by testing:
//! with weights w, a hypothetical p leaves c free, and the residual in the direction in which another p would show is
//!
//! ```text
//! T(p) = Σ wᵢ xᵢᵖ (ln xᵢ − ℓ) yᵢ,   ℓ = Σ w x²ᵖ ln x / Σ w x²ᵖ
//! ```
//!
//! It is *linear* in y, its expectation is zero if y is c xᵖ whatever c, and T = 0 is the condition of the least-squares fit.
//! Each replicate gives one value of T, so t = mean/standard error has Student's distribution, at any noise, any correlation
//! between the yᵢ of one replicate, and any fixed weights. The interval is every p that is not rejected: if nothing is known it is
//! unbounded, as it must be (as in Fieller's theorem). For an exact bias that is no power law, the exponent that is
//! predicted is the root of T with the exact values and the same weights, and the same distribution holds at that root.
//! Derived here.

use libm::{exp, log, sqrt};

use crate::judge::distributions::{student_quantile, student_survival};
use crate::judge::evidence::moments;

/// Exponents are looked for from minus to plus this; an interval that reaches it is unbounded.
pub const LARGEST_EXPONENT: f64 = 8.0;
/// Steps of the search per unit.
const PER_UNIT: i32 = 64;
/// A p whose fit is worse than the best by more than (t + this)² has no part in the interval: far from the data T looks at
/// two points only, and accepts what the others exclude.
const ALLOWANCE: f64 = 2.0;

/// Where y is measured, and how well.
#[derive(Clone, Debug)]
pub struct Design {
    /// ln x relative to its mean.
    log_x: Vec<f64>,
    weights: Vec<f64>,
}

/// An exponent from data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The least-squares fit.
    pub fitted: f64,
    /// Every exponent that the data do not reject at the level asked; infinite where nothing bounds it.
    pub interval: [f64; 2],
    /// Standard error, linearized at the fit.
    pub standard_error: f64,
}

impl Exponent {
    /// Nothing is known.
    pub const UNKNOWN: Exponent = Exponent {
        fitted: f64::NAN,
        interval: [f64::NEG_INFINITY, f64::INFINITY],
        standard_error: f64::INFINITY,
    };

    /// Half of the interval's width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.interval[1] - self.interval[0])
    }
}

impl Design {
    /// `x` positive; weights are those of the noise, 1/variance, to any constant factor. They must not depend on the data.
    pub fn new(x: &[f64], weights: &[f64]) -> Self {
        let logs: Vec<f64> = x.iter().map(|&x| log(x)).collect();
        let mean = logs.iter().sum::<f64>() / logs.len().max(1) as f64;
        Design {
            log_x: logs.iter().map(|l| l - mean).collect(),
            weights: weights.to_vec(),
        }
    }

    /// xᵖ relative to its largest value, which keeps every power finite.
    fn powers(&self, p: f64) -> Vec<f64> {
        let top = self.log_x.iter().map(|l| p * l).fold(f64::MIN, f64::max);
        self.log_x.iter().map(|l| exp(p * l - top)).collect()
    }

    /// The coefficients of T(p).
    pub fn contrast(&self, p: f64) -> Vec<f64> {
        let powers = self.powers(p);
        let (mut sum, mut logs) = (0.0, 0.0);
        for ((f, w), l) in powers.iter().zip(&self.weights).zip(&self.log_x) {
            sum += w * f * f;
            logs += w * f * f * l;
        }
        let center = logs / sum;
        let terms = powers.iter().zip(&self.weights).zip(&self.log_x);
        terms.map(|((f, w), l)| w * f * (l - center)).collect()
    }

    /// How much of Σ w y² the best c explains, (Σ w y xᵖ)²/Σ w x²ᵖ.
    fn explained(&self, p: f64, y: &[f64]) -> f64 {
        let powers = self.powers(p);
        let (mut sum, mut product) = (0.0, 0.0);
        for ((f, w), y) in powers.iter().zip(&self.weights).zip(y) {
            sum += w * f * f;
            product += w * f * y;
        }
        product * product / sum
    }

    fn candidates() -> impl Iterator<Item = f64> {
        let last = LARGEST_EXPONENT as i32 * PER_UNIT;
        (-last..=last).map(|i| f64::from(i) / f64::from(PER_UNIT))
    }

    /// The least-squares exponent of values without noise.
    pub fn exponent_of(&self, y: &[f64]) -> f64 {
        let better = |a: f64, b: f64| {
            if self.explained(b, y) > self.explained(a, y) {
                b
            } else {
                a
            }
        };
        let best = Self::candidates().fold(0.0, better);
        // Golden section between the neighbours.
        let step = 1.0 / f64::from(PER_UNIT);
        let (mut low, mut high) = (best - step, best + step);
        for _ in 0..50 {
            let (u, v) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
            if self.explained(u, y) > self.explained(v, y) {
                high = v;
            } else {
                low = u;
            }
        }
        0.5 * (low + high)
    }

    /// Mean and standard error of T(p) over replicates, each a list of y.
    fn score(&self, p: f64, replicates: &[Vec<f64>]) -> (f64, f64) {
        let a = self.contrast(p);
        let values: Vec<f64> = replicates.iter().map(|y| dot(&a, y)).collect();
        let (mean, variance) = moments(&values);
        (mean, sqrt(variance / replicates.len() as f64))
    }

    /// Two-sided p-value of the hypothesis that y is c xᵖ, where y may be wrong by `errors` and `exact` is what it should be.
    /// The exponent of `exact` is tested, so that a deviation of `exact` from a power law costs nothing.
    pub fn p_value(&self, exact: &[f64], errors: &[f64], replicates: &[Vec<f64>]) -> f64 {
        let p = self.exponent_of(exact);
        let a = self.contrast(p);
        let known_to: f64 = a.iter().zip(errors).map(|(a, e)| a.abs() * e).sum();
        let (mean, error) = self.score(p, replicates);
        let distance = (mean - dot(&a, exact)).abs() - known_to;
        if distance <= 0.0 {
            return 1.0;
        }
        2.0 * student_survival(distance / error, replicates.len() as f64 - 1.0)
    }

    /// The fit, and every exponent that is not rejected at a level, such as 0.05.
    pub fn fit(&self, replicates: &[Vec<f64>], level: f64) -> Exponent {
        let count = replicates.len() as f64;
        let columns = |i: usize| replicates.iter().map(|r| r[i]).collect::<Vec<f64>>();
        let of: Vec<(f64, f64)> = (0..self.log_x.len())
            .map(|i| moments(&columns(i)))
            .collect();
        let y: Vec<f64> = of.iter().map(|m| m.0).collect();
        let fitted = self.exponent_of(&y);
        let best = self.explained(fitted, &y);
        // The weights' scale: they should be 1/variance of the means.
        let scale = of
            .iter()
            .zip(&self.weights)
            .map(|(m, w)| w * m.1 / count)
            .sum::<f64>()
            / of.len() as f64;
        let t = student_quantile(0.5 * level, count - 1.0);
        let rejection = |p: f64| {
            let (mean, error) = self.score(p, replicates);
            mean.abs() - t * error
        };
        let is_possible =
            |p: f64| best - self.explained(p, &y) <= (t + ALLOWANCE) * (t + ALLOWANCE) * scale;
        let accepted = |p: f64| rejection(p) <= 0.0 && is_possible(p);
        let (mut low, mut high) = (fitted, fitted);
        for p in Self::candidates().filter(|&p| accepted(p)) {
            (low, high) = (low.min(p), high.max(p));
        }
        let refine = |inside: f64, direction: f64| {
            let step = 1.0 / f64::from(PER_UNIT);
            let edge = inside + direction * step;
            if edge.abs() > LARGEST_EXPONENT {
                return direction * f64::INFINITY;
            }
            let (mut inside, mut outside) = (inside, edge);
            for _ in 0..40 {
                let middle = 0.5 * (inside + outside);
                if accepted(middle) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            0.5 * (inside + outside)
        };
        let interval = [refine(low, -1.0), refine(high, 1.0)];
        Exponent {
            fitted,
            interval,
            standard_error: self.linearized_error(fitted, &y, replicates),
        }
    }

    /// The standard error of the exponent: that of T over T's derivative with respect to p, at c from `y`.
    fn linearized_error(&self, p: f64, y: &[f64], replicates: &[Vec<f64>]) -> f64 {
        let (_, error) = self.score(p, replicates);
        error / self.sensitivity(p, y)
    }

    /// |dT/dp| where y is close to c xᵖ: |c| Σ w x²ᵖ (ln x − ℓ)².
    pub fn sensitivity(&self, p: f64, y: &[f64]) -> f64 {
        let powers = self.powers(p);
        let a = self.contrast(p);
        let (mut sum, mut product, mut spread) = (0.0, 0.0, 0.0);
        for i in 0..y.len() {
            sum += self.weights[i] * powers[i] * powers[i];
            product += self.weights[i] * powers[i] * y[i];
            spread += a[i] * powers[i] * self.log_x[i];
        }
        (product / sum * spread).abs()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The factor by which the measured y is the predicted one, Σ w b y / Σ w b²: mean and standard error over replicates.
pub fn scale(weights: &[f64], predicted: &[f64], replicates: &[Vec<f64>]) -> (f64, f64) {
    let a: Vec<f64> = weights.iter().zip(predicted).map(|(w, b)| w * b).collect();
    let norm = dot(&a, predicted);
    let values: Vec<f64> = replicates.iter().map(|y| dot(&a, y) / norm).collect();
    let (mean, variance) = moments(&values);
    (mean, sqrt(variance / replicates.len() as f64))
}
