//! What of a spherical mirror is lit and seen: the cap, and its shadow.

use super::{Light, Setting, Side, SphereMirror};
use crate::kinds::{Estimate, rounding_error};
use crate::scalar::Scalar;
use crate::vector::Vec3;

impl<S: Scalar> SphereMirror<S> {
    /// By how much a direction from the centre is on the cap, negative off it.
    pub(super) fn on_cap(&self, normal: Vec3<S>) -> S {
        if self.cap_cos_min <= -S::ONE {
            S::ONE / S::ZERO
        } else {
            normal.dot(self.cap_axis) - self.cap_cos_min
        }
    }

    /// By how much a segment from `start`, in units of the radius, along a unit vector over `length` passes the cap,
    /// negative if it meets it.
    fn clearance(&self, start: Vec3<S>, direction: Vec3<S>, length: S) -> S {
        let across = start.cross(direction).length();
        let ahead = -start.dot(direction);
        if across >= S::ONE {
            return across - S::ONE;
        }
        let half = ((S::ONE - across) * (S::ONE + across)).sqrt();
        let past = |t: S| {
            let off = -self.on_cap(start + direction * t);
            (-t).max(t - length).max(off)
        };
        past(ahead - half).min(past(ahead + half))
    }

    /// The smallest of all amounts by which a mirror point is on the cap, above the receiver, and in free view of the light
    /// and of the receiver point, in units of the radius.
    pub(super) fn margin(&self, setting: &Setting<S>, normal: Vec3<S>, height: S) -> S {
        let mut margin = self.on_cap(normal).min(height);
        if self.side == Side::Concave {
            // The legs leave the mirror inwards: start at the far end of the chord, where they can meet the cap again.
            let to_source = if setting.far {
                (setting.source, S::ONE / S::ZERO)
            } else {
                let leg = setting.source - normal;
                (leg.normalized(), leg.length())
            };
            let leg = setting.receiver - normal;
            for (direction, length) in [to_source, (leg.normalized(), leg.length())] {
                let chord = -S::TWO * normal.dot(direction);
                let off = -self.on_cap(normal + direction * chord);
                margin = margin.min((chord - length).max(off));
            }
        }
        margin
    }

    /// Direct irradiance at the receiver point `x`, in the shadow of the mirror or not [W/m²].
    pub fn direct(&self, x: Vec3<S>) -> Estimate<S> {
        let setting = self.setting(x);
        let (free, direction, length) = match self.light {
            Light::Point {
                position,
                intensity,
            } => {
                let leg = setting.source - setting.receiver;
                let e = crate::kinds::diffuse::direct(position, intensity, x);
                (e, leg.normalized(), leg.length())
            }
            Light::Beam {
                direction,
                irradiance,
            } => {
                let mut sum = Estimate::NONE;
                if direction.z < S::ZERO {
                    sum.add(-direction.z * irradiance, S::ONE / -direction.z);
                }
                (sum, -direction, S::ONE / S::ZERO)
            }
        };
        let clearance = self.clearance(setting.receiver, direction, length);
        let noise = rounding_error(self.scale(x) / self.radius, S::ZERO);
        let mut sum = if clearance >= -noise {
            free
        } else {
            Estimate::NONE
        };
        if clearance.abs() <= noise {
            sum.error += free.value;
        }
        sum
    }
}
