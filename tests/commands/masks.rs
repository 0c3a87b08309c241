//! `verify --mask` from outside, on a small `mirror-wall`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use image::{GrayImage, Luma};
use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Kernel, Technique};
use serde_json::Value;

const SIDE: u32 = 32;

fn nephroid(args: &[&str]) -> (i32, String, String) {
    let output: Output = Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .args(args)
        .output()
        .unwrap();
    let text = |bytes: Vec<u8>| {
        let text = String::from_utf8(bytes).unwrap().replace('│', " ");
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("mask-{name}"))
}

fn shown(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The scene at a lower resolution.
fn scene(name: &str) -> PathBuf {
    let text = include_str!("../../scenes/mirror-wall.toml");
    let small = text.replace("= 128", &format!("= {SIDE}"));
    assert_ne!(text, small);
    let path = file(&format!("{name}.toml"));
    std::fs::write(&path, small).unwrap();
    path
}

/// The left of the image, and a row that does not touch it.
fn is_selected(i: u32, j: u32) -> bool {
    (i < 18 && j > 5) || j == 2
}

fn mask(name: &str, side: u32, white: impl Fn(u32, u32) -> bool) -> PathBuf {
    let path = file(&format!("{name}.png"));
    let picture = GrayImage::from_fn(side, side, |i, j| {
        // What is a little brighter or darker than half.
        Luma([if white(i, j) { 128 } else { 127 }])
    });
    picture.save(&path).unwrap();
    path
}

/// The part of the image that counts is the mask: truths are means over its pixels, of exact classes and of regularized ones, and the
/// integrators meet them. Taken over the image they would be others.
#[test]
fn verdicts_are_about_the_masked_pixels() {
    let (scene, mask) = (scene("judged"), mask("judged", SIDE, is_selected));
    let mut args = vec!["verify", "--scene", shown(&scene), "--mask", shown(&mask)];
    args.extend(["--integrator", "lt", "--integrator", "pt-reg"]);
    args.extend(["--margin", "0.1", "--bandwidth", "0.5", "--json"]);
    let (code, text, error) = nephroid(&args);
    assert_eq!(code, 0, "{text} {error}");
    let json: Value = serde_json::from_str(&text).unwrap();
    let verdict = |integrator: &str, class: &str| {
        let is = |v: &&Value| v["integrator"] == integrator && v["class"] == class;
        let list = json["verdicts"].as_array().unwrap();
        list.iter().find(is).unwrap().clone()
    };
    let entry = nephroid::entry::load(shown(&scene)).unwrap();
    let pixels: Vec<(u32, u32)> = (0..SIDE * SIDE)
        .map(|k| (k % SIDE, k / SIDE))
        .filter(|&(i, j)| is_selected(i, j))
        .collect();
    let exact = nephroid::truth::image(&entry, 1e-6);
    let mean = |layer: &[f64], pixels: &[(u32, u32)]| {
        let of = |&(i, j): &(u32, u32)| layer[(j * SIDE + i) as usize];
        pixels.iter().map(of).sum::<f64>() / pixels.len() as f64
    };
    let film = FilmExpectation::new(&entry, Technique::Camera, Kernel::Cone, &[0.5]).unwrap();
    // Pixel by pixel, clipped along what the mirror shows; one rule on each piece is good to a per cent of the sum.
    let regularized = |class: usize| -> Vec<f64> {
        let pixel = |k: u32| {
            let (i, j) = (k % SIDE, k / SIDE);
            film.region(i..i + 1, j..j + 1, &[[f64::INFINITY; 2]; 2], 1e-3)[class]
        };
        (0..SIDE * SIDE).map(|k| pixel(k).mean.value).collect()
    };
    let everything: Vec<(u32, u32)> = (0..SIDE * SIDE).map(|k| (k % SIDE, k / SIDE)).collect();
    for (integrator, class, layer, known_to) in [
        ("lt", "LDE", exact.layers[0].clone(), 2e-3),
        ("lt", "LSDE", exact.layers[1].clone(), 2e-3),
        ("pt-reg", "LSDE", regularized(0), 0.01),
        ("pt-reg", "LSDSE", regularized(1), 0.01),
    ] {
        let v = verdict(integrator, class);
        assert_eq!(v["state"], "equivalent", "{v}");
        assert_eq!(v["region"], "mask");
        let truth = v["truth"].as_f64().unwrap();
        let (inside, whole) = (mean(&layer, &pixels), mean(&layer, &everything));
        assert!(
            (truth / inside - 1.0).abs() < known_to,
            "{class} {truth} {inside}"
        );
        assert!(
            (truth / whole - 1.0).abs() > 0.03,
            "{class} {truth} {whole}"
        );
    }
    // The same again by the command that it gives.
    let v = verdict("lt", "LSDE");
    let command = v["command"].as_str().unwrap();
    let words: Vec<&str> = command.split(' ').skip(1).chain(["--json"]).collect();
    assert!(words.contains(&"--mask"), "{command}");
    let again: Value = serde_json::from_str(&nephroid(&words).1).unwrap();
    let found = again["verdicts"].as_array().unwrap();
    let same = found.iter().find(|w| w["class"] == "LSDE").unwrap();
    for key in ["effect", "interval", "paths", "state", "region"] {
        assert_eq!(same[key], v[key], "{key}");
    }
}

#[test]
fn a_mask_that_does_not_fit_says_what_would() {
    let scene = scene("refused");
    let text = file("text.png");
    std::fs::write(&text, "not a picture").unwrap();
    let cut = file("cut.png");
    let whole = std::fs::read(mask("whole", SIDE, is_selected)).unwrap();
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let large = mask("large", 2 * SIDE, is_selected);
    let black = mask("black", SIDE, |_, _| false);
    let absent = file("absent.png");
    let cases: [(&Path, &[&str], &str); 6] = [
        (&text, &[], "not a PNG"),
        (&cut, &[], "PNG"),
        (&large, &[], "32 x 32 pixels, the image of mirror-wall"),
        (&black, &[], "no pixel is brighter than half"),
        (&absent, &[], "No such file"),
        (&large, &["--variations"], "cannot be used with"),
    ];
    for (mask, more, message) in cases {
        let mut args = vec!["verify", "--scene", shown(&scene), "--mask", shown(mask)];
        args.extend(more);
        let (code, out, error) = nephroid(&args);
        assert_eq!(code, 2, "{mask:?}: {error}");
        assert!(
            out.is_empty() && error.contains(message),
            "{mask:?}: {error}"
        );
    }
}
