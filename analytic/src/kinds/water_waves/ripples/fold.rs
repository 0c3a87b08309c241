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
/// Squares that are kept for many points, in units of the smallest.
const COARSE: f64 = 4.0;
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

/// A square with folds, and its rays: x(u) is within R `bend` of x(c) + J (u - c).
#[derive(Clone, Copy, Debug)]
struct Patch<S> {
    center: [S; 2],
    half: S,
    landing: [S; 2],
    jacobian: [[S; 2]; 2],
    bend: S,
}

impl<S: Scalar> Patch<S> {
    /// How far from the landing point its rays land at most [m].
    fn reach(&self) -> S {
        let [a, b] = self.jacobian;
        let square = a[0].squared() + a[1].squared() + b[0].squared() + b[1].squared();
        S::TWO.sqrt() * self.half * (square.sqrt() + self.bend)
    }

    /// The square with its bound.
    fn seen_from(&self, x: [S; 2]) -> Square<S> {
        let (dx, dy) = (self.landing[0] - x[0], self.landing[1] - x[1]);
        let distance = (dx.squared() + dy.squared()).sqrt();
        let [a, b] = self.jacobian;
        // Jᵀ e times the distance.
        let (p, q) = (a[0] * dx + b[0] * dy, a[1] * dx + b[1] * dy);
        let radius = S::TWO.sqrt() * self.half;
        let nearest = if distance > S::ZERO {
            let slope = (p.squared() + q.squared()).sqrt() / distance;
            distance - radius * (slope + self.bend)
        } else {
            S::ZERO
        };
        Square {
            center: self.center,
            half: self.half,
            nearest: nearest.max(S::ZERO),
        }
    }
}

/// The centres of the four quarters of a square.
fn quarters<S: Scalar>([x, y]: [S; 2], half: S) -> [[S; 2]; 4] {
    let h = S::HALF * half;
    [
        [x - h, y - h],
        [x + h, y - h],
        [x - h, y + h],
        [x + h, y + h],
    ]
}

/// Sorts so that the most promising square comes out first.
fn promising_last<S: Scalar>(squares: &mut [Square<S>]) {
    squares.sort_by(|a, b| {
        b.nearest
            .partial_cmp(&a.nearest)
            .unwrap_or(core::cmp::Ordering::Equal)
    });
}

/// The folds of ripples under a rectangle of the floor, made ready for many points.
///
/// Where the folds are does not depend on the floor point: the squares that may contain one are found once, down to a
/// few times the size of the smallest, for all points within half a wavelength of the longest wave. A search starts from
/// those of them that the bound leaves, and goes on as for one point.
#[derive(Clone, Debug)]
pub struct FoldNetwork<S> {
    water: Ripples<S>,
    /// Range of x and of y [m].
    region: [[S; 2]; 2],
    /// In ascending x of the landing point.
    patches: Vec<Patch<S>>,
    /// The farthest that a patch's rays land from its landing point [m].
    widest: S,
}

impl<S: Scalar> FoldNetwork<S> {
    /// The folds that are nearest to some point of a region of the floor, ranges of x and y [m].
    pub fn new(water: &Ripples<S>, region: [[S; 2]; 2]) -> Self {
        let mut patches = vec![];
        if water.has_folds() {
            let around = water.reach() + water.narrow();
            let [sx, sy] = region.map(|[low, high]| S::HALF * (high - low) + around);
            let center = region.map(|[low, high]| S::HALF * (low + high));
            let within = |c: [S; 2], h: S| {
                (c[0] - center[0]).abs() <= sx + h && (c[1] - center[1]).abs() <= sy + h
            };
            let coarse = S::from_f64(COARSE) * water.finest();
            let mut open = vec![(center, sx.max(sy))];
            while let Some((c, half)) = open.pop() {
                let Some(patch) = water.patch(c, half).filter(|_| within(c, half)) else {
                    continue;
                };
                if half <= coarse {
                    patches.push(patch);
                } else {
                    open.extend(quarters(c, half).map(|q| (q, S::HALF * half)));
                }
            }
        }
        patches.sort_by(|a: &Patch<S>, b| {
            let order = a.landing[0].partial_cmp(&b.landing[0]);
            order.unwrap_or(core::cmp::Ordering::Equal)
        });
        let widest = patches.iter().fold(S::ZERO, |w, p| w.max(p.reach()));
        FoldNetwork {
            water: water.clone(),
            region,
            patches,
            widest,
        }
    }

    /// As [`Ripples::singularity`].
    pub fn nearest(&self, x: [S; 2]) -> Option<Singularity<S>> {
        let known = x
            .iter()
            .zip(&self.region)
            .all(|(&x, &[low, high])| low <= x && x <= high);
        if !known {
            return self.water.singularity(x);
        }
        // What is found within a distance is the nearest of all.
        let wide = self.water.narrow();
        [S::HALF * S::HALF * wide, wide]
            .into_iter()
            .find_map(|wide| self.nearest_within(x, wide))
            .or_else(|| self.water.singularity(x))
    }

    fn nearest_within(&self, x: [S; 2], wide: S) -> Option<Singularity<S>> {
        let from = x[0] - wide - self.widest;
        let first = self.patches.partition_point(|p| p.landing[0] < from);
        let mut open: Vec<_> = self.patches[first..]
            .iter()
            .take_while(|p| p.landing[0] <= x[0] + wide + self.widest)
            .filter(|p| (p.landing[1] - x[1]).abs() <= wide + self.widest)
            .map(|p| p.seen_from(x))
            .filter(|square| square.nearest <= wide)
            .collect();
        promising_last(&mut open);
        self.water.nearest_in(x, wide, open)
    }
}

impl<S: Scalar> Ripples<S> {
    /// Whether the surface may focus the beam before it reaches the floor.
    fn has_folds(&self) -> bool {
        let steepest = super::SlopeBounds::of(self.index, self.sums.slope).tau_1;
        let most = (self.depth + self.sums.height) * steepest * self.sums.second;
        // 1 + κ g gᵀ stretches by at least 1: less than 1 cannot undo it.
        most >= S::ONE
    }

    /// Half the longest wavelength [m].
    fn narrow(&self) -> S {
        S::PI / self.sums.smallest_wave_number
    }

    /// The fold or cusp nearest to the floor point x; `None` if there is none within 4 of the longest wavelengths.
    ///
    /// **Accuracy**: the distance is that of a stationary point of a fold, to rounding; it is the smallest but for
    /// differences that the map makes in squares of a hundredth of the shortest wavelength.
    pub fn singularity(&self, x: [S; 2]) -> Option<Singularity<S>> {
        if !self.has_folds() {
            return None;
        }
        let mut wide = self.narrow();
        let farthest = S::from_f64(2.0 * WAVELENGTHS) * wide;
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
        let start = Square {
            center: x,
            half: self.reach() + wide,
            nearest: S::ZERO,
        };
        self.nearest_in(x, wide, vec![start])
    }

    /// Half the side of the smallest squares, at most.
    fn finest(&self) -> S {
        S::from_f64(FINEST) / self.sums.largest_wave_number
    }

    /// The nearest singularity that enters in one of the squares, the last of which is looked at first, if it is within
    /// `wide`.
    fn nearest_in(&self, x: [S; 2], wide: S, mut open: Vec<Square<S>>) -> Option<Singularity<S>> {
        let finest = self.finest();
        let mut best: Option<Singularity<S>> = None;
        let mut limit = wide;
        while let Some(square) = open.pop() {
            if square.nearest > limit {
                continue;
            }
            if square.half <= finest {
                if let Some(found) = self.stationary(x, &square)
                    && found.distance <= limit
                {
                    limit = found.distance;
                    best = Some(found);
                }
                continue;
            }
            let mut parts: Vec<_> = quarters(square.center, square.half)
                .into_iter()
                .filter_map(|center| self.patch(center, S::HALF * square.half))
                .map(|patch| patch.seen_from(x))
                .collect();
            promising_last(&mut parts);
            open.extend(parts);
        }
        best
    }

    /// A square with what is proven of its landing points; `None` if it has no fold.
    fn patch(&self, center: [S; 2], half: S) -> Option<Patch<S>> {
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
        Some(Patch {
            center,
            half,
            landing: ray.floor,
            jacobian: ray.jacobian,
            bend: S::HALF * bend,
        })
    }

    /// The point of a fold near a small square at which the distance is stationary; where there is none near, a point of
    /// the fold. `None` where Newton's method comes to no fold: the square's bound could not tell that it has none.
    fn stationary(&self, x: [S; 2], square: &Square<S>) -> Option<Singularity<S>> {
        let near = S::from_f64(16.0) * square.half;
        let mut u = self.on_fold(square.center);
        let (mut kind, mut settled) = (SingularityKind::Fold, false);
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
                break;
            }
            u = next;
            kind = if speed <= S::from_f64(STANDSTILL) {
                SingularityKind::Cusp
            } else {
                SingularityKind::Fold
            };
            settled = step[0].hypot(step[1]) <= S::from_f64(64.0) * S::EPSILON * self.reach();
            if settled {
                break;
            }
        }
        let at = |u: [S; 2], kind: SingularityKind| {
            let ray = self.ray(u);
            let (floor, [a, b]) = (ray.floor, ray.jacobian);
            let norm = a[0].squared() + a[1].squared() + b[0].squared() + b[1].squared();
            let on_fold = ray.determinant().abs() <= S::EPSILON.sqrt() * norm;
            on_fold.then(|| Singularity {
                kind,
                distance: (floor[0] - x[0]).hypot(floor[1] - x[1]),
            })
        };
        let found = at(u, kind);
        if settled && found.is_some() {
            return found;
        }
        let plain = at(self.on_fold(square.center), SingularityKind::Fold);
        Singularity::nearer(found, plain)
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
