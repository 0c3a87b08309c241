//! Break points of a slice integral that have no formula: found from samples of smooth functions, then bisected.
//!
//! A function of the azimuth whose sign changes is an event. A pair of sign changes between two samples shows as a sample
//! smaller than its neighbours; there the minimum is searched for.

use crate::pixel::fan::{Break, Singularity};

/// Samples per interval.
const SAMPLES: usize = 9;

/// A slice's smooth functions, and labels of what cuts it at either end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe<const N: usize> {
    /// A change of label is a break point.
    pub labels: [u8; 2],
    /// A change of sign is a break point.
    pub values: [f64; N],
}

/// Appends the break points between `low` and `high`; `kinds` says what a function's zero does to the integral.
pub fn search<const N: usize>(
    (low, high): (f64, f64),
    kinds: [Singularity; N],
    probe: impl Fn(f64) -> Option<Probe<N>>,
    breaks: &mut Vec<Break>,
) {
    // Just inside, where the slice is not cut by both neighbours' borders at once.
    let inset = 1e-9 * (high - low);
    let at = |k: usize| {
        let x = low + (high - low) * (k as f64 / (SAMPLES as f64 - 1.0));
        x.clamp(low + inset, high - inset)
    };
    let samples: [Option<Probe<N>>; SAMPLES] = core::array::from_fn(|k| probe(at(k)));
    let labels = |p: &Option<Probe<N>>| p.map(|p| p.labels);
    for k in 1..SAMPLES {
        let (left, right) = (&samples[k - 1], &samples[k]);
        if labels(left) != labels(right) {
            let same = |x: f64| labels(&probe(x)) == labels(left);
            breaks.push(Break {
                azimuth: last_true(at(k - 1), at(k), same),
                kind: Singularity::Root,
            });
            continue;
        }
        let (Some(p), Some(q)) = (left, right) else {
            continue;
        };
        let before = if k >= 2 { samples[k - 2] } else { None };
        for (f, &kind) in kinds.iter().enumerate() {
            let value = |x: f64| probe(x).map_or(f64::NAN, |p| p.values[f]);
            let sign = p.values[f].signum();
            if (p.values[f] > 0.0) != (q.values[f] > 0.0) {
                let azimuth = last_true(at(k - 1), at(k), |x| sign * value(x) > 0.0);
                breaks.push(Break { azimuth, kind });
            } else if let Some(o) = before.filter(|o| o.labels == p.labels) {
                let [a, b, c] = [o, *p, *q].map(|s| sign * s.values[f]);
                if b <= a && b <= c && b < 0.5 * a.max(c) {
                    let lowest = minimum(at(k - 2), at(k), |x| sign * value(x));
                    if sign * value(lowest) < 0.0 {
                        let first = last_true(at(k - 2), lowest, |x| sign * value(x) > 0.0);
                        let second = last_true(lowest, at(k), |x| sign * value(x) <= 0.0);
                        breaks.extend([first, second].map(|azimuth| Break { azimuth, kind }));
                    }
                }
            }
        }
    }
}

/// Bisection: the border between where `same` holds (at `low`) and where it does not (at `high`).
pub fn last_true(mut low: f64, mut high: f64, same: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if !(middle > low && middle < high) {
            break;
        }
        if same(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Interval search for the smallest value, stopped early below zero.
fn minimum(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..40 {
        let (a, b) = (low + 0.4 * (high - low), low + 0.6 * (high - low));
        let (fa, fb) = (f(a), f(b));
        if fa < 0.0 {
            return a;
        }
        if fb < 0.0 {
            return b;
        }
        if fa < fb {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}
