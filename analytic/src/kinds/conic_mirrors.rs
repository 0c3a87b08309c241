//! Mirrors that are conics of revolution with the point light in one focus: an ellipsoid, seen from inside, and the convex
//! side of a hyperboloid. Both under a horizontal receiver that faces down.
//!
//! With r1 the distance of the mirror point from the light and r2 from the other focus, equal angles at the mirror make
//! r1² dΩ1 = r2² dΩ2: all rays go through (or come from) the other focus with intensity I R (r2/r1)². For a receiver
//! point at distance D from it, at a height g above or below it,
//!
//! ```text
//! E = I R (r2/r1)² g/D³,    cos t = g/D.
//! ```
//!
//! **Ellipsoid** with semi-major axis a and eccentricity e: foci (0, 0, ∓ae), the light in the lower one, the mirror the
//! part below the upper one. r2 = a(1 - e²)/(1 - e cos t), r1 = 2a - r2; written without cancellation
//!
//! ```text
//! r2/r1 = (1 - e²)/((1 - e)² + 2e(1 - cos t)),    1 - cos t = ρ²/(D (D + g)).
//! ```
//!
//! **Hyperboloid** sheet z = -A √(1 + r²/B²), B² = A²(e² - 1), the light in (0, 0, Ae), the virtual focus (0, 0, -Ae):
//! r2 = A(e² - 1)/(1 + e cos t), r1 = r2 + 2A, so that r2/r1 = (e² - 1)/(e² + 1 + 2e cos t): never singular.
//!
//! Theory block I. Only light from below counts, and nothing occludes. **Accuracy**: a few units of rounding times the
//! conditioning.

use crate::gradient::conditioning;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::kinds::{Estimate, diffuse, rounding_error};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// The reflection that lights a receiver point.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    /// Where the mirror reflects [m].
    pub specular_point: Vec3<S>,
    /// Irradiance of the receiver [W/m²]; infinite in a focus.
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// Length of the ray from the mirror to the receiver [m], negative where the receiver is behind the mirror.
    pub leg: S,
}

impl<S: Scalar> Root<S> {
    /// The light of this root, where the receiver is in front of the mirror.
    fn estimate(&self) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        if self.leg > S::ZERO {
            sum.add(self.irradiance, self.conditioning);
        }
        if self.leg.abs() <= rounding_error(self.specular_point.length(), self.conditioning) {
            sum.error += self.irradiance;
        }
        sum
    }
}

/// Direct irradiance of a receiver that faces down, by a light on the axis.
fn direct_from_below<S: Scalar>(light_z: S, intensity: S, x: S, y: S, z: S) -> Estimate<S> {
    // Look at the receiver in a mirror: it faces up.
    diffuse::direct(vec3(S::ZERO, S::ZERO, -light_z), intensity, vec3(x, y, -z))
}

/// An ellipsoid of revolution about z, mirror below its upper focus, with the light in its lower focus.
#[derive(Clone, Copy, Debug)]
pub struct Ellipsoid<S> {
    /// Semi-major axis a [m].
    pub semi_axis: S,
    /// Eccentricity, 0 ≤ e < 1.
    pub eccentricity: S,
    /// Height of the receiver above the upper focus [m]; below it where negative.
    pub defocus: S,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Specular reflectance R.
    pub reflectance: S,
}

/// r2/r1 of the ellipsoid.
#[inline(always)]
fn ellipsoid_ratio<S: Scalar>(e: S, g: S, distance: S, plan: S) -> S {
    let versine = plan.squared() / (distance * (distance + g));
    (S::ONE - e) * (S::ONE + e) / ((S::ONE - e).squared() + S::TWO * e * versine)
}

/// Irradiance for I R = 1.
#[inline(always)]
fn ellipsoid_irradiance<S: Scalar>(e: S, defocus: S, x: S, y: S) -> S {
    let (g, plan) = (defocus.abs(), x.hypot(y));
    let distance = plan.hypot(g);
    ellipsoid_ratio(e, g, distance, plan).squared() * g / (distance.squared() * distance)
}

impl<S: Scalar> Ellipsoid<S> {
    /// Height of the receiver [m].
    pub fn receiver_z(&self) -> S {
        self.semi_axis * self.eccentricity + self.defocus
    }

    /// The reflection towards (x, y); `None` if the light would come from above or along the receiver.
    pub fn reflection(&self, x: S, y: S) -> Option<Root<S>> {
        let (a, e, g) = (self.semi_axis, self.eccentricity, self.defocus.abs());
        let plan = x.hypot(y);
        let distance = plan.hypot(g);
        let focus_z = a * e;
        if distance == S::ZERO {
            let infinite = S::ONE / S::ZERO;
            return Some(Root {
                specular_point: vec3(S::ZERO, S::ZERO, -a),
                irradiance: infinite,
                conditioning: infinite,
                leg: a * (S::ONE + e),
            });
        }
        if g == S::ZERO {
            return None;
        }
        let r2 = a * (S::ONE - e) * (S::ONE + e) / (S::ONE - e * (g / distance));
        // Above the focus the ray has crossed the axis.
        let side = if self.defocus < S::ZERO {
            S::ONE
        } else {
            -S::ONE
        };
        let k = side * r2 / distance;
        Some(Root {
            specular_point: vec3(k * x, k * y, focus_z - r2 * g / distance),
            irradiance: self.intensity
                * self.reflectance
                * ellipsoid_irradiance(e, self.defocus, x, y),
            conditioning: conditioning([e, self.defocus, x, y], |[e, d, x, y]| {
                ellipsoid_irradiance(e, d, x, y)
            }),
            leg: r2 - side * distance,
        })
    }

    /// Caustic irradiance (LSDE) at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        self.reflection(x, y)
            .map_or(Estimate::NONE, |root| root.estimate())
    }

    /// Direct irradiance (LDE) at (x, y) [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let light_z = -self.semi_axis * self.eccentricity;
        direct_from_below(light_z, self.intensity, x, y, self.receiver_z())
    }

    /// The upper focus.
    pub fn singularity(&self, x: S, y: S) -> Option<Singularity<S>> {
        Some(Singularity {
            kind: SingularityKind::PointFocus,
            distance: x.hypot(y).hypot(self.defocus),
        })
    }
}

/// One sheet of a hyperboloid of revolution about z, mirror on its convex upper side, with the light above it in a focus.
#[derive(Clone, Copy, Debug)]
pub struct Hyperboloid<S> {
    /// Distance A of the vertex (0, 0, -A) from the centre [m].
    pub semi_axis: S,
    /// Eccentricity, e > 1.
    pub eccentricity: S,
    /// Height of the receiver [m].
    pub receiver_z: S,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Specular reflectance R.
    pub reflectance: S,
}

/// Irradiance for I R = 1.
#[inline(always)]
fn hyperboloid_irradiance<S: Scalar>(a: S, e: S, z: S, x: S, y: S) -> S {
    let g = z + a * e;
    let distance = x.hypot(y).hypot(g);
    let cosine = g / distance;
    let ratio = (e - S::ONE) * (e + S::ONE) / (e.squared() + S::ONE + S::TWO * e * cosine);
    ratio.squared() * cosine / distance.squared()
}

impl<S: Scalar> Hyperboloid<S> {
    /// The reflection towards (x, y); `None` if the light would not come from below.
    pub fn reflection(&self, x: S, y: S) -> Option<Root<S>> {
        let (a, e, z) = (self.semi_axis, self.eccentricity, self.receiver_z);
        let focus_z = -a * e;
        let g = z - focus_z;
        if !(g > S::ZERO) {
            return None;
        }
        let distance = x.hypot(y).hypot(g);
        let r2 = a * (e - S::ONE) * (e + S::ONE) / (S::ONE + e * (g / distance));
        let k = r2 / distance;
        Some(Root {
            specular_point: vec3(k * x, k * y, focus_z + k * g),
            irradiance: self.intensity * self.reflectance * hyperboloid_irradiance(a, e, z, x, y),
            conditioning: conditioning([a, e, z, x, y], |[a, e, z, x, y]| {
                hyperboloid_irradiance(a, e, z, x, y)
            }),
            leg: distance - r2,
        })
    }

    /// Caustic irradiance (LSDE) at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        self.reflection(x, y)
            .map_or(Estimate::NONE, |root| root.estimate())
    }

    /// Direct irradiance (LDE) at (x, y) [W/m²]: only of a receiver above the light, which faces it.
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let light_z = self.semi_axis * self.eccentricity;
        direct_from_below(light_z, self.intensity, x, y, self.receiver_z)
    }
}
