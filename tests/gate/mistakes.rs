//! A wrong render made from the exact image and noise is different, with the right diagnosis; a right one is equivalent.
//! Images are those of fixed seeds: a false alarm has probability 1e-4 for a right renderer, a miss far less.

use nephroid::truth;

use super::support::{Scene, gate, json, looks_like, mirror_wall, state, verdict};

#[test]
fn the_right_image_is_equivalent() {
    let scene = mirror_wall();
    let files = scene.beauty("right", &scene.all(), 16);
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.01"]);
    assert_eq!(code, 0, "{answer:#}");
    assert_eq!(answer["schema"], "nephroid-gate/1");
    assert_eq!(state(&answer, "all"), "equivalent");
    assert_eq!(state(&answer, "LDE"), "equivalent");
    let files = scene.layers("right-layers", 16, |_, v| Some(v.to_vec()));
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.02"]);
    assert_eq!(code, 0, "{answer:#}");
    for class in ["LDE", "LSDE", "LDSE", "LSDSE", "all"] {
        assert_eq!(state(&answer, class), "equivalent", "{answer:#}");
    }
}

#[test]
fn a_factor_is_named() {
    let scene = mirror_wall();
    let bright: Vec<f64> = scene.all().iter().map(|v| 1.01 * v).collect();
    let files = scene.beauty("bright", &bright, 16);
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.005"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (1, "different"),
        "{answer:#}"
    );
    assert!(
        looks_like(&answer, "all").contains("constant factor 1.0"),
        "{answer:#}"
    );
    let unit: Vec<f64> = scene
        .all()
        .iter()
        .map(|v| 4.0 * core::f64::consts::PI * v)
        .collect();
    let files = scene.beauty("unit", &unit, 8);
    let (code, answer) = json("mirror-wall", &files, &[]);
    assert_eq!(code, 1);
    let text = looks_like(&answer, "all");
    assert!(
        text.contains("= 4π") && text.contains("--gain 12.566371"),
        "{text}"
    );
    let (code, answer) = json(
        "mirror-wall",
        &files,
        &["--gain", "12.566370614359172", "--margin", "0.02"],
    );
    assert_eq!(code, 0, "{answer:#}");
}

#[test]
fn a_missing_class_is_named_until_it_is_declared() {
    let scene = mirror_wall();
    let files = scene.beauty("no-caustic", &scene.sum(&["LDE", "LDSE"]), 16);
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.02"]);
    assert_eq!(code, 1, "{answer:#}");
    for class in ["LSDE", "LSDSE"] {
        assert_eq!(state(&answer, class), "different", "{answer:#}");
        let text = looks_like(&answer, class);
        assert!(
            text.contains("class missing") && text.contains(&format!("--cannot {class}")),
            "{text}"
        );
    }
    assert!(
        looks_like(&answer, "all").contains("class missing: LSDE and LSDSE"),
        "{answer:#}"
    );
    let (code, answer) = json(
        "mirror-wall",
        &files,
        &["--margin", "0.02", "--cannot", "LSDE", "--cannot", "LSDSE"],
    );
    assert_eq!(code, 0, "{answer:#}");
    assert_eq!(state(&answer, "LSDE"), "not_sampled");
    assert_eq!(state(&answer, "LDSE"), "equivalent", "{answer:#}");
    // Layers: one is black, one is not there.
    let files = scene.layers("dropped", 8, |c, v| match c {
        "LSDE" => Some(vec![0.0; v.len()]),
        "LSDSE" => None,
        _ => Some(v.to_vec()),
    });
    let (code, answer) = json("mirror-wall", &files, &["--margin", "0.02"]);
    assert_eq!(code, 1);
    for class in ["LSDE", "LSDSE"] {
        assert!(
            looks_like(&answer, class).contains("class missing"),
            "{answer:#}"
        );
    }
    let (code, answer) = json(
        "mirror-wall",
        &files,
        &["--margin", "0.02", "--cannot", "LSDE", "--cannot", "LSDSE"],
    );
    assert_eq!(
        (code, state(&answer, "LSDE").as_str()),
        (0, "not_sampled"),
        "{answer:#}"
    );
    // Declared, yet there.
    let files = scene.layers("declared", 4, |_, v| Some(v.to_vec()));
    let (_, answer) = json("mirror-wall", &files, &["--cannot", "LSDE"]);
    assert_eq!(state(&answer, "LSDE"), "different");
}

#[test]
fn a_moved_image_is_seen_and_measured() {
    let scene = mirror_wall();
    let mut entry = scene.entry.clone();
    entry.camera.width *= 2;
    entry.camera.height *= 2;
    let fine = truth::image(&entry, 1e-4).total().0;
    let (w, h) = (scene.size().0 as usize, scene.size().1 as usize);
    // Half a pixel to the right; beyond the frame the nearest is repeated.
    let at = |x: i64, y: usize| fine[y * 2 * w + x.max(0) as usize];
    let moved: Vec<f64> = (0..w * h)
        .map(|i| {
            let (x, y) = (2 * (i % w) as i64 - 1, 2 * (i / w));
            0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1))
        })
        .collect();
    let files = scene.beauty("half", &moved, 16);
    let (code, answer) = json("mirror-wall", &files, &[]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (1, "different"),
        "{answer:#}"
    );
    let text = looks_like(&answer, "all");
    assert!(
        text.contains("moved by 0.5 pixels to the right and 0 down")
            && text.contains("--offset 0.5,0"),
        "{text}"
    );
    let (code, answer) = json("mirror-wall", &files, &["--offset", "0.5,0"]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (0, "equivalent"),
        "{answer:#}"
    );
}

#[test]
fn other_mistakes_are_told_apart() {
    let scene = mirror_wall();
    let (w, h) = (scene.size().0 as usize, scene.size().1 as usize);
    let all = scene.all();
    let flipped: Vec<f64> = (0..w * h)
        .map(|i| all[(h - 1 - i / w) * w + i % w])
        .collect();
    let mirrored: Vec<f64> = (0..w * h)
        .map(|i| all[(i / w) * w + w - 1 - i % w])
        .collect();
    let row: Vec<f64> = (0..w * h).map(|i| all[i.saturating_sub(w)]).collect();
    let srgb: Vec<f64> = all
        .iter()
        .map(|&v| {
            if v <= 0.0031308 {
                12.92 * v
            } else {
                1.055 * libm::pow(v, 1.0 / 2.4) - 0.055
            }
        })
        .collect();
    for (name, image, expected) in [
        ("flip", flipped, "upside down"),
        ("mirror", mirrored, "mirrored left and right"),
        ("row", row, "0 pixels to the right and 1 down"),
        ("srgb", srgb, "sRGB"),
    ] {
        let files = scene.beauty(name, &image, 8);
        let (code, answer) = json("mirror-wall", &files, &[]);
        assert_eq!(
            (code, state(&answer, "all").as_str()),
            (1, "different"),
            "{name}: {answer:#}"
        );
        assert!(
            looks_like(&answer, "all").contains(expected),
            "{name}: {answer:#}"
        );
    }
}

/// A caustic is brighter than 1 in places: the cup. Noise comes first, as in a renderer.
#[test]
fn clamped_values_are_told() {
    let scene = Scene::new("cup");
    let all = scene.all();
    let scale = 4.0 / all.iter().copied().fold(0.0, f64::max);
    assert!(scale < 4.0, "{scale}");
    let files = scene.beauty_with("clamped", &all, 8, |v| v.min(1.0));
    let (code, answer) = json("cup", &files, &[]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (1, "different"),
        "{answer:#}"
    );
    let text = looks_like(&answer, "all");
    assert!(text.contains("clamped at 1 "), "{text}");
}

#[test]
fn the_field_of_view_is_told() {
    let scene = mirror_wall();
    let mut entry = scene.entry.clone();
    entry.camera.field_of_view_degrees *= 0.5;
    let narrow = truth::image(&entry, 1e-3).total().0;
    let files = scene.beauty("narrow", &narrow, 8);
    let (code, answer) = json("mirror-wall", &files, &[]);
    assert_eq!(code, 1);
    let text = looks_like(&answer, "all");
    assert!(text.contains("field of view"), "{text}");
}

#[test]
fn one_image_is_compared_and_undecided() {
    let scene = mirror_wall();
    let files = scene.beauty("single", &scene.all(), 1);
    let (code, text, _) = gate("mirror-wall", &files, &[]);
    assert_eq!(code, 3, "{text}");
    assert!(
        text.contains("one image does not tell its own noise"),
        "{text}"
    );
    let double: Vec<f64> = scene.all().iter().map(|v| 2.0 * v).collect();
    let files = scene.beauty("single-double", &double, 1);
    let (code, answer) = json("mirror-wall", &files, &[]);
    assert_eq!(code, 1, "{answer:#}");
    let reason = verdict(&answer, "all")["reason"].as_str().unwrap();
    assert!(reason.contains("beyond any noise"), "{answer:#}");
    assert!(looks_like(&answer, "all").contains("= 2"), "{answer:#}");
}
