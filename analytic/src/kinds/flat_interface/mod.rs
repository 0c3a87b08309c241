//! A flat dielectric interface: a light in air or in water, a receiver in air or in water.
//!
//! The interface is z = `surface_z`, water of relative index n below. A receiver below it faces up, one above it faces
//! down. Where light and receiver are on different sides the light is refracted. With the ray parameter
//! p = n_j sin θ_j, layers of thickness l_j and q_j = n_j cos θ_j = √(n_j² - p²), the plan distance is
//!
//! ```text
//! X(p) = Σ l_j p/q_j,   E = I T / (n_src q_src · (Σ l_j/q_j) · (Σ l_j n_j²/q_j³)),
//! ```
//!
//! strictly increasing in p: one root. It is solved in t, the tangent in the rarest medium (index n_r; the other n_d), in
//! which X(t) = l_r t + l_d n_r t/√(n_d² + (n_d² - n_r²) t²) is increasing and concave, so that Newton's method from the
//! left of the root, t0 = X/(l_r + l_d n_r/n_d), converges monotonically, up to grazing incidence.
//!
//! On the same side the light is reflected: the image at distance D = l_1 + l_2 with the weight F,
//! E = I F D/(X² + D²)^{3/2}. From the water, F = 1 beyond the critical radius X_c = D/√(n² - 1), where E has a kink: inside,
//! 1 - F ~ √(X_c - X). Direct light is there too: E = I h/d³.
//!
//! Through the interface the basic radiance L/n² is conserved: a camera sees L T (n_camera/n_receiver)². Theory block C,
//! from flux conservation |dΩ/dA|. **Accuracy**: a few units of rounding times the conditioning, which grows like
//! (X_c - X)^{-1/2} near the kink.

mod conditioning;

use crate::kinds::Estimate;
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scalar::Scalar;
use crate::scene::{PointLight, Water};
use crate::vector::{Vec3, vec3};

/// Air above water, with a point light on either side and a horizontal receiver on either side.
#[derive(Clone, Copy, Debug)]
pub struct FlatInterface<S> {
    /// Height of the surface [m].
    pub surface_z: S,
    /// Index n of the water relative to the air.
    pub index: S,
    /// Position of the light [m], not on the surface.
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Height of the receiver [m], not on the surface.
    pub receiver_z: S,
}

/// The one specular ray from the light to a receiver point.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    /// Ray parameter p = n_j sin θ_j.
    pub ray_parameter: S,
    /// Where the ray meets the surface [m].
    pub specular_point: Vec3<S>,
    /// Fresnel factor: T or F.
    pub weight: S,
    /// Irradiance of the receiver [W/m²].
    pub irradiance: S,
}

/// A receiver point seen in or through the surface.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Where the ray meets the surface [m].
    pub first_hit: Vec3<S>,
    /// The receiver point [m].
    pub receiver: Vec3<S>,
    /// Fresnel factor of the ray: T where it is refracted, F where it is reflected.
    pub fresnel: S,
    /// Radiance factor: T (n_camera/n_receiver)², or F.
    pub weight: S,
    /// Whether the ray goes through the surface.
    pub through: bool,
    /// Bound of the rounding error of the receiver point [m].
    pub error: S,
    /// Relative change of `weight` per relative change of the inputs.
    pub conditioning: S,
}

/// The refracted ray in terms of its wave vector's normal components.
#[derive(Clone, Copy)]
struct Refracted<S> {
    p: S,
    /// Normal component on the light's side and on the receiver's side.
    q: [S; 2],
}

impl FlatInterface<f64> {
    /// The water of a catalogue entry.
    pub fn from_entry(light: &PointLight, water: &Water) -> Self {
        FlatInterface {
            surface_z: water.surface_z,
            index: water.index,
            light: Vec3::from_f64(light.position),
            intensity: light.intensity,
            receiver_z: 0.0,
        }
    }
}

impl<S: Scalar> FlatInterface<S> {
    /// Index at height z.
    #[inline(always)]
    fn index_at(&self, z: S) -> S {
        if z > self.surface_z {
            S::ONE
        } else {
            self.index
        }
    }

    /// Whether light and receiver are on different sides.
    #[inline(always)]
    pub fn is_refracted(&self) -> bool {
        (self.light.z > self.surface_z) != (self.receiver_z > self.surface_z)
    }

    #[inline(always)]
    fn layers(&self) -> ([S; 2], [S; 2]) {
        let (zl, zr) = (self.light.z, self.receiver_z);
        (
            [(zl - self.surface_z).abs(), (zr - self.surface_z).abs()],
            [self.index_at(zl), self.index_at(zr)],
        )
    }

    /// The refracted ray that spans the plan distance `x`.
    #[inline(always)]
    fn refract(&self, x: S, l: [S; 2], n: [S; 2]) -> Refracted<S> {
        let rare = usize::from(n[1] < n[0]);
        let dense = 1 - rare;
        let (nr, nd) = (n[rare], n[dense]);
        let gap = (nd - nr) * (nd + nr);
        let mut t = x / (l[rare] + l[dense] * nr / nd);
        for _ in 0..64 {
            let root = (nd.squared() + gap * t.squared()).sqrt();
            let value = l[rare] * t + l[dense] * nr * t / root - x;
            let slope = l[rare] + l[dense] * nr * nd.squared() / (root.squared() * root);
            let step = value / slope;
            t -= step;
            // From the left the steps are negative until rounding takes over; they shrink quadratically.
            if !(step.abs() > S::EPSILON.sqrt() * S::from_f64(0.25) * t) {
                break;
            }
        }
        // cos θ in the rarest medium is 1/√(1 + t²).
        let w = S::ONE / (S::ONE + t.squared()).sqrt();
        let mut q = [S::ZERO; 2];
        q[rare] = nr * w;
        q[dense] = (nd.squared() + gap * t.squared()).sqrt() * w;
        Refracted { p: nr * t * w, q }
    }

    /// The specular ray to the receiver point (x, y); none without a Fresnel factor to carry it.
    #[inline]
    pub fn root(&self, x: S, y: S) -> Root<S> {
        let (dx, dy) = (x - self.light.x, y - self.light.y);
        let plan = (dx.squared() + dy.squared()).sqrt();
        let (l, n) = self.layers();
        let (ray_parameter, weight, irradiance, fraction);
        if self.is_refracted() {
            let ray = self.refract(plan, l, n);
            let q = ray.q;
            weight = fresnel_transmittance(n[0], q[0], n[1], q[1]);
            let sagittal = l[0] / q[0] + l[1] / q[1];
            let cubed = |j: usize| q[j].squared() * q[j];
            let tangential = l[0] * n[0].squared() / cubed(0) + l[1] * n[1].squared() / cubed(1);
            irradiance = self.intensity * weight / (n[0] * q[0] * sagittal * tangential);
            ray_parameter = ray.p;
            fraction = l[0] / q[0] / sagittal;
        } else {
            let distance = l[0] + l[1];
            let squared = plan.squared() + distance.squared();
            weight = self.reflectance(plan, distance, n[0]);
            irradiance = self.intensity * weight * distance / (squared * squared.sqrt());
            ray_parameter = n[0] * plan / squared.sqrt();
            fraction = l[0] / distance;
        }
        Root {
            ray_parameter,
            specular_point: vec3(
                self.light.x + fraction * dx,
                self.light.y + fraction * dy,
                self.surface_z,
            ),
            weight,
            irradiance,
        }
    }

    /// F of the ray from a medium of index `n` (air or water) that spans `plan` over a height `distance`; 1 beyond the
    /// critical angle.
    #[inline]
    fn reflectance(&self, plan: S, distance: S, n: S) -> S {
        let length = plan.hypot(distance);
        let q1 = n * distance / length;
        let other = S::ONE * self.index / n;
        // q2² = other² - n² sin² i, as a difference of squares with the small factor exact.
        let (a, b) = (other * length, n * plan);
        let q2_squared = (a - b) * (a + b);
        if !(q2_squared > S::ZERO) {
            return S::ONE;
        }
        fresnel_reflectance(n, q1, other, q2_squared.sqrt() / length)
    }

    /// Irradiance by the refracted or reflected ray (LSDE) at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let root = self.root(x, y);
        sum.add(root.irradiance, self.conditioning(x, y));
        // Within rounding of the critical radius the weight is 1 - O(√ε), whatever the slope says.
        if let Some(kink) = self.distance_to_kink(x, y) {
            let size = x.abs() + y.abs() + self.light.length() + self.surface_z.abs();
            let near = S::EPSILON * S::from_f64(32.0) * size;
            if kink.abs() <= near {
                sum.error += root.irradiance * (near / size).sqrt() * S::from_f64(8.0);
            }
        }
        sum
    }

    /// Direct irradiance (LDE) at (x, y) [W/m²]: only where light and receiver are on the same side and the receiver
    /// faces the light.
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        if self.is_refracted() {
            return Estimate::NONE;
        }
        // A receiver above the surface faces down: look at it in a mirror.
        let flip = if self.receiver_z > self.surface_z {
            -S::ONE
        } else {
            S::ONE
        };
        let light = vec3(self.light.x, self.light.y, self.light.z * flip);
        crate::kinds::diffuse::direct(light, self.intensity, vec3(x, y, self.receiver_z * flip))
    }

    /// Signed plan distance X_c - X [m] to the critical radius of internal reflection; `None` where there is none.
    pub fn distance_to_kink(&self, x: S, y: S) -> Option<S> {
        let (l, n) = self.layers();
        let other = self.index / n[0];
        if self.is_refracted() || !(n[0] > other) {
            return None;
        }
        let plan = (x - self.light.x).hypot(y - self.light.y);
        let gap = (n[0] - other) * (n[0] + other);
        Some((l[0] + l[1]) * other / gap.sqrt() - plan)
    }

    /// The receiver point that the ray from `camera` through `aim` reaches by the surface: refracted if the receiver is
    /// on the other side, reflected if it is on the camera's. `None` if the ray does not meet the surface.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>) -> Option<Seen<S>> {
        let ray = aim - camera;
        let to_surface = (self.surface_z - camera.z) / ray.z;
        if !(to_surface > S::ZERO && to_surface.is_finite()) {
            return None;
        }
        let first_hit = camera + ray * to_surface;
        let length = ray.length();
        let plan = ray.x.hypot(ray.y);
        let n1 = self.index_at(camera.z);
        let n2 = self.index / n1;
        let depth = (self.receiver_z - self.surface_z).abs();
        let (sine, cosine) = (plan / length, ray.z.abs() / length);
        let through = (self.receiver_z > self.surface_z) != (camera.z > self.surface_z);
        let (q1, q2_squared) = (n1 * cosine, (n2 - n1 * sine) * (n2 + n1 * sine));
        let total = !(q2_squared > S::ZERO);
        if through && total {
            return None;
        }
        let q2 = if total { S::ZERO } else { q2_squared.sqrt() };
        let (fresnel, weight, tangent) = if through {
            let t = fresnel_transmittance(n1, q1, n2, q2);
            (t, t * (n1 / n2).squared(), n1 * sine / q2)
        } else {
            let f = if total {
                S::ONE
            } else {
                fresnel_reflectance(n1, q1, n2, q2)
            };
            (f, f, sine / cosine)
        };
        let shift = if plan > S::ZERO {
            tangent * depth / plan
        } else {
            S::ZERO
        };
        let receiver = vec3(
            first_hit.x + ray.x * shift,
            first_hit.y + ray.y * shift,
            self.receiver_z,
        );
        // Near grazing or critical incidence a small change of direction is a large change of both.
        let slant = S::ONE / cosine;
        let bend = if total { S::ZERO } else { n1 * n1 / q2_squared };
        let size = camera.length() + aim.length() + receiver.length() + self.surface_z.abs();
        let ratio = size / length;
        Some(Seen {
            first_hit,
            receiver,
            fresnel,
            weight,
            through,
            error: S::EPSILON * S::from_f64(8.0) * size * ratio * (slant.squared() + bend),
            conditioning: S::from_f64(4.0) * ratio * (slant + bend),
        })
    }
}
