//! Interval arithmetic against double-doubles, and double-doubles against 40-digit values and identities.

use nephroid_analytic::double_double::DoubleDouble;
use nephroid_analytic::enclosure::{Enclosure, decided};
use nephroid_analytic::scalar::Scalar;

/// Fractional parts of n φ: evenly spread, without a generator.
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        // Mixed, so that consecutive numbers do not depend on each other.
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Whether the sum `high + low` of a double-double is inside, whatever its own error of 1e-30.
fn holds(interval: Enclosure, value: DoubleDouble) -> bool {
    let room = DoubleDouble::from(value.high.abs() * 1e-29);
    DoubleDouble::from(interval.low()) <= value + room
        && value - room <= DoubleDouble::from(interval.high())
}

type Unary<S> = fn(S) -> S;
type Binary<S> = fn(S, S) -> S;

fn unary<S: Scalar>() -> Vec<(&'static str, Unary<S>, f64, f64)> {
    vec![
        ("sqrt", S::sqrt, 0.0, 9.0),
        ("abs", S::abs, -3.0, 3.0),
        ("squared", S::squared, -3.0, 3.0),
        ("sin", S::sin, -20.0, 20.0),
        ("cos", S::cos, -20.0, 20.0),
        ("tan", S::tan, -1.5, 1.5),
        ("asin", S::asin, -1.0, 1.0),
        ("atan", S::atan, -9.0, 9.0),
        ("exp", S::exp, -9.0, 9.0),
        ("exp_m1", S::exp_m1, -2.0, 2.0),
        ("ln", S::ln, 0.01, 9.0),
    ]
}

fn binary<S: Scalar>() -> Vec<(&'static str, Binary<S>)> {
    vec![
        ("add", |a, b| a + b),
        ("sub", |a, b| a - b),
        ("mul", |a, b| a * b),
        ("div", |a, b| a / b),
        ("atan2", S::atan2),
        ("hypot", S::hypot),
        ("max", S::max),
        ("min", S::min),
    ]
}

#[test]
fn points_are_enclosed_tightly() {
    let mut spread = Spread(1);
    for ((name, f, low, high), (_, exact, ..)) in unary::<Enclosure>().into_iter().zip(unary()) {
        let mut widest: f64 = 0.0;
        for _ in 0..2000 {
            let x = spread.between(low, high);
            let (interval, value) = (f(Enclosure::point(x)), exact(DoubleDouble::from(x)));
            assert!(
                holds(interval, value),
                "{name}({x:e}): {interval:?} {value:?}"
            );
            widest = widest.max(interval.relative_width());
        }
        assert!(widest < 10.0 * f64::EPSILON, "{name}: {widest:e}");
    }
    for ((name, f), (_, exact)) in binary::<Enclosure>().into_iter().zip(binary()) {
        for _ in 0..2000 {
            let (x, y) = (spread.between(-2.0, 2.0), spread.between(-2.0, 2.0));
            let interval = f(Enclosure::point(x), Enclosure::point(y));
            let value = exact(DoubleDouble::from(x), DoubleDouble::from(y));
            assert!(
                holds(interval, value),
                "{name}({x:e}, {y:e}): {interval:?} {value:?}"
            );
            assert!(
                interval.relative_width() < 10.0 * f64::EPSILON,
                "{name} {interval:?}"
            );
        }
    }
}

#[test]
fn boxes_are_enclosed() {
    let mut spread = Spread(2);
    for ((name, f, low, high), (_, exact, ..)) in unary::<Enclosure>().into_iter().zip(unary()) {
        for trial in 0..300 {
            let a = spread.between(low, high);
            // Narrow and wide ones, across extrema.
            let reach = if trial % 2 == 0 { 1e-3 } else { 1.0 };
            let b = (a + reach * spread.between(0.0, high - low)).min(high);
            let image = f(Enclosure::new(a, b));
            for _ in 0..12 {
                let x = spread.between(a, b).clamp(a, b);
                let value = exact(DoubleDouble::from(x));
                assert!(
                    holds(image, value),
                    "{name}({a:e}, {b:e}) at {x:e}: {image:?}"
                );
            }
        }
    }
    for ((name, f), (_, exact)) in binary::<Enclosure>().into_iter().zip(binary()) {
        for _ in 0..600 {
            let mut side = || {
                let a = spread.between(-2.0, 2.0);
                let b = a + spread.between(0.0, 1.0);
                // Ends at 0 too.
                let snap = |v: f64| if v.abs() < 0.2 { 0.0 } else { v };
                (snap(a), snap(b))
            };
            let ((a, b), (c, d)) = (side(), side());
            let image = f(Enclosure::new(a, b), Enclosure::new(c, d));
            for _ in 0..12 {
                let x = spread.between(a, b).clamp(a, b);
                let y = spread.between(c, d).clamp(c, d);
                if y == 0.0 {
                    continue;
                }
                let value = exact(DoubleDouble::from(x), DoubleDouble::from(y));
                assert!(
                    holds(image, value),
                    "{name} {a} {b} {c} {d}: {x} {y} {image:?}"
                );
            }
        }
    }
}

#[test]
fn ranges_reach_the_extrema() {
    let e = Enclosure::new;
    assert_eq!(e(1.0, 2.0).sin().high(), 1.0);
    assert_eq!(e(4.0, 5.0).sin().low(), -1.0);
    assert_eq!(e(-1.0, 1.0).cos().high(), 1.0);
    assert_eq!(e(3.0, 3.5).cos().low(), -1.0);
    assert!(e(0.1, 0.2).sin().high() < 0.2 && e(0.1, 0.2).sin().low() > 0.09);
    assert!(!e(1.5, 1.6).tan().is_finite() && e(1.6, 4.7).tan().is_finite());
    assert!(!(e(1.0, 2.0) / e(-1.0, 1.0)).is_finite());
    let half_line = e(1.0, 2.0) / e(0.0, 4.0);
    assert_eq!((half_line.low(), half_line.high()), (0.25, f64::INFINITY));
    assert_eq!(e(-4.0, 9.0).sqrt().low(), 0.0);
    assert_eq!(e(-4.0, 9.0).sqrt().high(), 3.0);
    assert_eq!(
        (e(-4.0, 3.0).squared().low(), e(-4.0, 3.0).squared().high()),
        (0.0, 16.0)
    );
    // The cut of the angle, from above and across.
    assert!(e(0.0, 1.0).atan2(e(-2.0, -1.0)).low() > 2.3);
    let across = e(-1.0, 1.0).atan2(e(-2.0, -1.0));
    assert!(across.contains(3.125) && across.contains(-3.125) && across.contains(0.0));
    assert!(e(-1.0, 1.0).ln().low() == f64::NEG_INFINITY);
    assert!(!e(-2.0, -1.0).sqrt().is_finite() && !e(1.5, 2.0).asin().is_finite());
    assert!(!e(1e300, 1e300).squared().is_finite() && e(1e300, 1e300).squared().low() > 1e308);
    assert!(e(1e-300, 1e-300).squared().low() >= 0.0);
    assert!(!(Enclosure::ENTIRE - Enclosure::ENTIRE).is_finite());
    assert_eq!(Enclosure::ENTIRE * Enclosure::ZERO, Enclosure::ZERO);
}

#[test]
fn decimals() {
    let d = |text| Enclosure::from_decimal(text).expect("a decimal");
    assert_eq!(d("0.25"), Enclosure::point(0.25));
    let tenth = d("0.10000000000000000000");
    assert_eq!((tenth.low(), tenth.high()), (0.1_f64.next_down(), 0.1));
    // A number just off an f64, in the 40th digit, on either side.
    let above = d("0.5000000000000000000000000000000000000001");
    assert_eq!((above.low(), above.high()), (0.5, 0.5_f64.next_up()));
    let below = d("0.4999999999999999999999999999999999999999");
    assert_eq!((below.low(), below.high()), (0.5_f64.next_down(), 0.5));
    assert_eq!(d("1e400").low(), f64::MAX);
    assert_eq!(d("-1e-400").low(), -f64::from_bits(1));
    assert!(Enclosure::from_decimal("one").is_none());
    let pi =
        d("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899");
    assert_eq!(
        (pi.low(), pi.high()),
        (Enclosure::PI.low(), Enclosure::PI.high())
    );
    let pi =
        DoubleDouble::from_decimal("3.14159265358979323846264338327950288419716939937510582097");
    assert_eq!(pi, Some(DoubleDouble::PI));
}

#[test]
fn undecided_comparisons_are_noticed() {
    let (a, b, c) = (
        Enclosure::new(0.0, 2.0),
        Enclosure::new(1.0, 3.0),
        Enclosure::new(2.5, 4.0),
    );
    assert_eq!(decided(|| a < c), Some(true));
    assert_eq!(decided(|| c <= a), Some(false));
    assert_eq!(decided(|| a < b), None);
    assert_eq!(decided(|| a < a), None);
    assert_eq!(decided(|| Enclosure::ONE <= Enclosure::ONE), Some(true));
}

#[test]
fn double_doubles_have_thirty_digits() {
    // sin, cos, tan, atan, exp, exp_m1, ln of x, to 40 digits, by an arbitrary-precision program.
    type Row = (&'static str, [&'static str; 7]);
    let rows: &[Row] = include!("double_double_values.in");
    let functions: [Unary<DoubleDouble>; 7] = [
        Scalar::sin,
        Scalar::cos,
        Scalar::tan,
        Scalar::atan,
        Scalar::exp,
        Scalar::exp_m1,
        Scalar::ln,
    ];
    let mut worst: f64 = 0.0;
    for (x, values) in rows {
        let x = DoubleDouble::from_decimal(x).expect("a decimal");
        for (f, value) in functions.iter().zip(values) {
            let value = DoubleDouble::from_decimal(value).expect("a decimal");
            let error = ((f(x) - value) / value).high.abs();
            assert!(error < 1e-30, "{x:?} {error:e}");
            worst = worst.max(error);
        }
    }
    assert!(worst > 0.0);
}

#[test]
fn double_double_identities() {
    let mut spread = Spread(3);
    let d = |spread: &mut Spread, low, high| {
        let high_part = spread.between(low, high);
        DoubleDouble::from(high_part) + DoubleDouble::from(high_part * 1e-17 * spread.next())
    };
    let near = |a: DoubleDouble, b: DoubleDouble, what: &str| {
        assert!(
            (a - b).high.abs() <= 2e-30 * b.high.abs(),
            "{what}: {a:?} {b:?}"
        );
    };
    for _ in 0..2000 {
        let (x, y) = (d(&mut spread, 0.01, 3.0), d(&mut spread, -3.0, -0.01));
        near(x.sqrt() * x.sqrt(), x, "square of the root");
        near(x / y * y, x, "quotient");
        near(x.hypot(y) * x.hypot(y), x * x + y * y, "hypotenuse");
        near(x.exp().ln(), x, "logarithm");
        near(
            x.sin().squared() + x.cos().squared(),
            DoubleDouble::ONE,
            "circle",
        );
        let s = d(&mut spread, -1.0, 1.0);
        near(s.asin().sin(), s, "arc sine");
        // All four quadrants.
        let (p, q) = (d(&mut spread, -3.0, 3.0), d(&mut spread, -3.0, 3.0));
        let (angle, length) = (p.atan2(q), p.hypot(q));
        // Relative to the length: the last bit of an angle near π is a large part of its sine.
        near(angle.sin() * length - p + length, length, "ordinate");
        near(angle.cos() * length - q + length, length, "abscissa");
        near(x.exp_m1() + DoubleDouble::ONE, x.exp(), "exponential");
    }
    near(
        DoubleDouble::ZERO.atan2(-DoubleDouble::ONE),
        DoubleDouble::PI,
        "half turn",
    );
    near(
        (DoubleDouble::ONE / DoubleDouble::from(1e200)).hypot(DoubleDouble::ZERO),
        DoubleDouble::ONE / DoubleDouble::from(1e200),
        "small",
    );
}
