//! The committed table of exact sums and chains, made by an independent program: every number of it.

use nephroid_analytic::schedule::chain::{blind, refresh, shells::Shells};
use nephroid_analytic::schedule::classify::{finite_rows, optimal_decay, optimal_start};
use nephroid_analytic::schedule::{Classification, Expression, Number, Request, Weights, classify};
use serde_json::Value;

const TABLE: &str = include_str!("../../../golden/reference/consistency.json");

fn table() -> Value {
    serde_json::from_str(TABLE).unwrap()
}

fn number(value: &Value) -> f64 {
    let text = value.as_str().map(str::parse);
    text.map_or_else(|| value.as_f64().unwrap(), Result::unwrap)
}

fn rows(value: &Value) -> &[Value] {
    let rows = value.as_array().unwrap();
    assert!(!rows.is_empty());
    rows
}

fn request() -> Request {
    Request {
        dimension: Number::integer(2),
        bias_order: Number::integer(2),
        weights: Weights::Uniform,
        discarded: 0.0,
        chain_rate: None,
    }
}

/// |a - b| over b.
fn error(a: f64, b: f64) -> f64 {
    f64::abs(a / b - 1.0)
}

const C: f64 = 0.5;
const VARIANCE: f64 = 2.0;

#[test]
fn sums_of_power_schedules_and_their_verdicts() {
    let table = table();
    let verdicts = ["0", "1/12", "1/6", "1/3", "0.45", "1/2", "0.55"];
    assert_eq!(rows(&table["schedules"]).len(), verdicts.len());
    for (case, lambda) in rows(&table["schedules"]).iter().zip(verdicts) {
        let schedule: Expression = format!("0.3*n^(-{lambda})").parse().unwrap();
        let exponent = number(&case["lambda"]);
        assert!(f64::abs(schedule.at(2) - 0.3 * libm::pow(2.0, -exponent)) < 1e-15);
        let ns: Vec<u64> = rows(&case["rows"])
            .iter()
            .map(|r| r["n"].as_u64().unwrap())
            .collect();
        let found = finite_rows(&schedule, &request(), &ns, 1_000_000);
        for (row, found) in rows(&case["rows"]).iter().zip(found) {
            let (bias, variance) = (C * found.bias.unwrap(), VARIANCE * found.variance.unwrap());
            assert!(
                error(bias, number(&row["bias"])) < 1e-12,
                "{lambda} {found:?}"
            );
            assert!(
                error(variance, number(&row["variance"])) < 1e-12,
                "{lambda} {found:?}"
            );
            let mse = bias * bias + variance;
            assert!(
                error(mse, number(&row["mse"])) < 1e-12,
                "{lambda} {found:?}"
            );
        }
        let expected = match case["verdict"].as_str().unwrap() {
            "consistent" => Classification::Consistent,
            "inconsistent: bias constant" => Classification::BiasPersists,
            "inconsistent: variance tends to C alpha0^-d/2" | "inconsistent: variance diverges" => {
                Classification::VariancePersists
            }
            other => panic!("{other}"),
        };
        let report = classify(&schedule, &request()).unwrap();
        assert_eq!(report.classification, expected, "{lambda}");
    }
}

#[test]
fn the_best_schedule() {
    let table = table();
    let expected = &table["asymptotics"];
    let best = optimal_decay(Number::integer(2), Number::integer(2)).value();
    assert!(error(best, number(&expected["lambda_opt"])) < 1e-15);
    let start = optimal_start(2.0, 2.0, C, VARIANCE);
    assert!(error(start, number(&expected["alpha0_opt"])) < 1e-14);
    let report = classify(&"0.3*n^(-1/6)".parse().unwrap(), &request()).unwrap();
    let (bias, variance) = (report.bias.unwrap(), report.variance.unwrap());
    let (b, v) = (
        C * bias.coefficient().unwrap(),
        VARIANCE * variance.coefficient().unwrap(),
    );
    assert!(error(b * b + v, number(&expected["mse_constant_at_alpha0"])) < 1e-14);
    let mse = report.mse.unwrap();
    assert!(error(mse.power(), number(&expected["rate_exponent"])) < 1e-15);
}

#[test]
fn sums_of_the_progressive_recursion() {
    let table = table();
    for row in rows(&table["ppm"]) {
        let (a, r1) = (&row["a"], &row["r1"]);
        let text = format!("ppm({}, {})", r1.as_str().unwrap(), a.as_str().unwrap());
        let n = row["n"].as_u64().unwrap();
        let found = finite_rows(&text.parse().unwrap(), &request(), &[n], 1_000_000)[0];
        let (bias, variance) = (C * found.bias.unwrap(), VARIANCE * found.variance.unwrap());
        assert!(error(bias, number(&row["bias"])) < 1e-12, "{row}");
        assert!(error(variance, number(&row["variance"])) < 1e-12, "{row}");
    }
}

/// Distribution of W = Σ k·hit(1/k), hits independent, by convolution: P(W ≤ n), no sampling.
#[test]
fn the_law_at_the_boundary() {
    let table = table();
    let law = &table["boundary_law"];
    for row in rows(&law["finite_n"]) {
        let n = row["n"].as_u64().unwrap() as usize;
        let mut at = vec![0.0; n + 1];
        at[0] = 1.0;
        for k in 1..=n {
            let p = 1.0 / k as f64;
            for w in (0..=n).rev() {
                let hit = if w >= k { p * at[w - k] } else { 0.0 };
                at[w] = (1.0 - p) * at[w] + hit;
            }
        }
        let below: f64 = at.iter().sum();
        assert!(f64::abs(below - number(&row["P(mean<=1)"])) < 1e-12, "{n}");
    }
    // The plateau of the variance, ½: C = 1, α₀ = 1.
    let report = classify(&"n^(-1/2)".parse().unwrap(), &request()).unwrap();
    let plateau = report.variance.unwrap().coefficient().unwrap();
    assert!(error(plateau, number(&law["limit_variance"])) < 1e-15);
    let limit = libm::exp(-0.577_215_664_901_532_9);
    assert!(error(limit, number(&law["limit"])) < 1e-15);
}

#[test]
fn a_chain_with_blind_proposals() {
    let table = table();
    let mass = number(&table["mcmc_blind"]["m"]);
    for case in rows(&table["mcmc_blind"]["rows"]) {
        let s: f64 = case["alpha_d"].as_str().unwrap()[3..].parse().unwrap();
        let volume = |k: u64| libm::pow(k as f64, -s);
        for row in rows(&case["rows"]) {
            let n = row["n"].as_u64().unwrap();
            let variance = blind::variance(mass, volume, n);
            assert!(
                error(variance, number(&row["variance"])) < 1e-9,
                "{s} {n} {variance}"
            );
        }
        let (last, mean) = blind::cold_start(mass, |k| 0.25 * mass * volume(k), 1_000_000);
        let expected = number(&case["cold_start_occupancy_1e6"]);
        assert!(error(last, expected) < 1e-10, "{s} {last}");
        let expected = number(&case["cold_start_mean_1e6"]);
        assert!(error(mean, expected) < 1e-10, "{s} {mean}");
    }
    let limit = number(&table["mcmc_blind"]["limit_variance_s1"]);
    assert!(error(mass * mass * (1.0 - mass) / (1.0 + mass), limit) < 1e-12);
}

#[test]
fn a_chain_that_mixes_whatever_the_bandwidth() {
    let table = table();
    let informed = &table["mcmc_informed"];
    let (mass, eps) = (number(&informed["m"]), number(&informed["kappa"]));
    let kernel = refresh::transition(mass, eps);
    let slem = kernel.second_eigenvalue(&[1.0 - mass, mass]);
    assert!(error(slem, number(&informed["slem"])) < 1e-14);
    for case in rows(&informed["rows"]) {
        let name = case["schedule"].as_str().unwrap();
        let last = |c: char| -> f64 { name.rsplit_once(c).unwrap().1.parse().unwrap() };
        // ln αₖ; α₀ = 1.
        let log_alpha: Box<dyn Fn(f64) -> f64> = if name.contains("gamma") {
            let gamma = match last('=') {
                0.948683 => f64::sqrt(0.9),
                gamma => gamma,
            };
            Box::new(move |k| k * libm::log(gamma))
        } else if name.contains("exp") {
            let s: f64 = name[15..name.len() - 1].parse().unwrap();
            Box::new(move |k| -libm::pow(k, s))
        } else {
            let s: f64 = name[11..].parse().unwrap();
            Box::new(move |k| -s * libm::log(f64::max(k, 1.0)))
        };
        let kept = |n: u64| libm::exp(2.0 * (log_alpha(n as f64) - log_alpha((n - 1) as f64)));
        for row in rows(&case["rows"]) {
            let n = row["n"].as_u64().unwrap();
            let (end, mean) = refresh::occupancy(mass, eps, kept, n);
            assert!(error(end, number(&row["occupancy"])) < 1e-11, "{name} {n}");
            assert!(
                error(mean, number(&row["time_average"])) < 1e-11,
                "{name} {n}"
            );
        }
        if name.contains("gamma") {
            let lost = refresh::lost_share(eps, libm::exp(log_alpha(1.0)), 2.0);
            let end = number(&rows(&case["rows"])[2]["occupancy"]);
            assert!(f64::abs(1.0 - lost - end / mass) < 1e-12, "{name}");
        }
    }
    let critical = refresh::critical_ratio(1.0 - eps, 2.0);
    let half = refresh::lost_share(eps, critical, 2.0);
    assert!(f64::abs(1.0 - half - 1.0 / (2.0 - eps)) < 1e-14);
}

#[test]
fn a_chain_on_shells() {
    let table = table();
    for case in rows(&table["mcmc_shells"]) {
        let shells = Shells {
            mass: 0.2,
            refresh: 0.1,
            dimension: 2.0,
            random_walk: case["random_walk"].as_bool().unwrap(),
        };
        let pi = shells.stationary();
        let kernel = shells.kernel();
        assert!(kernel.imbalance(&pi) < 1e-16);
        assert!(f64::abs(kernel.second_eigenvalue(&pi) - number(&case["slem"])) < 1e-12);
        assert!(f64::abs(kernel.doeblin(&pi) - number(&case["doeblin_eps"])) < 1e-12);
        // The walk between adjacent shells cannot couple distant ones.
        assert!(f64::abs(kernel.dobrushin() - 0.9) < 1e-12);
        let period = u32::try_from(case["period"].as_u64().unwrap()).unwrap();
        let (end, mean) = shells.occupancy(period, 4096);
        assert!(
            error(end, number(&case["occupancy_end"])) < 1e-10,
            "{case} {end}"
        );
        assert!(
            error(mean, number(&case["mean_second_half"])) < 1e-10,
            "{case} {mean}"
        );
    }
}
