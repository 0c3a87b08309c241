//! The floor seen through the waves by a camera above them.
//!
//! A camera ray meets the surface where g = z - H - ζ(x) first vanishes along it: the smallest root, isolated from the bound
//! Σ|A|k² of ζ''. There it is refracted in space, t = d/n + (cos i/n - cos t) N, and goes on to the floor, unless it meets
//! the surface again from below. The radiance arrives with the factor T/n². Theory §0.4.

use super::WaterWaves;
use crate::kinds::rounding_error;
use crate::optics::fresnel_transmittance;
use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// A floor point seen through the surface.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Where the ray meets the surface [m].
    pub first_hit: Vec3<S>,
    /// The floor point [m].
    pub floor: Vec3<S>,
    /// Fresnel transmittance T.
    pub transmittance: S,
    /// Radiance factor T/n².
    pub weight: S,
    /// Relative change of `weight` per relative change of the inputs.
    pub conditioning: S,
    /// Bound of the rounding error of the floor point [m].
    pub error: S,
}

/// The most radians of phase that a camera ray may pass over between the highest crest and the lowest trough.
pub const MAX_PHASE: f64 = 1e5;

impl<S: Scalar> WaterWaves<S> {
    /// Whether a camera ray is so steep that its first hit is searched for.
    pub fn is_searched(&self, camera: Vec3<S>, aim: Vec3<S>) -> bool {
        let ray = aim - camera;
        let run = S::TWO * self.sums.height * ray.x.abs() * self.sums.largest_wave_number;
        ray.z >= S::ZERO || run <= S::from_f64(MAX_PHASE) * -ray.z
    }

    /// What the ray from a `camera` above the crests through `aim` sees; `None` if it does not come down to the floor, or
    /// the camera is not above the crests.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>) -> Option<Seen<S>> {
        let ray = (aim - camera).normalized();
        if !(camera.z > self.highest() && ray.z < S::ZERO && self.is_searched(camera, aim)) {
            return None;
        }
        let t = self.first_hit(camera, ray)?;
        let hit = camera + ray * t;
        let at = self.surface(hit.x);
        let first_hit = vec3(hit.x, hit.y, self.depth + at.zeta);
        // Refraction at N = (-s, 0, 1)/M.
        let (n, s) = (self.index, at.slope);
        let m = (S::ONE + s.squared()).sqrt();
        let cos_in = (s * ray.x - ray.z) / m;
        if !(cos_in > S::ZERO) {
            return None;
        }
        let gap = (n - S::ONE) * (n + S::ONE);
        let q = (gap + cos_in.squared()).sqrt();
        // (cos i/n - cos t)/M, the difference without cancellation.
        let turn = -gap / ((q + cos_in) * n * m);
        let inside = vec3(
            ray.x * (S::ONE / n) - turn * s,
            ray.y * (S::ONE / n),
            ray.z * (S::ONE / n) + turn,
        );
        if !(inside.z < S::ZERO) || self.meets_again(first_hit, inside) {
            return None;
        }
        let length = first_hit.z / -inside.z;
        let floor = first_hit + inside * length;
        let transmittance = fresnel_transmittance(S::ONE, cos_in, n, q);
        // First-order bounds: the hit slides along the ray, the normal turns with it, the leg swings.
        let eight = S::from_f64(8.0);
        let size = camera.length() + t + first_hit.length();
        let [zeta_change, slope_change, _] = self.sums.changes(hit.x.abs());
        let slide = (size + zeta_change) / (cos_in * m);
        let swing = slope_change + self.sums.second * slide + S::ONE;
        let slant = S::ONE / -inside.z;
        let error = S::EPSILON * eight * (slide * slant + length * swing * slant.squared());
        Some(Seen {
            first_hit,
            floor: vec3(floor.x, floor.y, S::ZERO),
            transmittance,
            weight: transmittance / n.squared(),
            conditioning: S::from_f64(4.0) + swing / cos_in,
            error: error + rounding_error(floor.length(), S::ZERO),
        })
    }

    /// Distance along the unit `ray` to the surface.
    fn first_hit(&self, camera: Vec3<S>, ray: Vec3<S>) -> Option<S> {
        let room = S::from_f64(16.0) * S::EPSILON * (camera.z.abs() + self.highest());
        let down = S::ONE / -ray.z;
        let near = ((camera.z - self.highest() - room) * down).max(S::ZERO);
        let far = (camera.z - self.depth + self.sums.height + room) * down;
        let mut first = None;
        for_each_root(
            near,
            far,
            |t, _| self.clearance(camera, ray, t),
            |root| {
                let (Isolated::Simple(t) | Isolated::Touching(t)) = root;
                first = first.or(Some(t));
            },
        );
        first
    }

    /// What [`for_each_root`] must know of the height over the surface along a ray.
    fn clearance(&self, from: Vec3<S>, ray: Vec3<S>, t: S) -> Local<S> {
        let p = from + ray * t;
        let at = self.surface(p.x);
        let size = from.z.abs() + t + self.highest() + self.sums.changes(p.x.abs())[0];
        Local {
            value: p.z - self.depth - at.zeta,
            slope: ray.z - at.slope * ray.x,
            curvature: self.sums.second * ray.x.squared(),
            noise: S::from_f64(4.0) * S::EPSILON * size,
        }
    }

    /// Whether the refracted ray leaves the water before it reaches the floor.
    fn meets_again(&self, from: Vec3<S>, ray: Vec3<S>) -> bool {
        // Steeper than any slope: it cannot.
        if ray.x.abs() * self.sums.slope < -ray.z {
            return false;
        }
        let start = self.clearance(from, ray, S::ZERO);
        // g = g' t + O(t²) has no zero before this but the one at the start.
        let near = start.slope.abs() / start.curvature;
        let far = (from.z - self.depth + self.sums.height) / -ray.z;
        let mut found = false;
        if near < far {
            let local = |t: S, _| self.clearance(from, ray, t);
            for_each_root(near, far, local, |_| found = true);
        }
        found
    }
}
