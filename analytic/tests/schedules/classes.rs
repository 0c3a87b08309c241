//! Classification against what theory says of each kind of schedule, with the boundaries met exactly.

use nephroid_analytic::schedule::classify::finite_rows;
use nephroid_analytic::schedule::{
    Classification, Expression, Number, Report, Request, Weights, classify,
};

use Classification::{BiasPersists, Consistent, Unknown, VariancePersists};

fn number(text: &str) -> Number {
    text.parse::<Expression>().unwrap().constant().unwrap()
}

fn request(d: &str, p: &str) -> Request {
    Request {
        dimension: number(d),
        bias_order: number(p),
        weights: Weights::Uniform,
        discarded: 0.0,
        chain_rate: None,
    }
}

fn report(text: &str, request: &Request) -> Report {
    classify(&text.parse().unwrap(), request).unwrap_or_else(|e| panic!("{text}: {e}"))
}

#[test]
fn kinds_of_schedules() {
    for (text, d, p, expected) in [
        ("0.3", "2", "2", BiasPersists),
        ("0.3*n", "2", "2", BiasPersists),
        ("n^(-0.49)", "2", "2", Consistent),
        ("n^(-1/2)", "2", "2", VariancePersists),
        ("n^(-1/3)", "3", "2", VariancePersists),
        ("n^(-1/7)", "7", "2", VariancePersists),
        ("n^(-0.1428)", "7", "2", Consistent),
        ("1/sqrt(n)", "2", "2", VariancePersists),
        // On the boundary the logarithm decides.
        ("sqrt(log(n+2)/n)", "2", "2", Consistent),
        ("sqrt(1/(n*log(n+2)))", "2", "2", VariancePersists),
        ("1/log(n+e)^0.01", "2", "2", Consistent),
        ("(n^2*log(n+1))^(-1/5)", "2", "2", Consistent),
        ("ppm(0.1, 2/3)", "2", "2", Consistent),
        ("ppm(0.1, 2/3)", "4", "2", Consistent),
        ("ppm(0.1, 1/3)", "4", "2", VariancePersists),
        ("ppm(0.1, 0.5)", "4", "2", VariancePersists),
        ("geometric(0.3, 0.99)", "2", "2", VariancePersists),
        ("geometric(0.3, 1)", "2", "2", BiasPersists),
        ("exp(-sqrt(n))", "2", "2", VariancePersists),
        ("n^(-1/6)", "2", "0", BiasPersists),
        ("n^(-1/6)", "2", "-1/2", BiasPersists),
        // Floors and cut-offs.
        ("max(n^(-1), 0.001)", "2", "2", BiasPersists),
        ("max(n^(-1), n^(-1/4))", "2", "2", Consistent),
        ("min(0.2, 10*n^(-1/3))", "2", "2", Consistent),
        ("0.1+n^(-1/6)", "2", "2", BiasPersists),
        ("(0.1+n^(-1/6))-0.1", "2", "2", Consistent),
        // Bounds suffice.
        ("n^(-1/6)*(2+sin(n))", "2", "2", Consistent),
        ("n^(-0.6)*(2+sin(n))", "2", "2", VariancePersists),
        ("1/(n^(1/5)+3*cos(n)^2)", "2", "2", Consistent),
        ("0.1*n^(-1/6)*(3+sin(n)^3-2*cos(n))^0.5", "2", "2", Unknown),
        (
            "0.1*n^(-1/6)*(4+sin(n)^3-2*cos(n))^0.5",
            "2",
            "2",
            Consistent,
        ),
        ("0.1*(2+cos(log(n)))", "2", "2", BiasPersists),
        // They do not: the exponent swings across the window, or the bound is 0.
        ("min(1, n^(-0.2))*(1.0001+sin(n))", "2", "2", Consistent),
        ("n^(-0.2)*(1+sin(n))", "2", "2", Unknown),
        (
            "min(n^(-0.2), n^(-0.7)*(2+sin(n))*n^(0.3))",
            "2",
            "2",
            Consistent,
        ),
        ("n^(-0.4-0.3*sin(n))", "2", "2", Unknown),
        ("n^(-0.2)+(sqrt(n+1)-sqrt(n))", "2", "2", Unknown),
        // Rare large bandwidths do not hurt, rare tiny ones do.
        ("at_powers(2, 1, n^(-1/6))", "2", "2", Consistent),
        ("at_powers(2, 1/n, 1)", "2", "2", BiasPersists),
        ("at_powers(2, 1/n, n^(-1/6))", "2", "2", VariancePersists),
        ("at_powers(2, n^(-0.9), n^(-1/6))", "2", "2", Consistent),
        // n^a times a factor that tends to 1.
        ("n^(-1/4)*exp(1/n)", "2", "2", Consistent),
        ("(1+1/n)^n*n^(-1/4)", "2", "2", Unknown),
    ] {
        let report = report(text, &request(d, p));
        assert_eq!(
            report.classification, expected,
            "{text} {d} {p}: {report:#?}"
        );
        assert!(!report.argument.is_empty());
    }
}

#[test]
fn boundaries_with_known_constants() {
    let r = request("2", "2");
    let limit = |text: &str| report(text, &r).variance.unwrap().coefficient().unwrap();
    assert!(f64::abs(limit("0.3*n^(-1/2)") * 0.09 - 0.5) < 1e-14);
    assert!(f64::abs(limit("0.3*n^(-0.6)") * 0.09 - 1.0 / 2.2) < 1e-14);
    // Theory, section 3: α^-d = k² at powers of 2: up to 4/3.
    assert!(f64::abs(limit("at_powers(2, 1/n, 0.9)") - 4.0 / 3.0) < 1e-14);
    let swing = report("at_powers(2, 1, n^(-1/3))", &r).bias.unwrap();
    assert_eq!((swing.power(), swing.growth.log.value()), (-2.0 / 3.0, 0.0));
    // α = 1 at powers of 2 adds log2(n)/n, which shows once the rest is summable.
    let swing = report("at_powers(2, 1, n^(-0.6))", &r).bias.unwrap();
    assert_eq!((swing.power(), swing.growth.log.value()), (-1.0, 1.0));
    assert!(f64::abs(swing.coefficient().unwrap() * core::f64::consts::LN_2 - 1.0) < 1e-14);
    // λp = 1: ln(n)/n.
    let log = report("0.3*n^(-1/2)", &r).bias.unwrap();
    assert_eq!((log.power(), log.growth.log.value()), (-1.0, 1.0));
    assert!(f64::abs(log.coefficient().unwrap() - 0.09) < 1e-16);
}

#[test]
fn weights_and_discarded_samples() {
    let weighted = |d| Request {
        weights: Weights::InverseVariance,
        ..request(d, "2")
    };
    for (text, expected) in [
        ("n^(-1/2)", Consistent),
        // Once the weights can be summed the first samples decide for ever: bias and variance both persist.
        ("n^(-0.51)", BiasPersists),
        ("sqrt(1/(n*log(n+2)))", Consistent),
        ("sqrt(1/(n*log(n+2)^1.01))", BiasPersists),
        ("0.2", BiasPersists),
    ] {
        let report = report(text, &weighted("2"));
        assert_eq!(report.classification, expected, "{text}: {report:#?}");
    }
    // Theory, section 4: C α₀^-d/Hₙ and c α₀^p Hₙ(2)/Hₙ.
    let row = finite_rows(
        &"0.3*n^(-1/2)".parse().unwrap(),
        &weighted("2"),
        &[1000],
        100_000,
    )[0];
    let h: f64 = (1..=1000).map(|k| 1.0 / f64::from(k)).sum();
    let h2: f64 = (1..=1000).map(|k| 1.0 / f64::from(k * k)).sum();
    assert!(f64::abs(row.variance.unwrap() * 0.09 * h - 1.0) < 1e-13);
    assert!(f64::abs(row.bias.unwrap() * h / (0.09 * h2) - 1.0) < 1e-13);
    // Dropped samples change constants, not exponents.
    for beta in [0.1, 0.5, 0.9] {
        let r = Request {
            discarded: beta,
            ..request("2", "2")
        };
        let text = "n^(-1/6)";
        let dropped = report(text, &r);
        let (l, d) = (1.0 / 6.0, 2.0);
        let bias = (1.0 - libm::pow(beta, 1.0 - 2.0 * l)) / ((1.0 - beta) * (1.0 - 2.0 * l));
        let variance =
            (1.0 - libm::pow(beta, 1.0 + l * d)) / ((1.0 - beta) * (1.0 - beta) * (1.0 + l * d));
        let near = |a: f64, b: f64| f64::abs(a / b - 1.0) < 1e-13;
        assert!(near(dropped.bias.unwrap().coefficient().unwrap(), bias));
        assert!(near(
            dropped.variance.unwrap().coefficient().unwrap(),
            variance
        ));
        // And the exact sums agree with both.
        let n = 1_u64 << 40;
        let row = finite_rows(&text.parse().unwrap(), &r, &[n], 100_000)[0];
        let n = n as f64;
        assert!(f64::abs(row.bias.unwrap() * libm::pow(n, 1.0 / 3.0) / bias - 1.0) < 1e-7);
        assert!(f64::abs(row.variance.unwrap() * libm::pow(n, 2.0 / 3.0) / variance - 1.0) < 1e-7);
        assert_eq!(report("n^(-0.5)", &r).classification, VariancePersists);
        // Where the early samples dominate the bias, dropping them helps: n^(-2λ) instead of 1/n.
        let early = report("n^(-0.6)", &r).bias.unwrap();
        assert!(f64::abs(early.power() + 1.2) < 1e-15);
    }
}

#[test]
fn chains() {
    for (text, rate, expected) in [
        ("0.3*n^(-1/6)", 0.9, Consistent),
        ("n^(-5)", 0.9, Consistent),
        ("exp(-sqrt(n))", 0.9, Consistent),
        ("0.3", 0.9, BiasPersists),
        ("geometric(0.3, 0.99)", 0.9, BiasPersists),
        ("geometric(0.3, 0.5)", 0.9, BiasPersists),
        ("exp(-n^2)", 0.9, BiasPersists),
        ("geometric(0.3, 0.5)", 0.0, Consistent),
        ("n^(-1/6)*(2+sin(n))", 0.9, Unknown),
        ("n^(-1/6)*(2+sin(n))", 0.0, Consistent),
        ("ppm(0.1, 0.5)", 0.99, Consistent),
    ] {
        let r = Request {
            chain_rate: Some(rate),
            ..request("2", "2")
        };
        let report = report(text, &r);
        assert_eq!(report.classification, expected, "{text}: {report:#?}");
    }
    let r = Request {
        chain_rate: Some(0.9),
        ..request("2", "2")
    };
    // Theory, section 6.2: u/m = ε/(1 - (1 - ε) γ^d).
    let lost = report("geometric(0.3, 0.99)", &r).lost_share.unwrap();
    assert!(f64::abs(0.2 * (1.0 - lost) - 0.169_620_897_294_547) < 1e-14);
    assert_eq!(report("n^(-5)", &r).independent, VariancePersists);
}

#[test]
fn bandwidths_that_are_none() {
    for (text, n) in [
        ("log(n)", 1),
        ("1/log(n)", 1),
        ("sin(n)", 4),
        ("0-n", 1),
        ("1-n/10", 10),
        ("sqrt(5-n)+0.1", 6),
        ("1e9-n", 1 << 30),
    ] {
        let error = classify(&text.parse().unwrap(), &request("2", "2")).unwrap_err();
        assert_eq!(error.n, n, "{text}");
    }
}
