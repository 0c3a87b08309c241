//! The beam's rays by incidence angle: what they carry and where they land, smooth through fold rings and across the axis.

use super::GlassSphere;
use crate::scalar::Scalar;

/// The rays of one incidence angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing<S> {
    /// a sin i - c sin δ: the signed distance from the axis at which they meet the receiver is this over the cosine [m].
    pub offset: S,
    /// cos δ: they reach a receiver behind the sphere where it is positive, one before it where it is negative.
    pub cosine: S,
    /// Flux per incidence angle and azimuth, E0 W a² sin i cos i [W/rad²].
    pub flux: S,
}

impl<S: Scalar> GlassSphere<S> {
    /// The rays that come in at the angle `incidence`, after `interactions`.
    pub fn landing_of(&self, incidence: S, interactions: u32) -> Landing<S> {
        let ray = self.ray(incidence, interactions);
        let section = self.radius.squared() * ray.sin_i * ray.cos_i;
        Landing {
            offset: self.radius * ray.sin_i - self.receiver_z * ray.sin_d,
            cosine: ray.cos_d,
            flux: self.irradiance * self.weight(&ray, interactions) * section,
        }
    }

    /// Product W of the Fresnel factors of the rays that come in at the angle `incidence`.
    pub fn weight_of(&self, incidence: S, interactions: u32) -> S {
        self.weight(&self.ray(incidence, interactions), interactions)
    }
}
