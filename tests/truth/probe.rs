//! `probe`: answers, and points that are not on the floor.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

fn probe(name: &str, scene: &str, csv: &str, json: bool) -> Output {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let file = directory.join(format!("probe-{name}.csv"));
    fs::write(&file, csv).expect("a file");
    let mut command = Command::new(env!("CARGO_BIN_EXE_nephroid"));
    command.args(["probe", scene]).arg(&file);
    if json {
        command.arg("--json");
    }
    command.output().expect("the program runs")
}

#[test]
fn answers_per_point_and_class() {
    // mirror-wall by hand: light (0.25, 0, 2), I = 1, mirror y = 1: the image is (0.25, 2, 2).
    let output = probe(
        "good",
        "mirror-wall",
        "x,y,z\n0.25,0.5,0\n0.25,-2.9,0\n0.2,1.5,0\n",
        true,
    );
    assert_eq!(output.status.code(), Some(0));
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(answer["schema"], "nephroid-probe/1");
    let all = answer["answers"].as_array().expect("answers");
    let e = |id: u64, class: &str| {
        let found = all.iter().find(|a| a["id"] == id && a["class"] == class);
        let a = found.expect("an answer");
        let (e, l) = (a["E"].as_f64().expect("E"), a["L"].as_f64().expect("L"));
        assert!((l - 0.5 * e / std::f64::consts::PI).abs() <= 1e-15);
        (e, a["roots"].as_u64().expect("roots"))
    };
    let irradiance = |d2: f64| 2.0 / (d2 * d2.sqrt());
    let close = |(found, roots): (f64, u64), expected: f64| {
        assert!((found - expected).abs() <= 1e-14, "{found} {expected}");
        assert_eq!(roots, u64::from(expected > 0.0));
    };
    close(e(1, "LDE"), irradiance(0.25 + 4.0));
    close(e(1, "LSDE"), irradiance(2.25 + 4.0));
    // s = (0.25, 1, 0.4082 * 2): 2 * 3.9/4.9 = 1.59 is above the mirror.
    close(e(2, "LSDE"), 0.0);
    // Behind the mirror: the segment to the light crosses y = 1 at z = 2/3, inside the rectangle.
    close(e(3, "LDE"), 0.0);
    close(e(3, "LSDE"), 0.0);
}

#[test]
fn the_cup_knows_its_fold() {
    let output = probe(
        "cup",
        "tests/scenes/cup.toml",
        "x, y, z\n0.5,0,0\n0.7,0,0\n0.6,0,0\n",
        true,
    );
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let caustic: Vec<&Value> = answer["answers"]
        .as_array()
        .expect("answers")
        .iter()
        .filter(|a| a["class"] == "LSDE")
        .collect();
    // On the axis the cusp at a/2 = 0.6 is the nearest point: E = E0 R sin ε a/|2x - a| from φ = 0.
    let e0 = 3.4 * 0.9 * 0.5;
    assert!((caustic[0]["singularity"].as_f64().expect("a distance") - 0.1).abs() <= 1e-9);
    let e = caustic[0]["E"].as_f64().expect("E");
    assert!((e - e0 * 1.2 / 0.2).abs() <= 1e-13 * e);
    assert_eq!(caustic[0]["roots"], 1);
    assert_eq!(caustic[1]["roots"], 3);
    assert!(caustic[1]["singularity"].as_f64().expect("a distance") < 0.1);
    // On the cusp itself there is no bound, and JSON has no infinity.
    assert!(caustic[2]["error_bound"].is_null() && caustic[2]["E"].is_null());
    assert_eq!(caustic[2]["state"], "singular");
    assert_eq!(caustic[0]["state"], "regular");
}

/// The nephroid has the radius of curvature 3/4 a |sin φ| where the ray of φ touches it, and the two rays that touch it
/// next to a point at distance d inside have the spread 2 √(2 ρ d): A = E0 R sin ε cos φ √(a/(3/2 sin φ)).
#[test]
fn a_fold_has_a_place_and_a_strength() {
    let a = 1.2;
    let angles = [0.4_f64, 0.5, 0.8];
    let mut csv = "x,y,z\n".to_owned();
    for phi in angles {
        let (s, c) = libm::sincos(phi);
        let (sin_2, cos_2) = libm::sincos(2.0 * phi);
        let tau = 0.5 * a * c;
        let (x, y) = (a * c - tau * cos_2, a * s - tau * sin_2);
        // The normal of the last leg, away from the bright side.
        for d in [0.0, 0.01, -0.01] {
            csv += &format!("{},{},0\n", x + d * sin_2, y - d * cos_2);
        }
    }
    let output = probe("fold", "tests/scenes/cup.toml", &csv, true);
    let answer: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let answers = answer["answers"].as_array().expect("answers");
    let caustic: Vec<&Value> = answers.iter().filter(|a| a["class"] == "LSDE").collect();
    assert_eq!(caustic.len(), 9);
    for (three, phi) in caustic.chunks(3).zip(angles) {
        let (s, c) = libm::sincos(phi);
        let expected = 3.4 * 0.9 * 0.5 * c * libm::sqrt(a / (1.5 * s));
        for (answer, d) in three.iter().zip([0.0, 0.01, 0.01]) {
            let number = |key: &str| answer[key].as_f64().unwrap_or(f64::NAN);
            assert!((number("singularity") - d).abs() <= 1e-8, "{answer}");
            assert_eq!(answer["singularity_type"], "fold");
            assert!(
                (number("strength") / expected - 1.0).abs() <= 1e-4,
                "{answer} {expected}"
            );
        }
        assert_eq!(three[0]["state"], "singular", "{}", three[0]);
        assert_eq!(three[1]["state"], "regular");
        // Two roots more on one side than on the other.
        let roots = |k: usize| three[k]["roots"].as_u64().expect("roots");
        assert_eq!(roots(1).abs_diff(roots(2)), 2);
    }
    let text = probe("fold-text", "tests/scenes/cup.toml", &csv, false);
    let text = String::from_utf8_lossy(&text.stdout).into_owned();
    assert!(
        text.starts_with(
            "id,class,E,L,error_bound,roots,singularity,singularity_type,strength,state"
        )
    );
    assert!(
        text.lines()
            .any(|l| l.starts_with("1,LSDE,singular,singular,inf,")),
        "{text}"
    );
}

#[test]
fn bad_points_are_refused_with_line_and_range() {
    for (name, csv, words) in [
        ("header", "a,b,c\n0,0,0\n", vec!["header", "x,y,z"]),
        ("empty", "", vec!["empty"]),
        ("fields", "x,y,z\n0,0\n", vec!["line 2"]),
        (
            "word",
            "x,y,z\n0,0,0\n0,up,0\n",
            vec!["line 3", "`y`", "up"],
        ),
        ("nan", "x,y,z\nnan,0,0\n", vec!["line 2", "`x`"]),
        (
            "high",
            "x,y,z\n0,0,0.1\n",
            vec!["line 2", "floor", "-3 to 3"],
        ),
        ("far", "x,y,z\n3.1,0,0\n", vec!["line 2", "floor"]),
    ] {
        let output = probe(name, "mirror-wall", csv, false);
        assert_eq!(output.status.code(), Some(2), "{name}");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        for word in words {
            assert!(
                message.contains(word),
                "{name}: {message} should name {word}"
            );
        }
    }
    let output = probe("scene", "teapot", "x,y,z\n0,0,0\n", false);
    assert_eq!(output.status.code(), Some(2));
}
