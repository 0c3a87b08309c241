//! `nephroid run` from outside: files, exit codes, messages.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

fn run(threads: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .arg("run")
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap()
}

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-run-{name}.exr"))
}

#[test]
fn the_file_is_the_same_for_any_number_of_threads() {
    let target = file("threads");
    let shown = target.to_str().unwrap();
    let bytes = |threads: &str| {
        let arguments = [
            "mirror-wall",
            "--integrator",
            "ppm",
            "--paths",
            "2e5",
            "--paths-per-iteration",
            "3e4",
            "--seed",
            "5",
            "--schedule",
            "ppm(0.3,0.5)",
            "-o",
            shown,
        ];
        let output = run(threads, &arguments);
        assert!(output.status.success(), "{output:?}");
        assert!(
            output.stderr.is_empty(),
            "no progress bar without a terminal"
        );
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(
            text.contains("200000 paths") && text.contains("bandwidth ppm(0.3,0.5)"),
            "{text}"
        );
        (fs::read(&target).unwrap(), text)
    };
    let one = bytes("1");
    assert!(one == bytes("2"));
    assert!(one == bytes("7"));
}

#[test]
fn only_sampled_classes_are_in_the_file() {
    let target = file("classes");
    let output = run(
        "2",
        &[
            "cup",
            "--integrator",
            "lt",
            "--paths",
            "1e4",
            "-o",
            target.to_str().unwrap(),
        ],
    );
    assert!(output.status.success(), "{output:?}");
    let bytes = fs::read(&target).unwrap();
    let holds = |name: &[u8]| bytes.windows(name.len()).any(|w| w == name);
    assert!(holds(b"LDE.Y\0") && holds(b"LSDE.Y\0") && holds(b"nephroid:seed\0"));
    assert!(!holds(b"LDSE.Y\0") && !holds(b"LSDSE.Y\0"));
}

#[test]
fn what_cannot_be_run_says_why_and_writes_nothing() {
    let target = file("refused");
    let shown = target.to_str().unwrap();
    let cases: [(&[&str], i32, &str); 11] = [
        (
            &["pool", "--integrator", "pt"],
            4,
            "samples no path class of pool",
        ),
        (&["nowhere", "--integrator", "pt"], 2, "nowhere"),
        (
            &["floor", "--integrator", "mlt"],
            2,
            "pt, pt-reg, lt, pm, ppm",
        ),
        (
            &["floor", "--integrator", "pm", "--kernel", "vmf"],
            2,
            "disc, epanechnikov, biweight, cone",
        ),
        (
            &["floor", "--integrator", "pm", "--kernel", "box"],
            2,
            "vmf",
        ),
        (
            &[
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidth",
                "3.2",
            ],
            2,
            "at most π",
        ),
        (
            &["mirror-wall", "--integrator", "pm", "--bandwidth", "0"],
            2,
            "greater than 0",
        ),
        (
            &["mirror-wall", "--integrator", "pm", "--bandwidth", "nan"],
            2,
            "greater than 0",
        ),
        (
            &[
                "mirror-wall",
                "--integrator",
                "pm",
                "--schedule",
                "0.3*m^-0.2",
            ],
            2,
            "column 5: found `m`",
        ),
        (
            &[
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--schedule",
                "4*n^(-1/6)",
            ],
            2,
            "4 at n = 1",
        ),
        (
            &[
                "mirror-wall",
                "--integrator",
                "pm",
                "--schedule",
                "1",
                "--bandwidth",
                "1",
            ],
            2,
            "cannot be used",
        ),
    ];
    for (arguments, code, message) in cases {
        let mut arguments = arguments.to_vec();
        arguments.extend(["--paths", "1e3", "-o", shown]);
        let output = run("1", &arguments);
        let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        // Messages are wrapped to the width of the terminal.
        let words = text.replace("│", " ");
        let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(message), "{arguments:?}: {text}");
        assert!(!target.exists());
    }
    for paths in ["0", "-1", "1.5", "1e16", "x"] {
        let output = run(
            "1",
            &["floor", "--integrator", "pt", "--paths", paths, "-o", shown],
        );
        assert_eq!(output.status.code(), Some(2), "{paths}");
    }
    let one_at_a_time = [
        "floor",
        "--integrator",
        "pt",
        "--paths",
        "1e10",
        "--paths-per-iteration",
        "1",
        "-o",
        shown,
    ];
    assert_eq!(run("1", &one_at_a_time).status.code(), Some(2));
}
