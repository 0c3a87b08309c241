//! The command line from outside: decisions and rounded text, with times redacted.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

fn nephroid(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(args)
        .output()
        .unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A directory of its own for each test.
fn directory(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Replaces what depends on the machine: the last column of a verdict's line and the seconds of the summary.
fn redacted(text: &str) -> String {
    let redact = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        match words.as_slice() {
            [.., last] if line.contains("equivalent  ") && last.parse::<f64>().is_ok() => {
                format!("{} T", line[..line.len() - last.len()].trim_end())
            }
            [rest @ .., time, "s."] if time.parse::<f64>().is_ok() => {
                format!("{} T s.", rest.join(" "))
            }
            _ => line.to_owned(),
        }
    };
    text.lines().map(redact).collect::<Vec<_>>().join("\n")
}

#[test]
fn verify_prints_verdicts_that_do_not_change() {
    let args = ["verify", "--scene", "floor", "--scene", "pool"];
    let output = nephroid(&[&args[..], &["--integrator", "pt", "--seed", "7"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let text = stdout(&output);
    assert!(text.lines().all(|l| l.chars().count() <= 110), "{text}");
    insta::assert_snapshot!("verify", redacted(&text));
}

#[test]
fn verify_json_is_alone_on_standard_output_and_complete() {
    let args = [
        "verify",
        "--scene",
        "mirror-wall",
        "--integrator",
        "lt",
        "--json",
    ];
    let output = nephroid(&args);
    assert_eq!(output.status.code(), Some(0));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema"], "nephroid-verify/1");
    let verdicts = json["verdicts"].as_array().unwrap();
    let decisions: Vec<_> = verdicts
        .iter()
        .map(|v| {
            let word = |key: &str| v[key].as_str().unwrap().to_owned();
            [word("class"), word("region"), word("state")].join(" ")
        })
        .collect();
    assert_eq!(
        decisions,
        [
            "LDE image equivalent",
            "LSDE image equivalent",
            "LDSE image not_sampled",
            "LSDSE image not_sampled",
            "all image equivalent"
        ]
    );
    for v in verdicts {
        for key in [
            "scene",
            "integrator",
            "effect",
            "interval",
            "margin",
            "level",
            "power",
            "minimum_detectable_bias",
            "paths",
            "seed",
            "seconds",
            "command",
        ] {
            assert!(v.get(key).is_some(), "{key}");
        }
        let shared = v["level"].as_f64().unwrap();
        assert_eq!(shared, 1e-6 / 3.0);
        assert!(v["power"].is_null() || v["power"].as_f64().unwrap() >= 0.9);
    }
}

/// A verdict's command gives the verdict again, to the last bit, although fewer checks are asked for.
#[test]
fn a_verdict_says_how_to_get_it_again() {
    let args = ["verify", "--scene", "floor", "--seed", "3", "--json"];
    let output = nephroid(&args);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let verdict = &json["verdicts"][2];
    assert_eq!(verdict["integrator"], "lt");
    let command = verdict["command"].as_str().unwrap();
    let words: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
    assert!(words.contains(&"lt"), "{command}");
    let again: Value = serde_json::from_slice(&nephroid(&words).stdout).unwrap();
    for key in ["effect", "interval", "level", "paths", "state", "command"] {
        assert_eq!(again["verdicts"][0][key], verdict[key], "{key}");
    }
}

/// The same bits on one thread and on three.
#[test]
fn verdicts_do_not_depend_on_the_number_of_threads() {
    let run = |threads: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
            .args(["verify", "--scene", "floor", "--integrator", "pt", "--json"])
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        let mut json: Value = serde_json::from_slice(&output.stdout).unwrap();
        json["seconds"] = Value::Null;
        json["verdicts"][0]["seconds"] = Value::Null;
        json
    };
    assert_eq!(run("1"), run("3"));
}

#[test]
fn verify_writes_its_reports() {
    let directory = directory("verify-reports");
    let at = |name: &str| directory.join(name).display().to_string();
    let output = nephroid(&[
        "verify",
        "--scene",
        "floor",
        "--scene",
        "pool",
        "--integrator",
        "pt",
        "--json",
        &at("v.json"),
        "--junit",
        &at("v.xml"),
        "--report",
        &at("report"),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stdout(&output).contains("equivalent"));
    let read = |name: &str| std::fs::read_to_string(directory.join(name)).unwrap();
    let json: Value = serde_json::from_str(&read("v.json")).unwrap();
    assert_eq!(json["exit_code"], 0);
    let xml = read("v.xml");
    assert!(
        xml.contains(r#"<testsuite name="floor" tests="1" skipped="0" errors="0" failures="0""#),
        "{xml}"
    );
    assert!(
        xml.contains(r#"<testcase name="pt/LDE/image" classname="floor""#),
        "{xml}"
    );
    assert!(
        xml.contains(r#"<testcase name="pt/LSDSE/image" classname="pool""#),
        "{xml}"
    );
    assert!(xml.contains("<skipped"), "{xml}");
    let page = read("report/verify.md");
    assert!(page.contains("| floor | pt | LDE | equivalent |"), "{page}");
}

#[test]
fn nothing_to_judge_is_exit_code_4() {
    let declared = nephroid(&["verify", "--scene", "pool", "--integrator", "pt"]);
    assert_eq!(declared.status.code(), Some(4));
    assert!(stdout(&declared).contains("not_sampled"));
    let no_truth = nephroid(&["verify", "--scene", "furnace", "--integrator", "pm"]);
    assert_eq!(no_truth.status.code(), Some(4));
    assert!(stdout(&no_truth).contains("nothing to regularize"));
}

/// Curved mirrors and water: measured means at finite bandwidth against their exact expectations, class by class.
#[test]
fn regularized_pictures_of_curved_surfaces_are_as_expected() {
    // A margin of 10 % asks for little of the expectation: seconds. At 2 % and less it is a matter of minutes.
    let pair = ["--scene", "pillar", "--integrator", "pm", "--margin", "0.1"];
    let output = nephroid(&[&["verify"], &pair[..]].concat());
    let text = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(!text.contains("not_run"), "{text}");
}

#[test]
fn bad_usage_is_exit_code_2_and_says_what_is_allowed() {
    for (args, allowed) in [
        (&["verify", "--scene", "saucer"][..], "mirror-wall"),
        (&["verify", "--integrator", "mlt"], "pt-reg"),
        (&["verify", "--effort", "heroic"], "thorough"),
        (&["verify", "--margin", "0"], "1e-4 to 5e-1"),
        (&["verify", "--margin", "NaN"], "1e-4 to 5e-1"),
        (&["verify", "--level", "1"], "1e-15 to 1e-1"),
        (&["verify", "--bandwidth", "-0.1"], "1e-9 to 1e6"),
        (&["verify", "--kernel", "box"], "epanechnikov"),
        (
            &["verify", "--integrator", "pt-reg", "--kernel", "disc"],
            "cone",
        ),
        (
            &[
                "verify",
                "--scene",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidth",
                "4",
            ],
            "radians",
        ),
        (&["explain", "saucer"], "mirror-wall"),
        (&["explain", "cup", "--integrator", "mlt"], "pt-reg"),
    ] {
        let output = nephroid(args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(output.stdout.is_empty(), "{args:?}");
        let error = stderr(&output);
        assert!(error.contains(allowed), "{args:?}: {error}");
    }
}

#[test]
fn explain_says_what_is_irregular_and_why() {
    let output = nephroid(&["explain", "mirror-wall"]);
    assert_eq!(output.status.code(), Some(0));
    let text = stdout(&output);
    assert!(text.lines().all(|l| l.chars().count() <= 110), "{text}");
    insta::assert_snapshot!("explain", text);
    let output = nephroid(&["explain", "pool", "--integrator", "pt-reg", "--json"]);
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["schema"], "nephroid-explain/1");
    let [class] = json["classes"].as_array().unwrap().as_slice() else {
        panic!("{json}");
    };
    assert_eq!(class["class"], "LSDSE");
    assert_eq!(class["irregular"], true);
    assert_eq!(class["technique"], "camera");
    assert!(!class["reason"].as_str().unwrap().is_empty());
    assert_eq!(class["mollified_vertex"], 1);
    assert_eq!(class["techniques"][0]["s"], 1);
    assert_eq!(class["techniques"][0]["t"], 4);
    // One connection is possible with s = 1, and it ends in a specular vertex.
    assert_eq!(class["edges"][0]["ends"], "L-S");
    assert_eq!(class["edges"][0]["singular"], true);
}
