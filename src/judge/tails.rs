//! Tails of a t statistic whose replicates are skewed, far out where the t distribution alone does not carry.
//!
//! A caustic's replicates are sums of few large contributions and many small ones: skewed to the right. A skewness γ of one
//! replicate changes the tail of the Studentised mean T of R replicates by a factor that grows with the cube of how far
//! out it is [Shao 1999; Jing, Shao & Wang 2003: self-normalised sums, x = o(R^(1/4))]:
//!
//! > P(T < -x) ≈ P(t < -x) exp(+x³ γ / (3√R)),   P(T > x) ≈ P(t > x) exp(-x³ γ / (3√R)).
//!
//! At a p-value of 1e-3 this is a few per cent, at the levels of a suite (1e-9, x = 6) with the 32 replicates and 200
//! contributions that are the least accepted it is a factor of 30 for spiky contributions. So beyond x = 3 the tail used
//! here is
//!
//! > min over 3 ≤ y ≤ x of P(t > y) exp(y³ γ⁺ / (3√R)),
//!
//! with γ⁺ ≥ 0 the sample's skewness towards that tail plus twice its standard error √(6/R). The minimum is taken because
//! the expansion holds for moderate y only, while P(T > x) ≤ P(T > y) always holds. What is made smaller by skewness is
//! not used (γ⁺ ≥ 0). Below x = 3 the two tails' errors cancel in a two-sided test, and the t distribution is used as it
//! is; a one-sided test has the factor from x = 0 on. With few replicates, of which the skewness is not known, the minimum may stay above a level however far out x is:
//! then these replicates cannot decide, and more are drawn. `examples/calibration.rs` measures what is left of the error.

use libm::{exp, log, sqrt};

use super::distributions::{student_density, student_quantile, student_survival};

/// Up to here the t distribution is used as it is.
const NEAR: f64 = 3.0;
/// Beyond this nothing is asked.
const FAR: f64 = 1e6;
/// Standard errors of the skewness that are added to it.
const ALLOWANCE: f64 = 2.0;

/// The law of a Studentised mean of `replicates`, towards one of its tails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tail {
    dof: f64,
    /// γ⁺ / (3√R).
    growth: f64,
    /// Up to here the t distribution is used as it is.
    near: f64,
    /// Whether the skewness counts by the self-normalised sum, which is bounded, as it must for few replicates.
    is_bounded: bool,
}

impl Tail {
    /// The tail on the side of large means if `above`, else of small ones, for a sample's number of replicates and their
    /// skewness.
    pub fn new(replicates: usize, skewness: f64, above: bool) -> Self {
        let error = ALLOWANCE * sqrt(6.0 / replicates as f64);
        Tail {
            is_bounded: false,
            ..Tail::with_error(replicates, skewness, error, above)
        }
    }

    /// The same for few replicates, with a skewness that is known to ± `error` otherwise than from so many values. The
    /// factor is a law of the self-normalised sum y/√(1 + y²/ν), which never exceeds √ν [Jing, Shao & Wang 2003]; for many
    /// replicates that is y.
    pub fn with_error(replicates: usize, skewness: f64, error: f64, above: bool) -> Self {
        let n = replicates as f64;
        let towards = if above { -skewness } else { skewness };
        let bound = (towards + error).max(0.0);
        Tail {
            dof: replicates.saturating_sub(1) as f64,
            growth: bound / (3.0 * sqrt(n)),
            near: NEAR,
            is_bounded: true,
        }
    }

    /// The same for a one-sided test, in which the errors of the two tails do not cancel.
    pub fn one_sided(self) -> Self {
        Tail { near: 0.0, ..self }
    }

    fn far(&self, y: f64) -> f64 {
        student_survival(y, self.dof) * exp(self.exponent(y))
    }

    /// The logarithm of the factor for skewness.
    fn exponent(&self, y: f64) -> f64 {
        let y = if self.is_bounded {
            y / sqrt(1.0 + y * y / self.dof)
        } else {
            y
        };
        self.growth * y * y * y
    }

    /// Up to where [`Tail::far`] certainly falls: the density over the survival function, at least (ν - 1) y / (ν + y²)
    /// (from P(t > y) < E[t; t > y]/y), is above the slope 3 g y² of the exponent. Infinite without skewness.
    fn turning_point(&self) -> f64 {
        if self.growth == 0.0 {
            return f64::INFINITY;
        }
        if self.is_bounded {
            return FAR;
        }
        let rises = |y: f64| 3.0 * self.growth * y * (self.dof + y * y) > self.dof - 1.0;
        let (mut low, mut high) = (0.0, 1e4);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if rises(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }

    /// An upper bound of the probability that the statistic exceeds `x`. NaN for a NaN.
    pub fn survival(&self, x: f64) -> f64 {
        if !(x > self.near) {
            return student_survival(x, self.dof);
        }
        let plain = student_survival(self.near, self.dof);
        plain.min(self.far(x.min(self.turning_point().max(self.near))))
    }

    /// The x with survival(x) = `level`; infinite if these replicates never get there.
    pub fn critical(&self, level: f64) -> f64 {
        let plain = student_quantile(level, self.dof);
        if !(plain > self.near) || self.growth == 0.0 {
            return plain;
        }
        let end = self.turning_point();
        if !(end > plain) || self.far(end) > level {
            return f64::INFINITY;
        }
        // Newton's method inside a bracket on log far(y) - log level, which falls all the way.
        let target = log(level);
        let (mut low, mut high) = (plain, end);
        let mut y = plain;
        for _ in 0..60 {
            let survival = student_survival(y, self.dof);
            let value = log(survival) + self.exponent(y) - target;
            if value > 0.0 {
                low = y;
            } else {
                high = y;
            }
            // Of a bounded exponent about: the bracket has the last word.
            let slope = 3.0 * self.exponent(y) / y - student_density(y, self.dof) / survival;
            let next = y - value / slope;
            let inside = next > low && next < high;
            let next = if inside { next } else { 0.5 * (low + high) };
            let moved = (next - y).abs();
            y = next;
            if moved <= 1e-12 * y {
                break;
            }
        }
        // On the safe side of rounding, and of steps with a slope that is only about right.
        let mut margin = 1e-11;
        while self.far(y * (1.0 + margin)) > level && margin < 1.0 {
            margin *= 2.0;
        }
        y * (1.0 + margin)
    }

    /// Degrees of freedom.
    pub fn dof(&self) -> f64 {
        self.dof
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_skewness_it_is_student() {
        let tail = Tail {
            dof: 63.0,
            growth: 0.0,
            near: NEAR,
            is_bounded: false,
        };
        for x in [-2.0, 0.0, 1.0, 3.0, 6.0, 20.0] {
            assert_eq!(tail.survival(x), student_survival(x, 63.0));
        }
        assert_eq!(tail.critical(1e-9), student_quantile(1e-9, 63.0));
        assert!(tail.survival(f64::NAN).is_nan());
    }

    /// With few replicates the bounded factor leaves levels within reach, and is none for many.
    #[test]
    fn few_replicates_have_a_bounded_factor() {
        for (n, error) in [(4, 0.5), (8, 0.1), (16, 0.1), (16, 0.4)] {
            let tail = Tail::with_error(n, 0.0, error, true);
            let mut last = 1.0;
            for i in 0..400 {
                let p = tail.survival(0.1 * f64::from(i));
                assert!(p <= last && p >= student_survival(0.1 * f64::from(i), tail.dof()));
                last = p;
            }
            for level in [1e-2, 1e-4, 1e-6] {
                let x = tail.critical(level);
                assert!(
                    x.is_finite() && tail.survival(x) <= level,
                    "{n} {error} {level}: {x}"
                );
                assert!(x <= NEAR + 0.2 || tail.survival(0.99 * x) > level);
            }
        }
        let (few, many) = (
            Tail::with_error(1 << 20, 0.2, 0.1, true),
            Tail {
                is_bounded: false,
                ..Tail::with_error(1 << 20, 0.2, 0.1, true)
            },
        );
        assert!((few.survival(6.0) / many.survival(6.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn it_falls_and_the_critical_value_inverts_it() {
        for (n, skewness) in [(64, 0.3), (256, 0.2), (1024, -0.1), (100_000, 0.01)] {
            for above in [false, true] {
                let tail = Tail::new(n, skewness, above);
                let mut last = 1.0;
                for i in 0..400 {
                    let p = tail.survival(0.05 * f64::from(i));
                    assert!(p <= last, "{n} {skewness} {i}");
                    last = p;
                }
                for level in [0.1, 1e-2, 1e-4, 1e-6, 1e-9] {
                    let x = tail.critical(level);
                    if x.is_finite() {
                        let p = tail.survival(x);
                        let near = level > student_survival(NEAR, tail.dof());
                        let jump = student_survival(NEAR, tail.dof()) >= level && x < NEAR + 0.2;
                        assert!(
                            near || jump || (p / level - 1.0).abs() < 1e-6,
                            "{n} {skewness} {level}: {x} {p}"
                        );
                        assert!(p <= level * (1.0 + 1e-9) || near);
                    } else {
                        assert!(tail.survival(1e3) > level);
                    }
                }
            }
        }
    }

    /// Sums of exponential variables are skewed by 2/√n, and their Studentised mean has a heavier lower tail. The exact
    /// probability is found by drawing from the tilted law with its likelihood ratio: not by this module's formula.
    #[test]
    fn the_lower_tail_of_exponential_replicates_is_covered() {
        use crate::stream::{philox, uniform};
        // 32 replicates, each the mean of 50 exponential contributions; rates tilted by a factor 1 + δ.
        for (x, tilt) in [(4.0, 0.10), (5.0, 0.125), (6.0, 0.15)] {
            let (replicates, count, runs) = (128_usize, 50_u32, 3_000_u32);
            let tilt = tilt * 0.5;
            let mut sum = 0.0;
            let mut counter = 0_u32;
            for _ in 0..runs {
                let mut log_ratio = 0.0;
                let mut values = Vec::with_capacity(replicates);
                for _ in 0..replicates {
                    let mut total = 0.0;
                    for _ in 0..count / 2 {
                        counter += 1;
                        let [a, b, c, d] = philox([counter, 9, 0, 0], [5, 6]);
                        total -= log((1.0 - uniform(a, b)) * (1.0 - uniform(c, d)));
                    }
                    total /= 1.0 + tilt;
                    // Density under rate 1 over density under rate 1 + δ.
                    log_ratio += tilt * total - f64::from(count) * libm::log1p(tilt);
                    values.push(total / f64::from(count));
                }
                let (mean, variance) = crate::judge::evidence::moments(&values);
                if (mean - 1.0) / sqrt(variance / replicates as f64) < -x {
                    sum += exp(log_ratio);
                }
            }
            let exact = sum / f64::from(runs);
            let student = student_survival(x, replicates as f64 - 1.0);
            let bound = Tail::new(replicates, 2.0 / sqrt(f64::from(count)), false).survival(x);
            assert!(exact > 1.2 * student, "{x}: {exact:e} {student:e}");
            assert!(exact < bound, "{x}: {exact:e} {bound:e}");
        }
    }
}
