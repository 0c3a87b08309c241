//! The distance from a floor point to the caustic curve of a family of plan rays.
//!
//! The caustic touches every ray, so its tangent is the ray's direction d and its velocity is a multiple of it, c' = κ d.
//! The nearest point of the lit part is where (p - c)·d changes sign, a cusp (κ changes sign), or an end of the light.
//! The parameter range is searched on a grid; a feature narrower than a step of the grid can be missed.

use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::roots::bracketed;

/// Steps of the grid.
const STEPS: u32 = 512;

/// Where the caustic touches a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// The point c [m].
    pub point: (f64, f64),
    /// The direction d of the ray.
    pub direction: (f64, f64),
    /// κ = c'·d.
    pub speed: f64,
    /// Whether the walls let the ray through to the point.
    pub lit: bool,
}

impl Touch {
    fn ahead(&self, x: f64, y: f64) -> f64 {
        (x - self.point.0) * self.direction.0 + (y - self.point.1) * self.direction.1
    }
}

/// The nearest lit point of the caustic to (x, y), over the parameters from `low` to `high`; `touch` is `None` where the
/// caustic is not on the ray.
pub(super) fn nearest(
    (x, y): (f64, f64),
    (low, high): (f64, f64),
    touch: impl Fn(f64) -> Option<Touch>,
) -> Option<Singularity<f64>> {
    let mut found: Option<Singularity<f64>> = None;
    let mut try_touch = |t: Touch, kind: SingularityKind| {
        let distance = libm::hypot(x - t.point.0, y - t.point.1);
        // A cusp is a point of the curve as well: it counts as a cusp if no other point is nearer beyond rounding.
        let rounding = 1e-9 * (distance + libm::hypot(t.point.0, t.point.1));
        let nearer = found.is_none_or(|f| match (f.kind, kind) {
            (SingularityKind::Fold, SingularityKind::Cusp) => distance < f.distance + rounding,
            (SingularityKind::Cusp, SingularityKind::Fold) => distance < f.distance - rounding,
            _ => distance < f.distance,
        });
        if t.lit && nearer {
            found = Some(Singularity { kind, distance });
        }
    };
    let zero = |f: &dyn Fn(&Touch) -> f64, from: f64, to: f64| {
        // No derivative: the bracket is halved.
        let u = bracketed(|u| (touch(u).map_or(0.0, |t| f(&t)), 0.0), from, to);
        touch(u)
    };
    let mut last: Option<(f64, Touch)> = None;
    // Both ends, and between them the middles of the steps: a cusp on an axis of symmetry then lies between two.
    for n in 0..=STEPS + 1 {
        let step = (f64::from(n) - 0.5).clamp(0.0, f64::from(STEPS));
        let u = low + (high - low) * step / f64::from(STEPS);
        let now = touch(u);
        if let (Some((v, before)), Some(now)) = (last, now) {
            if (before.ahead(x, y) < 0.0) != (now.ahead(x, y) < 0.0)
                && let Some(foot) = zero(&|t| t.ahead(x, y), v, u)
            {
                try_touch(foot, SingularityKind::Fold);
            }
            if (before.speed < 0.0) != (now.speed < 0.0)
                && let Some(cusp) = zero(&|t| t.speed, v, u)
            {
                try_touch(cusp, SingularityKind::Cusp);
            }
            if before.lit != now.lit
                && let Some(end) = end_of_light(&touch, v, u, before.lit)
            {
                try_touch(end, SingularityKind::Fold);
            }
        }
        if let Some(now) = now {
            try_touch(now, SingularityKind::Fold);
        }
        last = now.map(|t| (u, t));
    }
    found
}

/// The last lit point between two parameters of which one is lit.
fn end_of_light(
    touch: impl Fn(f64) -> Option<Touch>,
    from: f64,
    to: f64,
    lit_at_from: bool,
) -> Option<Touch> {
    let (mut lit, mut dark) = if lit_at_from { (from, to) } else { (to, from) };
    for _ in 0..60 {
        let middle = 0.5 * (lit + dark);
        if touch(middle)?.lit {
            lit = middle;
        } else {
            dark = middle;
        }
    }
    touch(lit)
}
