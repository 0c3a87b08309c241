//! Break points of a slice integral that have no formula: found from samples of smooth functions, then bisected.
//!
//! A function of the azimuth whose sign changes is an event. A pair of sign changes between two samples shows in the parabola
//! through three; where that comes near zero the minimum is searched for.

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
    if !(low + inset < high - inset) {
        return;
    }
    let at = |k: usize| {
        let x = low + (high - low) * (k as f64 / (SAMPLES as f64 - 1.0));
        x.clamp(low + inset, high - inset)
    };
    let samples: [Option<Probe<N>>; SAMPLES] = core::array::from_fn(|k| probe(at(k)));
    let labels = |p: &Option<Probe<N>>| p.map(|p| p.labels);

    // Where the labels change the functions are others: each part is a new search.
    let mut cuts = vec![low];
    for k in 1..SAMPLES {
        let (mut x, mut left) = (at(k - 1), labels(&samples[k - 1]));
        while left != labels(&samples[k]) && cuts.len() < MOST_PARTS {
            x = first_false(x, at(k), |x| labels(&probe(x)) == left);
            cuts.push(x);
            left = labels(&probe(x));
        }
    }
    if cuts.len() > 1 {
        breaks.extend(cuts[1..].iter().map(|&azimuth| Break {
            azimuth,
            kind: Singularity::Root,
        }));
        cuts.push(high);
        for pair in cuts.windows(2) {
            if pair[1] - pair[0] > SHORTEST * (high - low) && pair[1] - pair[0] < high - low {
                signs((pair[0], pair[1]), kinds, &probe, breaks);
            }
        }
    } else {
        signs((low, high), kinds, &probe, breaks);
    }
}

/// Parts of an interval, at most.
const MOST_PARTS: usize = 24;
/// Parts shorter than this share of an interval are not searched.
const SHORTEST: f64 = 1e-8;

/// The sign changes in an interval of constant labels.
fn signs<const N: usize>(
    (low, high): (f64, f64),
    kinds: [Singularity; N],
    probe: &impl Fn(f64) -> Option<Probe<N>>,
    breaks: &mut Vec<Break>,
) {
    let inset = 1e-9 * (high - low);
    let at = |k: usize| {
        let x = low + (high - low) * (k as f64 / (SAMPLES as f64 - 1.0));
        x.clamp(low + inset, high - inset)
    };
    let samples: [Option<Probe<N>>; SAMPLES] = core::array::from_fn(|k| probe(at(k)));
    for k in 1..SAMPLES {
        let (Some(p), Some(q)) = (&samples[k - 1], &samples[k]) else {
            continue;
        };
        let before = if k >= 2 { samples[k - 2] } else { None };
        for (f, &kind) in kinds.iter().enumerate() {
            let value = |x: f64| probe(x).map_or(f64::NAN, |p| p.values[f]);
            let sign = p.values[f].signum();
            if (p.values[f] > 0.0) != (q.values[f] > 0.0) {
                let azimuth = first_false(at(k - 1), at(k), |x| sign * value(x) > 0.0);
                breaks.push(Break { azimuth, kind });
            } else if let Some(o) = before {
                let [a, b, c] = [o, *p, *q].map(|s| sign * s.values[f]);
                // The parabola through three samples of one sign: does it come near zero within them?
                let (bend, slope) = (0.5 * (a + c) - b, 0.5 * (c - a));
                let turns = bend > 0.0 && slope.abs() <= 2.0 * bend;
                if turns && b - 0.25 * slope * slope / bend < 0.05 * a.max(c) {
                    let lowest = minimum(at(k - 2), at(k), |x| sign * value(x));
                    if sign * value(lowest) < 0.0 {
                        let first = first_false(at(k - 2), lowest, |x| sign * value(x) > 0.0);
                        let second = first_false(lowest, at(k), |x| sign * value(x) <= 0.0);
                        breaks.extend([first, second].map(|azimuth| Break { azimuth, kind }));
                    }
                }
            }
        }
    }
}

/// Bisection between where `same` holds (at `low`) and where it does not (at `high`): a point just beyond the border.
pub fn first_false(mut low: f64, mut high: f64, same: impl Fn(f64) -> bool) -> f64 {
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
    high
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
