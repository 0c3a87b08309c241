//! Controls without a specular surface: a floor, a sphere, a furnace. Theory block A.

use crate::certificate::radiometry::{Facing, Point, point_light_enclosed, power_enclosed};
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

/// A point light over the floor z = 0.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    light: Point,
    intensity: Enclosure,
}

impl Floor {
    /// The floor of `light` and `I`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(Floor {
            light: p.point("light")?,
            intensity: p.number("I")?,
        })
    }

    /// E = I h/d³ of a point of the floor.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let mut sum = Certified::NONE;
        let (e, lit) = point_light_enclosed(self.light, self.intensity, x, Facing::Up);
        sum.add(e, lit);
        sum
    }
}

/// A closed Lambertian sphere with a point light inside.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    radius: Enclosure,
    offset: Enclosure,
    intensity: Enclosure,
    albedo: Enclosure,
}

impl Sphere {
    /// The sphere of `a`, `s`, `I` and `albedo2`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        Some(Sphere {
            radius: p.number("a")?,
            offset: p.number("s")?,
            intensity: p.number("I")?,
            albedo: p.number("albedo2")?,
        })
    }

    /// Irradiance of the wall point with polar cosine c: I (a - s c)/d³, d² = (a - s)² + 2 a s (1 - c).
    pub fn direct_enclosed(&self, c: Enclosure) -> Certified {
        let (a, s) = (self.radius, self.offset);
        let squared = (a - s).squared() + Enclosure::TWO * a * s * (Enclosure::ONE - c);
        let cosine = a - s * c;
        let mut sum = Certified::NONE;
        sum.add(
            self.intensity * cosine / (squared * squared.sqrt()),
            Lit::where_positive(cosine),
        );
        sum
    }

    /// What bounce k ≥ 1 adds: ρ^k I/a².
    pub fn bounce_enclosed(&self, k: u32) -> Certified {
        let unit = self.intensity / self.radius.squared();
        Certified::of(unit * power_enclosed(self.albedo, k))
    }

    /// All bounces: ρ/(1 - ρ) I/a².
    pub fn indirect_enclosed(&self) -> Certified {
        let unit = self.intensity / self.radius.squared();
        Certified::of(self.albedo / (Enclosure::ONE - self.albedo) * unit)
    }

    /// Radiance of an irradiance on the wall.
    pub fn radiance_enclosed(&self, irradiance: Certified) -> Certified {
        irradiance.times(self.albedo / Enclosure::PI)
    }
}

/// Radiance in a furnace after `bounces` reflections, or after all: Le (1 + ρ + ... + ρ^k).
pub fn furnace_enclosed(emission: Enclosure, albedo: Enclosure, bounces: Option<u32>) -> Certified {
    let rest = Enclosure::ONE - albedo;
    let series = match bounces {
        Some(k) if k <= 64 => (0..k).fold(Enclosure::ONE, |s, _| Enclosure::ONE + albedo * s),
        // A power that is not multiplied out still is between 0 and its 64th.
        Some(_) => {
            let power = power_enclosed(albedo, 65).hull(Enclosure::ZERO);
            (Enclosure::ONE - power) / rest
        }
        None => Enclosure::ONE / rest,
    };
    Certified::of(emission * series)
}
