//! What the mean of a regularized class does as the bandwidth shrinks: all that is known of it.

use super::constants::{Named, candidates, names};
use super::{Known, Subject, VARIED, shown, shown_names};
use crate::verify::replicates::Shape;

/// The phase of the replicates at half the bandwidth.
const PHASE_HALF: u32 = 1003;
/// Standard errors beyond which a mean is off.
const OFF: f64 = 3.0;

impl Subject<'_> {
    /// Names of a factor of a regularized class at a multiple of its bandwidths.
    fn names_at(&self, times: f64, [factor, error]: [f64; 2]) -> Vec<String> {
        let bandwidths = &self.shape.bandwidths;
        let is_angle = matches!(self.truth, Known::Means(technique, _) if technique.is_angular());
        let mut list = candidates(self.entry, Some(times * bandwidths[0]));
        list.retain(|c| is_angle || !c.name.contains('α'));
        if let [_, .., last] = bandwidths[..] {
            let squares = bandwidths.iter().map(|r| r * r).sum::<f64>() / bandwidths.len() as f64;
            let name = "mean r² over the last r², the newest normalisation".to_owned();
            let value = squares / (last * last);
            list.push(Named { name, value });
        }
        names(&list, factor, error)
    }

    /// From class means at two bandwidths.
    pub(super) fn trend(
        &self,
        [mean, error]: [f64; 2],
        [truth, truth_at_half]: [f64; 2],
    ) -> Option<String> {
        let half = Shape {
            bandwidths: self.shape.bandwidths.iter().map(|b| 0.5 * b).collect(),
            paths_per_iteration: 2 * self.shape.paths_per_iteration,
        };
        let [mean_half, error_half] = self.drawn(&half, PHASE_HALF, VARIED).image_mean();
        let ratio = [mean / truth, error / truth];
        if (ratio[0] - 1.0).abs() < OFF * ratio[1] {
            return None;
        }
        let at_half = [mean_half / truth_at_half, error_half / truth_at_half];
        let both = format!(
            "{}, and {} at half the bandwidth",
            shown(ratio),
            shown(at_half)
        );
        // A name that holds at both bandwidths.
        let also = self.names_at(0.5, at_half);
        let mut named = self.names_at(1.0, ratio);
        named.retain(|n| also.contains(n));
        if !named.is_empty() {
            let named = shown_names(&named);
            return Some(format!("looks like a factor of the mean{named}: {both}"));
        }
        let change = at_half[0] / ratio[0];
        let spread = change * libm::hypot(ratio[1] / ratio[0], at_half[1] / at_half[0]);
        let is =
            |expected: f64| (change - expected).abs() < f64::max(4.0 * spread, 0.02 * expected);
        if is(0.5) {
            return Some(format!(
                "looks like a factor proportional to the bandwidth: {both}"
            ));
        }
        if is(2.0) {
            return Some(format!(
                "looks like a factor proportional to 1/bandwidth: {both}"
            ));
        }
        if is(0.25) {
            return Some(format!(
                "looks like contributions that do not grow as the kernel narrows, clamped or not normalised: a factor \
                 proportional to the square of the bandwidth, {both}"
            ));
        }
        let shrinks = ((at_half[0] - 1.0) / (ratio[0] - 1.0)).abs();
        if shrinks > 0.75 {
            return Some(format!(
                "looks like a bias of the mean that does not shrink with the bandwidth (a constant factor, a floor of the bandwidth, light \
                 of another class): {both}"
            ));
        }
        Some(format!(
            "looks like another kernel, bandwidth or schedule than the one stated, the bias shrinks with it: {both}"
        ))
    }
}
