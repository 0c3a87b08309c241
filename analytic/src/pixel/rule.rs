//! Gauss–Legendre rules on [0, 1].

use crate::quadrature::gauss_legendre;

/// Nodes and weights on [0, 1]; exact for polynomials of degree 2n - 1.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Nodes, increasing.
    pub nodes: Vec<f64>,
    /// Weights, which add up to 1.
    pub weights: Vec<f64>,
}

impl Rule {
    /// The rule with `count` ≥ 1 nodes.
    pub fn gauss(count: usize) -> Self {
        let (nodes, weights) = gauss_legendre(count.max(1))
            .into_iter()
            .map(|(x, w)| (0.5 + 0.5 * x, 0.5 * w))
            .unzip();
        Rule { nodes, weights }
    }

    /// Nodes with their weights.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.nodes.iter().copied().zip(self.weights.iter().copied())
    }
}
