//! How much the light through or off the interface changes with its inputs: the logarithmic derivatives of E.
//!
//! With A = Σ l_j/q_j and B = Σ l_j n_j²/q_j³, ln E = ln τ - ln q_src - ln A - ln B + const is a function of the ray parameter p
//! and of the inputs; dp = dX/B at fixed layers, and dq_j = -p dp/q_j. Off the interface E = I F D/(X² + D²)^{3/2}, and F changes with
//! the incidence angle like 1/q_2 next to the critical one. All partial derivatives are added up with their moduli.

use super::{FlatInterface, Refracted};
use crate::scalar::Scalar;

impl<S: Scalar> FlatInterface<S> {
    /// Upper bound of the relative change of a root's irradiance per relative change of x, y, the heights and n.
    pub fn conditioning(&self, x: S, y: S) -> S {
        let plan = (x - self.light.x).hypot(y - self.light.y);
        let (l, n) = self.layers();
        // Coordinates are differences: their relative errors grow by this.
        let size =
            x.abs() + y.abs() + self.light.length() + self.surface_z.abs() + self.receiver_z.abs();
        let (k_plan, k_layers, k_index) = if self.is_refracted() {
            self.refracted_conditioning(plan, l, n)
        } else {
            self.reflected_conditioning(plan, l[0] + l[1], n[0])
        };
        let along_plan = if plan > S::ZERO { size / plan } else { S::ZERO };
        S::ONE + k_plan.abs() * along_plan + k_layers * size / l[0].min(l[1]) + k_index
    }

    /// |∂ ln E/∂ ln X|, the same for the thicknesses, and for n, of the refracted ray.
    fn refracted_conditioning(&self, plan: S, l: [S; 2], n: [S; 2]) -> (S, S, S) {
        let Refracted { p, q } = self.refract(plan, l, n);
        let three = S::from_f64(3.0);
        let cubed = |j: usize| q[j].squared() * q[j];
        let a = l[0] / q[0] + l[1] / q[1];
        let b = l[0] * n[0].squared() / cubed(0) + l[1] * n[1].squared() / cubed(1);
        // Derivatives with respect to p at fixed thicknesses; dq/dp = -p/q.
        let a_p = p * (l[0] / cubed(0) + l[1] / cubed(1));
        let b_p = three
            * p
            * (l[0] * n[0].squared() / (cubed(0) * q[0].squared())
                + l[1] * n[1].squared() / (cubed(1) * q[1].squared()));
        let t_p = self.log_transmittance(n, q, [-p / q[0], -p / q[1]], [S::ZERO; 2]);
        let e_p = (t_p + p / q[0].squared() - a_p / a - b_p / b).abs();
        let k_plan = plan * e_p / b;
        let k_layers = (0..2).fold(S::ZERO, |sum, j| {
            let direct = l[j] / q[j] / a + l[j] * n[j].squared() / cubed(j) / b;
            sum + direct + e_p * l[j] * p / q[j] / b
        });
        // Water: dq = n dn/q at fixed p, and p moves to keep X.
        let k_index = (0..2).fold(S::ZERO, |sum, j| {
            if n[j] == S::ONE {
                return sum;
            }
            let dq = n[j].squared() / q[j];
            let mut dqs = [S::ZERO; 2];
            let mut dns = [S::ZERO; 2];
            dqs[j] = dq;
            dns[j] = n[j];
            let t_n = self.log_transmittance(n, q, dqs, dns).abs();
            let term = l[j] / q[j].squared() * dq;
            let direct = t_n
                + S::TWO
                + dq / q[j]
                + term / a
                + S::from_f64(5.0) * l[j] * n[j].squared() / cubed(j) * (S::ONE + dq / q[j]) / b;
            sum + direct + e_p * p * term / b
        });
        (k_plan, k_layers, k_index)
    }

    /// Change of ln T for changes dq of the normal components and dn of the indices.
    fn log_transmittance(&self, n: [S; 2], q: [S; 2], dq: [S; 2], dn: [S; 2]) -> S {
        let (m1, m2) = (n[0].squared(), n[1].squared());
        let product = q[0] * q[1];
        let common = dq[0] / q[0] + dq[1] / q[1];
        let (s, p) = (q[0] + q[1], m2 * q[0] + m1 * q[1]);
        let (t_s, t_p) = (product / s.squared(), m1 * m2 * product / p.squared());
        let d_s = common - S::TWO * (dq[0] + dq[1]) / s;
        let dm = [S::TWO * n[0] * dn[0], S::TWO * n[1] * dn[1]];
        let dp = m2 * dq[0] + m1 * dq[1] + dm[1] * q[0] + dm[0] * q[1];
        let d_p = common + dm[0] / m1 + dm[1] / m2 - S::TWO * dp / p;
        (t_s * d_s + t_p * d_p) / (t_s + t_p)
    }

    /// As [`Self::refracted_conditioning`] for the reflected ray.
    fn reflected_conditioning(&self, plan: S, distance: S, n: S) -> (S, S, S) {
        let three = S::from_f64(3.0);
        let length = plan.hypot(distance);
        let (cosine, sine) = (distance / length, plan / length);
        let other = self.index / n;
        let (q1, q2_squared) = (n * cosine, (other - n * sine) * (other + n * sine));
        if !(q2_squared > S::ZERO) {
            // Total reflection: no kink on this side, only its distance.
            return (three, three + S::ONE, S::ZERO);
        }
        let q2 = q2_squared.sqrt();
        let (m1, m2) = (n.squared(), other.squared());
        let (s, p) = (q1 + q2, m2 * q1 + m1 * q2);
        let (r_s, r_p) = ((q1 - q2) / s, (m2 * q1 - m1 * q2) / p);
        let f = r_s.squared() + r_p.squared();
        if !(f > S::ZERO) {
            return (three, three + S::ONE, S::ZERO);
        }
        // d ln F for changes of q1, q2: both r are functions of q1/q2 (and n).
        let ratio = |dq1: S, dq2: S| q2 * dq1 - q1 * dq2;
        let change = |dq1: S, dq2: S, dm: S| {
            let ds = S::TWO * ratio(dq1, dq2) / s.squared();
            let dp = S::TWO * m1 * m2 * (ratio(dq1, dq2) + q1 * q2 * dm) / p.squared();
            S::TWO * (r_s * ds + r_p * dp).abs() / f
        };
        // di = X D/(X² + D²) per relative change of either length; dq1 = -n sin, dq2 = -n² sin cos/q2 per di.
        let turn = sine * cosine;
        let by_angle = change(-n * sine * turn, -m1 * sine * cosine * turn / q2, S::ZERO);
        let in_water = n != S::ONE;
        let (dq1, dq2) = if in_water {
            (q1, -m1 * sine.squared() / q2)
        } else {
            (S::ZERO, m2 / q2)
        };
        let by_index = change(dq1, dq2, S::TWO);
        (by_angle + three, by_angle + three + S::ONE, by_index)
    }
}
