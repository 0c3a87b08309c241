//! Smooth dielectrics: Snell's law in vector form and unpolarised Fresnel factors.

use glam::DVec3;

/// Reflectance of an interface with relative index n = n₂/n₁, from the cosines of both angles: the mean over the
/// polarisations of the squared amplitudes.
#[inline(always)]
pub fn reflectance(cos_1: f64, cos_2: f64, n: f64) -> f64 {
    let s = (cos_1 - n * cos_2) / (cos_1 + n * cos_2);
    let p = (n * cos_1 - cos_2) / (n * cos_1 + cos_2);
    0.5 * (s * s + p * p)
}

/// A unit direction refracted at an interface, and its reflectance there. `normal` is a unit vector on the side that the
/// ray comes from; `n` = n₂/n₁. At total internal reflection the reflectance is 1 and the direction has no meaning.
#[inline(always)]
pub fn refract(direction: DVec3, normal: DVec3, n: f64) -> (DVec3, f64) {
    let cos_1 = -direction.dot(normal);
    let across = direction + normal * cos_1;
    let square = 1.0 - across.dot(across) / (n * n);
    if !(square > 0.0) {
        return (direction, 1.0);
    }
    let cos_2 = f64::sqrt(square);
    (across / n - normal * cos_2, reflectance(cos_1, cos_2, n))
}
