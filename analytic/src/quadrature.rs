//! Deterministic quadrature: Gauss–Legendre rules and adaptive Gauss–Kronrod integration.
//!
//! Everything here is `f64`, takes its tolerance as a parameter and gives the same bits on every platform. Use
//! [`gauss_legendre`] where the integrand is known to be smooth, [`integrate`] where it is not, and
//! [`integrate_between_folds`] where it grows like the inverse square root of the distance to an end, as irradiance
//! does on the bright side of a fold.

use core::f64::consts::{FRAC_PI_2, PI};

use libm::{cos, sin};

use crate::camera::Bounded;
use crate::double_double::DoubleDouble;

/// Nodes and weights of the `n`-point Gauss–Legendre rule on [-1, 1], in ascending order; empty for `n = 0`.
///
/// The rule is exact for polynomials of degree 2n - 1. Nodes are the zeros of the Legendre polynomial P_n, found by
/// Newton's method from Tricomi's estimate; weights are 2/((1 - x²) P_n'(x)²). The last Newton step and the weights are
/// done in double-double, so that three-term recurrence leaves no trace.
///
/// **Accuracy**: half a unit in the last place of each node and weight, up to n = 256 at least.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let mut rule = vec![(0.0, 0.0); n];
    for i in 0..n.div_ceil(2) {
        let guess = cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
        let mut x = if 2 * i + 1 == n { 0.0 } else { guess };
        for _ in 0..8 {
            let (p, q) = legendre(n, DoubleDouble::from(x));
            let step = p.high / slope(n, DoubleDouble::from(x), p, q).high;
            x -= step;
            if f64::abs(step) <= 1e-12 {
                break;
            }
        }
        let at = DoubleDouble::from(x);
        let (p, q) = legendre(n, at);
        let node = at - p / slope(n, at, p, q);
        let (p, q) = legendre(n, node);
        let derivative = slope(n, node, p, q);
        let one = DoubleDouble::from(1.0);
        let weight = DoubleDouble::from(2.0) / ((one - node * node) * derivative * derivative);
        rule[i] = (-node.high, weight.high);
        rule[n - 1 - i] = (node.high, weight.high);
    }
    rule
}

/// P_n(x) and P_{n-1}(x) by the three-term recurrence.
fn legendre(n: usize, x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (mut p, mut q) = (DoubleDouble::from(1.0), DoubleDouble::from(0.0));
    for k in 1..=n {
        let k = k as f64;
        let next = (DoubleDouble::from(2.0 * k - 1.0) * x * p - DoubleDouble::from(k - 1.0) * q)
            / DoubleDouble::from(k);
        (p, q) = (next, p);
    }
    (p, q)
}

/// P_n'(x) = n (P_{n-1} - x P_n)/(1 - x²).
fn slope(n: usize, x: DoubleDouble, p: DoubleDouble, q: DoubleDouble) -> DoubleDouble {
    DoubleDouble::from(n as f64) * (q - x * p) / (DoubleDouble::from(1.0) - x * x)
}

/// The positive abscissae of the 15-point Kronrod rule; every second one belongs to the 7-point Gauss rule. Values from
/// R. Piessens et al., QUADPACK, Springer 1983.
const KRONROD: [(f64, f64); 7] = [
    (0.991_455_371_120_812_6, 0.022_935_322_010_529_224),
    (0.949_107_912_342_758_5, 0.063_092_092_629_978_56),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_18),
    (0.741_531_185_599_394_4, 0.140_653_259_715_525_92),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9),
    (0.405_845_151_377_397_2, 0.190_350_578_064_785_4),
    (0.207_784_955_007_898_47, 0.204_432_940_075_298_89),
];
const KRONROD_CENTRE: f64 = 0.209_482_141_084_727_82;
const GAUSS: [f64; 3] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_9,
];
const GAUSS_CENTRE: f64 = 0.417_959_183_673_469_4;

/// One Gauss–Kronrod panel: the Kronrod value and its difference from Gauss.
fn panel(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64) -> Bounded {
    let (c, h) = (0.5 * (a + b), 0.5 * (b - a));
    let centre = f(c);
    let (mut kronrod, mut gauss) = (KRONROD_CENTRE * centre, GAUSS_CENTRE * centre);
    for (i, &(x, w)) in KRONROD.iter().enumerate() {
        let pair = f(c - h * x) + f(c + h * x);
        kronrod += w * pair;
        if i % 2 == 1 {
            gauss += GAUSS[i / 2] * pair;
        }
    }
    Bounded {
        value: kronrod * h,
        error: f64::abs((kronrod - gauss) * h),
    }
}

/// The most panels that [`integrate`] splits an interval into.
const MAX_PANELS: usize = 4000;

/// ∫ f over [a, b] by adaptive Gauss–Kronrod (7, 15), splitting the worst panel until the sum of the panels' error
/// estimates is at most `tolerance` (absolute) or 4000 panels exist.
///
/// **Accuracy**: `error` is the sum of |Kronrod - Gauss|, for smooth panels far above the true error; it is not a proof.
pub fn integrate(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Bounded {
    let mut panels = vec![(a, b, panel(&mut f, a, b))];
    loop {
        let error: f64 = panels.iter().map(|p| p.2.error).sum();
        let worst = panels
            .iter()
            .enumerate()
            .max_by(|(_, p), (_, q)| p.2.error.total_cmp(&q.2.error))
            .map_or(0, |(i, _)| i);
        let (a, b, _) = panels[worst];
        let middle = 0.5 * (a + b);
        let splits = middle > a.min(b) && middle < a.max(b);
        if error <= tolerance || panels.len() >= MAX_PANELS || !splits {
            let value = panels.iter().map(|p| p.2.value).sum();
            return Bounded { value, error };
        }
        panels[worst] = (a, middle, panel(&mut f, a, middle));
        panels.push((middle, b, panel(&mut f, middle, b)));
    }
}

/// ∫ f over [a, b] where f may grow like the inverse square root of the distance to either end.
///
/// With x = c + h sin θ the element dx = h cos θ dθ takes the square root away, so that the integrand is smooth in θ up
/// to the ends. `tolerance` as in [`integrate`].
pub fn integrate_between_folds(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    tolerance: f64,
) -> Bounded {
    let (c, h) = (0.5 * (a + b), 0.5 * (b - a));
    integrate(
        |theta| h * cos(theta) * f(c + h * sin(theta)),
        -FRAC_PI_2,
        FRAC_PI_2,
        tolerance,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_five_point_rule() {
        // Abramowitz & Stegun, table 25.4.
        let rule = gauss_legendre(5);
        assert_eq!(rule[2], (0.0, 0.568_888_888_888_888_9));
        assert_eq!(rule[3], (0.538_469_310_105_683_1, 0.478_628_670_499_366_47));
        assert_eq!(rule[4], (0.906_179_845_938_664, 0.236_926_885_056_189_08));
    }

    #[test]
    fn high_orders_are_exact_for_high_powers() {
        for n in [1, 2, 3, 7, 16, 64, 255, 256] {
            let rule = gauss_legendre(n);
            assert_eq!(rule.len(), n);
            let sum: f64 = rule.iter().map(|r| r.1).sum();
            assert!((sum - 2.0).abs() <= 4e-15, "{n}: {sum}");
            let even = 2 * (n - 1);
            let power: f64 = rule.iter().map(|r| r.1 * libm::pow(r.0, even as f64)).sum();
            let exact = 2.0 / (even as f64 + 1.0);
            assert!((power / exact - 1.0).abs() <= 1e-13, "{n}: {power} {exact}");
            assert!(rule.windows(2).all(|w| w[0].0 < w[1].0));
        }
        assert!(gauss_legendre(0).is_empty());
    }

    #[test]
    fn extreme_node_and_weight_of_256_points() {
        // 1 - x to first order is j²/(2 (n + 1/2)²) with j the first zero of J0; 30-digit value from mpmath.
        let (x, w) = gauss_legendre(256)[255];
        assert!((x - 0.999_956_050_018_992_2).abs() <= 1.2e-16, "{x:e}");
        assert!(
            (w / 0.000_112_789_017_822_272_17 - 1.0).abs() <= 1e-15,
            "{w:e}"
        );
    }

    #[test]
    fn adaptive_rule_reaches_its_tolerance() {
        let smooth = integrate(|x| libm::exp(-x * x), -6.0, 6.0, 1e-13);
        assert!((smooth.value - libm::sqrt(PI)).abs() <= 1e-13);
        let fold = integrate_between_folds(|x| 1.0 / libm::sqrt(1.0 - x), 0.0, 1.0, 1e-12);
        assert!((fold.value - 2.0).abs() <= 1e-7, "{fold:?}");
        let arcsine = integrate_between_folds(
            |x| 1.0 / libm::sqrt((1.0 - x) * (1.0 + x)),
            -1.0,
            1.0,
            1e-12,
        );
        assert!((arcsine.value - PI).abs() <= 1e-7, "{arcsine:?}");
    }
}
