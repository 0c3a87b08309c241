//! A chain on nested shells of the cone, with a random walk inside: 61 states and explicit matrices.
//!
//! State 0 are the regular paths; states 1 to 60 are shells of the current cone, from the outermost inwards, with the
//! ratio ½ in α, so of masses m (1 - 2^-d) 2^(-d j); the last one is the disc that is left. When the cone is halved, the
//! outermost shell is thrown to the regular state and every other one moves outwards by one.

use super::matrix::Transition;

/// Number of states.
pub const STATES: usize = 61;

/// Mass of the lobe, ε, and dimension.
#[derive(Clone, Copy, Debug)]
pub struct Shells {
    /// m.
    pub mass: f64,
    /// ε.
    pub refresh: f64,
    /// d.
    pub dimension: f64,
    /// Whether the kernel walks between neighbouring shells where it does not refresh.
    pub random_walk: bool,
}

impl Shells {
    /// π, relative to the current cone.
    pub fn stationary(&self) -> [f64; STATES] {
        let ratio = libm::exp2(-self.dimension);
        let mut pi = [1.0 - self.mass; STATES];
        let mut left = self.mass;
        for shell in &mut pi[1..STATES - 1] {
            *shell = left * (1.0 - ratio);
            left *= ratio;
        }
        pi[STATES - 1] = left;
        pi
    }

    /// The kernel at a fixed bandwidth, in detailed balance with π.
    pub fn kernel(&self) -> Transition<STATES> {
        let pi = self.stationary();
        let mut inner = Transition::<STATES>::identity();
        if self.random_walk {
            // Metropolis: propose a neighbour with ½ each, accept with min(1, ratio).
            for i in 1..STATES {
                for j in [i - 1, i + 1] {
                    if (1..STATES).contains(&j) {
                        let step = 0.5 * f64::min(1.0, pi[j] / pi[i]);
                        inner.rows[i][j] += step;
                        inner.rows[i][i] -= step;
                    }
                }
            }
        }
        inner.mixed(&Transition::refresh(&pi), self.refresh)
    }

    /// Halving of the cone.
    pub fn halving(&self) -> Transition<STATES> {
        let mut rows = Box::new([[0.0; STATES]; STATES]);
        rows[0][0] = 1.0;
        rows[1][0] = 1.0;
        for i in 2..STATES {
            rows[i][i - 1] = 1.0;
        }
        // The disc is a disc of the smaller cone as well, of which the last shell is a part.
        let inside = libm::exp2(-self.dimension);
        rows[STATES - 1][STATES - 2] = 1.0 - inside;
        rows[STATES - 1][STATES - 1] = inside;
        Transition { rows }
    }

    /// Occupancy after the last step, and its mean over the second half, with a halving every `period` steps.
    pub fn occupancy(&self, period: u32, steps: u32) -> (f64, f64) {
        let kernel = self.kernel();
        let halved = self.halving().then(&kernel);
        let mut distribution = self.stationary();
        let (mut sum, mut last) = (0.0, 0.0);
        for step in 1..=steps {
            let matrix = if step % period == 0 { &halved } else { &kernel };
            distribution = matrix.step(&distribution);
            last = 1.0 - distribution[0];
            if step > steps / 2 {
                sum += last;
            }
        }
        (last, sum / f64::from(steps - steps / 2))
    }
}
