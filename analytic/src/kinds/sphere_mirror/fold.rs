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
use crate::vector::{Vec3, vec3};

/// Half planes through the axis with which the folds are searched.
const HALF_PLANES: u32 = 128;
/// Rays in each of them.
const RAYS: u32 = 192;
/// Mirror points of a ring that are tried.
const RING: u32 = 64;

/// The planes through the axis of centre and light.
#[derive(Clone, Copy, Debug)]
struct Meridians {
    /// The light; the receiver point is of no account.
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

/// A point of a fold in a half plane, in units of the radius: its ray, where it is, and whether the mirror lights it.
#[derive(Clone, Copy, Debug)]
struct Fold {
    psi: f64,
    at: Vec3<f64>,
    lit: bool,
}

/// The caustic of a mirror on its receiver, made ready for many points.
///
/// The folds belong to the scene: their points in all half planes are found once. What a receiver point adds is which of them
/// is nearest, and the refinement from there.
#[derive(Clone, Debug)]
pub struct SphereCaustic {
    mirror: SphereMirror<f64>,
    shape: Shape,
}

#[derive(Clone, Debug)]
enum Shape {
    /// A convex mirror has no caustic.
    Nothing,
    /// The light is at the centre: all rays return there, if that is on the receiver.
    PointFocus,
    Sheets {
        meridians: Meridians,
        /// The folds in each half plane.
        folds: Vec<Vec<Fold>>,
    },
}

impl SphereCaustic {
    /// Samples the folds.
    pub fn new(mirror: &SphereMirror<f64>) -> Self {
        let setting = mirror.setting(mirror.centre);
        let shape = if mirror.side == Side::Convex {
            Shape::Nothing
        } else if setting.source.length() < 1e-12 {
            if f64::abs(mirror.plane()) < 1e-12 {
                Shape::PointFocus
            } else {
                Shape::Nothing
            }
        } else {
            let axis = setting.source.normalized();
            let across = mirror.any_plane(axis);
            let meridians = Meridians {
                setting,
                axis,
                across,
                other: axis.cross(across),
            };
            let step = 2.0 * core::f64::consts::PI / f64::from(HALF_PLANES);
            let folds = (0..HALF_PLANES).map(|k| {
                let omega = step * f64::from(k);
                let mut found = vec![];
                mirror.for_each_fold(&meridians, omega, (0.0, core::f64::consts::PI), RAYS, |f| {
                    found.push(f)
                });
                found
            });
            Shape::Sheets {
                meridians,
                folds: folds.collect(),
            }
        };
        SphereCaustic {
            mirror: *mirror,
            shape,
        }
    }

    /// The nearest singularity of the irradiance to the receiver point `x`, of those that the mirror lights; `None` if
    /// there is none. The distance is accurate to about 1e-9 of the radius.
    pub fn nearest(&self, x: Vec3<f64>) -> Option<Singularity<f64>> {
        let receiver = self.mirror.scaled(x);
        match &self.shape {
            Shape::Nothing => None,
            Shape::PointFocus => Some(Singularity {
                kind: SingularityKind::PointFocus,
                distance: receiver.length() * self.mirror.radius,
            }),
            Shape::Sheets { meridians, folds } => Singularity::nearer(
                self.mirror.nearest_fold(meridians, folds, receiver),
                self.mirror.line_focus(meridians, receiver),
            ),
        }
    }
}

impl SphereMirror<f64> {
    /// As [`SphereCaustic::nearest`], for one point.
    pub fn singularity(&self, x: Vec3<f64>) -> Option<Singularity<f64>> {
        SphereCaustic::new(self).nearest(x)
    }

    /// Height of the receiver in units of the radius, from the centre.
    fn plane(&self) -> f64 {
        (self.receiver_z - self.centre.z) / self.radius
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
    fn line_focus(&self, m: &Meridians, receiver: Vec3<f64>) -> Option<Singularity<f64>> {
        let axis = m.axis;
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

    /// Visits the folds in the half plane ω, of those between two angles ψ.
    fn for_each_fold(
        &self,
        m: &Meridians,
        omega: f64,
        (low, high): (f64, f64),
        rays: u32,
        mut visit: impl FnMut(Fold),
    ) {
        let at = |k: u32| low + (high - low) * f64::from(k) / f64::from(rays);
        let sample = |psi: f64| self.above(m, psi, omega).map(|h| (psi, h));
        let mut crossing = |before: (f64, f64), after: (f64, f64)| {
            let psi = false_position(|psi| self.above(m, psi, omega), before, after);
            let normal = m.normal(psi, omega);
            if let Some(focus) = self.tangential_focus(&m.setting, normal) {
                let at = vec3(focus.x, focus.y, self.plane());
                let lit = self.lights(&m.setting, normal, at);
                visit(Fold { psi, at, lit });
            }
        };
        let (mut first, mut second) = (None::<(f64, f64)>, None::<(f64, f64)>);
        for k in 0..=rays {
            let third = sample(at(k));
            if let (Some(before), Some(after)) = (second, third)
                && (before.1 < 0.0) != (after.1 < 0.0)
            {
                crossing(before, after);
            }
            if let (Some((p0, h0)), Some((_, h1)), Some((p2, h2))) = (first, second, third)
                && (h0 < 0.0) == (h1 < 0.0)
                && (h1 < 0.0) == (h2 < 0.0)
                && f64::abs(h1) <= f64::min(f64::abs(h0), f64::abs(h2))
                && let Some(across) = self.other_side(m, omega, (p0, p2), h1 < 0.0)
            {
                // Two crossings between samples: the receiver nearly touches the sheet.
                crossing((p0, h0), across);
                crossing(across, (p2, h2));
            }
            (first, second) = (second, third);
        }
    }

    /// A ray between two whose tangential focus is on the other side of the receiver, if a search for the extremum finds one.
    fn other_side(
        &self,
        m: &Meridians,
        omega: f64,
        (mut low, mut high): (f64, f64),
        below: bool,
    ) -> Option<(f64, f64)> {
        let toward = |psi: f64| {
            let h = self.above(m, psi, omega).unwrap_or(f64::INFINITY);
            if below { -h } else { h }
        };
        for _ in 0..40 {
            let third = (high - low) / 3.0;
            let (c, d) = (low + third, high - third);
            let (at_c, at_d) = (toward(c), toward(d));
            if f64::min(at_c, at_d) < 0.0 {
                let (psi, h) = if at_c < at_d { (c, at_c) } else { (d, at_d) };
                return Some((psi, if below { -h } else { h }));
            }
            if at_c < at_d {
                high = d;
            } else {
                low = c;
            }
        }
        None
    }

    /// The nearest lit one of the folds whose samples are given.
    ///
    /// Every local minimum of the distance among the samples, and with it every end of a lit part, is refined, but for
    /// those that cannot win: up to the next half plane a fold does not go twice as far as to the farthest fold there.
    fn nearest_fold(
        &self,
        m: &Meridians,
        folds: &[Vec<Fold>],
        receiver: Vec3<f64>,
    ) -> Option<Singularity<f64>> {
        let near = |fold: &Fold| (*fold, (receiver - fold.at).length());
        let samples: Vec<_> = folds
            .iter()
            .map(|plane| {
                let lit = plane.iter().filter(|fold| fold.lit).map(near);
                lit.min_by(|a, b| a.1.total_cmp(&b.1))
            })
            .collect();
        let count = samples.len();
        let mut minima: Vec<_> = (0..count)
            .filter_map(|k| {
                let (here, distance) = samples[k]?;
                let sides = [(k + count - 1) % count, (k + 1) % count];
                let far = |side: usize| samples[side].map_or(f64::INFINITY, |s| s.1);
                if sides.iter().any(|&side| far(side) < distance) {
                    return None;
                }
                // Lit or dark, whichever of them continues this one.
                let way = |side: usize| {
                    let lengths = folds[side].iter().map(|f| (f.at - here.at).length());
                    lengths.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
                };
                let way = sides.into_iter().map(way).fold(0.0, f64::max);
                Some((k, here, distance, distance - 2.0 * way))
            })
            .collect();
        minima.sort_by(|a, b| a.2.total_cmp(&b.2));
        let step = 2.0 * core::f64::consts::PI / count as f64;
        let mut nearest = f64::INFINITY;
        for (k, here, distance, least) in minima {
            if least < nearest {
                let start = (step * k as f64, here.psi, distance);
                nearest = nearest.min(self.refined(m, receiver, start, step));
            }
        }
        nearest.is_finite().then_some(Singularity {
            kind: SingularityKind::Fold,
            distance: nearest * self.radius,
        })
    }

    /// The smallest distance along a fold within `step` in ω of a point of it: golden section, where a dark part counts as
    /// infinitely far.
    fn refined(
        &self,
        m: &Meridians,
        receiver: Vec3<f64>,
        (mut omega, mut psi, mut best): (f64, f64, f64),
        step: f64,
    ) -> f64 {
        let width = 2.0 * core::f64::consts::PI / f64::from(RAYS);
        let ratio = 0.5 * (libm::sqrt(5.0) - 1.0);
        let (mut a, mut b) = (omega - step, omega + step);
        let mut at = |w: f64, omega: &mut f64| {
            let mut distance = f64::INFINITY;
            self.for_each_fold(m, w, (psi - width, psi + width), 4, |fold| {
                let there = (receiver - fold.at).length();
                if fold.lit && there < distance {
                    distance = there;
                    if there < best {
                        (best, psi, *omega) = (there, fold.psi, w);
                    }
                }
            });
            distance
        };
        let (mut c, mut d) = (b - ratio * (b - a), a + ratio * (b - a));
        let (mut at_c, mut at_d) = (at(c, &mut omega), at(d, &mut omega));
        for _ in 0..48 {
            // Both in the dark: towards what is known to be lit.
            if at_c < at_d || (at_c == at_d && omega < d) {
                (b, d, at_d) = (d, c, at_c);
                c = b - ratio * (b - a);
                at_c = at(c, &mut omega);
            } else {
                (a, c, at_c) = (c, d, at_d);
                d = a + ratio * (b - a);
                at_d = at(d, &mut omega);
            }
        }
        best
    }
}

/// The zero of a function between two points at which it has different signs: false position, where the value at an end that
/// stays is halved (M. Dowell & P. Jarratt, BIT 11, 168-174, 1971, "Illinois"). A value that is missing counts as zero.
fn false_position(f: impl Fn(f64) -> Option<f64>, low: (f64, f64), high: (f64, f64)) -> f64 {
    let ((mut a, mut at_a), (mut b, mut at_b)) = (low, high);
    for _ in 0..64 {
        let x = b - at_b * (b - a) / (at_b - at_a);
        let value = f(x).unwrap_or(0.0);
        if (value < 0.0) != (at_b < 0.0) {
            (a, at_a) = (b, at_b);
        } else {
            at_a *= 0.5;
        }
        (b, at_b) = (x, value);
        if value == 0.0 || f64::abs(b - a) <= 4.0 * f64::EPSILON * f64::abs(b) {
            break;
        }
    }
    b
}
