//! Reflection and Fresnel's equations, for any scalar.
//!
//! Fresnel factors are unpolarised: the mean of both polarisations, and they multiply per interface, as in scalar
//! renderers. They are written in q_j = n_j cos θ_j, the normal component of the wave vector in units of the vacuum's, so
//! that nothing cancels at grazing or critical incidence:
//!
//! ```text
//! r_s = (q1 - q2)/(q1 + q2),   r_p = (n2² q1 - n1² q2)/(n2² q1 + n1² q2),   F = (r_s² + r_p²)/2,
//! T = 1 - F = 2 q1 q2/(q1 + q2)² + 2 n1² n2² q1 q2/(n2² q1 + n1² q2)².
//! ```
//!
//! (M. Born & E. Wolf, Principles of Optics, 7th ed., §1.5.2, eqs. 20a, 21a, rewritten.)

use crate::scalar::Scalar;
use crate::vector::Vec3;

/// Reflects a direction, or the difference of two points, at a plane with unit normal `normal`.
#[inline(always)]
pub fn reflect<S: Scalar>(direction: Vec3<S>, normal: Vec3<S>) -> Vec3<S> {
    direction - normal * (S::TWO * direction.dot(normal))
}

/// Unpolarised reflectance F of an interface from index `n1` to `n2`, with q_j = n_j cos θ_j ≥ 0.
#[inline(always)]
pub fn fresnel_reflectance<S: Scalar>(n1: S, q1: S, n2: S, q2: S) -> S {
    let (m1, m2) = (n1.squared(), n2.squared());
    let s = (q1 - q2) / (q1 + q2);
    let p = (m2 * q1 - m1 * q2) / (m2 * q1 + m1 * q2);
    S::HALF * (s.squared() + p.squared())
}

/// Unpolarised transmittance T = 1 - F, without cancellation. Arguments as for [`fresnel_reflectance`].
#[inline(always)]
pub fn fresnel_transmittance<S: Scalar>(n1: S, q1: S, n2: S, q2: S) -> S {
    let (m1, m2) = (n1.squared(), n2.squared());
    let product = S::TWO * q1 * q2;
    product / (q1 + q2).squared() + m1 * m2 * product / (m2 * q1 + m1 * q2).squared()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_incidence_brewster_and_energy() {
        let f = fresnel_reflectance(1.0, 1.0, 1.5, 1.5);
        assert!((f - 0.04).abs() < 1e-16);
        // At Brewster's angle tan i = n only the s wave is reflected: ((n² - 1)/(n² + 1))²/2.
        let i = libm::atan(1.5);
        let (q1, q2) = (libm::cos(i), 1.5 * libm::sin(i));
        let f = fresnel_reflectance(1.0, q1, 1.5, q2);
        assert!((f - 0.5 * (1.25 / 3.25) * (1.25 / 3.25)).abs() < 1e-15);
        for k in 1..100 {
            let i = f64::from(k) * 0.0157;
            let q1 = libm::cos(i);
            let q2 = libm::sqrt(1.333 * 1.333 - libm::sin(i) * libm::sin(i));
            let sum =
                fresnel_reflectance(1.0, q1, 1.333, q2) + fresnel_transmittance(1.0, q1, 1.333, q2);
            assert!((sum - 1.0).abs() < 4e-16);
        }
    }
}
