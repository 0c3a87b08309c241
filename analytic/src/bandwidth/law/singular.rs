//! The law where the map of offsets is singular: folds, cusps, lines of perfect paths.
//!
//! At a fold the Jacobian has the singular values σ and 0, right singular vectors v₁, v₂ and left ones e₁, e₂. With parameters
//! u = u* + v₁ a + v₂ s the offset is (σ a, κ s²/2) to leading order, κ = e₂·D²(v₂, v₂), so that with K = (w/σ) √(2/κ)
//!
//! ```text
//! E_α ~ K m α^(−1/2),    m = ∫_{Y>0} f Y^(−1/2),    m₂ ~ K f_s α^(−5/2) ∫_{Y>0} f² Y^(−1/2)
//! ```
//!
//! K is the strength of the caustic, E ~ K d^(−1/2), with distances measured as offsets. At a cusp κ = 0; along the curve on which the first
//! component stays zero, u = v₂ s − v₁ e₁·D²(v₂, v₂) s²/(2σ), the second is β s³, and the support reaches s ~ α^(1/3):
//!
//! ```text
//! E_α ~ w/(3 σ |β|^(1/3)) m α^(−2/3),    m = ∫ f |Y|^(−2/3),     β = e₂·D³(v₂, v₂, v₂)/6 − e₂·D²(v₂, v₁) e₁·D²(v₂, v₂)/(2σ)
//! ```
//!
//! (the mixed term a s is α^(4/3), which is small against α). On a line focus every path of a closed curve is perfect, and across it the
//! offset grows like σ n: E_α ~ α^(−1) ∮ w/σ dl ∫ f dX. In a point focus all are, and E_α ~ α^(−2) f(0) ∫ w du. Derived here;
//! exponents and the constants of E1 in theory/bandwidth.md, section 5.

use core::f64::consts::TAU;

use super::constants::Shape;
use super::family::Map;
use super::jet::{Jet, Vector, cross, dot};
use super::roots::size;

/// A leading term: mean ~ coefficient α^order, second moment ~ squared α^(order − 2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Leading {
    pub order: f64,
    pub coefficient: f64,
    pub squared: f64,
    /// |offset| of the singular path: how far the point is from the caustic, in units of the bandwidth.
    pub distance: f64,
}

/// Step of the differences, in widths of the domain.
const H: f64 = 3e-3;
/// Newton's steps.
const STEPS: usize = 40;

struct Frame {
    sigma: f64,
    v: [[f64; 2]; 2],
    e: Vector,
}

fn frame(jet: &Jet) -> Frame {
    let [(sigma, v1), (_, v2)] = jet.singular();
    let t = jet.terms(v1)[1];
    Frame {
        sigma,
        v: [v1, v2],
        e: t.map(|c| c / sigma),
    }
}

/// The signed determinant against a fixed normal, and its gradient.
fn determinant(jet: &Jet, normal: &Vector) -> (f64, [f64; 2]) {
    let [p, q] = jet.jacobian();
    let value = dot(&cross(&p, &q), normal);
    let gradient = [[1.0, 0.0], [0.0, 1.0]].map(|e| {
        let (dp, dq) = (jet.second([1.0, 0.0], e), jet.second([0.0, 1.0], e));
        dot(&cross(&dp, &q), normal) + dot(&cross(&p, &dq), normal)
    });
    (value, gradient)
}

/// A normal of the plane of offsets near `u`: of one point where the map is regular.
fn normal(map: &Map<'_>, u: [f64; 2], size: [f64; 2], h: f64) -> Option<Vector> {
    for k in 0..8 {
        let (s, c) = libm::sincos(0.3 + TAU * f64::from(k) / 8.0);
        let jet = Jet::new(
            map,
            [u[0] + 2.0 * h * c * size[0], u[1] + 2.0 * h * s * size[1]],
            size,
            h,
        );
        let [p, q] = jet.jacobian();
        let n = cross(&p, &q);
        let length = libm::sqrt(dot(&n, &n));
        if length > 1e-9 * (dot(&p, &p) + dot(&q, &q)) {
            return Some(n.map(|c| c / length));
        }
    }
    None
}

/// Newton's method on two equations that are known by their values, with a step limit; the Jacobian by differences.
fn solve(
    start: [f64; 2],
    size: [f64; 2],
    // Step of the differences, and the part of the domain to which they find a root.
    [d, close]: [f64; 2],
    equations: impl Fn([f64; 2]) -> Option<[f64; 2]>,
) -> Option<[f64; 2]> {
    let mut u = start;
    let mut last = f64::INFINITY;
    for _ in 0..STEPS {
        let f = equations(u)?;
        let column = |k: usize| -> Option<[f64; 2]> {
            let (mut low, mut high) = (u, u);
            low[k] -= d * size[k];
            high[k] += d * size[k];
            let (a, b) = (equations(low)?, equations(high)?);
            Some([0, 1].map(|i| (b[i] - a[i]) / (2.0 * d)))
        };
        let (p, q) = (column(0)?, column(1)?);
        let det = p[0] * q[1] - p[1] * q[0];
        let step = [
            (f[1] * q[0] - f[0] * q[1]) / det,
            (f[0] * p[1] - f[1] * p[0]) / det,
        ];
        let length = libm::hypot(step[0], step[1]);
        if !length.is_finite() {
            return None;
        }
        // Rounding of the differences ends it.
        if length < 1e-12 || (length < close && length >= last) {
            return Some(u);
        }
        let scale = (0.05 / length).min(1.0);
        u = [0, 1].map(|k| u[k] + scale * step[k] * size[k]);
        last = length;
    }
    (last < close).then_some(u)
}

/// The least bend of a fold, relative to the stretch along it.
const STRAIGHT: f64 = 1e-4;

/// The fold nearest to a path, and what it would give to a point on it.
pub(super) fn fold(map: &Map<'_>, start: [f64; 2], shape: &Shape) -> Option<([f64; 2], Leading)> {
    let size = size(map);
    let h = step(map, start)?;
    let n = normal(map, start, size, h)?;
    let reference = frame(&Jet::new(map, start, size, h)).e;
    let u = solve(start, size, [1e-5, 1e-7], |u| {
        let jet = Jet::new(map, u, size, h);
        let f = frame(&jet);
        // A singular direction has no sign of its own.
        let sign = if dot(&f.e, &reference) < 0.0 {
            -1.0
        } else {
            1.0
        };
        jet.is_finite().then(|| {
            [
                determinant(&jet, &n).0 / (f.sigma * f.sigma),
                sign * dot(&f.e, &jet.offset()) / f.sigma,
            ]
        })
    })?;
    let here = map.at(u);
    if !here.exists() {
        return None;
    }
    let jet = Jet::new(map, u, size, h);
    let f = frame(&jet);
    let bend = jet.second(f.v[1], f.v[1]);
    let along = dot(&bend, &f.e);
    let across: Vector = core::array::from_fn(|c| bend[c] - along * f.e[c]);
    let kappa = libm::sqrt(dot(&across, &across));
    // Where a fold does not bend it is a cusp, and its strength has no bound.
    if !(kappa > STRAIGHT * f.sigma) {
        return None;
    }
    let cell = size[0] * size[1];
    let strength = |w: f64| w * cell / f.sigma * libm::sqrt(2.0 / kappa);
    let leading = Leading {
        order: -0.5,
        coefficient: strength(here.density[0]) * 0.5 * shape.across(1, -0.5),
        squared: strength(here.density[1]) * 0.5 * shape.across(2, -0.5),
        distance: libm::sqrt(here.square()),
    };
    Some((u, leading))
}

/// A cusp near a path.
pub(super) fn cusp(map: &Map<'_>, start: [f64; 2], shape: &Shape) -> Option<([f64; 2], Leading)> {
    let size = size(map);
    let h = step(map, start)?;
    let n = normal(map, start, size, h)?;
    let reference = frame(&Jet::new(map, start, size, h)).v[1];
    let u = solve(start, size, [3e-4, 1e-5], |u| {
        let jet = Jet::new(map, u, size, h);
        let f = frame(&jet);
        let (value, gradient) = determinant(&jet, &n);
        // A null direction has no sign of its own.
        let v = f.v[1];
        let sign = if v[0] * reference[0] + v[1] * reference[1] < 0.0 {
            -1.0
        } else {
            1.0
        };
        let slope = sign * (v[0] * gradient[0] + v[1] * gradient[1]);
        let scale = f.sigma * f.sigma;
        jet.is_finite().then_some([value / scale, slope / scale])
    })?;
    let here = map.at(u);
    if !here.exists() {
        return None;
    }
    let jet = Jet::new(map, u, size, h);
    let f = frame(&jet);
    let e2 = {
        let c = cross(&n, &f.e);
        let length = libm::sqrt(dot(&c, &c));
        c.map(|v| v / length)
    };
    let bend = jet.second(f.v[1], f.v[1]);
    let third = jet.terms(f.v[1])[3];
    let mixed = jet.second(f.v[1], f.v[0]);
    let beta = dot(&e2, &third) - dot(&e2, &mixed) * dot(&f.e, &bend) / (2.0 * f.sigma);
    let cell = size[0] * size[1];
    let scale = |w: f64| w * cell / (3.0 * f.sigma * libm::cbrt(f64::abs(beta)));
    let leading = Leading {
        order: -2.0 / 3.0,
        coefficient: scale(here.density[0]) * shape.across(1, -2.0 / 3.0),
        squared: scale(here.density[1]) * shape.across(2, -2.0 / 3.0),
        distance: libm::sqrt(here.square()),
    };
    (beta != 0.0).then_some((u, leading))
}

/// A step of which half gives the same singular values: small against the scale on which the map changes.
fn step(map: &Map<'_>, u: [f64; 2]) -> Option<f64> {
    let size = size(map);
    let mut h = H;
    let mut coarse = Jet::new(map, u, size, h);
    for _ in 0..6 {
        let fine = Jet::new(map, u, size, h / 3.0);
        let bend = |j: &Jet| {
            j.second([1.0, 0.0], [0.0, 1.0])
                .map(|c| 1.0 + f64::abs(c))
                .iter()
                .sum::<f64>()
        };
        let agrees = f64::abs(bend(&fine) - bend(&coarse)) < 1e-5 * bend(&fine);
        if coarse.is_finite() && agrees {
            return Some(h);
        }
        (h, coarse) = (h / 3.0, fine);
    }
    coarse.is_finite().then_some(h)
}

/// The closed curve of perfect paths through several degenerate roots, from a point inside it.
pub(super) fn line(map: &Map<'_>, roots: &[[f64; 2]], shape: &Shape) -> Option<Leading> {
    let size = size(map);
    let count = roots.len() as f64;
    let middle = [0, 1].map(|k| roots.iter().map(|r| r[k]).sum::<f64>() / count);
    let radius = roots
        .iter()
        .map(|r| libm::hypot((r[0] - middle[0]) / size[0], (r[1] - middle[1]) / size[1]))
        .sum::<f64>()
        / count;
    let mut before: Option<[f64; 2]> = None;
    for n in [32_u32, 64, 128, 256, 512] {
        let mut sum = [0.0; 2];
        for k in 0..n {
            let (s, c) = libm::sincos(TAU * f64::from(k) / f64::from(n));
            let at =
                |rho: f64| map.at([middle[0] + rho * c * size[0], middle[1] + rho * s * size[1]]);
            let slope = |rho: f64| -> Vector {
                const D: f64 = 1e-6;
                let (a, b) = (at(rho - D).offset, at(rho + D).offset);
                core::array::from_fn(|i| (b[i] - a[i]) / (2.0 * D))
            };
            let mut rho = radius;
            for _ in 0..STEPS {
                let (d, j) = (at(rho).offset, slope(rho));
                let change = dot(&d, &j) / dot(&j, &j);
                rho -= change.clamp(-0.1, 0.1);
                if f64::abs(change) < 1e-14 {
                    break;
                }
            }
            let (here, j) = (at(rho), slope(rho));
            let sigma = libm::sqrt(dot(&j, &j));
            if !(here.square() < 1e-14 * sigma * sigma) {
                return None;
            }
            if here.exists() {
                for (sum, w) in sum.iter_mut().zip(here.density) {
                    *sum += rho * w / sigma * TAU / f64::from(n) * size[0] * size[1];
                }
            }
        }
        if let Some(before) = before
            && f64::abs(sum[0] - before[0]) <= 1e-9 * sum[0]
        {
            return Some(Leading {
                order: -1.0,
                coefficient: sum[0] * shape.line(1),
                squared: sum[1] * shape.line(2),
                distance: 0.0,
            });
        }
        before = Some(sum);
    }
    None
}
