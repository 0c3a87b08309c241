//! Exact expectations on any specular surface: the mirror point (or the ray of light) as a pair of parameters.
//!
//! The polar coordinates of `unfold` exist for a plane mirror only. Elsewhere the deflection has folds: several roots, a
//! support of several parts that merge, a minimum without a root. So the parameters are those of the surface itself,
//! in which everything is smooth, and the support of the kernel is one more condition on them, like the mirror's edge:
//!
//! ```text
//! E_α(x) = ∫ φ_α(g(u)) w(u) du,    second moment = ∫ φ_α(g(u))² w(u) f(u) du,
//! ```
//!
//! w the density of the mean and f the value of one sample, both without the kernel (`theory/bandwidth.md` sections 2 and 4).

pub(super) mod connection;
mod cutter;
pub(super) mod merging;
pub(super) mod scenes;
mod surfaces;

pub(super) use cutter::integrate;

/// Number of margins of a node.
pub(super) const MARGINS: usize = 12;

/// What the integrals need at one pair of parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// What the kernel depends on: the squared chord of the deflection, 4 sin²(g/2), or the squared distance on the floor
    /// [m²]; in units of the squared bandwidth where that depends on the node. Smooth, also at a root.
    pub level: f64,
    /// What multiplies φ and φ² per parameter area.
    pub density: [f64; 2],
    /// Distance by which a linked bandwidth is found [m].
    pub distance: f64,
    /// The path exists where all are ≥ 0; smooth, with a change of sign. Where one is negative everything else may be NaN.
    pub margins: [f64; MARGINS],
}

/// A two-parameter family of paths with a kernel.
pub(super) trait Integrand {
    /// Rectangle of the parameters.
    fn domain(&self) -> [[f64; 2]; 2];
    /// Levels at which the kernel jumps or kinks, ascending; nothing is beyond the last.
    fn edges(&self) -> &[f64];
    /// A path.
    fn node(&self, u: [f64; 2]) -> Node;
    /// φ and φ² between the edges `ring - 1` and `ring`.
    fn kernel(&self, ring: usize, node: &Node) -> [f64; 2];
    /// Relative rounding of the level at the kernel's edge.
    fn rounding(&self) -> f64;
}
