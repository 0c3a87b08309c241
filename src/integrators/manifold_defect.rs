//! What each fault does to specular manifold sampling. Without one nothing here changes a bit.

use glam::DVec3;

use super::fault::Fault;
use super::manifold_walk::{EXACT, Precision, Solution};
use crate::geometry::scene::unit;

/// Of unit directions that are counted as one, the cosine is at least 1 minus this: the public code's default.
const UNIQUENESS: f64 = 1e-4;
/// A residual that passes for none.
const LOOSE: f64 = 1e-3;
/// Walks after which [`Fault::TrialsBounded`] gives up, and those of [`Fault::FixedNumberOfWalks`].
const FEW: u64 = 4;

/// A fault, or none.
#[derive(Clone, Copy, Debug)]
pub(super) struct ManifoldDefect(Option<Fault>);

impl ManifoldDefect {
    pub fn new(fault: Option<Fault>) -> Self {
        ManifoldDefect(fault)
    }

    fn is(&self, fault: Fault) -> bool {
        self.0 == Some(fault)
    }

    /// |dω₁/dω₂| from c₁/r₁², c₂/|det H| and r₂, which is infinite for parallel light.
    pub fn jacobian(&self, solid_angle: f64, area: f64, distance: f64) -> f64 {
        let own = solid_angle * area;
        let squared = distance * distance;
        let clamp = match self.0 {
            // Surface per unit of area at the light.
            Some(Fault::ManifoldJacobianClamped) if squared.is_finite() => solid_angle * squared,
            Some(Fault::ManifoldJacobianClamped) => 10.0,
            Some(Fault::GeneralizedGeometryClamped) if squared.is_finite() => 2.0 * squared,
            Some(Fault::GeneralizedGeometryClamped) => 2.0,
            _ => return own,
        };
        own.min(clamp)
    }

    /// When a walk ends.
    pub fn precision(&self) -> Precision {
        if self.is(Fault::ResidualLoose) {
            Precision {
                last_step: LOOSE,
                ..EXACT
            }
        } else {
            EXACT
        }
    }

    /// The squared chord up to which a solution is one.
    pub fn agrees(&self, exact: f64) -> f64 {
        if self.is(Fault::ResidualLoose) {
            // A residual turns the direction by about as much, more where the surface is curved.
            100.0 * LOOSE * LOOSE
        } else {
            exact
        }
    }

    /// Whether two solutions are the same.
    pub fn same(&self, x: DVec3, a: &Solution, b: &Solution, precision: Precision) -> bool {
        match self.0 {
            Some(Fault::SolutionsMerged | Fault::ResidualLoose) => {
                let [a, b] = [a, b].map(|s| unit(s.point - x));
                f64::abs(a.dot(b) - 1.0) < UNIQUENESS
            }
            _ => a.is(b, precision),
        }
    }

    /// The number of walks of the variant that has a fixed one.
    pub fn fixed_walks(&self) -> Option<u64> {
        self.is(Fault::FixedNumberOfWalks).then_some(FEW)
    }

    /// Whether so many further walks are enough to give up.
    pub fn gives_up(&self, walks: u64) -> bool {
        self.is(Fault::TrialsBounded) && walks >= FEW
    }

    /// The estimate of the reciprocal probability after so many further walks.
    pub fn reciprocal(&self, walks: u64) -> f64 {
        match self.0 {
            Some(Fault::ReciprocalOffByOne) => (walks - 1) as f64,
            Some(Fault::ReciprocalForgotten) => 1.0,
            _ => walks as f64,
        }
    }
}
