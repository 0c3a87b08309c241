//! Random schedules: what is decided from the leading behaviour agrees with the exact partial sums, which do not use it.

use nephroid_analytic::schedule::classify::{finite_rows, optimal_start};
use nephroid_analytic::schedule::{
    Classification, Expression, FiniteRow, Number, Request, Weights, classify,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

fn settings(cases: u32) -> Config {
    Config {
        cases,
        rng_seed: RngSeed::Fixed(20_261_122),
        failure_persistence: None,
        ..Config::default()
    }
}

fn request(d: u32, p: u32) -> Request {
    Request {
        dimension: Number::integer(i64::from(d)),
        bias_order: Number::integer(i64::from(p)),
        weights: Weights::Uniform,
        discarded: 0.0,
        chain_rate: None,
    }
}

fn at_two_points(schedule: &Expression, r: &Request) -> [FiniteRow; 2] {
    let rows = finite_rows(schedule, r, &[1 << 20, 1 << 40], 1_000_000);
    [rows[0], rows[1]]
}

/// Exponents of bias and variance between n = 2²⁰ and 2⁴⁰.
fn slopes(schedule: &Expression, r: &Request) -> (f64, f64) {
    let [a, b] = at_two_points(schedule, r);
    let slope = |a: Option<f64>, b: Option<f64>| libm::log2(b.unwrap() / a.unwrap()) / 20.0;
    (slope(a.bias, b.bias), slope(a.variance, b.variance))
}

/// λd away from the boundary at 1.
fn decay() -> impl Strategy<Value = f64> {
    prop_oneof![0.1..0.85_f64, 1.15..2.0_f64]
}

/// The classification is that of the slopes, and the exponents are those of theory within `slack`.
fn agrees(text: &str, d: u32, p: u32, slack: f64) -> Result<(), TestCaseError> {
    let schedule: Expression = text.parse().unwrap();
    let r = request(d, p);
    let report = classify(&schedule, &r).unwrap();
    let (bias, variance) = slopes(&schedule, &r);
    let expected = match (bias < -0.01, variance < 0.0) {
        (true, true) => Classification::Consistent,
        (true, false) => Classification::VariancePersists,
        (false, _) => Classification::BiasPersists,
    };
    prop_assert_eq!(
        report.classification,
        expected,
        "{} {} {}",
        text,
        bias,
        variance
    );
    // Where the behaviour lies between bounds of one growth, the exponents are known all the same.
    let (b, v) = (report.bias.unwrap(), report.variance.unwrap());
    // ln(n)^s adds s log2(40/20)/20 to the slope.
    let predicted =
        |r: &nephroid_analytic::schedule::rate::Rate| r.power() + r.growth.log.value() / 20.0;
    prop_assert!(
        f64::abs(variance - predicted(&v)) < slack,
        "{} {} {}",
        text,
        variance,
        v
    );
    // A sum that hardly converges, or hardly diverges, has not settled at 2⁴⁰.
    if f64::abs(b.power() + 1.0) > 0.15 {
        prop_assert!(
            f64::abs(bias - predicted(&b)) < 3.0 * slack,
            "{} {} {}",
            text,
            bias,
            b
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(settings(150))]

    #[test]
    fn powers(x in decay(), d in 1..7_u32, p in 1..5_u32, start in 0.001..2.0_f64) {
        agrees(&format!("{start}*n^(-{}/{d})", x), d, p, 0.01)?;
    }

    #[test]
    fn powers_with_logarithms(x in decay(), d in 1..5_u32, p in 1..4_u32, s in -1.0..1.0_f64) {
        agrees(&format!("0.3*n^(-{x}/{d})*log(n+2)^({s}/{d})"), d, p, 0.02)?;
    }

    #[test]
    fn the_recursion(a in 0.01..0.99_f64, d in 1..5_u32, p in 1..4_u32) {
        let x = 0.5 * (1.0 - a) * f64::from(d);
        prop_assume!(!(0.85..1.15).contains(&x) && x > 0.02 * f64::from(d));
        agrees(&format!("ppm(0.2, {a})"), d, p, 0.01)?;
    }

    #[test]
    fn oscillating_in_the_logarithm(x in decay(), d in 1..5_u32, w in 0.5..8.0_f64, b in 1.2..4.0_f64) {
        agrees(&format!("0.1*n^(-{x}/{d})*({b}+sin({w}*log(n)))"), d, 2, 0.6)?;
    }

    #[test]
    fn cut_off_sums_and_exceptions(x in 0.1..0.85_f64, d in 1..5_u32, u in 0.1..8.0_f64) {
        // The cut-off ends at n = 2^u, long before the sums are compared.
        let c = libm::exp2(-u * x / f64::from(d));
        agrees(&format!("min({c}, n^(-{x}/{d}))"), d, 2, 0.02)?;
        agrees(&format!("n^(-{x}/{d})+{c}*n^(-2)"), d, 2, 0.02)?;
        agrees(&format!("at_powers(3, {c}, n^(-{x}/{d}))"), d, 2, 0.02)?;
    }

    /// At λ = 1/d the variance is (C α₀^-d/2)(1 + 1/n) exactly.
    #[test]
    fn the_boundary_has_a_plateau(d in 1..13_u32, p in 1..5_u32, start in 0.01..2.0_f64) {
        let schedule: Expression = format!("{start}*n^(-1/{d})").parse().unwrap();
        let r = request(d, p);
        let report = classify(&schedule, &r).unwrap();
        prop_assert_eq!(report.classification, Classification::VariancePersists);
        let plateau = 0.5 * libm::pow(start, -f64::from(d));
        let found = report.variance.unwrap().coefficient().unwrap();
        prop_assert!(f64::abs(found / plateau - 1.0) < 1e-12);
        let rows = [1 << 10, 1 << 20, 1 << 30, 1 << 40];
        for row in finite_rows(&schedule, &r, &rows, 1_000_000) {
            let exact = plateau * (1.0 + 1.0 / row.n as f64);
            prop_assert!(f64::abs(row.variance.unwrap() / exact - 1.0) < 1e-12, "{:?}", row);
        }
    }

    /// Among schedules with the best start for their decay, the best decay has the smallest MSE.
    #[test]
    fn the_best_decay_beats_its_neighbours(d in 1..5_u32, p in 1..4_u32, c in 0.1..3.0_f64, v in 0.1..3.0_f64) {
        let best = 1.0 / f64::from(d + 2 * p);
        let start = optimal_start(f64::from(d), f64::from(p), c, v);
        let mse = |lambda: f64, start: f64| {
            let schedule: Expression = format!("{start}*n^(-{lambda})").parse().unwrap();
            let row = at_two_points(&schedule, &request(d, p))[1];
            let bias = c * row.bias.unwrap();
            bias * bias + v * row.variance.unwrap()
        };
        let least = mse(best, start);
        for factor in [0.7, 0.85, 1.15, 1.3] {
            prop_assert!(mse(best * factor, start) > least, "{}", factor);
        }
        for factor in [0.9, 1.1] {
            prop_assert!(mse(best, start * factor) > least, "{}", factor);
        }
    }

    /// The sums by blocks against one term after the other, where blocks are first used.
    #[test]
    fn blocks_add_up(x in 0.05..2.5_f64, n in 2049..20_000_u64, w in 0.1..3.0_f64, cut in 0.01..0.5_f64) {
        for text in [
            format!("n^(-{x}/2)"),
            format!("max({cut}*n^(-0.1), n^(-{x}/2))"),
            format!("n^(-{x}/2)*(2+sin({w}*n))"),
            format!("at_powers(5, 3, log(n+1)*n^(-{x}/2))"),
        ] {
            let schedule: Expression = text.parse().unwrap();
            let row = finite_rows(&schedule, &request(2, 2), &[n], 10_000_000)[0];
            let sum = |e: f64| (1..=n).map(|k| libm::pow(schedule.at(k), e)).sum::<f64>();
            let n = n as f64;
            prop_assert!(f64::abs(row.bias.unwrap() * n / sum(2.0) - 1.0) < 1e-11, "{}", text);
            prop_assert!(f64::abs(row.variance.unwrap() * n * n / sum(-2.0) - 1.0) < 1e-11, "{}", text);
        }
    }

    /// No text makes it panic, and what can be read is read again as written.
    #[test]
    fn any_text(text in "[n0-9.,+*/^() -]{0,24}|(max|min|log|exp|ppm|sin|at_powers)\\([n0-9.,+*/^()-]{0,16}\\)|.{0,12}") {
        if let Ok(schedule) = text.parse::<Expression>() {
            let again: Expression = schedule.to_string().parse().unwrap();
            let (a, b) = (schedule.at(3), again.at(3));
            let same = a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()) || f64::abs(a / b - 1.0) < 1e-6;
            prop_assert!(same, "{} {} {}", text, a, b);
            let _ = classify(&schedule, &request(2, 2));
        }
    }
}
