//! Proofs: intervals that contain the true value of a quantity, and the true number of rays behind it.
//!
//! The closed forms of [`crate::kinds`] are fast and carry an error bound that is estimated. Here the same quantities are
//! enclosed with [`Enclosure`]s, from decimal parameters to the sum over all rays, so that nothing is estimated:
//!
//! * formulas are straight-line code over enclosures, derived anew from the theory and not shared with the `f64` path;
//! * the rays of one class are the zeros of a function of one variable, found, counted and enclosed by [`roots`];
//! * a series ends with an enclosed bound of its tail;
//! * whether a ray is blocked is decided in three values, [`Lit`]: an undecided ray contributes anything from nothing to
//!   its whole irradiance, and the value says so.
//!
//! Functions that return an enclosure end in `_enclosed`.

pub mod claims;
pub mod conic_mirrors;
pub mod conic_wall;
pub mod cylinder_cup;
pub mod diffuse;
pub mod entry;
pub mod flat_interface;
pub mod glass_pillar;
pub mod glass_slab;
pub mod glass_sphere;
pub mod layers;
pub mod paraboloid;
pub mod pillar;
pub mod planar_chains;
pub mod planar_mirror;
pub mod radiometry;
pub mod ripples;
pub mod roots;
pub mod scene;
pub mod source;
pub mod sphere_mirror;
pub mod stigmatic_refractors;
pub mod vertical_walls;
pub mod water_waves;

use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

/// A quantity with its proof.
#[derive(Clone, Copy, Debug)]
pub struct Certified {
    /// Contains the true value, whatever the other fields say.
    pub value: Enclosure,
    /// Number of rays that certainly contribute.
    pub roots: u32,
    /// Whether more rays may contribute: a fold or a shadow's edge within rounding. The value then includes both.
    pub undecided: bool,
}

impl Certified {
    /// No light at all.
    pub const NONE: Self = Certified {
        value: Enclosure::ZERO,
        roots: 0,
        undecided: false,
    };

    /// One ray that is certainly there.
    pub fn of(value: Enclosure) -> Self {
        Certified {
            value,
            roots: 1,
            undecided: false,
        }
    }

    /// Whether the value is bounded and the number of rays known.
    pub fn is_proven(&self) -> bool {
        !self.undecided && self.value.is_finite()
    }

    /// Adds a ray.
    pub fn add(&mut self, irradiance: Enclosure, lit: Lit) {
        match lit {
            Lit::Yes => {
                self.value += irradiance;
                self.roots += 1;
            }
            Lit::No => {}
            Lit::Undecided => {
                self.value += irradiance.hull(Enclosure::ZERO);
                self.undecided = true;
            }
        }
    }

    /// Adds what cannot be told apart from a fold: any amount of light.
    pub fn add_unresolved(&mut self) {
        self.value += Enclosure::new(0.0, f64::INFINITY);
        self.undecided = true;
    }

    /// Adds another sum.
    pub fn join(&mut self, other: Self) {
        self.value += other.value;
        self.roots += other.roots;
        self.undecided |= other.undecided;
    }

    /// What holds wherever one of two holds.
    pub fn either(self, other: Self) -> Self {
        Certified {
            value: self.value.hull(other.value),
            roots: self.roots.min(other.roots),
            undecided: self.undecided || other.undecided || self.roots != other.roots,
        }
    }

    /// The value times a factor.
    pub fn times(self, factor: Enclosure) -> Self {
        Certified {
            value: self.value * factor,
            ..self
        }
    }
}

/// Whether a ray arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lit {
    /// Certainly.
    Yes,
    /// Certainly not.
    No,
    /// The decision is within rounding.
    Undecided,
}

impl Lit {
    /// Lit where `margin` is above 0.
    pub fn where_positive(margin: Enclosure) -> Self {
        if margin.is_positive() {
            Lit::Yes
        } else if margin.high() <= 0.0 {
            Lit::No
        } else {
            Lit::Undecided
        }
    }

    /// Lit where `margin` is 0 or above.
    pub fn where_not_negative(margin: Enclosure) -> Self {
        if margin.low() >= 0.0 {
            Lit::Yes
        } else if margin.is_negative() {
            Lit::No
        } else {
            Lit::Undecided
        }
    }

    /// Lit if both are.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Lit::No, _) | (_, Lit::No) => Lit::No,
            (Lit::Yes, Lit::Yes) => Lit::Yes,
            _ => Lit::Undecided,
        }
    }

    /// Lit if one is.
    pub fn or(self, other: Self) -> Self {
        self.inverted().and(other.inverted()).inverted()
    }

    /// Lit where it was dark.
    pub fn inverted(self) -> Self {
        match self {
            Lit::Yes => Lit::No,
            Lit::No => Lit::Yes,
            Lit::Undecided => Lit::Undecided,
        }
    }
}
