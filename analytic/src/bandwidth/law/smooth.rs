//! The law at a root where the map is regular: the next term of the density of offsets.
//!
//! Let C(u) be the length of the offset and w du the weight. On a ray u = u* + L (cos ω, sin ω) t with L Lᵀ = (JᵀJ)⁻¹,
//!
//! ```text
//! C² = t² (1 + A₁ t + A₂ t² + …),      w = w₀ (1 + c₁ t + c₂ t² + …),
//! g  = C + χ C³/24 = t (1 + a t + b t² + …),     a = A₁/2,  b = A₂/2 − A₁²/8 + χ/24
//! ```
//!
//! χ the curvature of the space of offsets. Inverted, w t dt = w₀ g (1 + (c₁ − 3a) g + Q g² + …) dg with
//! Q = 10a² − 4b − 4ac₁ + c₂; odd terms cancel over ω, sin g = g (1 − χ g²/6), and
//!
//! ```text
//! E_α = h₀ (1 + κ ⟨g²⟩ + O(α⁴)),     h₀ = w₀ det L,     κ = ⟨Q⟩_ω + χ/6
//! ```
//!
//! which is a quarter of the Laplacian, on the sphere of deflections, of weight/Jacobian [theory/bandwidth.md, 3]. For a linked
//! bandwidth atan(r/d) the same holds with offsets d g and χ = 1/d². Where an edge passes through the root,
//! only those ω remain on which its margin m = m₁ t + m₂ t² grows, and the odd terms do not cancel:
//!
//! ```text
//! E_α = h₀ share + h₀ α ∫ f t² dt [ ∫ (c₁ − 3a) dω + Σ_ends m₂/|∂m₁/∂ω| ]
//! ```
//!
//! Derived here.

use core::f64::consts::{PI, TAU};

use super::constants::Shape;
use super::family::{LIMITS, Map};
use super::jet::{Jet, dot};
use super::roots::size;
use crate::quadrature::gauss_legendre;

/// What a root gives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Term {
    /// Limit of the mean.
    pub limit: f64,
    /// Coefficient of α.
    pub first: f64,
    /// Coefficient of α², and an estimate of its error; 0 on an edge.
    pub second: [f64; 2],
    /// Second moment times α².
    pub squared: f64,
    /// Offset to the nearest edge, to first order, and to where the map folds on a ray if its slope 1 + 2at went on: 1/(4|a|).
    pub reach: f64,
    /// Whether an edge passes through it.
    pub on_edge: bool,
}

/// Steps of the differences: of the pair that agrees best the finer is taken.
const H: [f64; 7] = [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5];

struct Local {
    jet: Jet,
    /// L, lower triangular.
    lower: [f64; 3],
    /// Parameter area per area of offsets.
    area: f64,
}

impl Local {
    fn new(map: &Map<'_>, u: [f64; 2], h: f64) -> Option<Self> {
        let size = size(map);
        let jet = Jet::new(map, u, size, h);
        let [a, b, c] = jet.metric();
        let det = a * c - b * b;
        if !(jet.is_finite() && det > 0.0) {
            return None;
        }
        let l00 = libm::sqrt(c / det);
        let lower = [l00, -b / (det * l00), libm::sqrt(1.0 / c)];
        Some(Local {
            jet,
            area: l00 * lower[2] * size[0] * size[1],
            lower,
        })
    }

    fn along(&self, w: f64) -> [f64; 2] {
        let (s, c) = libm::sincos(w);
        let [l00, l10, l11] = self.lower;
        [l00 * c, l10 * c + l11 * s]
    }

    /// The smallest 1/(4|a|) over all rays.
    fn fold(&self) -> f64 {
        const N: u32 = 32;
        let most = (0..N)
            .map(|k| f64::abs(self.ray(TAU * f64::from(k) / f64::from(N))[2]))
            .fold(0.0, f64::max);
        0.25 / most
    }

    /// c₁ − 3a, Q and a on a ray.
    fn ray(&self, w: f64) -> [f64; 3] {
        let e = self.along(w);
        let [_, d1, d2, d3] = self.jet.terms(e);
        let [w0, w1, w2] = self.jet.density(e);
        let (a1, a2) = (2.0 * dot(&d1, &d2), dot(&d2, &d2) + 2.0 * dot(&d1, &d3));
        let (c1, c2) = (w1 / w0, w2 / w0);
        let a = 0.5 * a1;
        let b = 0.5 * a2 - 0.125 * a1 * a1 + self.jet.curvature / 24.0;
        [c1 - 3.0 * a, 10.0 * a * a - 4.0 * b - 4.0 * a * c1 + c2, a]
    }

    fn kappa(&self) -> f64 {
        // Q is a trigonometric polynomial of degree 6.
        const N: u32 = 16;
        let sum: f64 = (0..N)
            .map(|k| self.ray(TAU * f64::from(k) / f64::from(N))[1])
            .sum();
        sum / f64::from(N) + self.jet.curvature / 6.0
    }
}

/// The term of a root.
pub(super) fn term(map: &Map<'_>, u: [f64; 2], shape: &Shape) -> Option<Term> {
    let mut best: Option<(Local, f64, f64)> = None;
    let mut before: Option<f64> = None;
    for h in H {
        let Some(local) = Local::new(map, u, h) else {
            before = None;
            continue;
        };
        let kappa = local.kappa();
        if let Some(coarse) = before {
            let error = f64::abs(kappa - coarse);
            if best.as_ref().is_none_or(|(_, _, e)| error < *e) {
                best = Some((local, kappa, error));
            }
        }
        before = Some(kappa);
    }
    let (local, kappa, error) = best?;
    let here = map.at(u);
    let value = here.density[0] * local.area;
    let mut term = Term {
        limit: value,
        second: [value * kappa, value * error].map(|v| v * shape.second()),
        squared: here.density[1] * local.area * shape.whole(2),
        reach: local.fold(),
        ..Term::default()
    };
    // Margins by their gradients in the space of offsets.
    let slope = |m: usize, w: f64| margin_terms(map, u, &local, m, w)[0];
    let mut edges = Vec::new();
    for m in 0..LIMITS {
        let (x, y) = (slope(m, 0.0), slope(m, 0.5 * PI));
        let steep = libm::hypot(x, y);
        if steep == 0.0 {
            continue;
        }
        let distance = here.margins[m] / steep;
        if distance < 1e-8 * reach_unit(&local, map) {
            edges.push((m, libm::atan2(y, x), steep));
        } else if distance < term.reach {
            term.reach = distance;
        }
    }
    if edges.is_empty() {
        return Some(term);
    }
    // The ω on which all margins grow.
    let mut ends: Vec<f64> = edges
        .iter()
        .flat_map(|(_, w, _)| [w - 0.5 * PI, w + 0.5 * PI])
        .map(|w| w - TAU * libm::floor(w / TAU))
        .collect();
    ends.sort_by(f64::total_cmp);
    let (mut share, mut odd) = (0.0, 0.0);
    let rule = gauss_legendre(16);
    for (k, &from) in ends.iter().enumerate() {
        let to = ends.get(k + 1).copied().unwrap_or(ends[0] + TAU);
        let middle = 0.5 * (from + to);
        if edges.iter().all(|(_, w, _)| libm::cos(middle - w) > 0.0) {
            share += (to - from) / TAU;
            for (x, weight) in &rule {
                let half = 0.5 * (to - from);
                odd += half * weight * local.ray(middle + half * x)[0];
            }
        }
    }
    for (m, w, steep) in &edges {
        for end in [w - 0.5 * PI, w + 0.5 * PI] {
            let bound = edges
                .iter()
                .all(|(other, v, _)| other == m || libm::cos(end - v) > 0.0);
            if bound {
                odd += margin_terms(map, u, &local, *m, end)[1] / steep;
            }
        }
    }
    Some(Term {
        limit: value * share,
        first: value * odd * shape.radial(1, 2.0),
        second: [0.0; 2],
        squared: term.squared * share,
        reach: term.reach,
        on_edge: true,
    })
}

/// What an offset of the whole domain is about.
fn reach_unit(local: &Local, map: &Map<'_>) -> f64 {
    let size = size(map);
    libm::sqrt(size[0] * size[1] / local.area)
}

/// m₁ and m₂ of a margin along a ray.
fn margin_terms(map: &Map<'_>, u: [f64; 2], local: &Local, m: usize, w: f64) -> [f64; 2] {
    let (size, e) = (size(map), local.along(w));
    // A step that is a ten-thousandth of the domain.
    let h = 1e-4 / libm::hypot(e[0], e[1]);
    let at = |t: f64| {
        map.at([0, 1].map(|k| u[k] + t * h * e[k] * size[k]))
            .margins[m]
    };
    let (low, here, high) = (at(-1.0), at(0.0), at(1.0));
    [
        (high - low) / (2.0 * h),
        (high - 2.0 * here + low) / (2.0 * h * h),
    ]
}
