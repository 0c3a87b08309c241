//! Scenes without a specular surface: the controls.
//!
//! * A point light over a floor: E = I h/d³.
//! * A closed Lambertian sphere of radius a, albedo ρ, with a point light at distance s from the centre: the form factor
//!   between any two points of a sphere is the same, so bounce k ≥ 1 adds the same ρ^k I/a² everywhere (the mean of the
//!   direct irradiance is 4π I/(4π a²)) and the sum of all is ρ/(1-ρ) I/a². At the wall point with polar cosine c the
//!   light is at distance d² = a² + s² - 2 a s c and the cosine there is (a - s c)/d: E_direct = I (a - s c)/d³.
//! * A furnace: a closed wall that emits Le and reflects ρ has radiance Le (1 - ρ^{k+1})/(1 - ρ) after k bounces.
//!
//! Theory block A. No singularity.

use super::Estimate;
use crate::scalar::Scalar;
use crate::vector::Vec3;

/// Irradiance of a point `x` that faces up, under a point light of intensity I [W/sr] at `light` [W/m²]; zero if the
/// light is not above the point.
pub fn direct<S: Scalar>(light: Vec3<S>, intensity: S, x: Vec3<S>) -> Estimate<S> {
    let mut sum = Estimate::NONE;
    let to_light = light - x;
    if !(to_light.z > S::ZERO) {
        return sum;
    }
    let squared = to_light.length_squared();
    let distance = squared.sqrt();
    let size = light.length() + x.length();
    let conditioning = size * (S::ONE / to_light.z + S::from_f64(3.0) / distance);
    sum.add(intensity * to_light.z / (squared * distance), conditioning);
    sum
}

/// A closed Lambertian sphere with an isotropic point light inside.
#[derive(Clone, Copy, Debug)]
pub struct Sphere<S> {
    /// Radius a [m].
    pub radius: S,
    /// Distance s of the light from the centre, |s| < a [m].
    pub offset: S,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Albedo ρ < 1.
    pub albedo: S,
}

impl<S: Scalar> Sphere<S> {
    /// Direct irradiance of the wall point with polar cosine `c` [W/m²].
    pub fn direct(&self, c: S) -> Estimate<S> {
        let (a, s) = (self.radius, self.offset);
        // a² + s² - 2 a s c without cancellation at c = 1.
        let squared = (a - s).squared() + S::TWO * a * s * (S::ONE - c);
        let distance = squared.sqrt();
        let cosine = a - s * c;
        let size = a + s.abs();
        let mut sum = Estimate::NONE;
        sum.add(
            self.intensity * cosine / (squared * distance),
            size * (S::TWO / cosine + S::from_f64(6.0) * size / squared),
        );
        sum
    }

    /// What bounce k adds to the irradiance, everywhere on the wall: ρ^k I/a² [W/m²].
    pub fn bounce(&self, k: u32) -> Estimate<S> {
        let unit = self.intensity / self.radius.squared();
        let mut sum = Estimate::NONE;
        sum.add(
            (0..k).fold(unit, |e, _| e * self.albedo),
            S::from_f64(f64::from(k)),
        );
        sum
    }

    /// Irradiance by all bounces: ρ/(1-ρ) I/a² [W/m²].
    pub fn indirect(&self) -> Estimate<S> {
        let rest = S::ONE - self.albedo;
        let mut sum = Estimate::NONE;
        sum.add(
            self.albedo / rest * (self.intensity / self.radius.squared()),
            S::ONE / rest,
        );
        sum
    }
}

/// Radiance in a furnace after `bounces` reflections, or after all: Le (1 - ρ^{k+1})/(1 - ρ) [W m⁻² sr⁻¹].
pub fn furnace<S: Scalar>(emission: S, albedo: S, bounces: Option<u32>) -> Estimate<S> {
    let rest = S::ONE - albedo;
    let mut sum = Estimate::NONE;
    let (value, conditioning) = match bounces {
        // The sum itself: no cancellation for ρ near 1 either.
        Some(k) => {
            let k = k.min(1_000_000);
            let series = (0..k).fold(S::ONE, |s, _| S::ONE + albedo * s);
            (
                emission * series,
                S::from_f64(f64::from(k)).min(S::ONE / rest),
            )
        }
        None => (emission / rest, S::ONE / rest),
    };
    sum.add(value, conditioning);
    sum
}
