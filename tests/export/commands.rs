//! `nephroid export` from outside: exit codes, and directories that are whole or not there.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn nephroid(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(args)
        .output()
        .unwrap()
}

fn directory(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("export-{name}"));
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn names(directory: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_directory_appears_whole_and_is_replaced() {
    let parent = directory("whole");
    let target = parent.join("cup");
    let args = [
        "export",
        "cup",
        "--format",
        "mitsuba",
        "-o",
        target.to_str().unwrap(),
    ];
    let output = nephroid(&args);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let files = ["README.md", "export.json", "meshes", "scene.xml"];
    assert_eq!(names(&target), files);
    assert_eq!(names(&target.join("meshes")), ["wall.ply"]);
    // An image that has been rendered there goes, too: the directory is an export's.
    std::fs::write(target.join("stray"), "x").unwrap();
    assert_eq!(nephroid(&args).status.code(), Some(0));
    assert_eq!(names(&target), files);
    assert_eq!(names(&parent), ["cup"]);
}

#[test]
fn what_is_not_an_export_is_left_alone() {
    let parent = directory("mine");
    std::fs::write(parent.join("precious"), "x").unwrap();
    let output = nephroid(&[
        "export",
        "floor",
        "--format",
        "pbrt",
        "-o",
        parent.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("not an export"),
        "{output:?}"
    );
    assert_eq!(names(&parent), ["precious"]);
    let file = parent.join("precious");
    let output = nephroid(&[
        "export",
        "floor",
        "--format",
        "pbrt",
        "-o",
        file.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn bad_usage_exits_with_2() {
    let parent = directory("usage");
    let target = parent.join("x");
    let target = target.to_str().unwrap();
    for args in [
        vec![
            "export",
            "no-such-scene",
            "--format",
            "mitsuba",
            "-o",
            target,
        ],
        vec!["export", "floor", "--format", "povray", "-o", target],
        vec!["export", "floor", "-o", target],
        vec!["export", "floor", "--format", "mitsuba"],
        vec!["export", "floor", "--format", "mitsuba", "-o", "/"],
    ] {
        let output = nephroid(&args);
        assert_eq!(output.status.code(), Some(2), "{args:?} {output:?}");
    }
    assert!(names(&parent).is_empty());
}

#[test]
fn a_scene_that_single_precision_cannot_tell_is_refused_with_the_reason() {
    let parent = directory("far");
    let file = parent.join("far.toml");
    let floor = include_str!("../../scenes/floor.toml");
    let far = floor
        .replace("position = [-2.1, -3.4, 2.3]", "position = [1e6, 0, 2.3]")
        .replace("look_at = [0.1, 0.0, 0.0]", "look_at = [1000002, 0, 0.0]");
    assert_ne!(far, floor);
    std::fs::write(&file, far).unwrap();
    let target = parent.join("out");
    let output = nephroid(&[
        "export",
        file.to_str().unwrap(),
        "--format",
        "luxcore",
        "-o",
        target.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("single"),
        "{output:?}"
    );
    assert!(!target.exists());
}
