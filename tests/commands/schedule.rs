//! `nephroid schedule` from outside: answers, exit codes, columns of errors.

use std::process::{Command, Output};

use serde_json::Value;

fn schedule(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .arg("schedule")
        .args(arguments)
        .output()
        .unwrap()
}

fn answer(arguments: &[&str]) -> (Value, i32) {
    let output = schedule(&[arguments, &["--json"]].concat());
    let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{output:?}"));
    (value, output.status.code().unwrap())
}

#[test]
fn classifications_and_their_exit_codes() {
    for (arguments, expected, code) in [
        (&["0.2*n^(-1/6)", "--dimension", "2"][..], "consistent", 0),
        (&["ppm(0.1, 2/3)", "--dimension", "2"], "consistent", 0),
        (&["0.2", "--dimension", "2"], "bias_persists", 1),
        (&["n^(-1/2)", "--dimension", "2"], "variance_persists", 1),
        (&["n^(-1/2)", "--dimension", "1"], "consistent", 0),
        (&["n^(-0.2)*(1+sin(n))", "--dimension", "2"], "unknown", 3),
        (
            &["n^(-1/6)", "--dimension", "2", "--bias-order", "-1/2"],
            "bias_persists",
            1,
        ),
        (
            &["n^(-2)", "--dimension", "2", "--chain-rate", "0.9"],
            "consistent",
            0,
        ),
        (
            &[
                "geometric(0.3, 0.99)",
                "--dimension",
                "2",
                "--chain-rate",
                "0.9",
            ],
            "bias_persists",
            1,
        ),
        (
            &[
                "n^(-1/2)",
                "--dimension",
                "2",
                "--weights",
                "inverse-variance",
            ],
            "consistent",
            0,
        ),
        (
            &["n^(-1/2)", "--dimension", "2", "--discard", "0.5"],
            "variance_persists",
            1,
        ),
    ] {
        let (json, found) = answer(arguments);
        assert_eq!(json["schema"], "nephroid-schedule/1");
        assert_eq!(json["classification"], expected, "{arguments:?} {json}");
        assert_eq!(found, code, "{arguments:?}");
        assert!(!json["argument"].as_array().unwrap().is_empty());
        let text = schedule(arguments);
        assert_eq!(text.status.code(), Some(code));
        let shown = String::from_utf8(text.stdout).unwrap();
        assert!(shown.starts_with(&expected.replace('_', " ")), "{shown}");
    }
}

#[test]
fn rates_and_sums_are_in_the_answer() {
    let (json, _) = answer(&["0.3*n^(-1/6)", "--dimension", "2"]);
    let near = |value: &Value, expected: f64| {
        let value = value.as_f64().unwrap();
        assert!(
            f64::abs(value / expected - 1.0) < 1e-12,
            "{value} {expected}"
        );
    };
    near(&json["bias"]["power"], -1.0 / 3.0);
    near(&json["bias"]["coefficient"], 0.09 * 1.5);
    near(&json["variance"]["power"], -2.0 / 3.0);
    near(&json["variance"]["coefficient"], 0.75 / 0.09);
    near(&json["mse"]["power"], -2.0 / 3.0);
    near(&json["optimal_lambda"], 1.0 / 6.0);
    let finite = json["finite"].as_array().unwrap();
    assert_eq!(finite.len(), 5);
    near(&finite[0]["bias_over_c"], 0.09);
    near(&finite[0]["variance_over_C"], 1.0 / 0.09);
    assert!(finite.iter().all(|row| row["variance_over_C"].is_f64()));
}

#[test]
fn errors_name_the_column() {
    for (text, place) in [
        ("0.2*n^(-1/6", "column 12"),
        ("0.2*m", "column 5"),
        ("ppm(0.1, 2)", "column 10"),
        ("", "column 1"),
        ("log(n)", "n = 1"),
    ] {
        let output = schedule(&[text, "--dimension", "2"]);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(output.stdout.is_empty());
        let message = String::from_utf8(output.stderr).unwrap();
        assert!(message.contains(place), "{text}: {message}");
    }
    for arguments in [
        &["n^(-1/6)"][..],
        &["n^(-1/6)", "--dimension", "0"],
        &["n^(-1/6)", "--dimension", "n"],
        &["n^(-1/6)", "--dimension", "nan"],
        &["n^(-1/6)", "--dimension", "2", "--chain-rate", "1"],
        &["n^(-1/6)", "--dimension", "2", "--chain-rate", "-0.1"],
        &["n^(-1/6)", "--dimension", "2", "--discard", "1"],
    ] {
        assert_eq!(schedule(arguments).status.code(), Some(2), "{arguments:?}");
    }
}
