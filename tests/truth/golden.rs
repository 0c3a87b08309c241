//! `nephroid golden` from outside: what it writes it finds again, it sees what has changed, and CI cannot update.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn directory(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn golden(action: &str, directory: &Path, ci: bool) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["golden", action, "--scene", "mirror-wall", "--directory"]);
    command.arg(directory).env_remove("CI");
    if ci {
        command.env("CI", "true");
    }
    command.output().unwrap()
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn what_is_written_is_found_again_and_a_change_is_seen() {
    let directory = directory("golden-mirror-wall");
    assert!(golden("--update", &directory, false).status.success());
    let values = directory.join("values/mirror-wall.json");
    let stored = std::fs::read_to_string(&values).unwrap();
    let same = golden("--check", &directory, true);
    assert!(
        same.status.success() && text(&same).contains("2 files: 2 the same to the bit"),
        "{}",
        text(&same)
    );

    // The last digit of a value is within the bounds, a wrong one is not.
    let mut table: serde_json::Value = serde_json::from_str(&stored).unwrap();
    let value = table["values"][0]["E"].as_f64().unwrap();
    for (factor, code, words) in [
        (1.0 + 2.0 * f64::EPSILON, 0, "other bits"),
        (1.0 + 1e-9, 1, "values/mirror-wall.json: different"),
    ] {
        table["values"][0]["E"] = (value * factor).into();
        std::fs::write(&values, table.to_string()).unwrap();
        let output = golden("--check", &directory, true);
        assert_eq!(output.status.code(), Some(code), "{}", text(&output));
        assert!(text(&output).contains(words), "{}", text(&output));
    }

    // An image of another scene is another image.
    std::fs::write(&values, stored).unwrap();
    let image = directory.join("images/mirror-wall.exr");
    let render = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args([
            "render",
            "cup",
            "--size",
            "48x48",
            "--tolerance",
            "1e-3",
            "-o",
        ])
        .arg(&image)
        .status()
        .unwrap();
    assert!(render.success());
    let output = golden("--check", &directory, false);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output));
    assert!(
        text(&output).contains("images/mirror-wall.exr: different: "),
        "{}",
        text(&output)
    );

    for (broken, words) in [
        (Some("not an image"), "OpenEXR file"),
        (None, "mirror-wall.exr"),
    ] {
        match broken {
            Some(bytes) => std::fs::write(&image, bytes).unwrap(),
            None => std::fs::remove_file(&image).unwrap(),
        }
        let output = golden("--check", &directory, false);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        assert!(text(&output).contains(words), "{}", text(&output));
    }
}

#[test]
fn ci_cannot_update() {
    let directory = directory("golden-ci");
    let output = golden("--update", &directory, true);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output).contains("--update") && text(&output).contains("--check in CI"));
    assert!(!directory.exists());
}
