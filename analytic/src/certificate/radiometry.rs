//! What all certificates share: rays that arrive or not, the inverse-square law, Fresnel's factors.

use crate::certificate::{Certified, Lit};
use crate::enclosure::Enclosure;
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::scalar::Scalar;
use crate::vector::Vec3;

/// A point of which each coordinate is enclosed.
pub type Point = Vec3<Enclosure>;

/// The rays of one path class at a point.
#[derive(Clone, Debug)]
pub struct Bundle {
    /// Their sum.
    pub total: Certified,
    /// The irradiance of each ray that arrives, or may arrive.
    pub rays: Vec<(Enclosure, Lit)>,
}

impl Default for Bundle {
    fn default() -> Self {
        Bundle {
            total: Certified::NONE,
            rays: vec![],
        }
    }
}

impl Bundle {
    /// Adds a ray.
    pub fn add(&mut self, irradiance: Enclosure, lit: Lit) {
        self.total.add(irradiance, lit);
        if lit != Lit::No {
            self.rays.push((irradiance, lit));
        }
    }

    /// A class of at most one ray.
    pub fn single(irradiance: Enclosure, lit: Lit) -> Self {
        let mut bundle = Bundle::default();
        bundle.add(irradiance, lit);
        bundle
    }
}

/// Which way a horizontal receiver looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Towards +z.
    Up,
    /// Towards -z.
    Down,
}

impl Facing {
    /// How far `above` is in front of `below` along z.
    pub fn height(self, above: Enclosure, below: Enclosure) -> Enclosure {
        match self {
            Facing::Up => above - below,
            Facing::Down => below - above,
        }
    }
}

/// Irradiance by a point light, E = I h/d³, and whether it is in front of the receiver.
pub fn point_light_enclosed(
    light: Point,
    intensity: Enclosure,
    x: Point,
    facing: Facing,
) -> (Enclosure, Lit) {
    let to_light = light - x;
    let height = facing.height(light.z, x.z);
    let squared = to_light.x.squared() + to_light.y.squared() + to_light.z.squared();
    (
        intensity * height / (squared * squared.sqrt()),
        Lit::where_positive(height),
    )
}

/// F of an interface from index n1 to n2, within [0, 1].
pub fn reflectance_enclosed(
    n1: Enclosure,
    q1: Enclosure,
    n2: Enclosure,
    q2: Enclosure,
) -> Enclosure {
    within_unit(fresnel_reflectance(n1, q1, n2, q2))
}

/// T of an interface from index n1 to n2, within [0, 1].
pub fn transmittance_enclosed(
    n1: Enclosure,
    q1: Enclosure,
    n2: Enclosure,
    q2: Enclosure,
) -> Enclosure {
    within_unit(fresnel_transmittance(n1, q1, n2, q2))
}

/// The part of an interval that a fraction can be.
pub fn within_unit(value: Enclosure) -> Enclosure {
    let unit = Enclosure::new(0.0, 1.0);
    value.intersection(unit).unwrap_or(unit)
}

/// `base^exponent` for base ≥ 0.
pub fn power_enclosed(base: Enclosure, exponent: u32) -> Enclosure {
    (0..exponent).fold(Enclosure::ONE, |product, _| product * base)
}

/// A whole number.
pub fn whole(value: u32) -> Enclosure {
    Enclosure::point(f64::from(value))
}

/// Squared distance of two numbers' point from the origin, never below 0.
pub fn plan_squared(x: Enclosure, y: Enclosure) -> Enclosure {
    x.squared() + y.squared()
}
