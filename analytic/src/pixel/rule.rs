//! Gauss–Legendre rules on [0, 1], computed once.

use core::f64::consts::PI;

use libm::cos;

/// Nodes and weights on [0, 1]; exact for polynomials of degree 2n - 1.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Nodes, increasing.
    pub nodes: Vec<f64>,
    /// Weights; they add up to 1.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The rule with `count` ≥ 1 nodes. **Accuracy**: 1e-15 absolute in nodes and weights for up to 100 nodes.
    pub fn gauss(count: usize) -> Self {
        let n = count.max(1);
        let (mut nodes, mut weights) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n.div_ceil(2) {
            // Newton on P_n from Tricomi's estimate of the root.
            let mut x = cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..n {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = n as f64 * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            if 2 * i + 1 == n {
                x = 0.0;
            }
            let weight = 1.0 / ((1.0 - x * x) * slope * slope);
            nodes[i] = 0.5 - 0.5 * x;
            nodes[n - 1 - i] = 0.5 + 0.5 * x;
            weights[i] = weight;
            weights[n - 1 - i] = weight;
        }
        Rule { nodes, weights }
    }

    /// Nodes with their weights.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }
}
