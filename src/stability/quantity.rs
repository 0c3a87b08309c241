//! What a sweep computes, and what it is compared with.

use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::scalar::Scalar;

use super::inputs::Inputs;
use super::{Precision, bandwidth, forms};

/// A quantity with a form and a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The kind's first caustic class, in any precision, against its enclosure.
    Caustic,
    /// A moment of a biased estimator at a finite bandwidth. The quadrature is `f64` only.
    Bandwidth(Moment),
}

/// A moment of a technique with a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// How the estimator builds its paths.
    pub technique: Technique,
    /// Its kernel.
    pub kernel: Kernel,
    /// The second moment, or else the mean.
    pub second: bool,
    /// What it is compared with.
    pub against: Against,
}

/// A reference for a bandwidth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The same integral over other coordinates, in double-double: not a proof, but 15 digits more.
    DoubleDouble,
    /// The enclosure of the sharp limit times the theory's 1 + κ⟨g²⟩, for small bandwidths only.
    SmallBandwidthLaw,
}

/// Where the exact value is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Not above it.
    pub low: f64,
    /// Not below it.
    pub high: f64,
    /// Whether the certificate cannot decide between two values.
    pub undecided: bool,
}

impl Reference {
    /// An exact value that is known to a part of itself.
    pub fn around(value: f64, relative: f64) -> Self {
        let width = value.abs() * relative;
        Reference {
            low: value - width,
            high: value + width,
            undecided: false,
        }
    }

    /// The middle.
    pub fn middle(&self) -> f64 {
        self.low + 0.5 * (self.high - self.low)
    }

    /// Whether it says anything.
    pub fn is_proven(&self) -> bool {
        !self.undecided && self.low.is_finite() && self.high.is_finite()
    }
}

impl Quantity {
    /// The precisions in which there is a form.
    pub const fn precisions(&self) -> &'static [Precision] {
        match self {
            Quantity::Caustic => &Precision::ALL,
            Quantity::Bandwidth(_) => &[Precision::Double],
        }
    }

    /// Value and error bound in the precision of `S`; `None` if the numbers are outside what the form holds for.
    pub fn estimate<S: Scalar>(&self, kind: &str, inputs: &Inputs) -> Option<[f64; 2]> {
        match self {
            Quantity::Caustic => {
                let e = forms::irradiance::<S>(kind, inputs)?;
                Some([e.value.to_f64(), e.error.to_f64()])
            }
            Quantity::Bandwidth(moment) => bandwidth::estimate(moment, inputs),
        }
    }

    /// The reference for exactly the same numbers.
    pub fn reference(&self, kind: &str, inputs: &Inputs) -> Option<Reference> {
        match self {
            Quantity::Caustic => {
                let certified = forms::enclosed(kind, inputs)?;
                Some(Reference {
                    low: certified.value.low(),
                    high: certified.value.high(),
                    undecided: certified.undecided,
                })
            }
            Quantity::Bandwidth(moment) => bandwidth::reference(moment, inputs),
        }
    }
}
