//! Where a margin's zero crosses a chart, and the charts that end at it.

use crate::flux::chart::{Chart, Edge};
use crate::flux::poly::{Chebyshev, Grid, N, chebyshev, nodes, powers, transposed, zeros};

/// What to do with a chart in which a margin may change sign.
#[derive(Debug)]
pub enum Border {
    /// Nothing can be said: halve along this axis.
    Halve(usize),
    /// The parts where the margin may be non-negative.
    Parts(Vec<(Chart, Part)>),
}

/// What is known of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The margin is not negative.
    Whole,
    /// The margin is not negative, and zero at one end.
    Cut(Edge),
    /// Nothing.
    Unknown,
}

/// A curve that is its interpolant to rounding.
pub const EXACT: f64 = 3e-13;

/// Finds the border of a margin with the samples `g` (`[b][a]`) and, where all are finite, their Chebyshev coefficients;
/// `size` is the scale of the margin's rounding. Where a border may coincide with the chart's own end, `coincides`, it is moved
/// outwards by as much, so that rounding does not cut it. `fit` is what the last coefficients of the curve may be, in half
/// widths of the chart; [`EXACT`] if it is to be known to rounding.
pub fn find(
    chart: &Chart,
    g: &Grid,
    c: Option<&Chebyshev>,
    depth: u32,
    size: f64,
    coincides: bool,
    fit: f64,
    value: &dyn Fn(&Chart, [f64; 2]) -> f64,
) -> Border {
    let axis = match c.map_or_else(|| by_signs(g, depth), monotone) {
        Ok(axis) => axis,
        Err(axis) => return Border::Halve(axis),
    };
    // In a small chart rounding shows in the curve.
    let slope = c.map_or(f64::INFINITY, |c| {
        f64::abs(if axis == 0 { c.c[0][1] } else { c.c[1][0] })
    });
    let rounding = 8.0 * f64::EPSILON * size;
    // Rounding must not cut a border that coincides with the chart's own.
    let scale = g.iter().flatten().map(|v| v.abs());
    let scale = scale.filter(|v| v.is_finite()).fold(0.0, f64::max);
    let shift = if coincides {
        1e-13 * scale + rounding
    } else {
        0.0
    };
    let at = |s: f64, t: f64| {
        let p = if axis == 0 { [t, s] } else { [s, t] };
        value(chart, p) + shift
    };
    let class = |s: f64| [at(s, -1.0) >= 0.0, at(s, 1.0) >= 0.0];

    // Ranges of the other axis over which the curve leaves through the same sides.
    let mut points = vec![-1.0];
    points.extend(nodes());
    points.push(1.0);
    // The curve can leave through a side and come back between two of them: look where the side's function turns.
    for side in [-1.0, 1.0] {
        let c = powers(&chebyshev(&nodes().map(|s| at(s, side))));
        let slope = core::array::from_fn(|k| match c.get(k + 1) {
            Some(c) => (k + 1) as f64 * c,
            None => 0.0,
        });
        points.extend(zeros(&slope).as_slice());
    }
    points.sort_by(f64::total_cmp);
    let mut cuts = vec![-1.0];
    for pair in points.windows(2) {
        let mut from = pair[0];
        let (mut first, last) = (class(from), class(pair[1]));
        // Between two samples both ends can change, one after the other.
        for _ in 0..4 {
            if first == last {
                break;
            }
            let (mut low, mut high) = (from, pair[1]);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if !(middle > low && middle < high) {
                    break;
                }
                if class(middle) == first {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            cuts.push(high);
            (from, first) = (high, class(high));
        }
    }
    cuts.push(1.0);
    let mut parts = Vec::new();
    for pair in cuts.windows(2) {
        let (low, high) = (pair[0], pair[1]);
        if !(high - low > 1e-13) {
            continue;
        }
        let mut range = [[-1.0, 1.0]; 2];
        range[1 - axis] = [low, high];
        let part = chart.part(range);
        match class(0.5 * (low + high)) {
            [false, false] => {}
            [true, true] => parts.push((part, Part::Whole)),
            [_, above] => {
                let s = |x: f64| 0.5 * (low + high) + 0.5 * (high - low) * x;
                let curve = nodes().map(|x| crossing(|t| at(s(x), t), above));
                let c = chebyshev(&curve);
                if c[N - 1].abs() + c[N - 2].abs() < fit + 4.0 * rounding / slope {
                    let edge = Edge { axis, above };
                    parts.push((part.cut(edge, powers(&c)), Part::Cut(edge)));
                } else {
                    parts.extend(part.halves(1 - axis).map(|half| (half, Part::Unknown)));
                }
            }
        }
    }
    Border::Parts(parts)
}

/// The axis along which a margin is proven monotone, or else the one to halve.
fn monotone(c: &Chebyshev) -> Result<usize, usize> {
    let lead = [c.c[0][1].abs(), c.c[1][0].abs()];
    let square = |k: usize| (k * k) as f64;
    let rest = [
        c.sum(|k, l| if (k, l) == (1, 0) { 0.0 } else { square(k) }),
        c.sum(|k, l| if (k, l) == (0, 1) { 0.0 } else { square(l) }),
    ];
    let tails = c.tails();
    let proven = [0, 1].map(|k| lead[k] > rest[k] + 81.0 * tails[k]);
    match proven {
        [true, true] => Ok(usize::from(lead[1] > lead[0])),
        [true, false] => Ok(0),
        [false, true] => Ok(1),
        [false, false] => {
            let bend = [
                c.sum(|k, _| if k > 1 { square(k) } else { 0.0 }),
                c.sum(|_, l| if l > 1 { square(l) } else { 0.0 }),
            ];
            Err(usize::from(bend[1] > bend[0]))
        }
    }
}

/// As [`monotone`] for a margin that is not finite everywhere, from the signs of the samples; NaN counts as negative.
fn by_signs(g: &Grid, depth: u32) -> Result<usize, usize> {
    let mut changes = [0; 2];
    let mut ordered = [true; 2];
    for axis in 0..2 {
        let (mut up, mut down) = (0, 0);
        let lines = if axis == 0 { *g } else { transposed(g) };
        for line in lines {
            let sign = |k: usize| line[k] >= 0.0;
            let here = |wanted: bool| {
                (1..N)
                    .filter(|&k| sign(k - 1) != sign(k) && sign(k) == wanted)
                    .count()
            };
            ordered[axis] &= here(true) + here(false) <= 1;
            up += here(true);
            down += here(false);
        }
        ordered[axis] &= up == 0 || down == 0;
        changes[axis] = up + down;
    }
    match ordered {
        [true, true] => Ok(usize::from(changes[1] > changes[0])),
        [true, false] => Ok(0),
        [false, true] => Ok(1),
        [false, false] => Err((depth % 2) as usize),
    }
}

/// Zero of a function that is negative (or NaN) at one end of [-1, 1] and not at the other: `rising` says which.
fn crossing(f: impl Fn(f64) -> f64, rising: bool) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    let (mut at_low, mut at_high) = (f(low), f(high));
    // The Illinois variant of the false position; bisection where it is slow or a value is not finite.
    let (mut last, mut before) = (0, f64::NAN);
    for round in 0..200 {
        let secant = low - at_low * (high - low) / (at_high - at_low);
        let usable = round % 8 != 7 && secant > low && secant < high;
        let x = if usable { secant } else { 0.5 * (low + high) };
        if !(x > low && x < high) || high - low <= 1e-15 {
            break;
        }
        let y = f(x);
        if y == 0.0 || (x - before).abs() < 2e-16 {
            return x;
        }
        before = x;
        if (y >= 0.0) == rising {
            (high, at_high) = (x, y);
            if last == 1 {
                at_low *= 0.5;
            }
            last = 1;
        } else {
            (low, at_low) = (x, y);
            if last == -1 {
                at_high *= 0.5;
            }
            last = -1;
        }
    }
    if rising { high } else { low }
}
