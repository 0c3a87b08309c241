//! Where the folds of the waves are: the zeros of dx/du, isolated from a bound of d³x/du³.
//!
//! With τ'' = τ' s B(s) (see [`super::bounds`]),
//!
//! ```text
//! d²x/du² = ζ''(τ + 2sτ') + (H + ζ)(τ'' ζ''² + τ' ζ''').
//! ```
//!
//! Where both vanish two folds are born: a cusp.

use super::{WaterWaves, landing, refraction};
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;

/// A fold line on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold<S> {
    /// Where its rays enter the water [m].
    pub u: S,
    /// Where it is on the floor [m].
    pub x: S,
    /// Fold, or cusp.
    pub kind: SingularityKind,
}

/// The search for the nearest fold goes this many of the longest wavelengths far.
const WAVELENGTHS: f64 = 64.0;
/// And no further than this many radians of the shortest.
const PHASE: f64 = 4e4;

impl<S: Scalar> WaterWaves<S> {
    /// Visits the folds with entry points u from `low` to `high`, in ascending u. No allocation.
    pub fn for_each_fold(&self, low: S, high: S, mut visit: impl FnMut(Fold<S>)) {
        if !self.can_fold() {
            return;
        }
        for_each_root(
            low,
            high,
            |u, half| self.fold_local(u, half),
            |root| {
                let (u, kind) = match root {
                    Isolated::Simple(u) => (u, SingularityKind::Fold),
                    Isolated::Touching(u) => (u, SingularityKind::Cusp),
                };
                let at = self.surface(u);
                let r = refraction(self.index, at.slope);
                let (shift, _) = landing(&r, self.depth, at.zeta, at.slope, at.second);
                visit(Fold {
                    u,
                    x: u + shift,
                    kind,
                });
            },
        );
    }

    /// Whether dx/du could be zero at all: it is at least 1 - (H + Σ|A|) τ' Σ|A|k².
    fn can_fold(&self) -> bool {
        let flat = self.surface(S::ZERO);
        let everywhere = S::ONE / S::ZERO;
        let bounds = if self.sums.largest_wave_number > S::ZERO {
            self.slope_bounds(&flat, everywhere)
        } else {
            return false;
        };
        self.highest() * bounds.tau_1 * self.sums.second >= S::ONE
    }

    fn fold_local(&self, u: S, half: S) -> Local<S> {
        let at = self.surface(u);
        let (n, s) = (self.index, at.slope);
        let r = refraction(n, s);
        let (_, value) = landing(&r, self.depth, at.zeta, s, at.second);
        let gap = (n - S::ONE) * (n + S::ONE);
        let steep = S::ONE + s.squared();
        let turn = s
            * (S::TWO / steep + (r.q + S::ONE) / (r.q * steep)
                - gap / r.q.squared()
                - S::TWO * (gap / r.q + S::TWO) / (r.q + s.squared()));
        let slope = at.second * (r.tau + S::TWO * s * r.tau_1)
            + (self.depth + at.zeta) * r.tau_1 * (turn * at.second.squared() + at.third);
        let b = self.slope_bounds(&at, half);
        let (second, third) = (
            self.sums.second_within(&at, half),
            self.sums.third_within(&at, half),
        );
        let (h, three) = (self.highest(), S::from_f64(3.0));
        let curvature = third * (b.tau + S::TWO * b.slope * b.tau_1)
            + second.squared() * (three * b.tau_1 + S::TWO * b.slope * b.tau_2)
            + b.slope * (b.tau_2 * second.squared() + b.tau_1 * third)
            + h * (b.tau_3 * second.squared() * second
                + three * b.tau_2 * second * third
                + b.tau_1 * self.sums.fourth);
        let [_, slope_change, second_change] = self.sums.changes(u.abs());
        let noise = S::ONE + h * (b.tau_1 * second_change + b.tau_2 * second * slope_change);
        Local {
            value,
            slope,
            curvature,
            noise: S::from_f64(4.0) * S::EPSILON * noise,
        }
    }

    /// The fold or cusp nearest to the floor point x; `None` if there is none within 64 of the longest wavelengths.
    pub fn singularity(&self, x: S) -> Option<Singularity<S>> {
        if !self.can_fold() {
            return None;
        }
        let reach = self.reach();
        let longest = S::TWO * S::PI / self.sums.smallest_wave_number;
        let farthest = (S::from_f64(WAVELENGTHS) * longest)
            .min(S::from_f64(PHASE) / self.sums.largest_wave_number);
        let mut wide = longest.min(farthest);
        loop {
            let mut nearest = None;
            self.for_each_fold(x - reach - wide, x + reach + wide, |fold| {
                let found = Singularity {
                    kind: fold.kind,
                    distance: (fold.x - x).abs(),
                };
                nearest = Singularity::nearer(nearest, Some(found));
            });
            // Folds from outside the window land farther away than `wide`.
            let complete = nearest.is_some_and(|n: Singularity<S>| n.distance <= wide);
            if complete || !(wide < farthest) {
                return nearest;
            }
            wide = (S::TWO * wide).min(farthest);
        }
    }
}
