//! Newton's method for the specular point between a floor point and the light, by Fermat's principle.
//!
//! A path x - s - y is specular at s where its optical length L(s) = n₁ |x - s| + n₂ |y - s| is stationary on the surface:
//! the tangential part of n₁ ω₁ + n₂ ω₂ is zero, which is the half-vector constraint of specular manifold sampling [Zeltner,
//! Georgiev & Jakob 2020, sec. 3], not normalised. In the tangent plane at s, with K the surface's second fundamental form,
//!
//! ∇L = -(n₁ ω₁ + n₂ ω₂)·t,   H = n₁ (1 - ω₁ω₁ᵀ)/r₁ + n₂ (1 - ω₂ω₂ᵀ)/r₂ - (n₁ ω₁ + n₂ ω₂)·n K.
//!
//! Parallel light has 1/r₂ = 0. The tangential part of the exact continuation of x - s is off the light's direction by
//! ∇L/n₂, so that directions at x and mismatches at s are related by |dω₁/dω₂| = n₂² c₁ c₂/(r₁² |det H|), c₁ and c₂ the
//! cosines at s: what the delta of the surface leaves when it is integrated (derived here). Folds are where det H = 0;
//! across one its sign changes, so the two solutions that meet there differ in it.

use glam::DVec3;

use crate::geometry::manifold::{Frame, Manifold};

/// The light's end of a path.
#[derive(Clone, Copy, Debug)]
pub(super) enum Source {
    /// A point [m].
    Point(DVec3),
    /// Parallel light: the unit direction towards it.
    Distant(DVec3),
}

/// The ends of a path with one specular point between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    /// The floor point.
    pub x: DVec3,
    /// The light.
    pub source: Source,
    /// n₁, of which n₂ = 1.
    pub index: f64,
}

/// A stationary point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solution {
    /// s [m].
    pub point: DVec3,
    /// det H [1/m²].
    pub determinant: f64,
    /// r₁ [m].
    pub distance: f64,
}

/// When a walk ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precision {
    /// A solution is where the next step is at most this part of r₁.
    pub last_step: f64,
    /// Solutions are the same if they are no farther from each other than this part of r₁, and their determinants have
    /// the same sign.
    pub same: f64,
}

/// A solution is exact to rounding where Newton's method converges at all. Different solutions of the same sign are nearer
/// than `same` only around a cusp, on 1e-35 of the floor.
pub(super) const EXACT: Precision = Precision {
    last_step: 1e-11,
    same: 1e-7,
};

/// Steps of a walk. A walk that takes longer fails, as one that leaves the surface: that only makes solutions less likely to
/// be found, by the same amount in every trial.
const STEPS: usize = 30;

impl Solution {
    /// Whether two walks found the same.
    pub fn is(&self, other: &Solution, precision: Precision) -> bool {
        let apart = self.point - other.point;
        let radius = precision.same * self.distance;
        apart.dot(apart) <= radius * radius && (self.determinant > 0.0) == (other.determinant > 0.0)
    }
}

/// Gradient, Hessian and r₁.
fn stationarity(ends: &Ends, point: DVec3, frame: &Frame) -> ([f64; 2], [f64; 3], f64) {
    let towards = |end: DVec3| {
        let d = end - point;
        let r = f64::sqrt(d.dot(d));
        (d / r, r)
    };
    let (first, r1) = towards(ends.x);
    let (second, curvature) = match ends.source {
        Source::Point(y) => {
            let (direction, r2) = towards(y);
            (direction, 1.0 / r2)
        }
        Source::Distant(direction) => (direction, 0.0),
    };
    let n1 = ends.index;
    let half = first * n1 + second;
    let [s, t] = frame.tangents;
    let along = half.dot(frame.normal);
    let hessian = |a: DVec3, b: DVec3, bend: f64| {
        let unit = a.dot(b);
        n1 / r1 * (unit - first.dot(a) * first.dot(b))
            + curvature * (unit - second.dot(a) * second.dot(b))
            - along * bend
    };
    let [k11, k12, k22] = frame.bends;
    let gradient = [-half.dot(s), -half.dot(t)];
    (
        gradient,
        [hessian(s, s, k11), hessian(s, t, k12), hessian(t, t, k22)],
        r1,
    )
}

/// Walks from a point of the surface to a stationary point; `None` if that does not end well.
pub(super) fn walk(
    surface: &dyn Manifold,
    ends: &Ends,
    start: DVec3,
    precision: Precision,
) -> Option<Solution> {
    let mut point = start;
    for _ in 0..STEPS {
        let frame = surface.frame(point);
        let ([g1, g2], [h11, h12, h22], r1) = stationarity(ends, point, &frame);
        let determinant = h11 * h22 - h12 * h12;
        let a = (h12 * g2 - h22 * g1) / determinant;
        let b = (h12 * g1 - h11 * g2) / determinant;
        let length = f64::sqrt(a * a + b * b);
        if length <= precision.last_step * r1 {
            return Some(Solution {
                point,
                determinant,
                distance: r1,
            });
        }
        if !length.is_finite() {
            return None;
        }
        // No step longer than half of the way to the floor point: the surface is not flat.
        let scale = f64::min(1.0, 0.5 * r1 / length);
        let [s, t] = frame.tangents;
        point = surface.step(point, s * (a * scale) + t * (b * scale))?;
    }
    None
}
