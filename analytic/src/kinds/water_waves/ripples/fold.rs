//! The nearest fold or cusp: the curves det J = 0, by branch and bound.
//!
//! Squares of entry points are quartered. One with centre c and circumradius R is dropped if it has no fold, or none that
//! lands nearer than the best found: with M from the curvature of the map and |·| the Euclidean norm of a matrix,
//!
//! ```text
//! |det J(u) - det J(c)| ≤ √2 M R (|J| + √2 M R),    |x(u) - x| ≥ |x(c) - x| - R (|Jᵀ e| + M R/2),
//! ```
//!
//! e the unit vector along x(c) - x. Where the distance is stationary along a fold, Jᵀ e = 0, so that few squares next to it
//! are left to be looked at.
//!
//! In the smallest squares Newton's method solves det J = 0 together with (x(u) - x)·J t = 0, t ⟂ ∇ det J the direction of
//! the fold: the distance is stationary along it. J t = 0 there is a cusp.

use super::Ripples;
use crate::gradient::Gradient;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::scalar::Scalar;

/// Folds are looked for within this many of the longest wavelengths.
const WAVELENGTHS: f64 = 4.0;
/// The smallest squares, in radians of phase of the shortest wave.
const FINEST: f64 = 0.05;
/// Below this relative speed along the fold its landing point stands still: a cusp.
const STANDSTILL: f64 = 1e-6;

type Once<S> = Gradient<S, 2>;
type Twice<S> = Gradient<Once<S>, 2>;

/// A square that may contain folds.
struct Square<S> {
    center: [S; 2],
    half: S,
    /// No fold in it lands nearer than this [m].
    nearest: S,
}

impl<S: Scalar> Ripples<S> {
    /// The fold or cusp nearest to the floor point x; `None` if there is none within 4 of the longest wavelengths.
    ///
    /// **Accuracy**: the distance is that of a stationary point of a fold, to rounding; it is the smallest but for
    /// differences that the map makes in squares of a hundredth of the shortest wavelength.
    pub fn singularity(&self, x: [S; 2]) -> Option<Singularity<S>> {
        let steepest = super::SlopeBounds::of(self.index, self.sums.slope).tau_1;
        let most = (self.depth + self.sums.height) * steepest * self.sums.second;
        // 1 + κ g gᵀ stretches by at least 1: less than 1 cannot undo it.
        if !(most >= S::ONE) {
            return None;
        }
        let longest = S::TWO * S::PI / self.sums.smallest_wave_number;
        let farthest = S::from_f64(WAVELENGTHS) * longest;
        let mut wide = S::HALF * longest;
        loop {
            let found = self.nearest_fold(x, wide);
            if found.is_some() || wide >= farthest {
                return found;
            }
            wide = S::TWO * wide;
        }
    }

    /// The nearest singularity, if it is within `wide`.
    fn nearest_fold(&self, x: [S; 2], wide: S) -> Option<Singularity<S>> {
        let finest = S::from_f64(FINEST) / self.sums.largest_wave_number;
        let mut best: Option<Singularity<S>> = None;
        let mut limit = wide;
        let start = Square {
            center: x,
            half: self.reach() + wide,
            nearest: S::ZERO,
        };
        let mut open = vec![start];
        while let Some(square) = open.pop() {
            if square.nearest > limit {
                continue;
            }
            if square.half <= finest {
                let found = self.stationary(x, &square);
                if found.distance <= limit {
                    limit = found.distance;
                    best = Some(found);
                }
                continue;
            }
            let half = S::HALF * square.half;
            let corners = [(-half, -half), (half, -half), (-half, half), (half, half)];
            let mut parts: Vec<_> = corners
                .iter()
                .filter_map(|&(i, j)| {
                    let center = [square.center[0] + i, square.center[1] + j];
                    self.square(x, center, half)
                })
                .collect();
            // The most promising one comes out first.
            parts.sort_by(|a, b| {
                b.nearest
                    .partial_cmp(&a.nearest)
                    .unwrap_or(core::cmp::Ordering::Equal)
            });
            open.extend(parts);
        }
        best
    }

    /// A square with its bound; `None` without a fold.
    fn square(&self, x: [S; 2], center: [S; 2], half: S) -> Option<Square<S>> {
        let at = self.surface(center, |s| s);
        let ray = super::refracted(self.index, self.depth, center, &at);
        let radius = S::TWO.sqrt() * half;
        let bend = self.curvature(&at, radius) * radius;
        let [a, b] = ray.jacobian;
        let norm = a[0].hypot(a[1]).hypot(b[0].hypot(b[1]));
        let spread = S::TWO.sqrt() * bend;
        if ray.determinant().abs() > spread * (norm + spread) {
            return None;
        }
        let (dx, dy) = (ray.floor[0] - x[0], ray.floor[1] - x[1]);
        let distance = dx.hypot(dy);
        // |Jᵀ e| times the distance.
        let moved = (a[0] * dx + b[0] * dy).hypot(a[1] * dx + b[1] * dy);
        let nearest = if distance > S::ZERO {
            distance - radius * (moved / distance + S::HALF * bend)
        } else {
            S::ZERO
        };
        Some(Square {
            center,
            half,
            nearest: nearest.max(S::ZERO),
        })
    }

    /// The point of a fold near a small square at which the distance is stationary; where there is none near, a point of
    /// the fold.
    fn stationary(&self, x: [S; 2], square: &Square<S>) -> Singularity<S> {
        let near = S::from_f64(16.0) * square.half;
        let mut u = self.on_fold(square.center);
        let mut kind = SingularityKind::Fold;
        for _ in 0..24 {
            let (value, slopes, speed) = self.conditions(x, u);
            let [[a, b], [c, d]] = slopes;
            let determinant = a * d - b * c;
            let step = [
                (d * value[0] - b * value[1]) / determinant,
                (a * value[1] - c * value[0]) / determinant,
            ];
            let next = [u[0] - step[0], u[1] - step[1]];
            let away = (next[0] - square.center[0]).hypot(next[1] - square.center[1]);
            if !(away <= near) {
                u = self.on_fold(square.center);
                kind = SingularityKind::Fold;
                break;
            }
            u = next;
            kind = if speed <= S::from_f64(STANDSTILL) {
                SingularityKind::Cusp
            } else {
                SingularityKind::Fold
            };
            if step[0].hypot(step[1]) <= S::from_f64(64.0) * S::EPSILON * self.reach() {
                break;
            }
        }
        let floor = self.ray(u).floor;
        Singularity {
            kind,
            distance: (floor[0] - x[0]).hypot(floor[1] - x[1]),
        }
    }

    /// A point of the fold near u, down the slope of the determinant.
    fn on_fold(&self, mut u: [S; 2]) -> [S; 2] {
        for _ in 0..8 {
            let moving = [Once::input(u[0], 0, S::ONE), Once::input(u[1], 1, S::ONE)];
            let determinant = self.ray_in(moving, Once::constant).determinant();
            let [p, q] = determinant.slopes;
            let scale = determinant.value / (p.squared() + q.squared());
            if !scale.is_finite() {
                break;
            }
            u = [u[0] - scale * p, u[1] - scale * q];
            if (scale * p).hypot(scale * q) <= S::from_f64(64.0) * S::EPSILON * self.reach() {
                break;
            }
        }
        u
    }

    /// det J and (x(u) - x)·J t with their slopes, and |J t|/(|J| |t|).
    fn conditions(&self, x: [S; 2], u: [S; 2]) -> ([S; 2], [[S; 2]; 2], S) {
        let lift = |s: S| Twice::constant(Once::constant(s));
        let one = Once::<S>::ONE;
        let moving = [
            Twice::input(Once::input(u[0], 0, S::ONE), 0, one),
            Twice::input(Once::input(u[1], 1, S::ONE), 1, one),
        ];
        let ray = self.ray_in(moving, lift);
        let determinant = ray.determinant();
        let t = [-determinant.slopes[1], determinant.slopes[0]];
        let along = ray
            .jacobian
            .map(|row| row[0].value * t[0] + row[1].value * t[1]);
        let miss = [
            ray.floor[0].value - Once::constant(x[0]),
            ray.floor[1].value - Once::constant(x[1]),
        ];
        let turn = miss[0] * along[0] + miss[1] * along[1];
        let norm = |v: [Once<S>; 2]| v[0].value.hypot(v[1].value);
        let [a, b] = ray.jacobian.map(|row| norm(row.map(|e| e.value)));
        (
            [determinant.value.value, turn.value],
            [determinant.value.slopes, turn.slopes],
            norm(along) / (a.hypot(b) * norm(t)),
        )
    }
}
