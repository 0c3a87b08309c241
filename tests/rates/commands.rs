//! The two commands from outside.

fn nephroid(threads: &str, arguments: &[&str]) -> (i32, String, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

const BIAS: [&str; 10] = [
    "bias",
    "mirror-wall",
    "--integrator",
    "pt-reg",
    "--bandwidths",
    "0.4,0.2",
    "--class",
    "LSDE",
    "--paths",
    "4e6",
];
const CONVERGE: [&str; 14] = [
    "converge",
    "mirror-wall",
    "--integrator",
    "ppm",
    "--schedule",
    "ppm(0.4,0.5)",
    "--class",
    "LSDE",
    "--iterations",
    "8",
    "--replicates",
    "64",
    "--paths-per-iteration",
    "8192",
];

#[test]
fn answers_have_the_keys_of_the_contract_and_exit_codes_say_what_follows() {
    let plot = std::path::PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("rates.svg");
    let plot = plot.to_str().unwrap();
    for (arguments, schema) in [
        (&BIAS[..], "nephroid-bias/1"),
        (&CONVERGE[..], "nephroid-converge/1"),
    ] {
        let mut pictures = Vec::new();
        let mut points = Vec::new();
        for threads in ["1", "3"] {
            let all = [arguments, &["--json", "--plot", plot]].concat();
            let (code, text, error) = nephroid(threads, &all);
            assert!([0, 3].contains(&code), "{text} {error}");
            let json: serde_json::Value = serde_json::from_str(&text).unwrap();
            assert_eq!(json["schema"], schema);
            let class = &json["classes"][0];
            let fits = match schema {
                "nephroid-bias/1" => vec![class],
                _ => vec![&class["variance"], &class["squared_bias"]],
            };
            for fit in fits {
                assert!(
                    fit["fitted"].is_number() && fit["predicted"].is_number(),
                    "{text}"
                );
                assert_eq!(fit["interval"].as_array().unwrap().len(), 2);
            }
            // Times differ, and what is derived from them.
            let mut values = class["points"].clone();
            for p in values.as_array_mut().unwrap() {
                p.as_object_mut().unwrap().remove("efficiency");
            }
            points.push(values);
            pictures.push(std::fs::read_to_string(plot).unwrap());
        }
        assert!(points[0] == points[1] && pictures[0] == pictures[1]);
        assert!(pictures[0].starts_with("<svg") && pictures[0].ends_with("</svg>\n"));
        assert!(!pictures[0].contains("NaN") && pictures[0].contains("predicted"));
    }
    // Another technique's prediction, an integrator with nothing to measure.
    let (code, text, _) = nephroid(
        "2",
        &[&BIAS[..9], &["8e6", "--technique", "light"]].concat(),
    );
    assert_eq!(code, 1, "{text}");
    let nothing = [
        "bias",
        "floor",
        "--integrator",
        "pt-reg",
        "--bandwidths",
        "0.4,0.2",
    ];
    assert_eq!(nephroid("2", &nothing).0, 4);
    let unknown = [
        "bias",
        "cup",
        "--integrator",
        "pt-reg",
        "--bandwidths",
        "0.4,0.2",
    ];
    let (code, text, _) = nephroid("2", &unknown);
    assert!(code == 4 && text.contains("name a --region"), "{text}");
}

#[test]
fn bad_input_names_the_option_and_what_is_allowed() {
    let bias = |option: &'static str, value: &'static str| [&BIAS[..], &[option, value]].concat();
    let converge =
        |option: &'static str, value: &'static str| [&CONVERGE[..], &[option, value]].concat();
    let cases = [
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3",
            ],
            "--bandwidths",
            "2 to 32",
        ),
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,-1",
            ],
            "--bandwidths",
            "positive",
        ),
        (
            vec![
                "bias",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,9",
            ],
            "--bandwidths",
            "radians",
        ),
        (
            vec![
                "bias",
                "no-such-scene",
                "--integrator",
                "pt-reg",
                "--bandwidths",
                "0.3,0.1",
            ],
            "no-such-scene",
            "mirror-wall",
        ),
        (bias("--region", "5,5,5,9"), "--region", "x0 < x1"),
        (bias("--region", "0,0,500,9"), "--region", "128"),
        (bias("--replicates", "3"), "--replicates", "16 to 65536"),
        (bias("--technique", "merge"), "--technique", "camera"),
        (bias("--kernel", "disc"), "kernel", "cone"),
        (bias("--level", "2"), "--level", "1e-15"),
        (converge("--region", "0,0,1,500"), "--region", "128"),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "ppm",
                "--schedule",
                "0.2*pow(n)",
            ],
            "--schedule",
            "column 5: found `pow`",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "ppm",
                "--schedule",
                "0.2",
                "--iterations",
                "9",
            ],
            "--iterations",
            "power of two",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "pt-reg",
                "--schedule",
                "4,3",
            ],
            "--schedule",
            "radians",
        ),
        (
            vec![
                "converge",
                "mirror-wall",
                "--integrator",
                "lt",
                "--schedule",
                "0.2",
                "--class",
                "LTTDE",
            ],
            "--class",
            "LSDE",
        ),
    ];
    for (arguments, option, allowed) in cases {
        let (code, _, error) = nephroid("1", &arguments);
        let error = error.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(code, 2, "{arguments:?}: {error}");
        assert!(
            error.contains(option) && error.contains(allowed),
            "{arguments:?}: {error}"
        );
    }
}
