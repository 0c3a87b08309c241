//! `--command`: a program that copies prepared images, one for each call, stands for a renderer.
#![cfg(unix)]

use super::support::{file, gate, json, mirror_wall, nephroid, shown, state, verdict};

/// A command that copies the next of some files to `{out}`, and the prepared files.
fn renderer(name: &str, image: &[f64], files: u32) -> String {
    mirror_wall().beauty(name, image, files);
    let count = file(&format!("{name}-count"));
    let _ = std::fs::remove_file(&count);
    let script = file(&format!("{name}.sh"));
    let prefix = shown(&file(name));
    let text = format!(
        "n=$(cat '{count}' 2>/dev/null || echo 0)\necho $((n + 1)) > '{count}'\n[ -z \"$(ls -A . | grep -v stderr.txt)\" ] || exit 9\ncp '{prefix}'-$n.exr \"$2\"\n",
        count = shown(&count)
    );
    std::fs::write(&script, text).unwrap();
    format!("sh '{}' {{seed}} {{out}}", shown(&script))
}

#[test]
fn images_are_made_until_the_verdict_stands() {
    let command = renderer("made", &mirror_wall().all(), 64);
    let (code, answer) = json(
        "mirror-wall",
        &[],
        &["--command", &command, "--margin", "0.02"],
    );
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
    assert_eq!(verdict(&answer, "all")["integrator"], "sh");
    let again = verdict(&answer, "all")["command"].as_str().unwrap();
    assert!(
        again.contains("--command") && again.contains("--budget 64"),
        "{again}"
    );
    // A wrong one is seen at the first look.
    let bright: Vec<f64> = mirror_wall().all().iter().map(|v| 1.3 * v).collect();
    let command = renderer("made-bright", &bright, 8);
    let (code, answer) = json("mirror-wall", &[], &["--command", &command]);
    assert_eq!(
        (code, verdict(&answer, "all")["replicates"].as_u64()),
        (1, Some(8)),
        "{answer:#}"
    );
    // A margin that the budget does not reach.
    let command = renderer("made-few", &mirror_wall().all(), 8);
    let (code, _) = json(
        "mirror-wall",
        &[],
        &["--command", &command, "--margin", "0.0001", "--budget", "8"],
    );
    assert_eq!(code, 3);
}

#[test]
fn failures_are_shown() {
    let run = |command: &str, options: &[&str]| {
        let mut all = vec!["--command", command];
        all.extend(options);
        gate("mirror-wall", &[], &all)
    };
    for (command, options, part) in [
        (
            "sh -c 'echo broken lamp >&2; exit 3' {seed} {out}",
            &[][..],
            "broken lamp",
        ),
        ("true {seed} {out}", &[], "wrote no file"),
        (
            "no-such-program-at-all {seed} {out}",
            &[],
            "could not be started",
        ),
        ("sleep 30 {seed} {out}", &["--timeout", "0.2"], "sleep"),
        (
            "sh -c 'sleep 30' {seed} {out}",
            &["--timeout", "0.2"],
            "not finished after 0.2 s",
        ),
        (
            "sh -c 'echo no image > \"$1\"' {seed} {out}",
            &[],
            "neither OpenEXR nor PFM",
        ),
        ("true {out}", &[], "without {seed}"),
        ("true {seed}", &[], "without {out}"),
        ("true '{seed} {out}", &[], "a quote is open"),
    ] {
        let (code, _, err) = run(command, options);
        assert_eq!(code, 2, "{command}: {err}");
        assert!(err.contains(part), "{command}: {part}: {err}");
    }
    // Nothing is read by a shell unless it is asked for.
    let target = file("shell-ran");
    let _ = std::fs::remove_file(&target);
    let command = format!("true {{seed}} {{out}} ; touch {}", shown(&target));
    assert_eq!(run(&command, &[]).0, 2);
    assert!(!target.exists());
    assert_eq!(run(&command, &["--shell"]).0, 2);
    assert!(target.exists());
    let (code, out, _) = nephroid(&["gate".to_owned(), "--help".to_owned()]);
    assert!(code == 0 && out.contains("--cannot"), "{out}");
}
