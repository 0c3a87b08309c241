//! The files of a directory: each is what its renderer reads, and every mesh that is named is there.

use std::collections::BTreeSet;

use nephroid::entry;
use nephroid::export::{Export, Format, export, number};
use quick_xml::Reader;
use quick_xml::events::Event;
use serde_json::Value;

use super::{exported, load, text};

/// The meshes that a text names.
fn named_meshes(text: &str) -> BTreeSet<String> {
    let parts = text.split('"').filter(|p| p.starts_with("meshes/"));
    parts.map(str::to_owned).collect()
}

fn present_meshes(export: &Export) -> BTreeSet<String> {
    let names = export.files.iter().map(|(name, _)| name.clone());
    names.filter(|n| n.starts_with("meshes/")).collect()
}

/// Reads all of an XML text; tags must match. Answers the types of its shapes.
fn shapes_of_xml(text: &str) -> Vec<String> {
    let mut reader = Reader::from_str(text);
    let mut shapes = vec![];
    loop {
        match reader.read_event().unwrap() {
            Event::Start(tag) if tag.name().as_ref() == b"shape" => {
                let kind = tag.try_get_attribute("type").unwrap().unwrap();
                shapes.push(String::from_utf8(kind.value.to_vec()).unwrap());
            }
            Event::Eof => return shapes,
            _ => {}
        }
    }
}

/// Reads properties: `key = value` lines without a key twice.
fn keys_of_properties(text: &str) -> BTreeSet<String> {
    let mut keys = BTreeSet::new();
    for line in text.lines().filter(|l| !l.starts_with('#')) {
        let (key, value) = line.split_once(" = ").unwrap_or_else(|| panic!("{line}"));
        assert!(!value.trim().is_empty(), "{line}");
        assert!(keys.insert(key.to_owned()), "{key} twice");
    }
    keys
}

/// Every parameter's list is closed, and every attribute block ends.
fn check_pbrt(text: &str) {
    let count = |what: &str| text.split_whitespace().filter(|w| *w == what).count();
    assert_eq!(count("["), count("]"));
    assert_eq!(count("AttributeBegin"), count("AttributeEnd"));
    assert_eq!(text.matches('"').count() % 2, 0);
    assert_eq!(count("WorldBegin"), 1);
}

#[test]
fn every_entry_exports_to_every_format_or_says_why_not() {
    let mut refused = vec![];
    for name in entry::names() {
        for format in Format::ALL {
            let export = match export(&load(name), format) {
                Ok(export) => export,
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.contains(format.name()), "{message}");
                    refused.push(format!("{name} {}", format.name()));
                    continue;
                }
            };
            let (scene, others) = match format {
                Format::Mitsuba => ("scene.xml", vec![]),
                Format::Pbrt => (
                    "scene.pbrt",
                    vec!["integrator-path.pbrt", "integrator-sppm.pbrt"],
                ),
                Format::Luxcore => ("scene.scn", vec!["render.cfg", "render.py"]),
            };
            let scene = text(&export, scene);
            for other in others {
                text(&export, other);
            }
            match format {
                Format::Mitsuba => assert!(!shapes_of_xml(&scene).is_empty()),
                Format::Pbrt => check_pbrt(&scene),
                Format::Luxcore => {
                    let keys = keys_of_properties(&scene);
                    assert!(keys.contains("scene.camera.type"), "{keys:?}");
                    keys_of_properties(&text(&export, "render.cfg"));
                }
            }
            assert_eq!(
                named_meshes(&scene),
                present_meshes(&export),
                "{name} {}",
                format.name()
            );
            // No number that a renderer could misread.
            for word in ["NaN", "inf ", "nan"] {
                assert!(!scene.contains(word), "{name}: {word}");
            }
            let json: Value = serde_json::from_str(&text(&export, "export.json")).unwrap();
            assert_eq!(json["schema"], "nephroid-export/1");
            assert_eq!(json["tessellation"]["pixel_error"], export.pixel_error());
            assert!(
                export.pixel_error() <= 0.05,
                "{name}: {}",
                export.pixel_error()
            );
            let classes: Vec<_> = ["comparable", "left_out"]
                .iter()
                .flat_map(|key| json[key].as_array().unwrap())
                .map(|c| c.as_str().unwrap().to_owned())
                .collect();
            let all: Vec<_> = load(name)
                .kind
                .classes()
                .iter()
                .map(ToString::to_string)
                .collect();
            assert_eq!(classes.len(), all.len());
            assert!(text(&export, "README.md").contains("can sample"));
        }
    }
    insta::assert_snapshot!("refused", refused.join("\n"));
}

#[test]
fn the_depth_is_the_closure_s_or_that_of_the_longest_class() {
    for (name, edges, left_out) in [
        ("floor", 2, 0),
        ("mirror-wall", 4, 0),
        ("pool", 4, 0),
        ("ball", 3, 0),
        // LTTDE has four edges, as LDRDE has.
        ("glass-ball", 3, 2),
        ("slab", 5, 3),
    ] {
        let json: Value =
            serde_json::from_str(&text(&exported(name, Format::Mitsuba), "export.json")).unwrap();
        assert_eq!(json["longest_path_edges"], edges, "{name}");
        assert_eq!(
            json["left_out"].as_array().unwrap().len(),
            left_out,
            "{name}"
        );
    }
    assert!(
        text(&exported("pool", Format::Mitsuba), "scene.xml")
            .contains(r#"name="max_depth" value="4""#)
    );
    // Interactions, not edges.
    assert!(
        text(&exported("pool", Format::Pbrt), "integrator-path.pbrt").contains("maxdepth\" [ 3 ]")
    );
}

#[test]
fn integrators_are_told_what_they_cannot_sample() {
    let cannot = |name: &str, format, integrator: &str| {
        let json: Value =
            serde_json::from_str(&text(&exported(name, format), "export.json")).unwrap();
        let all = json["integrators"].as_array().unwrap().clone();
        let found = all.iter().find(|i| i["name"] == integrator).unwrap();
        serde_json::to_string(&found["cannot"]).unwrap()
    };
    assert_eq!(
        cannot("cup", Format::Mitsuba, "path"),
        r#"["LSDE","LSDSE"]"#
    );
    assert_eq!(
        cannot("cup", Format::Mitsuba, "ptracer"),
        r#"["LDSE","LSDSE"]"#
    );
    assert_eq!(cannot("cup", Format::Luxcore, "BIDIRCPU"), r#"["LSDSE"]"#);
    assert_eq!(cannot("cup", Format::Luxcore, "BIDIRVMCPU"), "[]");
    assert_eq!(cannot("pool", Format::Pbrt, "bdpt"), r#"["LSDSE"]"#);
}

#[test]
fn the_bytes_are_always_the_same() {
    for (name, format) in [
        ("cup", Format::Mitsuba),
        ("lens", Format::Luxcore),
        ("cup", Format::Pbrt),
    ] {
        assert_eq!(exported(name, format).files, exported(name, format).files);
    }
}

#[test]
fn a_title_cannot_break_a_file() {
    let mut entry = load("floor");
    entry.title = "a -- b\n<scene> & \"c\"".to_owned();
    for format in Format::ALL {
        let export = export(&entry, format).unwrap();
        match format {
            Format::Mitsuba => {
                assert_eq!(shapes_of_xml(&text(&export, "scene.xml")), ["rectangle"])
            }
            Format::Pbrt => assert!(!text(&export, "scene.pbrt").contains("\n<scene>")),
            Format::Luxcore => drop(keys_of_properties(&text(&export, "scene.scn"))),
        }
    }
}

#[test]
fn numbers_are_written_in_full_and_without_exponents() {
    assert_eq!(number(0.1), "0.1");
    assert_eq!(number(-0.0), "0");
    assert_eq!(number(1e-7), "0.0000001");
    assert_eq!(number(1.0 / 3.0).parse::<f64>().unwrap(), 1.0 / 3.0);
}

#[test]
fn seeds_of_mitsuba_must_be_all_pixels_apart() {
    let export = exported("floor", Format::Mitsuba);
    let json: Value = serde_json::from_str(&text(&export, "export.json")).unwrap();
    assert_eq!(json["seed_spacing"], 128 * 128);
    assert!(text(&export, "README.md").contains("at least 16384 apart"));
}

#[test]
fn golden_files() {
    insta::assert_snapshot!(
        "mirror_wall_mitsuba",
        text(&exported("mirror-wall", Format::Mitsuba), "scene.xml")
    );
    insta::assert_snapshot!(
        "pool_luxcore",
        text(&exported("pool", Format::Luxcore), "scene.scn")
    );
    insta::assert_snapshot!(
        "cup_luxcore",
        text(&exported("cup", Format::Luxcore), "render.cfg")
    );
    insta::assert_snapshot!(
        "cup_pbrt",
        text(&exported("cup", Format::Pbrt), "scene.pbrt")
    );
    insta::assert_snapshot!(
        "glass_ball_readme",
        text(&exported("glass-ball", Format::Mitsuba), "README.md")
    );
}
