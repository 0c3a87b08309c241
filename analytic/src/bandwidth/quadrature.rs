//! One-dimensional rules: Gauss–Legendre of several orders, and an adaptive Gauss–Kronrod driver for two integrals at
//! once.
//!
//! Error estimates follow QUADPACK: the difference of two rules is the error of the poorer one, and for the smooth
//! pieces integrated here the better one converges at least as its power 3/2. They are estimates, not enclosures; the
//! pieces are cut at every known kink so that they hold.

use libm::sqrt;

use crate::pixel::rule::Rule;

/// Two integrals (mean and second moment), estimates of their errors and of the integrals of the absolute values.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair {
    /// The integrals.
    pub value: [f64; 2],
    /// Their errors, never negative.
    pub error: [f64; 2],
}

impl Pair {
    /// Adds another part of the domain.
    pub fn add(&mut self, o: &Pair) {
        for k in 0..2 {
            self.value[k] += o.value[k];
            self.error[k] += o.error[k];
        }
    }

    /// Multiplies by a non-negative constant.
    pub fn scaled(mut self, c: f64) -> Pair {
        for k in 0..2 {
            self.value[k] *= c;
            self.error[k] *= c;
        }
        self
    }
}

/// The error of the better of two rules from their difference and the integral of the absolute value, where the
/// integrand is known to be smooth.
pub(super) fn error_of_better(difference: f64, absolute: f64) -> f64 {
    estimate(difference, absolute, 30.0)
}

/// The same where a kink may be hidden: it takes a much closer agreement before the power 3/2 is trusted (QUADPACK's
/// constant), and twice the difference before that.
fn error_with_kinks(difference: f64, absolute: f64) -> f64 {
    2.0 * estimate(difference, absolute, 2828.0)
}

fn estimate(difference: f64, absolute: f64, factor: f64) -> f64 {
    if !(absolute > 0.0) {
        return difference;
    }
    difference * (factor * sqrt(difference / absolute)).min(1.0) + 4.0 * f64::EPSILON * absolute
}

/// Orders of the Gauss–Legendre rules; each is about 3/2 of the one before.
pub(super) const ORDERS: [usize; 7] = [2, 4, 7, 11, 17, 26, 40];

/// The Gauss–Legendre rules of all [`ORDERS`], on [0, 1].
pub(super) fn gauss_rules() -> Vec<Rule> {
    ORDERS.iter().map(|&n| Rule::gauss(n)).collect()
}

/// Values P_0(x) … P_{n-1}(x).
pub(super) fn legendre_values(n: usize, x: f64, out: &mut Vec<f64>) {
    out.clear();
    out.push(1.0);
    if n > 1 {
        out.push(x);
    }
    for k in 2..n {
        let kf = k as f64;
        out.push(((2.0 * kf - 1.0) * x * out[k - 1] - (kf - 1.0) * out[k - 2]) / kf);
    }
}

/// Positive nodes of the Kronrod rule of order 15, outermost first; the odd ones are those of the Gauss rule of order 7.
/// Piessens et al., QUADPACK (1983), routine qk15.
const KRONROD_NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD_WEIGHTS: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS_WEIGHTS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

/// How the variable of a piece is stretched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// The integrand is smooth up to the ends.
    Smooth,
    /// It may behave like a square root at both ends: x = a + L(3t² − 2t³) makes it smooth in t.
    SquareRoot,
}

#[derive(Clone, Copy)]
struct Piece {
    from: f64,
    to: f64,
    ends: Ends,
    // Sub-interval of t in [0, 1].
    t0: f64,
    t1: f64,
    result: Pair,
}

fn kronrod(p: &mut Piece, f: &mut impl FnMut(f64) -> Pair) {
    let (mid, half) = (0.5 * (p.t0 + p.t1), 0.5 * (p.t1 - p.t0));
    let length = p.to - p.from;
    let mut at = |u: f64| {
        let t = mid + half * u;
        match p.ends {
            Ends::Smooth => f(p.from + length * t).scaled(half * length),
            Ends::SquareRoot => f(p.from + length * (t * t * (3.0 - 2.0 * t)))
                .scaled(half * length * 6.0 * t * (1.0 - t)),
        }
    };
    let (mut fine, mut coarse, mut absolute, mut inner) = ([0.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]);
    for (i, (&node, &weight)) in KRONROD_NODES.iter().zip(&KRONROD_WEIGHTS).enumerate() {
        let gauss = if i % 2 == 1 {
            GAUSS_WEIGHTS[i / 2]
        } else {
            0.0
        };
        let mut use_value = |v: Pair| {
            for k in 0..2 {
                fine[k] += weight * v.value[k];
                coarse[k] += gauss * v.value[k];
                absolute[k] += weight * v.value[k].abs();
                inner[k] += weight * v.error[k];
            }
        };
        use_value(at(-node));
        if node > 0.0 {
            use_value(at(node));
        }
    }
    p.result.value = fine;
    for k in 0..2 {
        p.result.error[k] = error_with_kinks((fine[k] - coarse[k]).abs(), absolute[k]) + inner[k];
    }
}

/// Integrates over several pieces, always splitting the one with the largest error, until both errors meet
/// `tolerance × max(|value|, floor)` or `max_splits` is used up. What was reached is in the result.
pub(super) fn adaptive(
    pieces: &[(f64, f64, Ends)],
    tolerance: f64,
    floor: [f64; 2],
    max_splits: usize,
    f: &mut impl FnMut(f64) -> Pair,
) -> Pair {
    let mut list: Vec<Piece> = Vec::with_capacity(pieces.len() + 16);
    for &(from, to, ends) in pieces {
        let mut p = Piece {
            from,
            to,
            ends,
            t0: 0.0,
            t1: 1.0,
            result: Pair::default(),
        };
        kronrod(&mut p, f);
        list.push(p);
    }
    for _ in 0..=max_splits {
        let mut sum = Pair::default();
        list.iter().for_each(|p| sum.add(&p.result));
        let target: [f64; 2] =
            core::array::from_fn(|k| tolerance * sum.value[k].abs().max(floor[k]));
        let missed = |e: &[f64; 2]| {
            (e[0] / target[0].max(f64::MIN_POSITIVE)).max(e[1] / target[1].max(f64::MIN_POSITIVE))
        };
        if missed(&sum.error) <= 1.0 {
            return sum;
        }
        let worst = list
            .iter()
            .enumerate()
            .map(|(i, p)| (i, missed(&p.result.error)))
            .fold((0, -1.0), |best, c| if c.1 > best.1 { c } else { best })
            .0;
        let mut left = list[worst];
        if !(left.t1 - left.t0 > 1e-13) {
            return sum;
        }
        let mut right = left;
        left.t1 = 0.5 * (left.t0 + left.t1);
        right.t0 = left.t1;
        kronrod(&mut left, f);
        kronrod(&mut right, f);
        list[worst] = left;
        list.push(right);
    }
    let mut sum = Pair::default();
    list.iter().for_each(|p| sum.add(&p.result));
    sum
}

/// A root of f between `a` and `b`, where f changes sign: regula falsi in the Illinois form, then what is left by
/// bisection.
pub(super) fn bracketed_root(
    mut a: f64,
    mut b: f64,
    mut fa: f64,
    mut fb: f64,
    f: &mut impl FnMut(f64) -> f64,
) -> f64 {
    let mut side = 0;
    for step in 0..80 {
        if fa == 0.0 {
            return a;
        }
        if fb == 0.0 || !((b - a).abs() > 4.0 * f64::EPSILON * a.abs().max(b.abs())) {
            return b;
        }
        let mut c = if step % 8 == 7 {
            0.5 * (a + b)
        } else {
            (a * fb - b * fa) / (fb - fa)
        };
        if !((c > a.min(b)) && (c < a.max(b))) {
            c = 0.5 * (a + b);
        }
        let fc = f(c);
        if (fc > 0.0) == (fb > 0.0) {
            (b, fb) = (c, fc);
            if side == -1 {
                fa *= 0.5;
            }
            side = -1;
        } else {
            (a, fa) = (c, fc);
            if side == 1 {
                fb *= 0.5;
            }
            side = 1;
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adaptive_error_bound_covers_the_error() {
        // ∫√t = 2/3, ∫|t−0.3| = 0.29: a square root at the end and an unannounced kink.
        let mut f = |t: f64| Pair {
            value: [sqrt(t), (t - 0.3).abs()],
            error: [0.0; 2],
        };
        for ends in [Ends::Smooth, Ends::SquareRoot] {
            for tolerance in [1e-4, 1e-8, 1e-12] {
                let r = adaptive(&[(0.0, 1.0, ends)], tolerance, [0.0; 2], 200, &mut f);
                for (k, exact) in [2.0 / 3.0, 0.29].into_iter().enumerate() {
                    let off = (r.value[k] - exact).abs();
                    assert!(off <= r.error[k], "{ends:?} {tolerance} {k}: {off}");
                    assert!(r.error[k] <= 1.01 * tolerance, "{ends:?} {tolerance} {k}");
                }
            }
        }
    }
}
