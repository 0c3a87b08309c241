//! The caustic on the floor, along the light's own lines.
//!
//! Light that meets the wall at angle φ lands on the straight segment a e^{iφ} - τ e^{2iφ}, 0 < τ < height / tan ε, with
//! flux density E₀ R sin ε a cos φ per dφ dτ [theory/scenes.md, section G]. The film's area element along a line has a
//! closed form, so a pixel is one integral over φ, whose integrand knows no fold and no cusp. It is analytic between the φ
//! at which the line passes through a corner of the footprint, or an end of the segment crosses an edge. The variable is
//! t = tan(φ/2), which makes everything rational.

use crate::camera::Bounded;
use crate::pixel::cup::CupImage;
use crate::pixel::floor_polygon::FloorPolygon;
use crate::pixel::quartic::{Few, Trigonometric};

/// cos φ, sin φ, cos 2φ, sin 2φ and dφ/dt at t = tan(φ/2).
#[inline(always)]
pub(super) fn angles(t: f64) -> ([f64; 2], [f64; 2], f64) {
    let scale = 1.0 / (1.0 + t * t);
    let (c, s) = ((1.0 - t * t) * scale, 2.0 * t * scale);
    ([c, s], [(c - s) * (c + s), 2.0 * s * c], 2.0 * scale)
}

impl CupImage {
    /// The φ whose lines pass through `x`: y cos 2φ - x sin 2φ + a sin φ = 0.
    pub(super) fn lines_through(&self, x: [f64; 2]) -> Trigonometric {
        Trigonometric {
            sin2: -x[0],
            cos2: x[1],
            sin1: self.radius,
            ..Trigonometric::default()
        }
    }

    /// The φ whose segments' far ends lie on the line m·x = k.
    pub(super) fn ends_on(&self, m: [f64; 2], k: f64) -> Trigonometric {
        Trigonometric {
            sin2: -self.reach * m[1],
            cos2: -self.reach * m[0],
            ..self.feet_on(m, k)
        }
    }

    /// The φ whose wall points lie on the line m·x = k.
    pub(super) fn feet_on(&self, m: [f64; 2], k: f64) -> Trigonometric {
        Trigonometric {
            sin1: self.radius * m[1],
            cos1: self.radius * m[0],
            constant: -k,
            ..Trigonometric::default()
        }
    }

    /// Mean caustic radiance over the film area of a footprint, times that area.
    pub(super) fn caustic(&self, footprint: &FloorPolygon, tolerance: f64) -> Bounded {
        let mut sum = Bounded::default();
        let [x, y] = footprint.center;
        if libm::hypot(x, y) > self.radius + footprint.radius {
            return sum;
        }
        let mut cuts = Few::default();
        cuts.push(-self.limit, 0);
        cuts.push(self.limit, 0);
        for &c in &footprint.corners {
            self.lines_through(c).roots(self.limit, 0, &mut cuts);
        }
        for e in &footprint.edges {
            let ends = self.ends_on(e.normal, e.offset);
            ends.roots(self.limit, 0, &mut cuts);
            let feet = self.feet_on(e.normal, e.offset);
            feet.roots(self.limit, 0, &mut cuts);
        }
        cuts.sort();
        let strength = self.direct * self.reflectance * self.radius;
        let clipped = |t: f64| {
            let ([c, s], [c2, s2], _) = angles(t);
            let from = [self.radius * c, self.radius * s];
            footprint.clip(from, [-c2, -s2], 0.0, self.reach)
        };
        let mut flux = |t: f64| {
            let ([c, s], [c2, s2], dphi) = angles(t);
            let from = [self.radius * c, self.radius * s];
            let Some(([t0, t1], _)) = footprint.clip(from, [-c2, -s2], 0.0, self.reach) else {
                return Bounded::default();
            };
            let at = |tau: f64| {
                self.projection
                    .depth([from[0] - tau * c2, from[1] - tau * s2])
            };
            let area = self.projection.along(t1 - t0, [at(t0), at(t1)]);
            Bounded {
                value: strength * c * dphi * area,
                error: 0.0,
            }
        };
        for pair in cuts.as_slice().windows(2) {
            let (low, high) = (pair[0].0, pair[1].0);
            if clipped(0.5 * (low + high)).is_some() {
                let part = self.line.integrate(low, high, tolerance, &mut flux);
                sum.value += part.value;
                sum.error += part.error;
            }
        }
        sum
    }
}
