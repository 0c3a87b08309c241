//! Transition matrices: distributions, second eigenvalue, Doeblin's bound.

/// A row-stochastic matrix on N states: `rows[i][j]` is the probability of a step from i to j.
#[derive(Clone, Debug)]
pub struct Transition<const N: usize> {
    /// The rows.
    pub rows: Box<[[f64; N]; N]>,
}

/// Starting values and steps of the eigenvalue iteration; Jacobi's sweeps converge quadratically.
const SWEEPS: usize = 60;

impl<const N: usize> Transition<N> {
    /// The identity.
    pub fn identity() -> Self {
        let mut rows = Box::new([[0.0; N]; N]);
        for i in 0..N {
            rows[i][i] = 1.0;
        }
        Self { rows }
    }

    /// The distribution after a step.
    pub fn step(&self, distribution: &[f64; N]) -> [f64; N] {
        let mut next = [0.0; N];
        for (mass, row) in distribution.iter().zip(self.rows.iter()) {
            for (to, probability) in next.iter_mut().zip(row) {
                *to += mass * probability;
            }
        }
        next
    }

    /// This, then `o`.
    pub fn then(&self, o: &Self) -> Self {
        let mut rows = Box::new([[0.0; N]; N]);
        for (row, from) in rows.iter_mut().zip(self.rows.iter()) {
            *row = o.step(from);
        }
        Self { rows }
    }

    /// (1 - weight) this + weight `o`.
    pub fn mixed(&self, o: &Self, weight: f64) -> Self {
        let mut rows = self.rows.clone();
        for (row, other) in rows.iter_mut().zip(o.rows.iter()) {
            for (x, y) in row.iter_mut().zip(other) {
                *x = (1.0 - weight) * *x + weight * y;
            }
        }
        Self { rows }
    }

    /// Every row the same: forgets everything.
    pub fn refresh(distribution: &[f64; N]) -> Self {
        Self {
            rows: Box::new([*distribution; N]),
        }
    }

    /// Doeblin's ε: the largest number with Pᵢⱼ ≥ ε πⱼ for all i and j. The distance to π then falls by 1 - ε in
    /// every step. 0 at least.
    pub fn doeblin(&self, stationary: &[f64; N]) -> f64 {
        let mut least = f64::INFINITY;
        for row in self.rows.iter() {
            for (p, pi) in row.iter().zip(stationary) {
                if *pi > 0.0 {
                    least = least.min(p / pi);
                }
            }
        }
        least
    }

    /// Dobrushin's coefficient: half the largest L¹ distance of two rows, at least the second eigenvalue's modulus.
    pub fn dobrushin(&self) -> f64 {
        let mut most = 0.0;
        for (i, a) in self.rows.iter().enumerate() {
            for b in &self.rows[..i] {
                let distance: f64 = a.iter().zip(b).map(|(x, y)| f64::abs(x - y)).sum();
                most = f64::max(most, 0.5 * distance);
            }
        }
        most
    }

    /// Largest violation of detailed balance πᵢ Pᵢⱼ = πⱼ Pⱼᵢ.
    pub fn imbalance(&self, stationary: &[f64; N]) -> f64 {
        let mut most = 0.0;
        for i in 0..N {
            for j in 0..i {
                let flow = stationary[i] * self.rows[i][j] - stationary[j] * self.rows[j][i];
                most = f64::max(most, f64::abs(flow));
            }
        }
        most
    }

    /// Modulus of the second-largest eigenvalue of a chain in detailed balance with `stationary` > 0: the eigenvalues of
    /// √πᵢ Pᵢⱼ/√πⱼ, which is symmetric, by Jacobi's rotations.
    pub fn second_eigenvalue(&self, stationary: &[f64; N]) -> f64 {
        let root = stationary.map(f64::sqrt);
        let mut a = self.rows.clone();
        for i in 0..N {
            for j in 0..N {
                a[i][j] = root[i] * self.rows[i][j] / root[j];
            }
        }
        for i in 0..N {
            for j in 0..i {
                let mean = 0.5 * (a[i][j] + a[j][i]);
                (a[i][j], a[j][i]) = (mean, mean);
            }
        }
        for _ in 0..SWEEPS {
            let mut off = 0.0;
            for i in 0..N {
                for j in 0..i {
                    off += a[i][j] * a[i][j];
                    rotate(&mut a, i, j);
                }
            }
            if off < 1e-30 {
                break;
            }
        }
        let mut moduli: Vec<f64> = (0..N).map(|i| f64::abs(a[i][i])).collect();
        moduli.sort_unstable_by(|x, y| y.total_cmp(x));
        // The largest one is 1.
        moduli.get(1).copied().unwrap_or(0.0)
    }
}

/// One Jacobi rotation, which makes a[p][q] zero.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = f64::copysign(1.0, theta) / (f64::abs(theta) + f64::sqrt(theta * theta + 1.0));
    let c = 1.0 / f64::sqrt(t * t + 1.0);
    let s = t * c;
    for row in a.iter_mut() {
        let (x, y) = (row[p], row[q]);
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
    }
    let (x, y) = (a[p], a[q]);
    a[p] = core::array::from_fn(|k| c * x[k] - s * y[k]);
    a[q] = core::array::from_fn(|k| s * x[k] + c * y[k]);
}
