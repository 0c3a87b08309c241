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

pub(super) mod chain;
pub(super) mod chains;
pub(super) mod connection;
mod cutter;
pub(super) mod link;
pub(super) mod merging;
pub(super) mod scatter;
pub(super) mod scenes;
mod star;
mod surfaces;
mod walls;

use super::quadrature::Pair;

/// Number of margins of a node.
pub(super) const MARGINS: usize = 15;

/// What the integrals need at one pair of parameters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Where the kernel ends, in the units of [`Integrand::edges`]: smooth at the scale of the scene however small the bandwidth is,
    /// so that its interpolants tell where the kernel cannot reach.
    pub level: f64,
    /// Not above the level, and smooth where the level is not (at the critical angle); NaN where there is nothing better than the level.
    pub least: f64,
    /// What the kernel depends on, zero at a root: the chord of the deflection, 2 sin(g/2) long, or the way on the floor [m], in units
    /// of the bandwidth where that depends on the node.
    pub deflection: [f64; 3],
    /// What multiplies φ and φ² per parameter area.
    pub density: [f64; 2],
    /// Distance by which a linked bandwidth is found [m].
    pub distance: f64,
    /// The path exists where all are ≥ 0; smooth, with a change of sign. Where one is negative everything else may be NaN.
    pub margins: [f64; MARGINS],
}

impl Node {
    /// Squared length of the deflection.
    #[inline(always)]
    pub fn square(&self) -> f64 {
        let [a, b, c] = self.deflection;
        a * a + b * b + c * c
    }
}

/// A two-parameter family of paths with a kernel.
pub(super) trait Integrand {
    /// Rectangle of the parameters.
    fn domain(&self) -> [[f64; 2]; 2];
    /// Levels at which the kernel jumps or kinks, ascending; nothing is beyond the last.
    fn edges(&self) -> &[f64];
    /// The same as squared lengths of the deflection.
    fn spans(&self) -> &[f64];
    /// A path.
    fn node(&self, u: [f64; 2]) -> Node;
    /// The margins of a path alone.
    fn margins(&self, u: [f64; 2]) -> [f64; MARGINS] {
        self.node(u).margins
    }
    /// φ and φ² between the edges `ring - 1` and `ring`.
    fn kernel(&self, ring: usize, node: &Node) -> [f64; 2];
    /// Relative rounding of the level at the kernel's edge.
    fn rounding(&self) -> f64;
    /// Cells along both axes on which nothing is hidden between nine samples.
    fn coarse(&self) -> [u32; 2] {
        [2, 2]
    }
    /// Second parameters, ascending, between which a thin layer at the low end of the domain is wide; none where there is none.
    fn layers(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// Roots that are taken out one by one; beyond, the parameters are cut.
const MOST_ROOTS: u32 = 6;

/// ∫∫ of an integrand, to `tolerance × max(|value|, floor)`.
///
/// Where a kernel is small and nothing cuts it, its support is a convex spot about a root, which polar coordinates take
/// at a hundredth of the cost. Such spots are cut out with a box, and what is left of the rectangle is searched for more.
pub(super) fn integrate<I: Integrand>(integrand: &I, tolerance: f64, floor: [f64; 2]) -> Pair {
    let mut sum = Pair::default();
    let whole = integrand.domain();
    let mut boxes = vec![(whole, 0)];
    let mut rest = Vec::new();
    while let Some((rectangle, roots)) = boxes.pop() {
        let spot = (roots < MOST_ROOTS)
            .then(|| star::spot(integrand, rectangle, tolerance))
            .flatten();
        let Some((inner, pair)) = spot else {
            rest.push(rectangle);
            continue;
        };
        sum.add(&pair);
        let ([a, b], [p, q]) = (rectangle, inner);
        for part in [
            [a, [b[0], q[0]]],
            [a, [q[1], b[1]]],
            [[a[0], p[0]], q],
            [[p[1], a[1]], q],
        ] {
            if part.iter().all(|[low, high]| low < high) {
                boxes.push((part, roots + 1));
            }
        }
    }
    // Nine samples do not see a layer that is thin beside their cell.
    for at in integrand.layers() {
        for k in 0..rest.len() {
            let [a, [low, high]] = rest[k];
            if low < at && at < high {
                rest[k] = [a, [low, at]];
                rest.push([a, [at, high]]);
            }
        }
    }
    sum.add(&cutter::integrate(
        integrand, &rest, tolerance, sum.value, floor,
    ));
    sum
}
