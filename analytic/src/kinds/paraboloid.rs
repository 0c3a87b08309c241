//! A paraboloid mirror z = r²/(4f), silvered on its upper side between two radii, under a horizontal receiver that faces
//! down.
//!
//! A point light at the focus (0, 0, f) is collimated: at every height
//!
//! ```text
//! E = I R/(f + r²/(4f))²,
//! ```
//!
//! the distance from the focus to the mirror point (r, r²/(4f)) being f + r²/(4f). A beam along -z goes to the focus: with
//! D the distance of the receiver point from it, g = |c - f| the height over it or under it and cos θ = g/D, the mirror
//! point has r = 2f tan(θ/2) and
//!
//! ```text
//! E = E0 R f² cos³θ/(cos⁴(θ/2) (c - f)²) = 4 E0 R f² g/(D (D + g)²),
//! ```
//!
//! the second form for every D > 0. Theory block H, from r dr = (2f)² tan(θ/2)/(2 cos²(θ/2)) dθ and tan θ = x/g. Light
//! reaches the receiver from below only if the mirror point is lower than the receiver. The beam passes behind the
//! receiver. **Accuracy**: a few units of rounding times the conditioning.

use crate::gradient::conditioning;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::kinds::{Estimate, diffuse, rounding_error};
use crate::scalar::Scalar;
use crate::vector::{Vec3, vec3};

/// What lights the mirror.
#[derive(Clone, Copy, Debug)]
pub enum Light<S> {
    /// A point light at the focus, radiant intensity I [W/sr].
    Focus(S),
    /// A beam along -z, irradiance E0 on a plane perpendicular to it [W/m²].
    Beam(S),
}

/// The mirror with light and receiver.
#[derive(Clone, Copy, Debug)]
pub struct Paraboloid<S> {
    /// Focal length f > 0 [m].
    pub focal_length: S,
    /// Specular reflectance R.
    pub reflectance: S,
    /// The light.
    pub light: Light<S>,
    /// Height of the receiver [m].
    pub receiver_z: S,
    /// The mirror is silvered from this radius [m] ...
    pub inner_radius: S,
    /// ... to this one [m].
    pub outer_radius: S,
}

/// The reflection that lights a receiver point.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    /// Where the mirror reflects [m].
    pub specular_point: Vec3<S>,
    /// Irradiance of the receiver [W/m²]; infinite in the focus.
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the lengths.
    pub conditioning: S,
    /// How far inside the silvered annulus the mirror point is [m], negative outside.
    pub inside: S,
}

/// Irradiance by the light at the focus.
#[inline(always)]
fn collimated<S: Scalar>(intensity: S, f: S, x: S, y: S) -> S {
    let distance = f + (x.squared() + y.squared()) / (S::from_f64(4.0) * f);
    intensity / distance.squared()
}

/// Irradiance by the beam at a height `c`.
#[inline(always)]
fn focused<S: Scalar>(irradiance: S, f: S, c: S, x: S, y: S) -> S {
    let g = (c - f).abs();
    let distance = x.hypot(y).hypot(g);
    let four = S::from_f64(4.0);
    four * irradiance * f.squared() * g / (distance * (distance + g).squared())
}

impl<S: Scalar> Paraboloid<S> {
    /// The reflection that would light the receiver point (x, y), whether that part of the mirror is silvered or not;
    /// `None` if light does not come from below.
    pub fn reflection(&self, x: S, y: S) -> Option<Root<S>> {
        let (f, c) = (self.focal_length, self.receiver_z);
        let (factor, irradiance, conditioning) = match self.light {
            Light::Focus(intensity) => (
                S::ONE,
                collimated(self.reflectance * intensity, f, x, y),
                conditioning([f, x, y], |[f, x, y]| collimated(Scalar::ONE, f, x, y)),
            ),
            Light::Beam(e0) => {
                let g = (c - f).abs();
                let distance = x.hypot(y).hypot(g);
                if distance == S::ZERO {
                    return self.in_focus();
                }
                let side = if c > f { -S::ONE } else { S::ONE };
                (
                    side * S::TWO * f / (distance + g),
                    focused(self.reflectance * e0, f, c, x, y),
                    conditioning([f, c, x, y], |[f, c, x, y]| {
                        focused(Scalar::ONE, f, c, x, y)
                    }),
                )
            }
        };
        let (mx, my) = (factor * x, factor * y);
        let radius = mx.hypot(my);
        let height = radius.squared() / (S::from_f64(4.0) * f);
        (height < c).then(|| Root {
            specular_point: vec3(mx, my, height),
            irradiance,
            conditioning,
            inside: (self.outer_radius - radius).min(if self.inner_radius > S::ZERO {
                radius - self.inner_radius
            } else {
                S::ONE / S::ZERO
            }),
        })
    }

    /// All mirror points below the focus light it at once; one of them stands for all.
    fn in_focus(&self) -> Option<Root<S>> {
        let (f, r) = (self.focal_length, self.inner_radius);
        (r < S::TWO * f).then(|| Root {
            specular_point: vec3(r, S::ZERO, r.squared() / (S::from_f64(4.0) * f)),
            irradiance: S::ONE / S::ZERO,
            conditioning: S::ONE / S::ZERO,
            inside: self.outer_radius - r,
        })
    }

    /// Caustic irradiance (LSDE) at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let Some(root) = self.reflection(x, y) else {
            return sum;
        };
        if root.inside >= S::ZERO {
            sum.add(root.irradiance, root.conditioning);
        }
        // Rounding decides on the edge of the silver, or on whether the receiver is above the mirror.
        let size = self.outer_radius.max(self.receiver_z.abs());
        let room = rounding_error(size, root.conditioning);
        if root.inside.abs() <= room || self.receiver_z - root.specular_point.z <= room {
            sum.error += root.irradiance;
        }
        sum
    }

    /// Direct irradiance (LDE) at (x, y) [W/m²]: the light at the focus, if the receiver is above it. A beam comes from
    /// behind.
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        match self.light {
            Light::Beam(_) => Estimate::NONE,
            // The receiver faces down: look at it in a mirror.
            Light::Focus(intensity) => diffuse::direct(
                vec3(S::ZERO, S::ZERO, -self.focal_length),
                intensity,
                vec3(x, y, -self.receiver_z),
            ),
        }
    }

    /// The focus of the beam; the collimated light has no singularity.
    pub fn singularity(&self, x: S, y: S) -> Option<Singularity<S>> {
        match self.light {
            Light::Focus(_) => None,
            Light::Beam(_) => Some(Singularity {
                kind: SingularityKind::PointFocus,
                distance: x.hypot(y).hypot(self.receiver_z - self.focal_length),
            }),
        }
    }
}
