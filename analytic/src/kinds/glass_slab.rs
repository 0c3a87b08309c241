//! A parallel glass slab in air between a point light and a floor.
//!
//! Light above the slab, receiver below it, facing up. A ray that is reflected 2k times inside has passed air of thickness
//! l_a (both gaps) and glass of thickness (2k+1) t, whatever the slab's height. With the ray parameter p = sin θ in air,
//! q_j = n_j cos θ_j = √(n_j² - p²), and layers (l_a, 1), (l_g, n), l_g = (2k+1) t,
//!
//! ```text
//! X(p) = Σ l_j p/q_j,    E_k = I T² F^{2k} / (q_a · Σ l_j/q_j · Σ l_j n_j²/q_j³),
//! ```
//!
//! strictly increasing in p: one root per order k, classes `LSSDE`, `LSSSSDE` and so on. It is solved in t, the tangent in
//! the rarer medium, where X(t) is increasing and concave, so that Newton's method converges monotonically from
//! t0 = X/X'(0), the left of the root.
//!
//! **Series.** At a fixed point p falls as k grows, so that for k > K: q_a grows, X/p = Σ l_j/q_j grows,
//! Σ l_j n_j²/q_j³ ≥ l_a + l_g/n, and F ≤ F̄ = (r_s²(p_K) + max(r_p²(0), r_p²(p_K)))/2, since r_s² grows with p and r_p²
//! has no maximum inside an interval. What is left out after K is at most a geometric series in F̄² with these bounds.
//!
//! A camera above the slab sees L T² of the floor: the n² of both surfaces cancel. Theory block D; tail bound derived
//! here. No singularity. **Accuracy**: a few units of rounding times the conditioning.

use crate::kinds::{Estimate, power, rounding_error};
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// The most orders that are added up one by one; the rest is in the error bound.
const MAX_ORDERS: u32 = 1 << 16;

/// A slab with its light and its receiver.
#[derive(Clone, Copy, Debug)]
pub struct GlassSlab<S> {
    /// Height of the lower surface [m].
    pub bottom: S,
    /// Height of the upper surface [m].
    pub top: S,
    /// Index n of the glass relative to the air.
    pub index: S,
    /// Position of the light, above the slab [m].
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Height of the receiver, not above the lower surface [m].
    pub receiver_z: S,
}

/// The one ray of an order from the light to a receiver point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Ray parameter p = sin θ in air.
    pub ray_parameter: S,
    /// Unpolarised transmittance T of one surface.
    pub transmittance: S,
    /// Unpolarised reflectance F of one surface.
    pub reflectance: S,
    /// Irradiance of the receiver [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of x, y, the heights and n.
    pub conditioning: S,
}

/// A receiver point seen through the slab without internal reflection.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Where the ray enters the slab [m].
    pub first_hit: Vec3<S>,
    /// The receiver point [m].
    pub receiver: Vec3<S>,
    /// T² of the ray.
    pub weight: S,
    /// Bound of the rounding error of the receiver point [m].
    pub error: S,
    /// Relative change of `weight` per relative change of the inputs.
    pub conditioning: S,
}

/// Logarithmic derivatives of T and F, as moduli.
struct Slopes<S> {
    transmittance: S,
    reflectance: S,
}

impl<S: Scalar> GlassSlab<S> {
    /// Thickness of the air in both gaps [m].
    #[inline(always)]
    fn air(&self) -> S {
        (self.light.z - self.top) + (self.bottom - self.receiver_z)
    }

    /// Thickness of the glass that a ray of order k passes [m].
    #[inline(always)]
    fn glass(&self, order: u32) -> S {
        S::from_f64(f64::from(order) * 2.0 + 1.0) * (self.top - self.bottom)
    }

    /// The ray parameter p, q in air and q in glass of the ray that spans the plan distance.
    #[inline]
    fn refract(&self, plan: S, air: S, glass: S) -> (S, S, S) {
        let n = self.index;
        let (l_rare, l_dense, n_rare, n_dense) = if n >= S::ONE {
            (air, glass, S::ONE, n)
        } else {
            (glass, air, n, S::ONE)
        };
        let gap = (n_dense - n_rare) * (n_dense + n_rare);
        let mut t = plan / (l_rare + l_dense * n_rare / n_dense);
        for _ in 0..64 {
            let root = (n_dense.squared() + gap * t.squared()).sqrt();
            let value = l_rare * t + l_dense * n_rare * t / root - plan;
            let slope = l_rare + l_dense * n_rare * n_dense.squared() / (root.squared() * root);
            let step = value / slope;
            t -= step;
            // From the left the steps are negative until rounding takes over; they shrink quadratically.
            if !(step.abs() > S::EPSILON.sqrt() * S::from_f64(0.25) * t) {
                break;
            }
        }
        // cos θ in the rarer medium is 1/√(1 + t²).
        let w = S::ONE / (S::ONE + t.squared()).sqrt();
        let q_rare = n_rare * w;
        let q_dense = (n_dense.squared() + gap * t.squared()).sqrt() * w;
        let p = n_rare * t * w;
        if n >= S::ONE {
            (p, q_rare, q_dense)
        } else {
            (p, q_dense, q_rare)
        }
    }

    /// The ray of order `order` (2·order internal reflections) to the receiver point (x, y).
    pub fn root(&self, x: S, y: S, order: u32) -> Root<S> {
        let n = self.index;
        let plan = (x - self.light.x).hypot(y - self.light.y);
        let (air, glass) = (self.air(), self.glass(order));
        let (p, q_a, q_g) = self.refract(plan, air, glass);
        let transmittance = fresnel_transmittance(S::ONE, q_a, n, q_g);
        let reflectance = fresnel_reflectance(S::ONE, q_a, n, q_g);
        let weight = transmittance.squared() * power(reflectance.squared(), order);
        let sagittal = air / q_a + glass / q_g;
        let tangential = air / (q_a.squared() * q_a) + glass * n.squared() / (q_g.squared() * q_g);
        Root {
            ray_parameter: p,
            transmittance,
            reflectance,
            irradiance: self.intensity * weight / (q_a * sagittal * tangential),
            conditioning: self.conditioning(x, y, order, (p, q_a, q_g), (sagittal, tangential)),
        }
    }

    /// Moduli of d ln T and d ln F for changes dq of q in air and in glass and a relative change of n.
    fn slopes(&self, (q1, q2): (S, S), (dq1, dq2): (S, S), dn: S) -> Slopes<S> {
        let m2 = self.index.squared();
        let (s, p) = (q1 + q2, m2 * q1 + q2);
        let (r_s, r_p) = ((q1 - q2) / s, (m2 * q1 - q2) / p);
        let turn = q2 * dq1 - q1 * dq2;
        let d_s = S::TWO * turn / s.squared();
        let d_p = S::TWO * m2 * (turn + S::TWO * dn * q1 * q2) / p.squared();
        let d_f = (r_s * d_s + r_p * d_p).abs();
        let f = S::HALF * (r_s.squared() + r_p.squared());
        Slopes {
            transmittance: d_f / fresnel_transmittance(S::ONE, q1, self.index, q2),
            reflectance: if f > S::ZERO { d_f / f } else { S::ZERO },
        }
    }

    /// Upper bound of the relative change of E_k per relative change of the inputs.
    ///
    /// At a fixed p all of ln E is explicit; p moves by dX/Σ l_j n_j²/q_j³.
    fn conditioning(
        &self,
        x: S,
        y: S,
        order: u32,
        (p, q_a, q_g): (S, S, S),
        (sagittal, tangential): (S, S),
    ) -> S {
        let n2 = self.index.squared();
        let (air, glass) = (self.air(), self.glass(order));
        let (two, three) = (S::TWO, S::from_f64(3.0));
        let k = S::from_f64(2.0 * f64::from(order));
        let of_weight = |s: Slopes<S>| two * s.transmittance + k * s.reflectance;
        let (a2, g2) = (q_a.squared(), q_g.squared());
        // Per change of p: dq = -p/q.
        let tau = of_weight(self.slopes((q_a, q_g), (-p / q_a, -p / q_g), S::ZERO));
        let by_sagittal = p * (air / (a2 * q_a) + glass / (g2 * q_g)) / sagittal;
        let by_tangential =
            three * p * (air / (a2 * a2 * q_a) + glass * n2 / (g2 * g2 * q_g)) / tangential;
        let by_p = tau + p / a2 + by_sagittal + by_tangential;
        let span = p * sagittal / tangential;
        // Per relative change of n at a fixed p: dq = n²/q.
        let tau_n = of_weight(self.slopes((q_a, q_g), (S::ZERO, n2 / q_g), S::ONE));
        let by_index = tau_n + two + S::from_f64(4.0) * n2 / g2 + by_p * span * n2 / g2;
        let size = x.abs() + y.abs() + self.light.length() + self.top.abs() + self.bottom.abs();
        let plan = (x - self.light.x).hypot(y - self.light.y);
        let along = if plan > S::ZERO { size / plan } else { S::ZERO };
        // A thickness is a difference of heights: its relative error grows by this.
        let thin = size / air + size / (self.top - self.bottom);
        S::ONE + by_p * span * along + (two + by_p * span) * thin + by_index + k
    }

    /// Irradiance of the receiver point (x, y) by the ray of order `order` [W/m²].
    pub fn caustic(&self, x: S, y: S, order: u32) -> Estimate<S> {
        let root = self.root(x, y, order);
        let mut sum = Estimate::NONE;
        sum.add(root.irradiance, root.conditioning);
        sum
    }

    /// Irradiance of (x, y) by all orders from `first` on [W/m²]: orders are added up to where the bound of the rest is
    /// below rounding; that bound is in the error.
    pub fn all_orders_from(&self, x: S, y: S, first: u32) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let mut rest = S::ZERO;
        for order in first..first.saturating_add(MAX_ORDERS) {
            let root = self.root(x, y, order);
            sum.value += root.irradiance;
            sum.roots += 1;
            sum.error += rounding_error(root.irradiance, root.conditioning);
            rest = self.rest(&root, order);
            if !(rest > sum.value * S::EPSILON * S::from_f64(0.25)) {
                break;
            }
        }
        sum.error += rest + rounding_error(sum.value, S::ZERO);
        sum
    }

    /// Upper bound of the irradiance by all orders above `order`, whose root is given.
    fn rest(&self, root: &Root<S>, order: u32) -> S {
        let n = self.index;
        let (n2, p2) = (n.squared(), root.ray_parameter.squared());
        let (q_a, q_g) = ((S::ONE - p2).abs().sqrt(), (n2 - p2).abs().sqrt());
        let r_s = (q_a - q_g) / (q_a + q_g);
        let r_p = (n2 * q_a - q_g) / (n2 * q_a + q_g);
        let r_0 = (n - S::ONE) / (n + S::ONE);
        let square = (S::HALF * (r_s.squared() + r_0.squared().max(r_p.squared()))).squared();
        let (air, glass) = (self.air(), self.glass(order));
        let spread = q_a * (air / q_a + glass / q_g) * (air + glass / n);
        let weight = power(square, order + 1);
        self.intensity * weight / (spread * (S::ONE - square))
    }

    /// The receiver point that the ray from `camera`, above the slab, through `aim` reaches without internal reflection;
    /// `None` if the ray does not come down through the slab.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>) -> Option<Seen<S>> {
        let ray = aim - camera;
        let above = camera.z - self.top;
        if !(above > S::ZERO && ray.z < S::ZERO) {
            return None;
        }
        let n = self.index;
        let (length, plan) = (ray.length(), ray.x.hypot(ray.y));
        let (sine, q_a) = (plan / length, -ray.z / length);
        let q_g_squared = (n - sine) * (n + sine);
        if !(q_g_squared > S::ZERO) {
            return None;
        }
        let q_g = q_g_squared.sqrt();
        let below = self.bottom - self.receiver_z;
        // Per unit of plan direction: p/q times the thickness, in each medium.
        let to_top = above / -ray.z;
        let after = below / -ray.z + (self.top - self.bottom) / (q_g * length);
        let first_hit = camera + ray * to_top;
        let receiver = vec3(
            first_hit.x + ray.x * after,
            first_hit.y + ray.y * after,
            self.receiver_z,
        );
        let transmittance = fresnel_transmittance(S::ONE, q_a, n, q_g);
        let slant = S::ONE / q_a;
        let bend = n.squared() / q_g_squared;
        let size = camera.length() + aim.length() + receiver.length() + self.top.abs();
        let ratio = size / length;
        let eight = S::from_f64(8.0);
        Some(Seen {
            first_hit: vec3(first_hit.x, first_hit.y, self.top),
            receiver,
            weight: transmittance.squared(),
            error: S::EPSILON * eight * size * ratio * (slant.squared() + bend),
            conditioning: eight * ratio * (slant + bend),
        })
    }
}
