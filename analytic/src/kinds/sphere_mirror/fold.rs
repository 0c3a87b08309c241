//! Where a concave mirror's caustic meets the receiver: the distance to the nearest fold, line focus or point focus.
//!
//! Two sheets: the tangential focus of each ray, 1/r1 + 1/r2 = 2/(a cos i), a surface of revolution about the axis through
//! centre and light, which the receiver cuts in folds; and the axis itself, J_s = 0, where the mirror points at
//! cos φ = (s + b)/(2 s b) reflect to the axis at b (cos φ = 1/(2b) for parallel light). A convex mirror has neither.
//!
//! The folds are searched with [`MERIDIANS`] × [`RAYS`] rays, the nearest one is refined along the curve. A lit part of a
//! fold that is narrower than the spacing of the rays is missed.

use super::{Setting, Side, SphereMirror};
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::roots::bracketed;
use crate::vector::{Vec3, vec3};

/// Planes through the axis with which the folds are searched.
const MERIDIANS: u32 = 48;
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

    /// The nearest lit fold in one half plane after the other, of those between `low` and `high` in ψ.
    fn fold_in(&self, m: &Meridians, omega: f64, low: f64, high: f64, rays: u32) -> Option<Fold> {
        let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(rays);
        let mut nearest: Option<Fold> = None;
        let mut last: Option<(f64, f64)> = None;
        for k in 0..=rays {
            let psi = at(k);
            let here = self.above(m, psi, omega).map(|h| (psi, h));
            if let (Some((before, h0)), Some((_, h1))) = (last, here)
                && (h0 < 0.0) != (h1 < 0.0)
            {
                // No derivative: the bracket is halved.
                let f = |w: f64| (self.above(m, w, omega).unwrap_or(0.0), 0.0);
                let root = bracketed(f, before, psi);
                let normal = m.normal(root, omega);
                if let Some(focus) = self.tangential_focus(&m.setting, normal) {
                    let target = vec3(focus.x, focus.y, self.plane());
                    let distance = (m.setting.receiver - target).length();
                    if self.lights(&m.setting, normal, target)
                        && nearest.is_none_or(|n| distance < n.distance)
                    {
                        nearest = Some(Fold {
                            psi: root,
                            distance,
                        });
                    }
                }
            }
            last = here;
        }
        nearest
    }

    fn nearest_fold(&self, m: &Meridians) -> Option<Singularity<f64>> {
        use core::f64::consts::PI;
        let step = PI / f64::from(MERIDIANS);
        // ψ of both signs and half a turn in ω: each half plane once. The grid is off the paraxial ray ψ = 0.
        let (low, high) = (-PI + 1e-3, PI + 1e-3);
        let found = (0..MERIDIANS)
            .filter_map(|k| {
                let omega = step * f64::from(k);
                self.fold_in(m, omega, low, high, RAYS)
                    .map(|fold| (omega, fold))
            })
            .min_by(|a, b| a.1.distance.total_cmp(&b.1.distance))?;
        // Golden section along the curve; outside the lit part the distance counts as infinite.
        let width = 2.0 * PI / f64::from(RAYS);
        let (mut a, mut b) = (found.0 - step, found.0 + step);
        let mut psi = found.1.psi;
        let mut best = found.1.distance;
        let ratio = 0.5 * (libm::sqrt(5.0) - 1.0);
        for _ in 0..48 {
            let (c, d) = (b - ratio * (b - a), a + ratio * (b - a));
            let mut at = |omega: f64| {
                let fold = self.fold_in(m, omega, psi - width, psi + width, 4);
                fold.map_or(f64::INFINITY, |fold| {
                    if fold.distance < best {
                        (best, psi) = (fold.distance, fold.psi);
                    }
                    fold.distance
                })
            };
            let (at_c, at_d) = (at(c), at(d));
            if at_c < at_d {
                b = d;
            } else {
                a = c;
            }
        }
        Some(Singularity {
            kind: SingularityKind::Fold,
            distance: best * self.radius,
        })
    }
}
