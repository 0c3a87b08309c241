//! The two-dimensional integral in polar coordinates (azimuth, level), the level being the kernel's argument.
//!
//! Where nothing cuts the kernel's support the integrand is periodic and analytic in the azimuth, and the trapezoid rule
//! converges geometrically. Otherwise the azimuth is broken at the corners of the domain and where a border of the domain
//! crosses an edge of the kernel, and each piece is integrated by an adaptive Gauss–Kronrod rule.

use libm::sincos;

use super::clip::{Domain, smooth};
use super::kernel::Profile;
use super::quadrature::{Pair, adaptive, bracketed_root, error_of_better};

const PI: f64 = core::f64::consts::PI;

/// A parametrisation of a plane by azimuth and level.
pub(super) trait Chart {
    /// What is constant along a radial line.
    type Line;
    /// The radial line of azimuth (cos ω, sin ω).
    fn line(&self, c: f64, s: f64) -> Self::Line;
    /// The level at a radius, strictly increasing from 0; the radius may be infinite.
    fn level(&self, line: &Self::Line, rho: f64) -> f64;
    /// What multiplies the kernel, and its square, per dω d(level).
    fn density(&self, line: &Self::Line, level: f64) -> [f64; 2];
    /// A radius within which every point of a level lies, whatever the azimuth.
    fn farthest(&self, level: f64) -> f64;
    /// The domain of integration.
    fn domain(&self) -> &Domain;
}

/// Samples per piece in the search for crossings.
const SAMPLES: usize = 8;

/// Sub-intervals at most; each is 15 radial integrals.
pub(super) const SPLITS: usize = 2000;

/// ∫∫ over the domain, to `tolerance × max(|value|, floor)`.
pub(super) fn integrate<C: Chart>(
    chart: &C,
    profile: &Profile,
    tolerance: f64,
    floor: [f64; 2],
) -> Pair {
    let domain = chart.domain();
    let reach = chart.farthest(profile.end);
    if domain.is_beyond(reach) {
        return Pair::default();
    }
    if domain.contains_disc(reach)
        && let Some(r) = trapezoid(chart, profile, tolerance, floor)
    {
        return r;
    }
    let inner = 0.1 * tolerance;
    let mut radial = |w: f64| {
        let (s, c) = sincos(w);
        let Some((low, high)) = domain.interval(c, s) else {
            return Pair::default();
        };
        let line = chart.line(c, s);
        let from = if low > 0.0 {
            chart.level(&line, low)
        } else {
            0.0
        };
        let to = chart.level(&line, high).min(profile.end);
        profile.integrate(from, to, inner, &mut |g| chart.density(&line, g))
    };
    let pieces = broken_at_crossings(chart, profile, tolerance);
    adaptive(&smooth(&pieces), tolerance, floor, SPLITS, &mut radial)
}

/// Whether no border of the domain cuts the kernel's support.
pub(super) fn is_plain<C: Chart>(chart: &C, end: f64) -> bool {
    let reach = chart.farthest(end);
    chart.domain().is_beyond(reach) || chart.domain().contains_disc(reach)
}

fn trapezoid<C: Chart>(
    chart: &C,
    profile: &Profile,
    tolerance: f64,
    floor: [f64; 2],
) -> Option<Pair> {
    let at = |w: f64| {
        let (s, c) = sincos(w);
        let line = chart.line(c, s);
        profile.integrate(0.0, profile.end, 0.1 * tolerance, &mut |g| {
            chart.density(&line, g)
        })
    };
    let mut sum = Pair::default();
    let mut count = 4;
    for k in 0..count {
        sum.add(&at(2.0 * PI * k as f64 / count as f64));
    }
    let mut before: Option<[f64; 2]> = None;
    while count <= 512 {
        let value = sum.value.map(|v| v * 2.0 * PI / count as f64);
        if let Some(before) = before {
            // Geometric convergence: the error of 2n points is about the square of that of n points.
            let error: [f64; 2] = core::array::from_fn(|k| {
                error_of_better((value[k] - before[k]).abs(), value[k].abs())
                    + sum.error[k] * 2.0 * PI / count as f64
            });
            if (0..2).all(|k| error[k] <= tolerance * value[k].abs().max(floor[k])) {
                return Some(Pair { value, error });
            }
        }
        before = Some(value);
        for k in 0..count {
            sum.add(&at(2.0 * PI * (k as f64 + 0.5) / count as f64));
        }
        count *= 2;
    }
    None
}

/// The levels at which the azimuth is broken: all edges of the kernel, or, when a long schedule is wanted to a loose
/// tolerance, the few that matter (each of n edges is then a kink of relative size 1/n, which adaptivity resolves).
fn break_levels(profile: &Profile, tolerance: f64) -> Vec<f64> {
    let edges = &profile.edges;
    let most = if tolerance >= 1e-8 { 4 } else { 400 };
    if edges.len() <= most {
        return edges.clone();
    }
    let step = edges.len().div_ceil(most);
    edges.iter().rev().step_by(step).copied().collect()
}

fn broken_at_crossings<C: Chart>(chart: &C, profile: &Profile, tolerance: f64) -> Vec<(f64, f64)> {
    let domain = chart.domain();
    let levels = break_levels(profile, tolerance);
    let mut pieces = Vec::new();
    // The level on the inner or the outer border; capped, so that differences stay finite.
    let border = |w: f64, outer: bool| {
        let (s, c) = sincos(w);
        domain.interval(c, s).map(|(low, high)| {
            chart.level(&chart.line(c, s), if outer { high.min(1e30) } else { low })
        })
    };
    for (a, b) in domain.pieces() {
        let mut breaks = vec![a, b];
        for outer in [false, true] {
            let at = |k: usize| {
                let edge = 1e-9 * (b - a);
                (a + (b - a) * k as f64 / SAMPLES as f64).clamp(a + edge, b - edge)
            };
            let samples: Vec<(f64, f64)> = (0..=SAMPLES)
                .filter_map(|k| border(at(k), outer).map(|g| (at(k), g)))
                .collect();
            for &level in &levels {
                crossings(&samples, level, &mut breaks, &mut |w| {
                    border(w, outer).unwrap_or(0.0) - level
                });
            }
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|x, y| *x - *y < 1e-14);
        pieces.extend(breaks.windows(2).map(|w| (w[0], w[1])));
    }
    pieces
}

/// Appends the azimuths where the sampled function crosses a level, also where it dips below (or rises above) it between
/// two samples.
fn crossings(
    samples: &[(f64, f64)],
    level: f64,
    breaks: &mut Vec<f64>,
    f: &mut impl FnMut(f64) -> f64,
) {
    for k in 1..samples.len() {
        let ((w0, g0), (w1, g1)) = (samples[k - 1], samples[k]);
        if (g0 > level) != (g1 > level) {
            breaks.push(bracketed_root(w0, w1, g0 - level, g1 - level, f));
        }
        if k + 1 == samples.len() {
            break;
        }
        let (w2, g2) = samples[k + 1];
        let sign = if g1 > level { 1.0 } else { -1.0 };
        let (d0, d1, d2) = (
            sign * (g0 - level),
            sign * (g1 - level),
            sign * (g2 - level),
        );
        let dips = d1 <= d0 && d1 <= d2 && d1 < (d0 - d1).max(d2 - d1) && d0 > 0.0 && d2 > 0.0;
        if !dips {
            continue;
        }
        // Golden section for the extremum; two crossings if it is on the other side.
        let (mut lo, mut hi) = (w0, w2);
        for _ in 0..40 {
            let (u, v) = (lo + 0.382 * (hi - lo), lo + 0.618 * (hi - lo));
            let (fu, fv) = (sign * f(u), sign * f(v));
            if fu < fv {
                hi = v
            } else {
                lo = u
            }
            if fu.min(fv) < 0.0 {
                let w = if fu < fv { u } else { v };
                let fw = f(w);
                breaks.push(bracketed_root(w0, w, g0 - level, fw, f));
                breaks.push(bracketed_root(w, w2, fw, g2 - level, f));
                break;
            }
        }
    }
}
