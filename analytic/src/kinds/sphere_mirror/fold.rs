//! Where a concave mirror's caustic meets the receiver: the distance to the nearest fold, line focus or point focus.
//!
//! Two sheets: the tangential focus of each ray, 1/r1 + 1/r2 = 2/(a cos i), a surface of revolution about the axis through
//! centre and light, which the receiver cuts in folds; and the axis itself, J_s = 0, where the mirror points at
//! cos φ = (s + b)/(2 s b) reflect to the axis at b (cos φ = 1/(2b) for parallel light). A convex mirror has neither.
//!
//! The folds are searched with [`HALF_PLANES`] × [`RAYS`] rays, and every local minimum of the distance is
//! refined along the curve. A lit part of a
//! fold that is narrower than the spacing of the rays is missed.

use super::{Setting, Side, SphereMirror};
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::roots::bracketed;
use crate::vector::{Vec3, vec3};

/// Half planes through the axis with which the folds are searched.
const HALF_PLANES: u32 = 128;
/// Rays in each of them.
const RAYS: u32 = 192;
/// Mirror points of a ring that are tried.
const RING: u32 = 64;

/// The planes through the axis of centre and light.
struct Meridians {
    setting: Setting<f64>,
    axis: Vec3<f64>,
    across: Vec3<f64>,
    other: Vec3<f64>,
}

impl Meridians {
    fn normal(&self, psi: f64, omega: f64) -> Vec3<f64> {
        let radial = self.across * libm::cos(omega) + self.other * libm::sin(omega);
        self.axis * libm::cos(psi) + radial * libm::sin(psi)
    }
}

/// A point of a fold, in units of the radius: the ray and how far the point is.
#[derive(Clone, Copy)]
struct Fold {
    psi: f64,
    distance: f64,
}

impl SphereMirror<f64> {
    /// The nearest singularity of the irradiance to the receiver point `x`, of those that the mirror lights; `None` if
    /// there is none. The distance is accurate to about 1e-9 of the radius.
    pub fn singularity(&self, x: Vec3<f64>) -> Option<Singularity<f64>> {
        if self.side == Side::Convex {
            return None;
        }
        let setting = self.setting(x);
        let from_centre = setting.source.length();
        if from_centre < 1e-12 {
            return self.point_focus(&setting);
        }
        let axis = setting.source.normalized();
        let across = self.any_plane(axis);
        let meridians = Meridians {
            setting,
            axis,
            across,
            other: axis.cross(across),
        };
        Singularity::nearer(self.nearest_fold(&meridians), self.line_focus(&meridians))
    }

    /// Height of the receiver in units of the radius, from the centre.
    fn plane(&self) -> f64 {
        (self.receiver_z - self.centre.z) / self.radius
    }

    /// A light at the centre: all rays return there.
    fn point_focus(&self, setting: &Setting<f64>) -> Option<Singularity<f64>> {
        let distance = setting.receiver.length() * self.radius;
        (f64::abs(self.plane()) < 1e-12).then_some(Singularity {
            kind: SingularityKind::PointFocus,
            distance,
        })
    }

    /// Whether the mirror lights the point `target`, in units of the radius, by way of the mirror point with this normal.
    fn lights(&self, setting: &Setting<f64>, normal: Vec3<f64>, target: Vec3<f64>) -> bool {
        let height = normal.z - self.plane();
        let to_source = if setting.far {
            setting.source
        } else {
            setting.source - normal
        };
        let faces = |leg: Vec3<f64>| leg.dot(normal) < 0.0;
        let there = Setting {
            receiver: target,
            ..*setting
        };
        faces(to_source)
            && faces(target - normal)
            && self.margin(&there, normal, height) >= -16.0 * f64::EPSILON
    }

    /// Where the axis of centre and light crosses the receiver, if the ring that reflects there is lit.
    fn line_focus(&self, m: &Meridians) -> Option<Singularity<f64>> {
        let (axis, receiver) = (m.axis, m.setting.receiver);
        let b = if f64::abs(axis.z) > 1e-12 {
            self.plane() / axis.z
        } else if f64::abs(self.plane()) < 1e-12 {
            // The axis lies in the receiver: the nearest point is the foot of the perpendicular.
            receiver.dot(axis)
        } else {
            return None;
        };
        let cosine = if m.setting.far {
            0.5 / b
        } else {
            let s = m.setting.source.length();
            0.5 * (1.0 / s + 1.0 / b)
        };
        if !(f64::abs(cosine) <= 1.0) {
            return None;
        }
        let psi = libm::acos(cosine);
        let target = axis * b;
        let turn = 2.0 * core::f64::consts::PI / f64::from(RING);
        let lit = (0..RING)
            .map(|k| m.normal(psi, turn * f64::from(k)))
            .any(|normal| self.lights(&m.setting, normal, target));
        // Where the ring shrinks to a point, both sheets meet.
        let kind = if 1.0 - f64::abs(cosine) < 1e-12 {
            SingularityKind::PointFocus
        } else {
            SingularityKind::LineFocus
        };
        lit.then(|| Singularity {
            kind,
            distance: (receiver - target).length() * self.radius,
        })
    }

    /// The tangential focus of the ray at a mirror point, in units of the radius; `None` if it is virtual.
    fn tangential_focus(&self, setting: &Setting<f64>, normal: Vec3<f64>) -> Option<Vec3<f64>> {
        let (toward, power) = if setting.far {
            (setting.source, 0.0)
        } else {
            let leg = setting.source - normal;
            (leg.normalized(), 1.0 / leg.length())
        };
        let cosine = -toward.dot(normal);
        let inverse = 2.0 / cosine - power;
        (cosine > 0.0 && inverse > 0.0).then(|| {
            let reflected = -toward - normal * (2.0 * cosine);
            normal + reflected * (1.0 / inverse)
        })
    }

    /// By how much the tangential focus is above the receiver.
    fn above(&self, m: &Meridians, psi: f64, omega: f64) -> Option<f64> {
        self.tangential_focus(&m.setting, m.normal(psi, omega))
            .map(|focus| focus.z - self.plane())
    }

    /// The nearest lit fold in the half plane ω, of those between `low` and `high` in ψ.
    fn fold_in(&self, m: &Meridians, omega: f64, low: f64, high: f64, rays: u32) -> Option<Fold> {
        let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(rays);
        let sample = |psi: f64| self.above(m, psi, omega).map(|h| (psi, h));
        let mut nearest: Option<Fold> = None;
        let mut crossing = |before: f64, after: f64| {
            // No derivative: the bracket is halved.
            let f = |psi: f64| (self.above(m, psi, omega).unwrap_or(0.0), 0.0);
            let psi = bracketed(f, before, after);
            let normal = m.normal(psi, omega);
            if let Some(focus) = self.tangential_focus(&m.setting, normal) {
                let target = vec3(focus.x, focus.y, self.plane());
                let distance = (m.setting.receiver - target).length();
                if self.lights(&m.setting, normal, target)
                    && nearest.is_none_or(|n| distance < n.distance)
                {
                    nearest = Some(Fold { psi, distance });
                }
            }
        };
        let (mut first, mut second) = (None, None);
        for k in 0..=rays {
            let third = sample(at(k));
            if let (Some((p1, h1)), Some((p2, h2))) = (second, third)
                && (h1 < 0.0) != (h2 < 0.0)
            {
                crossing(p1, p2);
            }
            if let (Some((p0, h0)), Some((_, h1)), Some((p2, h2))) = (first, second, third)
                && (h0 < 0.0) == (h1 < 0.0)
                && (h1 < 0.0) == (h2 < 0.0)
                && f64::abs(h1) <= f64::min(f64::abs(h0), f64::abs(h2))
                && let Some(across) = self.other_side(m, omega, (p0, p2), h1 < 0.0)
            {
                // Two crossings between samples: the receiver nearly touches the sheet.
                crossing(p0, across);
                crossing(across, p2);
            }
            (first, second) = (second, third);
        }
        nearest
    }

    /// A ray between two whose tangential focus is on the other side of the receiver, if a search for the extremum finds one.
    fn other_side(
        &self,
        m: &Meridians,
        omega: f64,
        (mut low, mut high): (f64, f64),
        below: bool,
    ) -> Option<f64> {
        let toward = |psi: f64| {
            let h = self.above(m, psi, omega).unwrap_or(f64::INFINITY);
            if below { -h } else { h }
        };
        for _ in 0..40 {
            let third = (high - low) / 3.0;
            let (c, d) = (low + third, high - third);
            let (at_c, at_d) = (toward(c), toward(d));
            if f64::min(at_c, at_d) < 0.0 {
                return Some(if at_c < at_d { c } else { d });
            }
            if at_c < at_d {
                high = d;
            } else {
                low = c;
            }
        }
        None
    }

    fn nearest_fold(&self, m: &Meridians) -> Option<Singularity<f64>> {
        use core::f64::consts::PI;
        let step = 2.0 * PI / f64::from(HALF_PLANES);
        let at = |k: u32| self.fold_in(m, step * f64::from(k), 0.0, PI, RAYS);
        let mut nearest = f64::INFINITY;
        let far = |fold: Option<Fold>| fold.map_or(f64::INFINITY, |f| f.distance);
        let (mut before, mut here) = (at(HALF_PLANES - 1), at(0));
        for k in 0..HALF_PLANES {
            let after = at(k + 1);
            // Every local minimum, and with it every end of a lit part, is refined.
            if let Some(fold) = here
                && fold.distance <= far(before)
                && fold.distance <= far(after)
            {
                let omega = step * f64::from(k);
                nearest = nearest.min(self.refined(m, (omega, fold), step));
            }
            (before, here) = (here, after);
        }
        nearest.is_finite().then_some(Singularity {
            kind: SingularityKind::Fold,
            distance: nearest * self.radius,
        })
    }

    /// The smallest distance along a fold within `step` in ω of a point of it: golden section, where a dark part counts as
    /// infinitely far.
    fn refined(&self, m: &Meridians, (mut omega, mut fold): (f64, Fold), step: f64) -> f64 {
        let width = 2.0 * core::f64::consts::PI / f64::from(RAYS);
        let ratio = 0.5 * (libm::sqrt(5.0) - 1.0);
        let (mut a, mut b) = (omega - step, omega + step);
        for _ in 0..48 {
            let (c, d) = (b - ratio * (b - a), a + ratio * (b - a));
            let [at_c, at_d] = [c, d].map(|w| {
                let there = self.fold_in(m, w, fold.psi - width, fold.psi + width, 4);
                there.map_or(f64::INFINITY, |there| {
                    if there.distance < fold.distance {
                        (omega, fold) = (w, there);
                    }
                    there.distance
                })
            });
            // Both in the dark: towards what is known to be lit.
            if at_c < at_d || (at_c == at_d && omega < d) {
                b = d;
            } else {
                a = c;
            }
        }
        fold.distance
    }
}
