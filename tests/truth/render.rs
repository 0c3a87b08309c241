//! `nephroid render` from outside: what is in the file, that it repeats byte for byte, and what bad usage answers.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use exr::prelude::{AttributeValue, FlatSamples, Text, read_all_flat_layers_from_file};
use nephroid::{entry, truth};

fn directory(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn render(arguments: &[&str], threads: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nephroid"))
        .arg("render")
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .output()
        .unwrap()
}

#[test]
fn the_file_has_one_layer_per_class_a_bound_and_the_parameters() {
    let path = directory("render-layers").join("cup.exr");
    let shown = path.to_str().unwrap();
    let output = render(&["cup", "-o", shown, "--size", "31x17", "--png"], "2");
    assert!(output.status.success(), "{output:?}");

    let file = read_all_flat_layers_from_file(&path).unwrap();
    let layer = &file.layer_data[0];
    assert_eq!((layer.size.width(), layer.size.height()), (31, 17));
    let mut scene = entry::load("cup").unwrap();
    (scene.camera.width, scene.camera.height) = (31, 17);
    let expected = truth::image(&scene, truth::DEFAULT_TOLERANCE);
    let channel = |name: &str| -> Vec<f64> {
        let found = layer
            .channel_data
            .list
            .iter()
            .find(|c| c.name.to_string() == name);
        match &found
            .unwrap_or_else(|| panic!("no channel {name}"))
            .sample_data
        {
            FlatSamples::F32(values) => values.iter().map(|&v| f64::from(v)).collect(),
            other => panic!("{other:?}"),
        }
    };
    assert_eq!(layer.channel_data.list.len(), 5);
    let error = channel("error.Y");
    let mut stored_off = vec![0.0; error.len()];
    for (class, values) in expected.classes.iter().zip(&expected.layers) {
        for (k, (stored, value)) in channel(&format!("{class}.Y"))
            .iter()
            .zip(values)
            .enumerate()
        {
            stored_off[k] += (stored - value).abs();
        }
    }
    // The bound includes what f32 took away from each layer.
    assert!(
        stored_off
            .iter()
            .zip(&error)
            .all(|(off, bound)| off <= bound)
    );
    assert!(stored_off.iter().any(|&off| off > 0.0));

    let text = |key: &str| match layer.attributes.other.get(&Text::from(key)) {
        Some(AttributeValue::Text(text)) => text.to_string(),
        other => panic!("{key}: {other:?}"),
    };
    assert_eq!(text("nephroid:version"), env!("CARGO_PKG_VERSION"));
    assert_eq!(text("nephroid:scene"), "cup");
    let parameters: nephroid_analytic::scene::Entry =
        serde_json::from_str(&text("nephroid:parameters")).unwrap();
    assert_eq!(parameters, scene);

    let png = image::open(path.with_extension("png")).unwrap();
    assert_eq!((png.width(), png.height()), (31, 17));
}

#[test]
fn the_bytes_repeat_from_run_to_run_and_for_any_number_of_threads() {
    let directory = directory("render-repeats");
    let mut files = Vec::new();
    for (k, threads) in ["1", "2", "7", "2"].iter().enumerate() {
        let path = directory.join(format!("{k}.exr"));
        let shown = path.to_str().unwrap();
        let output = render(&["pool", "-o", shown, "--size", "19x23", "--png"], threads);
        assert!(output.status.success(), "{output:?}");
        let png = std::fs::read(path.with_extension("png")).unwrap();
        files.push((std::fs::read(&path).unwrap(), png));
    }
    assert!(files.iter().all(|f| *f == files[0]));
}

#[test]
fn bad_usage_says_what_is_allowed_and_exits_with_2() {
    let path = directory("render-usage").join("none.exr");
    let shown = path.to_str().unwrap();
    for (arguments, allowed) in [
        (vec!["cup", "-o", shown, "--size", "0x10"], "1 to 8192"),
        (vec!["cup", "-o", shown, "--size", "10"], "WxH"),
        (vec!["cup", "-o", shown, "--size", "9000x9000"], "1 to 8192"),
        (
            vec!["cup", "-o", shown, "--tolerance", "nan"],
            "1e-12 to 0.1",
        ),
        (
            vec!["cup", "-o", shown, "--tolerance", "-1"],
            "1e-12 to 0.1",
        ),
        (vec!["teapot", "-o", shown], "catalogue"),
        (
            vec!["cup", "-o", "no/such/directory/x.exr"],
            "no/such/directory",
        ),
        (vec!["cup"], "--output"),
    ] {
        let output = render(&arguments, "1");
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?} {text}");
        assert!(text.contains(allowed), "{arguments:?} {text}");
        assert!(!path.exists(), "{arguments:?}");
    }
}
