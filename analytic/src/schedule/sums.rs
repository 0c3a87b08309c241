//! Sums Σ_{k ≤ n} f(αₖ) up to n = 2⁴⁰ and beyond: the first terms one by one, then Euler–Maclaurin by blocks.
//!
//! Over a block of whole numbers from a to b,
//!
//! ```text
//! Σ_{a < k ≤ b} f(k) = ∫ₐᵇ f dx + (f(b) - f(a))/2 + (f'(b) - f'(a))/12 + …
//! ```
//!
//! whose next term is below 1e-14 of the sum where f varies on the scale of its argument and a ≥ 2048. Where it does not
//! (kinks of `max`, oscillation), the integral with 16 nodes differs from that over two halves, and the block is split,
//! down to sums one by one. An expression that oscillates all the way exhausts the allowed evaluations and gives no
//! value rather than a wrong one.

use crate::quadrature::gauss_legendre;

use super::evaluate::is_power;
use super::expression::Expression;

/// Compensated sum [Neumaier 1974].
#[derive(Clone, Copy, Default)]
pub(super) struct Total {
    sum: f64,
    rest: f64,
}

impl Total {
    pub(super) fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.rest += if f64::abs(self.sum) >= f64::abs(term) {
            (self.sum - sum) + term
        } else {
            (term - sum) + self.sum
        };
        self.sum = sum;
    }

    pub(super) fn value(self) -> f64 {
        // An infinite sum has no rest.
        if self.sum.is_finite() {
            self.sum + self.rest
        } else {
            self.sum
        }
    }
}

const DIRECT: u64 = 2048;
const SHORT: u64 = 64;
const TOLERANCE: f64 = 1e-13;

/// The sums of αₖ to several powers.
pub struct PowerSums<'a, const M: usize> {
    expression: &'a Expression,
    exponents: [f64; M],
    bases: Vec<u64>,
    rule: Vec<(f64, f64)>,
    budget: u64,
    done: u64,
    totals: [Total; M],
}

impl<'a, const M: usize> PowerSums<'a, M> {
    /// Sums of αₖ^e for each exponent e, at the cost of at most `budget` evaluations of the expression.
    pub fn new(expression: &'a Expression, exponents: [f64; M], budget: u64) -> Self {
        Self {
            expression,
            exponents,
            bases: expression.bases(),
            rule: gauss_legendre(16),
            budget,
            done: 0,
            totals: [Total::default(); M],
        }
    }

    /// Σ_{k ≤ n} αₖ^e, for n not below that of the previous call; `None` once the evaluations are used up.
    ///
    /// **Accuracy**: 1e-12 relative, plus the rounding of αₖ itself.
    pub fn up_to(&mut self, n: u64) -> Option<[f64; M]> {
        while self.done < n {
            let next = if self.done < DIRECT {
                DIRECT
            } else {
                self.done.saturating_mul(2)
            };
            let next = next.min(n);
            self.block(self.done, next)?;
            self.exceptions(self.done, next);
            self.done = next;
        }
        Some(self.totals.map(Total::value))
    }

    fn terms(&mut self, alpha: f64) -> [f64; M] {
        self.budget = self.budget.saturating_sub(1);
        self.exponents.map(|e| libm::pow(alpha, e))
    }

    fn usual(&mut self, x: f64) -> [f64; M] {
        let alpha = self.expression.between(x);
        self.terms(alpha)
    }

    /// Adds the usual terms a < k ≤ b.
    fn block(&mut self, a: u64, b: u64) -> Option<()> {
        if self.budget == 0 {
            return None;
        }
        if b - a <= SHORT || b <= DIRECT {
            for k in a + 1..=b {
                let terms = self.usual(k as f64);
                for (total, term) in self.totals.iter_mut().zip(terms) {
                    total.add(term);
                }
            }
            return Some(());
        }
        let (x, y) = (a as f64, b as f64);
        let middle = 0.5 * (x + y);
        let whole = self.integral(x, y);
        let (left, right) = (self.integral(x, middle), self.integral(middle, y));
        let smooth = (0..M).all(|i| {
            let halves = left[i] + right[i];
            f64::abs(whole[i] - halves) <= TOLERANCE * f64::abs(halves)
        });
        if !smooth {
            let half = a + (b - a) / 2;
            self.block(a, half)?;
            return self.block(half, b);
        }
        let ends = [x - 1.0, x, x + 1.0, y - 1.0, y, y + 1.0].map(|x| self.usual(x));
        for i in 0..M {
            let slope = |j: usize| 0.5 * (ends[j + 1][i] - ends[j - 1][i]);
            let total = &mut self.totals[i];
            total.add(left[i]);
            total.add(right[i]);
            total.add(0.5 * (ends[4][i] - ends[1][i]));
            total.add((slope(4) - slope(1)) / 12.0);
        }
        Some(())
    }

    fn integral(&mut self, x: f64, y: f64) -> [f64; M] {
        let (centre, half) = (0.5 * (x + y), 0.5 * (y - x));
        let mut sums = [0.0; M];
        for i in 0..self.rule.len() {
            let (node, weight) = self.rule[i];
            let terms = self.usual(centre + half * node);
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += half * weight * term;
            }
        }
        sums
    }

    /// Replaces the usual terms by what `at_powers` says, a < k ≤ b.
    fn exceptions(&mut self, a: u64, b: u64) {
        let bases = self.bases.clone();
        for (i, &base) in bases.iter().enumerate() {
            let mut k = 1_u64;
            while k <= b {
                // A power of two bases counts once.
                let seen = bases[..i].iter().any(|&other| is_power(k, other));
                if k > a && !seen {
                    let alpha = self.expression.at(k);
                    let (exact, usual) = (self.terms(alpha), self.usual(k as f64));
                    for j in 0..M {
                        self.totals[j].add(-usual[j]);
                        self.totals[j].add(exact[j]);
                    }
                }
                let Some(next) = k.checked_mul(base) else {
                    break;
                };
                k = next;
            }
        }
    }
}
