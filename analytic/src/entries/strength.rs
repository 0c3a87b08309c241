//! How strong a singularity is: the coefficient of the irradiance's leading term on approach.
//!
//! Next to a fold the two roots that meet there carry E = A/√d + O(√d) at distance d on the bright side, and nothing on the
//! dark side [theory/scenes.md, 0.1]; on a line focus E = A/d + O(1) on either side. A is the limit of (E₊ - E₋)√h at the
//! points y ± h n, y the nearest point of the fold and n its normal: the light of all other roots is smooth and drops out
//! but for O(h). With the error linear in h, A ≈ (4 A(h) - A(4h))/3; of a sequence of h the two neighbours that agree best
//! are taken, and their difference is the error. Derived here.

use super::{FloorTruth, PointTruth};
use crate::camera::Bounded;
use crate::kinds::singularity::SingularityKind;

/// Steps h, as parts of the floor's half width, each a quarter of the one before.
const FIRST: f64 = 4e-3;
const STEPS: usize = 9;

impl FloorTruth {
    /// Strength of the singularity nearest to (x, y) of the class with position `index` in [`FloorTruth::at`]: A in
    /// [W m^(-3/2)] for a fold, in [W/m] for a line focus, with an estimate of its error; `None` for other singularities,
    /// for none, and where the class ends (a shadow edge next to the nearest point).
    pub fn strength(&self, x: f64, y: f64, index: usize) -> Option<Bounded> {
        let here = self.singularity(x, y, index)?;
        let power = match here.kind {
            SingularityKind::Fold => 0.5,
            SingularityKind::LineFocus => 1.0,
            _ => return None,
        };
        let [wx, wy] = self.floor.half_width;
        let size = wx.min(wy);
        let distance = |p: [f64; 2]| {
            let s = self.singularity(p[0], p[1], index)?;
            (s.kind == here.kind).then_some(s.distance)
        };
        // The normal: along which the distance grows, from the point itself or, if it is on the fold, from next to it.
        let reach = if here.distance > 1e-3 * size {
            1e-4 * here.distance
        } else {
            1e-3 * size
        };
        let slope = |e: [f64; 2]| -> Option<f64> {
            let at = |s: f64| distance([x + s * reach * e[0], y + s * reach * e[1]]);
            Some(at(1.0)? - at(-1.0)?)
        };
        let (gx, gy) = (slope([1.0, 0.0])?, slope([0.0, 1.0])?);
        let mut n = [gx, gy];
        if here.distance <= 1e-3 * size {
            // On a fold the distance is |signed distance|, and its slope says nothing: the steepest direction does.
            let mut best = 0.0;
            for k in 0..64 {
                let angle = core::f64::consts::PI * f64::from(k) / 64.0;
                let e = [libm::cos(angle), libm::sin(angle)];
                let d = distance([x + reach * e[0], y + reach * e[1]])?;
                if d > best {
                    (best, n) = (d, e);
                }
            }
        }
        let length = libm::hypot(n[0], n[1]);
        if !(length > 0.0) {
            return None;
        }
        let n = n.map(|c| c / length);
        let nearest = [x - here.distance * n[0], y - here.distance * n[1]];
        let scaled = |h: f64| -> Option<f64> {
            let side = |s: f64| {
                let t = self.class_at(nearest[0] + s * h * n[0], nearest[1] + s * h * n[1], index);
                t.map(|t| t.irradiance.value)
            };
            let (front, back) = (side(1.0)?, side(-1.0)?);
            let pair = if power == 0.5 {
                (front - back).abs()
            } else {
                0.5 * (front + back)
            };
            Some(pair * libm::pow(h, power))
        };
        let mut h = FIRST * size;
        let (mut coarse, mut before) = (scaled(h)?, None::<f64>);
        let mut best = Bounded {
            value: 0.0,
            error: f64::INFINITY,
        };
        for _ in 0..STEPS {
            h *= 0.25;
            let fine = scaled(h)?;
            let value = (4.0 * fine - coarse) / 3.0;
            if let Some(before) = before
                && (value - before).abs() < best.error
            {
                best = Bounded {
                    value,
                    error: (value - before).abs(),
                };
            }
            (coarse, before) = (fine, Some(value));
        }
        (best.value > 0.0 && best.error <= 1e-2 * best.value).then_some(best)
    }

    fn class_at(&self, x: f64, y: f64, index: usize) -> Option<PointTruth> {
        self.at(x, y).get(index).copied()
    }
}
