//! Counts of rare events: what an expectation cannot see.
//!
//! With α_k ~ k^(−λ), λ > 1/d, every running mean has the right expectation and yet tends to zero almost surely, because
//! only finitely many samples are not zero (`theory/consistency.md`, section 2). Their number shows it, and so does a
//! quantile: the probability that a whole octave of iterations adds nothing. Both are sums of independent events with known probabilities.

use libm::{exp, log, log1p};

/// Upper bound of the two-sided p-value of `successes` among independent events whose probabilities sum to `expected`;
/// `trials` is their number. The truth may be anywhere within ± `error` of `expected`.
///
/// P(S ≥ s) and P(S ≤ s) are at most exp(−n D(s/n ‖ q)), D the relative entropy of coins, q the mean probability, also where the
/// probabilities differ [Hoeffding 1963, theorem 1].
pub fn p_bound(successes: u64, trials: f64, expected: f64, error: f64) -> f64 {
    let s = successes as f64;
    let nearest = s.clamp(expected - error, expected + error);
    if nearest == s {
        return 1.0;
    }
    let (f, q) = ((s / trials).clamp(0.0, 1.0), nearest / trials);
    if !(q > 0.0 && q < 1.0) {
        return 0.0;
    }
    let part = |a: f64, b: f64| if a > 0.0 { a * log(a / b) } else { 0.0 };
    let entropy = part(f, q) + part(1.0 - f, 1.0 - q);
    (2.0 * exp(-trials * entropy)).min(1.0)
}

/// The probability that none of `trials` independent events of probability p happens.
pub fn none_of(p: f64, trials: f64) -> f64 {
    exp(trials * log1p(-p.clamp(0.0, 1.0)))
}
