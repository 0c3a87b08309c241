//! A small kernel about a root that nothing cuts: polar coordinates in which it is nearly a disc.
//!
//! Near a root the squared deflection is |J (u − u*)|² with the map's derivative J, so that u = u* + L (t cos ω, t sin ω), L Lᵀ = (JᵀJ)⁻¹, makes it
//! nearly t². If the level is convex on a box that contains the kernel's support, then that is one convex spot: every
//! ray from the root leaves it once, the integrand is periodic and analytic in ω, and the trapezoid rule converges
//! geometrically. Convexity is bounded by the interpolant's second derivatives; where it does not hold, and where a margin is
//! not clearly positive, the caller cuts cells instead.

use libm::{sincos, sqrt};

use super::{Integrand, MARGINS, Node};
use crate::bandwidth::kernel::{escalate, gauss};
use crate::bandwidth::quadrature::{Pair, bracketed_root, error_of_better, gauss_rules};
use crate::flux::chart::Chart;
use crate::flux::poly::{Chebyshev, Grid, nodes};
use crate::pixel::rule::Rule;
use std::sync::OnceLock;

const PI: f64 = core::f64::consts::PI;
/// Samples along both axes among which the nearest to a root is taken.
const LOOK: usize = 8;
/// Steps of Newton's method.
const STEPS: usize = 30;
/// The box in units of the spot's extent.
const MARGIN: f64 = 1.25;
/// Azimuths at most.
const MOST: usize = 256;

type Rectangle = [[f64; 2]; 2];

fn rules() -> &'static [Rule] {
    static RULES: OnceLock<Vec<Rule>> = OnceLock::new();
    RULES.get_or_init(gauss_rules)
}

/// The derivative of the deflection by both parameters, by central differences over `h`.
fn derivative<I: Integrand>(integrand: &I, u: [f64; 2], h: [f64; 2]) -> [[f64; 3]; 2] {
    [0, 1].map(|k| {
        let (mut low, mut high) = (u, u);
        low[k] -= h[k];
        high[k] += h[k];
        let (a, b) = (
            integrand.node(low).deflection,
            integrand.node(high).deflection,
        );
        core::array::from_fn(|i| (b[i] - a[i]) / (high[k] - low[k]))
    })
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// JᵀJ.
fn metric(j: &[[f64; 3]; 2]) -> [f64; 3] {
    [dot(&j[0], &j[0]), dot(&j[0], &j[1]), dot(&j[1], &j[1])]
}

fn inside(u: [f64; 2], rectangle: &Rectangle) -> bool {
    (0..2).all(|k| u[k] > rectangle[k][0] && u[k] < rectangle[k][1])
}

/// A root in the rectangle, from the best of a few samples.
fn root<I: Integrand>(integrand: &I, rectangle: &Rectangle, edge: f64) -> Option<[f64; 2]> {
    let exists = |n: &Node| n.margins.iter().all(|m| *m > 0.0);
    let mut best: Option<([f64; 2], f64)> = None;
    for k in 0..LOOK * LOOK {
        let at = [k % LOOK, k / LOOK];
        let u = [0, 1].map(|k| {
            let [low, high] = rectangle[k];
            low + (high - low) * (at[k] as f64 + 0.5) / LOOK as f64
        });
        let node = integrand.node(u);
        if exists(&node) && best.is_none_or(|(_, l)| node.square() < l) {
            best = Some((u, node.square()));
        }
    }
    let (mut u, mut level) = best?;
    let size = [0, 1].map(|k| rectangle[k][1] - rectangle[k][0]);
    for _ in 0..STEPS {
        let d = integrand.node(u).deflection;
        let j = derivative(integrand, u, size.map(|s| 1e-6 * s));
        let [a, b, c] = metric(&j);
        let det = a * c - b * b;
        let g = [dot(&j[0], &d), dot(&j[1], &d)];
        let step = [(b * g[1] - c * g[0]) / det, (b * g[0] - a * g[1]) / det];
        let mut scale = 1.0;
        let (next, lower) = loop {
            let next = [u[0] + scale * step[0], u[1] + scale * step[1]];
            let l = integrand.node(next).square();
            if inside(next, rectangle) && l < level {
                break (next, l);
            }
            scale *= 0.5;
            if !(scale > 1e-3) {
                return (level < 1e-4 * edge && inside(u, rectangle)).then_some(u);
            }
        };
        (u, level) = (next, lower);
        if level < 1e-24 * edge {
            break;
        }
    }
    (level < 1e-4 * edge).then_some(u)
}

/// A spot of the rectangle in which the kernel's support is whole: the box around it and its integrals. `None` where there is no
/// such spot, or none that can be shown.
pub(super) fn spot<I: Integrand>(
    integrand: &I,
    rectangle: Rectangle,
    tolerance: f64,
) -> Option<(Rectangle, Pair)> {
    let (end, edge) = (*integrand.spans().last()?, *integrand.edges().last()?);
    let u = root(integrand, &rectangle, end)?;
    // The extent of the spot, first from the derivative over the rectangle, then over the spot itself.
    let extent = |m: &[f64; 3]| {
        let det = m[0] * m[2] - m[1] * m[1];
        [sqrt(end * m[2] / det), sqrt(end * m[0] / det)]
    };
    let size = [0, 1].map(|k| 1e-5 * (rectangle[k][1] - rectangle[k][0]));
    let first = extent(&metric(&derivative(integrand, u, size)));
    let j = derivative(integrand, u, first.map(|e| 0.01 * e));
    let m = metric(&j);
    let reach = extent(&m);
    let inner = [0, 1].map(|k| [u[k] - MARGIN * reach[k], u[k] + MARGIN * reach[k]]);
    let within = (0..2).all(|k| inner[k][0] >= rectangle[k][0] && inner[k][1] <= rectangle[k][1]);
    if !within || !is_plain(integrand, inner, edge) {
        return None;
    }
    // L Lᵀ = (JᵀJ)⁻¹.
    let det = m[0] * m[2] - m[1] * m[1];
    let l00 = sqrt(m[2] / det);
    let l10 = -m[1] / (det * l00);
    let l11 = sqrt(1.0 / m[2]);
    polar(integrand, u, [l00, l10, l11], tolerance).map(|pair| (inner, pair))
}

/// Whether on a box all margins hold, and the level is convex and beyond the end of the kernel along the border.
fn is_plain<I: Integrand>(integrand: &I, inner: Rectangle, end: f64) -> bool {
    let (chart, x) = (Chart::new(inner), nodes());
    let samples: [[Node; 9]; 9] = core::array::from_fn(|l| {
        core::array::from_fn(|k| integrand.node(chart.at([x[k], x[l]]).0))
    });
    let fit = |f: &dyn Fn(&Node) -> f64| {
        let g: Grid = core::array::from_fn(|l| core::array::from_fn(|k| f(&samples[l][k])));
        g.iter()
            .flatten()
            .all(|v| v.is_finite())
            .then(|| Chebyshev::new(&g))
    };
    for k in 0..MARGINS {
        let holds = fit(&|n| n.margins[k]).is_some_and(|c| {
            let [p, q] = c.tails();
            c.c[0][0] > c.spread() + 6.0 * (p + q)
        });
        if !holds {
            return false;
        }
    }
    let Some(c) = fit(&|n| n.level) else {
        return false;
    };
    // |T_k''| ≤ k²(k² − 1)/3 and |T_k'| ≤ k²; T_2'' = 4.
    let second = |k: usize| (k * k * (k * k).saturating_sub(1)) as f64 / 3.0;
    let along = |axis: usize| {
        let main = if axis == 0 { c.c[0][2] } else { c.c[2][0] };
        let rest = c.sum(|k, l| match (axis, k, l) {
            (0, 2, 0) | (1, 0, 2) => 0.0,
            (0, k, _) | (1, _, k) => second(k),
            _ => 0.0,
        });
        4.0 * main - rest
    };
    let mixed = c.sum(|k, l| (k * k * l * l) as f64);
    let (aa, bb) = (along(0), along(1));
    if !(aa > 0.0 && bb > 0.0 && aa * bb > mixed * mixed) {
        return false;
    }
    // By convexity the support is inside the box if its border is outside the support.
    let p = c.polynomial();
    [-1.0, 1.0].into_iter().all(|s| {
        let lines = [p.along_a(s), p.along_b(s)];
        lines.iter().all(|line| {
            // The smallest value of a convex polynomial of one variable.
            let (mut low, mut high) = (-1.0, 1.0);
            for _ in 0..60 {
                let mid = 0.5 * (low + high);
                if crate::flux::poly::with_slope(line, mid)[1] > 0.0 {
                    high = mid;
                } else {
                    low = mid;
                }
            }
            crate::flux::poly::value(line, 0.5 * (low + high)) > end
        })
    })
}

/// The integrals over the spot in polar coordinates about its root.
fn polar<I: Integrand>(
    integrand: &I,
    u: [f64; 2],
    [l00, l10, l11]: [f64; 3],
    tolerance: f64,
) -> Option<Pair> {
    let (spans, rules) = (integrand.spans(), rules());
    let area = l00 * l11;
    let mut start = 2;
    let mut ray = |w: f64| {
        let (s, c) = sincos(w);
        let d = [l00 * c, l10 * c + l11 * s];
        let node = |t: f64| integrand.node([u[0] + t * d[0], u[1] + t * d[1]]);
        let mut sum = Pair::default();
        let mut from = 0.0;
        for (ring, &edge) in spans.iter().enumerate() {
            let to = crossing(&node, from, edge)?;
            let found = escalate(&mut start, 0.05 * tolerance, &sum, [0.0; 2], |order| {
                gauss(&rules[order], from, to, |t| {
                    let n = node(t);
                    let k = integrand.kernel(ring, &n);
                    [t * k[0] * n.density[0], t * k[1] * n.density[1]]
                })
            })?;
            sum.add(&found);
            from = to;
        }
        Some(sum)
    };
    let mut sum = Pair::default();
    let mut count = 4;
    for k in 0..count {
        sum.add(&ray(2.0 * PI * k as f64 / count as f64)?);
    }
    let mut before: Option<[f64; 2]> = None;
    while count <= MOST {
        let scale = area * 2.0 * PI / count as f64;
        let value = sum.value.map(|v| v * scale);
        if let Some(before) = before {
            // Geometric convergence: the error of 2n points is about the square of that of n points.
            let error: [f64; 2] = core::array::from_fn(|k| {
                error_of_better((value[k] - before[k]).abs(), value[k].abs())
                    + sum.error[k] * scale
                    + integrand.rounding() * value[k].abs()
            });
            let rounding = 4.0 * integrand.rounding();
            if (0..2).all(|k| error[k] <= (tolerance + rounding) * value[k].abs()) {
                return Some(Pair { value, error });
            }
        }
        before = Some(value);
        for k in 0..count {
            sum.add(&ray(2.0 * PI * (k as f64 + 0.5) / count as f64)?);
        }
        count *= 2;
    }
    None
}

/// Where the squared deflection reaches an edge along a ray that starts below it, about √edge.
fn crossing(node: &impl Fn(f64) -> Node, from: f64, edge: f64) -> Option<f64> {
    // Its root is nearly linear in t.
    let height = sqrt(edge);
    let mut f = |t: f64| sqrt(node(t).square()) - height;
    let (mut low, mut at_low) = (from, f(from));
    let mut high = height * 1.05;
    for _ in 0..40 {
        let at_high = f(high);
        if at_high >= 0.0 {
            return Some(bracketed_root(low, high, at_low, at_high, &mut f));
        }
        (low, at_low) = (high, at_high);
        high *= 1.3;
    }
    None
}
