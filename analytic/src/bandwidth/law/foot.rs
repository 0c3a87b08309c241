//! The foot of a wall that stands on the floor, under a bandwidth linked to the way along the exact ray.
//!
//! At the height h above the foot an exact ray that comes down is on the floor after d = h/σ, so that the kernel of the angle
//! atan(r/d) opens to a half-space as h → 0, and connects with any floor point that is within a right angle of the ray. With h = σ r t
//! the angle is atan(1/t), whatever r. The weight of the mean has the cosine at the floor point, h/r₁, and is w' h there; its
//! second moment is w₂' h², and with a parameter a along the foot
//!
//! ```text
//! mean = r² ∫ w' σ² da ∫ t φ(g, atan(1/t)) dt + O(r³),    second moment = r³ ∫ w₂' σ³ da ∫ t² φ(g, atan(1/t))² dt + O(r⁴)
//! ```
//!
//! g the angle between the exact ray at the foot and the way to the floor point, over all t for which φ is not zero. For a cone, with
//! T = cot g,
//!
//! ```text
//! ∫ t φ dt = (T²/2 + T⁴/4 + (T (2T² + 1) √(1 + T²) − asinh T)/8) / 2π
//! ```
//!
//! A lit point has this in addition to what its perfect paths give; a dark one is not dark any more. Derived here.
//! **Accuracy**: 1e-6 relative, tested against the exact expectations.

use libm::{asin, cos, sin, sqrt};

use super::family::Map;
use crate::bandwidth::Kernel;
use crate::bandwidth::kernel::{cone_height, epanechnikov_height, von_mises_fisher};
use crate::quadrature::gauss_legendre;

/// Coefficients of r² in the mean and of r³ in the second moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Foot {
    pub mean: f64,
    pub squared: f64,
}

/// Pieces of the foot, at first: what is lit ends at tangents, which are met by halving.
const PIECES: u32 = 32;
/// Halvings of a piece at whose ends the path exists or not.
const HALVINGS: u32 = 24;
/// Height at which a foot is looked at, in heights of the wall.
const LOW: f64 = 1e-7;

/// Whether the linked distance vanishes along the lower border of the second parameter, and nowhere else on the border; `Err` where it
/// vanishes elsewhere.
pub(super) fn stands(map: &Map<'_>) -> Result<bool, ()> {
    let [a, b] = map.domain();
    let mut foot = false;
    for k in 0..=32 {
        let t = f64::from(k) / 32.0;
        let [x, y] = [a, b].map(|[low, high]| low + (high - low) * t);
        let vanishes = |u| f64::abs(map.linked_distance(u)) < 1e-9;
        foot |= vanishes([x, b[0]]);
        let above = y > b[0] && (vanishes([a[0], y]) || vanishes([a[1], y]));
        if vanishes([x, b[1]]) || above {
            return Err(());
        }
    }
    Ok(foot)
}

/// The share of the foot.
pub(super) fn share(map: &Map<'_>, kernel: Kernel) -> Foot {
    let [[low, high], _] = map.domain();
    let rule = gauss_legendre(8);
    let mut sum = Foot::default();
    let width = (high - low) / f64::from(PIECES);
    let mut pieces: Vec<_> = (0..PIECES)
        .map(|k| {
            let from = low + width * f64::from(k);
            ([from, from + width], 0)
        })
        .collect();
    while let Some(([from, to], depth)) = pieces.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let mut part = Foot::default();
        let mut inside = 0;
        for (x, weight) in &rule {
            if let Some(f) = at(map, kernel, middle + half * x) {
                inside += 1;
                part.mean += weight * half * f.mean;
                part.squared += weight * half * f.squared;
            }
        }
        if 0 < inside && inside < rule.len() && depth < HALVINGS {
            pieces.push(([from, middle], depth + 1));
            pieces.push(([middle, to], depth + 1));
        } else {
            sum.mean += part.mean;
            sum.squared += part.squared;
        }
    }
    sum
}

/// Per parameter along the foot; `None` where there is no path.
fn at(map: &Map<'_>, kernel: Kernel, a: f64) -> Option<Foot> {
    let [_, [bottom, top]] = map.domain();
    let h = LOW * (top - bottom);
    let (chord, density) = map.connection([a, bottom + h])?;
    let d = map.linked_distance([a, bottom + h]);
    if !(d > 0.0 && d.is_finite()) {
        return None;
    }
    let g = 2.0 * asin((0.5 * chord).min(1.0));
    let (scale, [first, second]) = (h / d, over_heights(kernel, g));
    Some(Foot {
        mean: density[0] / h * scale * scale * first,
        squared: density[1] / (h * h) * scale * scale * scale * second,
    })
}

/// ∫ t φ dt and ∫ t² φ² dt.
fn over_heights(kernel: Kernel, g: f64) -> [f64; 2] {
    let right = core::f64::consts::FRAC_PI_2;
    // In the angle α = atan(1/t), from where the kernel reaches g up to a right one.
    let from = match kernel {
        // exp(−k(1 − cos g)) with k = 4/α² is 1e-17 there.
        Kernel::VonMisesFisher => sin(0.5 * g) / sqrt(5.0),
        _ => g,
    };
    if !(from < right) {
        return [0.0; 2];
    }
    let half = 0.5 * (right - from);
    let mut sum = [0.0; 2];
    for (x, weight) in &gauss_legendre(48) {
        let alpha = from + half * (1.0 + x);
        let phi = match kernel {
            Kernel::VonMisesFisher => {
                let (k, n) = von_mises_fisher(alpha);
                let s = sin(0.5 * g);
                n * libm::exp(-2.0 * k * s * s)
            }
            Kernel::Epanechnikov => {
                let t = g / alpha;
                epanechnikov_height(alpha) * (1.0 - t * t)
            }
            _ => cone_height(alpha),
        };
        // dt = dα/sin²α.
        let (s, c) = (sin(alpha), cos(alpha));
        let t = c / s;
        let step = weight * half / (s * s);
        sum[0] += step * t * phi;
        sum[1] += step * t * t * phi * phi;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_over_all_heights_is_the_closed_form() {
        for g in [0.2, 0.7, 1.2, 1.5] {
            let t: f64 = cos(g) / sin(g);
            let (q, root) = (t * t, sqrt(1.0 + t * t));
            let last = (t * (2.0 * q + 1.0) * root - libm::asinh(t)) / 8.0;
            let exact = (0.5 * q + 0.25 * q * q + last) / (2.0 * core::f64::consts::PI);
            let found = over_heights(Kernel::Cone, g)[0];
            assert!((found / exact - 1.0).abs() < 1e-9, "{g} {found} {exact}");
        }
        assert_eq!(over_heights(Kernel::Epanechnikov, 1.6), [0.0; 2]);
    }
}
