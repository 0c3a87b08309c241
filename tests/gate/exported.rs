//! What the meshes of an exported scene may change is no fault of the renderer.

use super::support::{file, gate, json, mirror_wall, nephroid, noisy, shown, state};

/// Writes a description with this error and the scene's name.
fn described(name: &str, scene: &str, error: &str) -> String {
    let directory = file(name);
    std::fs::create_dir_all(&directory).unwrap();
    let text = format!(
        r#"{{"schema": "nephroid-export/1", "scene": "{scene}", "tessellation": {{"pixel_error": {error}}}}}"#
    );
    std::fs::write(directory.join("export.json"), text).unwrap();
    shown(&directory)
}

/// 3 % too bright is different, and is not where meshes may change as much; then it is no proof of equivalence within 1 % either.
#[test]
fn a_mesh_is_allowed_its_error() {
    let scene = mirror_wall();
    let brighter: Vec<f64> = scene.all().iter().map(|v| 1.03 * v).collect();
    let files = scene.beauty("exported", &brighter, 8);
    let (code, answer) = json("mirror-wall", &files, &[]);
    assert_eq!((code, state(&answer, "all").as_str()), (1, "different"));
    let directory = described("exported-coarse", "mirror-wall", "0.04");
    let (code, answer) = json("mirror-wall", &files, &["--exported", &directory]);
    assert_eq!(
        (code, state(&answer, "all").as_str()),
        (3, "undecided"),
        "{answer:#}"
    );
    // What `nephroid export` itself writes: two triangles are exact.
    let own = shown(&file("exported-own"));
    let args = ["export", "mirror-wall", "--format", "mitsuba", "-o", &own].map(str::to_owned);
    let (code, _, err) = nephroid(&args);
    assert_eq!(code, 0, "{err}");
    let right = scene.beauty("exported-right", &scene.all(), 8);
    let (code, answer) = json("mirror-wall", &right, &["--exported", &own]);
    assert_eq!((code, state(&answer, "all").as_str()), (0, "equivalent"));
}

#[test]
fn descriptions_that_do_not_fit_are_refused() {
    let scene = mirror_wall();
    let files: Vec<String> = scene.beauty("exported-refused", &noisy(&scene.all(), 3), 1);
    for (name, of, error, part) in [
        ("exported-other", "cup", "0.0", "`scene`"),
        ("exported-large", "mirror-wall", "2.0", "pixel_error"),
        ("exported-text", "mirror-wall", "\"none\"", "pixel_error"),
        ("exported-broken", "mirror-wall", "", "no JSON"),
    ] {
        let directory = described(name, of, error);
        let (code, _, err) = gate("mirror-wall", &files, &["--exported", &directory]);
        assert!(code == 2 && err.contains(part), "{name}: {err}");
    }
    let (code, _, err) = gate("mirror-wall", &files, &["--exported", "nowhere"]);
    assert!(code == 2 && err.contains("nowhere"), "{err}");
}
