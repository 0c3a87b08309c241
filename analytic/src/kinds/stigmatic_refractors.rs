//! Glass that brings all light to one point: an ellipsoid in a beam, and a Cartesian oval with a point light.
//!
//! The focus is the origin, deep in the glass; the glass fills all space behind the front sheet, the receiver z = -δ in it
//! included, which faces up. For a receiver point at distance D from the focus and g = |δ|, cos t = g/D; all light comes
//! along straight lines through the focus from the surface point at distance r2 from it, at the angle t from +z.
//!
//! **Ellipsoid** of eccentricity 1/n and semi-major axis a, centred at (0, 0, a/n), in a beam along -z from the air:
//! r2 = a(n² - 1)/(n(n - cos t)) and
//!
//! ```text
//! E = E0 T a² (n² - 1)² (n cos t - 1)/(n² (n - cos t)³) · g/D³,
//! ```
//!
//! lit where n cos t > 1. **Cartesian oval** r1 + n r2 = C with the light at (0, 0, d), d < C < n d: with s = sin t,
//!
//! ```text
//! r2 = (C² - d²)/(n C - d cos t + √Δ),    Δ = (nC - d cos t)² - (n² - 1)(C² - d²),    r1 = C - n r2,
//! E = I T (r2/r1)² (cos i1/cos i2) · g/D³,
//! ```
//!
//! the smaller root of the quadratic (the larger one has r1 < 0). Both surfaces have the normal along (ray in) - n (ray
//! out), so that with κ the cosine between the two, M² = n² + 1 - 2nκ, cos i1 = (nκ - 1)/M and cos i2 = (n - κ)/M; κ = cos t
//! for the ellipsoid and (d cos t - r2)/r1 for the oval. Theory block J; r1² dΩ1/cos i1 = r2² dΩ2/cos i2 is the element of
//! the surface. **Accuracy**: a few units of rounding times the conditioning, which grows like 1/(nκ - 1) at grazing
//! incidence.

use crate::gradient::conditioning;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::kinds::{Estimate, rounding_error};
use crate::optics::fresnel_transmittance;
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// The front surface with its light.
#[derive(Clone, Copy, Debug)]
pub enum Front<S> {
    /// An ellipsoid of semi-major axis a [m] in a beam of irradiance E0 perpendicular to it [W/m²].
    Ellipsoid {
        /// Semi-major axis a [m].
        semi_axis: S,
        /// Irradiance E0 [W/m²].
        irradiance: S,
    },
    /// A Cartesian oval with a point light.
    Oval {
        /// Height d of the light above the focus [m].
        light_z: S,
        /// Optical length C from light to focus [m].
        optical_length: S,
        /// Radiant intensity I [W/sr].
        intensity: S,
    },
}

/// A stigmatic refractor with its receiver.
#[derive(Clone, Copy, Debug)]
pub struct StigmaticRefractor<S> {
    /// Index n > 1 of the glass.
    pub index: S,
    /// Surface and light.
    pub front: Front<S>,
    /// Depth δ of the receiver below the focus [m]; above it where negative.
    pub defocus: S,
}

/// The refracted ray that lights a receiver point.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    /// Where the light enters [m].
    pub specular_point: Vec3<S>,
    /// Fresnel transmittance T.
    pub transmittance: S,
    /// Irradiance of the receiver [W/m²]; infinite in the focus.
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// Length of the ray in the glass [m], negative where the receiver is outside.
    pub leg: S,
}

/// Entry point and intensity of a ray towards the focus.
#[derive(Clone, Copy)]
struct Ray<S> {
    /// Distance of the surface point from the focus [m].
    r2: S,
    /// nκ - 1: positive where light comes in.
    entering: S,
    transmittance: S,
    /// Intensity towards the focus [W/sr].
    intensity: S,
    /// What one rounding of κ does to nκ - 1, relatively.
    rounding: S,
}

/// T for a ray whose directions in air and glass have the cosine κ.
#[inline(always)]
fn transmittance<S: Scalar>(n: S, entering: S, leaving: S) -> S {
    // The common factor 1/M of both cosines drops out.
    fresnel_transmittance(S::ONE, entering, n, n * leaving)
}

#[inline(always)]
fn ellipsoid<S: Scalar>(n: S, a: S, e0: S, cosine: S) -> Ray<S> {
    let (entering, leaving) = (n * cosine - S::ONE, n - cosine);
    let gap = (n - S::ONE) * (n + S::ONE);
    let r2 = a * gap / (n * leaving);
    let t = transmittance(n, entering, leaving);
    Ray {
        r2,
        entering,
        transmittance: t,
        intensity: e0 * t * r2.squared() * entering / leaving,
        rounding: n * cosine / entering,
    }
}

#[inline(always)]
fn oval<S: Scalar>(n: S, d: S, c: S, intensity: S, cosine: S, sine: S) -> Ray<S> {
    let versine = sine.squared() / (S::ONE + cosine);
    // Δ = (nd - C)² + 2ncd(1 - cos t) - d² sin² t: no cancellation on the axis.
    let rest = versine * (S::TWO * n * c - d * (S::ONE + cosine));
    let root = ((n * d - c).squared() + d * rest).sqrt();
    let r2 = (c - d) * (c + d) / (n * c - d * cosine + root);
    let r1 = c - n * r2;
    let kappa = (d * cosine - r2) / r1;
    let (entering, leaving) = (n * kappa - S::ONE, n - kappa);
    let t = transmittance(n, entering, leaving);
    Ray {
        r2,
        entering,
        transmittance: t,
        intensity: intensity * t * (r2 / r1).squared() * entering / leaving,
        rounding: n * (d * cosine + r2) / (r1 * entering),
    }
}

impl<S: Scalar> Front<S> {
    #[inline(always)]
    fn ray(&self, n: S, cosine: S, sine: S) -> Ray<S> {
        match *self {
            Front::Ellipsoid {
                semi_axis,
                irradiance,
            } => ellipsoid(n, semi_axis, irradiance, cosine),
            Front::Oval {
                light_z,
                optical_length,
                intensity,
            } => oval(n, light_z, optical_length, intensity, cosine, sine),
        }
    }

    /// Irradiance of the receiver point (x, y) at the depth `defocus`.
    #[inline(always)]
    fn irradiance(&self, n: S, defocus: S, x: S, y: S) -> S {
        let (g, plan) = (defocus.abs(), x.hypot(y));
        let distance = plan.hypot(g);
        let ray = self.ray(n, g / distance, plan / distance);
        ray.intensity * g / (distance.squared() * distance)
    }

    fn conditioning(&self, n: S, defocus: S, x: S, y: S) -> S {
        match *self {
            Front::Ellipsoid { semi_axis, .. } => {
                conditioning([n, defocus, x, y, semi_axis], |[n, g, x, y, semi_axis]| {
                    let irradiance = Scalar::ONE;
                    let front = Front::Ellipsoid {
                        semi_axis,
                        irradiance,
                    };
                    front.irradiance(n, g, x, y)
                })
            }
            Front::Oval {
                light_z,
                optical_length,
                ..
            } => conditioning(
                [n, defocus, x, y, light_z, optical_length],
                |[n, g, x, y, light_z, optical_length]| {
                    let front = Front::Oval {
                        light_z,
                        optical_length,
                        intensity: Scalar::ONE,
                    };
                    front.irradiance(n, g, x, y)
                },
            ),
        }
    }
}

impl<S: Scalar> StigmaticRefractor<S> {
    /// The ray that lights the receiver point (x, y); `None` where the surface that the ray would come from turns away
    /// from the light, or the ray would come along the receiver.
    pub fn refraction(&self, x: S, y: S) -> Option<Root<S>> {
        let (n, g, plan) = (self.index, self.defocus.abs(), x.hypot(y));
        let distance = plan.hypot(g);
        if distance == S::ZERO {
            let ray = self.front.ray(n, S::ONE, S::ZERO);
            let infinite = S::ONE / S::ZERO;
            return Some(Root {
                specular_point: vec3(S::ZERO, S::ZERO, ray.r2),
                transmittance: ray.transmittance,
                irradiance: infinite,
                conditioning: infinite,
                leg: ray.r2,
            });
        }
        let ray = self.front.ray(n, g / distance, plan / distance);
        if !(g > S::ZERO && ray.entering > S::ZERO) {
            return None;
        }
        // Below the focus the ray has crossed the axis.
        let side = if self.defocus < S::ZERO {
            S::ONE
        } else {
            -S::ONE
        };
        let k = side * ray.r2 / distance;
        Some(Root {
            specular_point: vec3(k * x, k * y, ray.r2 * g / distance),
            transmittance: ray.transmittance,
            irradiance: self.front.irradiance(n, self.defocus, x, y),
            // Towards grazing incidence E falls with the square of nκ - 1.
            conditioning: self.front.conditioning(n, self.defocus, x, y) + S::TWO * ray.rounding,
            leg: ray.r2 - side * distance,
        })
    }

    /// Caustic irradiance (LSDE) at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let Some(root) = self.refraction(x, y) else {
            return sum;
        };
        if root.leg > S::ZERO {
            sum.add(root.irradiance, root.conditioning);
        }
        if root.leg.abs() <= rounding_error(root.specular_point.length(), root.conditioning) {
            sum.error += root.irradiance;
        }
        sum
    }

    /// Intensity of the light towards the focus from the angle with this tangent from the axis [W/sr].
    pub fn intensity(&self, tangent: S) -> S {
        self.towards_focus(tangent).intensity
    }

    /// Transmittance T of that light.
    pub fn transmittance(&self, tangent: S) -> S {
        self.towards_focus(tangent).transmittance
    }

    fn towards_focus(&self, tangent: S) -> Ray<S> {
        let slant = tangent.hypot(S::ONE);
        self.front.ray(self.index, S::ONE / slant, tangent / slant)
    }

    /// The focus.
    pub fn singularity(&self, x: S, y: S) -> Option<Singularity<S>> {
        Some(Singularity {
            kind: SingularityKind::PointFocus,
            distance: x.hypot(y).hypot(self.defocus),
        })
    }
}
