//! How a root and its irradiance move with the ends of the legs.

use crate::scalar::Scalar;

/// The lengths and angles of a root, in units of the radius.
pub(super) struct Lengths<S> {
    pub r1: S,
    pub r2: S,
    /// r1 + r2; 1 for parallel light.
    pub sum: S,
    /// r1 r2; r2 for parallel light.
    pub product: S,
    pub cos_i: S,
    pub sin_i: S,
    pub tangential: S,
    pub sagittal: S,
    /// Height of the mirror point above the receiver.
    pub height: S,
}

impl<S: Scalar> Lengths<S> {
    fn far(&self) -> bool {
        !self.r1.is_finite()
    }

    /// |∂g| per displacement of source and receiver.
    pub fn reach(&self) -> S {
        if self.far() {
            S::ONE + self.r2
        } else {
            self.sum
        }
    }

    /// By how much φ moves per displacement of source and receiver: ∂g over |g'| = cos i |J_t|.
    pub fn moved(&self) -> S {
        self.reach() / (self.cos_i * self.tangential.abs())
    }

    /// Relative change of E per displacement of source and receiver.
    ///
    /// Along the circle r1 and r2 change by ± sin i, their sum not at all (Fermat), and cos i by sin i |cos i/r - σ|;
    /// moving an end of a leg turns it by 1/r. Moving the mirror point across the plane of incidence changes cos θ_x alone.
    pub fn conditioning(&self, sigma: S) -> S {
        let (c, s, two) = (self.cos_i, self.sin_i, S::TWO);
        let turn = |r: S| (c / r - sigma).abs();
        let (turns, difference) = if self.far() {
            (S::ONE + turn(self.r2), S::ONE)
        } else {
            (turn(self.r1) + turn(self.r2), (self.r1 - self.r2).abs())
        };
        let (reach, moved) = (self.reach(), self.moved());
        let tangential = two
            + two * reach / c * (S::ONE + s / c)
            + moved * s * two * (difference + self.product * turns / c) / c;
        let sagittal =
            two + two * two * reach + moved * s * two * (difference * c + self.product * turns);
        let shift = S::ONE + moved + reach / self.sagittal.abs();
        let cosine = shift / self.height.abs() + shift / self.r2;
        tangential / self.tangential.abs() + sagittal / self.sagittal.abs() + cosine
    }
}
