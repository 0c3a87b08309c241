//! The domain of integration in polar coordinates: an intersection of half-planes seen from a centre.
//!
//! The mirror's edges, the receiver's horizon, the floor's edges and the lit region are all half-planes, so the domain is
//! convex and a radial line meets it in one interval, wherever the centre is. It may be unbounded.

use libm::{atan2, sqrt};

use super::quadrature::Ends;

const PI: f64 = core::f64::consts::PI;

/// The points ξ with n·ξ ≤ h, |n| = 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfPlane {
    /// Unit normal, outwards.
    pub n: [f64; 2],
    /// Signed distance of the centre from the border, positive inside.
    pub h: f64,
}

impl HalfPlane {
    /// From a normal of any length; `None` if it has no direction, when the condition is constant.
    pub fn new(n: [f64; 2], h: f64) -> Option<HalfPlane> {
        let length = sqrt(n[0] * n[0] + n[1] * n[1]);
        (length > 1e-300).then(|| HalfPlane {
            n: [n[0] / length, n[1] / length],
            h: h / length,
        })
    }
}

/// A convex domain about a centre.
#[derive(Clone, Debug, Default)]
pub(super) struct Domain {
    half_planes: Vec<HalfPlane>,
    empty: bool,
}

impl Domain {
    /// Adds the condition n·ξ ≤ h.
    pub fn cut(&mut self, n: [f64; 2], h: f64) {
        match HalfPlane::new(n, h) {
            Some(p) => self.half_planes.push(p),
            None => self.empty |= !(h >= 0.0),
        }
    }

    /// The intersection with another domain about the same centre.
    pub fn and(&self, other: &Domain) -> Domain {
        let mut both = self.clone();
        both.half_planes.extend_from_slice(&other.half_planes);
        both.empty |= other.empty;
        both
    }

    /// Signed distance of the centre from the nearest border, positive inside; infinite without borders.
    pub fn room(&self) -> f64 {
        let room = self.half_planes.iter().map(|p| p.h);
        room.fold(f64::INFINITY, f64::min)
    }

    /// Whether nothing of the domain is within a distance of the centre (it may also be found later to be empty).
    pub fn is_beyond(&self, radius: f64) -> bool {
        self.empty || self.half_planes.iter().any(|p| !(p.h > -radius))
    }

    /// Whether the whole disc of a radius about the centre belongs to the domain.
    pub fn contains_disc(&self, radius: f64) -> bool {
        !self.empty && self.half_planes.iter().all(|p| p.h >= radius)
    }

    /// The interval of radii along the direction (c, s), the outer end possibly infinite.
    pub fn interval(&self, c: f64, s: f64) -> Option<(f64, f64)> {
        if self.empty {
            return None;
        }
        let (mut low, mut high) = (0.0_f64, f64::INFINITY);
        for p in &self.half_planes {
            let along = p.n[0] * c + p.n[1] * s;
            if along > 0.0 {
                high = high.min(p.h / along);
            } else if along < 0.0 {
                low = low.max(p.h / along);
            } else if p.h < 0.0 {
                return None;
            }
        }
        (low < high).then_some((low, high))
    }

    /// Azimuths between which the interval's ends are each on one border: those of the corners, and, for an unbounded
    /// domain, those along its borders. Ascending, each with the next (cyclically) bounding a piece; pieces in which the
    /// domain is not seen are left out.
    pub fn pieces(&self) -> Vec<(f64, f64)> {
        let mut breaks: Vec<f64> = Vec::new();
        let n = self.half_planes.len();
        let scale = self
            .half_planes
            .iter()
            .map(|p| p.h.abs())
            .fold(0.0, f64::max);
        let mut corners = 0;
        for i in 0..n {
            for j in i + 1..n {
                let (a, b) = (&self.half_planes[i], &self.half_planes[j]);
                let det = a.n[0] * b.n[1] - a.n[1] * b.n[0];
                if !(det.abs() > 1e-14) {
                    continue;
                }
                let x = (a.h * b.n[1] - b.h * a.n[1]) / det;
                let y = (a.n[0] * b.h - b.n[0] * a.h) / det;
                let inside = self
                    .half_planes
                    .iter()
                    .all(|p| p.n[0] * x + p.n[1] * y - p.h <= 1e-12 * (scale + x.abs() + y.abs()));
                if inside {
                    corners += 1;
                    breaks.push(atan2(y, x));
                }
            }
        }
        if corners < 3 {
            for p in &self.half_planes {
                let w = atan2(p.n[1], p.n[0]);
                for turned in [w - 0.5 * PI, w + 0.5 * PI] {
                    breaks.push(if turned > PI {
                        turned - 2.0 * PI
                    } else if turned < -PI {
                        turned + 2.0 * PI
                    } else {
                        turned
                    });
                }
            }
        }
        if breaks.is_empty() {
            breaks.extend([-PI, 0.0]);
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b < 1e-15);
        let first = breaks[0];
        breaks.push(first + 2.0 * PI);
        let mut pieces = Vec::new();
        for w in breaks.windows(2) {
            // Never more than a quarter turn, so that a piece is at most one side of a smooth curve.
            let count = libm::ceil((w[1] - w[0]) / (0.5 * PI + 1e-9)).max(1.0);
            for k in 0..count as usize {
                let at = |k: usize| w[0] + (w[1] - w[0]) * (k as f64 / count);
                let (a, b) = (at(k), at(k + 1));
                let (s, c) = libm::sincos(0.5 * (a + b));
                if b > a && self.interval(c, s).is_some() {
                    pieces.push((a, b));
                }
            }
        }
        pieces
    }
}

/// Pieces with smooth ends.
pub(super) fn smooth(pieces: &[(f64, f64)]) -> Vec<(f64, f64, Ends)> {
    pieces.iter().map(|&(a, b)| (a, b, Ends::Smooth)).collect()
}
