//! What a camera ray sees in a spherical mirror: the receiver point that it reaches after one reflection.

use super::{Side, SphereMirror};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// A receiver point seen in the mirror.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Where the ray meets the mirror [m].
    pub first_hit: Vec3<S>,
    /// The receiver point [m].
    pub receiver: Vec3<S>,
    /// Bound of the rounding error of the receiver point [m].
    pub error: S,
}

impl<S: Scalar> SphereMirror<S> {
    /// The receiver point that the ray from `camera` through `aim` reaches after one reflection at the front of the mirror;
    /// `None` if the ray passes the mirror, meets its back first, does not come down, or meets the mirror again.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>) -> Option<Seen<S>> {
        let start = self.scaled(camera);
        let length = (aim - camera).length();
        let ray = (aim - camera) * (S::ONE / length);
        let across = start.cross(ray).length();
        if !(across < S::ONE) {
            return None;
        }
        let half = ((S::ONE - across) * (S::ONE + across)).sqrt();
        let ahead = -start.dot(ray);
        let met = |t: S| t > S::ZERO && self.on_cap(start + ray * t) >= S::ZERO;
        let (enter, exit) = (ahead - half, ahead + half);
        let to_hit = match self.side {
            Side::Concave if met(exit) && !met(enter) => exit,
            Side::Convex if met(enter) => enter,
            _ => return None,
        };
        let normal = (start + ray * to_hit).normalized();
        let cosine = ray.dot(normal);
        let reflected = ray - normal * (S::TWO * cosine);
        let height = normal.z - (self.receiver_z - self.centre.z) / self.radius;
        if !(reflected.z < S::ZERO && height >= S::ZERO) {
            return None;
        }
        let rest = height / -reflected.z;
        let chord = S::TWO * half;
        let again = self.side == Side::Concave
            && rest > chord
            && self.on_cap(normal + reflected * chord) >= S::ZERO;
        if again {
            return None;
        }
        let point = self.centre + (normal + reflected * rest) * self.radius;
        let size = camera.length() + aim.length() + self.scale(point);
        // The hit is displaced by the aim's error times to_hit/cos i, and the reflected leg turned by twice that.
        let aimed = (S::ONE + to_hit * self.radius / length) / half;
        let turned = S::ONE + S::TWO * rest + rest * self.radius / length;
        let slant = S::ONE / -reflected.z;
        Some(Seen {
            first_hit: self.centre + normal * self.radius,
            receiver: vec3(point.x, point.y, self.receiver_z),
            error: S::EPSILON * S::from_f64(8.0) * size * aimed * turned * (S::ONE + slant),
        })
    }
}
