//! Fold rings and the axial line of the glass sphere.
//!
//! A ray reaches the receiver at X(i) = (a sin i - c sin δ)/cos δ, and X' cos² δ = Φ with
//!
//! ```text
//! Φ(i) = a cos i cos δ + δ' (a sin i sin δ - c).
//! ```
//!
//! The zeros of Φ are the fold rings (the rainbow among them); a zero at i = 0 is the paraxial focus, where a ring closes
//! to a cusp. The zeros of X off the axis are the rings whose rays meet on it. Both are isolated from bounds of the second
//! derivative, so that none is missed.

use super::{GlassSphere, Ray};
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;

/// A ring on which two rays of one class merge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold<S> {
    /// Incidence angle [rad].
    pub incidence: S,
    /// Radius of the ring on the receiver [m].
    pub radius: S,
    /// Fold, or cusp where the ring closes on the axis or two rings merge.
    pub kind: SingularityKind,
}

impl<S: Scalar> GlassSphere<S> {
    /// Visits every fold ring of rays with exactly `interactions` that the beam lights, in ascending incidence.
    pub fn for_each_fold(&self, interactions: u32, mut visit: impl FnMut(Fold<S>)) {
        for_each_root(
            S::ZERO,
            self.max_incidence,
            |i, half| self.fold_local(interactions, i, half),
            |root| {
                let (incidence, double) = match root {
                    Isolated::Simple(i) => (i, false),
                    Isolated::Touching(i) => (i, true),
                };
                let ray = self.ray(incidence, interactions);
                if ray.cos_d * self.receiver_z > S::ZERO {
                    let radius = self.landing(&ray).abs();
                    let closed = !(radius > S::EPSILON.sqrt() * self.radius);
                    let kind = if double || closed {
                        SingularityKind::Cusp
                    } else {
                        SingularityKind::Fold
                    };
                    visit(Fold {
                        incidence,
                        radius,
                        kind,
                    });
                }
            },
        );
    }

    /// X: the distance from the axis, on the side that the ray came from, at which it meets the receiver [m].
    fn landing(&self, ray: &Ray<S>) -> S {
        (self.radius * ray.sin_i - self.receiver_z * ray.sin_d) / ray.cos_d
    }

    fn fold_local(&self, interactions: u32, i: S, half: S) -> Local<S> {
        let (a, c) = (self.radius, self.receiver_z);
        let ray = self.ray(i, interactions);
        let chords = S::TWO * S::from_f64(f64::from(interactions) - 1.0);
        let turn_1 = self.turn_1(&ray, interactions);
        let turn = ray.turn;
        let value = a * ray.cos_i * ray.cos_d + turn * (a * ray.sin_i * ray.sin_d - c);
        let inner = a * (ray.cos_d * (turn.squared() - S::ONE) + turn_1 * ray.sin_d);
        let b = self.bounds(&ray, half, interactions);
        let stretch = b.turn.squared() + S::ONE;
        // |d/di| of sin i [cos δ (δ'² - 1) + δ'' sin δ] and of δ'', term by term.
        let curvature = a
            * (stretch
                + b.turn_1
                + b.turn * stretch
                + S::from_f64(3.0) * b.turn * b.turn_1
                + b.turn_2)
            + c.abs() * b.turn_2;
        Local {
            value,
            slope: ray.sin_i * inner - c * turn_1,
            curvature,
            noise: S::from_f64(8.0) * S::EPSILON * (a + c.abs()) * (S::ONE + chords),
        }
    }

    /// Whether a ring of rays off the axis meets it on the receiver.
    pub fn has_axial_line(&self, interactions: u32) -> bool {
        let mut found = false;
        self.for_each_root(S::ZERO, interactions, |root| {
            let off_axis = root.incidence.abs() > S::EPSILON.sqrt();
            found |= off_axis && root.inside >= S::ZERO;
        });
        found
    }

    /// The singularity of rays with exactly `interactions` that is nearest to the distance ρ from the axis.
    pub fn singularity(&self, rho: S, interactions: u32) -> Option<Singularity<S>> {
        let mut nearest = self.has_axial_line(interactions).then_some(Singularity {
            kind: SingularityKind::LineFocus,
            distance: rho,
        });
        self.for_each_fold(interactions, |fold| {
            let ring = Singularity {
                kind: fold.kind,
                distance: (fold.radius - rho).abs(),
            };
            nearest = Singularity::nearer(nearest, Some(ring));
        });
        nearest
    }
}
