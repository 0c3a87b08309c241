//! Scene entries as users write them: what is wrong is named with file, key and allowed range, and nothing panics.

use nephroid::{entry, error::Error};
use nephroid_analytic::scene::{Kind, PlanarMirrorScene};
use proptest::prelude::*;

const CUP: &str = include_str!("../scenes/cup.toml");
const MIRROR_WALL: &str = include_str!("../scenes/mirror-wall.toml");
const POOL: &str = include_str!("../scenes/pool.toml");

/// The error's message and help together, as a person sees them.
fn complaint(text: &str) -> String {
    let error = entry::from_toml("mine.toml", text).expect_err("the entry must be refused");
    let help = miette::Diagnostic::help(&error)
        .map(|h| h.to_string())
        .unwrap_or_default();
    format!("{error} | {help}")
}

fn assert_complains(text: &str, parts: &[&str]) {
    let complaint = complaint(text);
    for part in ["mine.toml"].iter().chain(parts) {
        assert!(
            complaint.contains(part),
            "`{part}` is missing in: {complaint}"
        );
    }
}

#[test]
fn every_catalogue_entry_loads_under_its_own_name() {
    for name in entry::names() {
        let e = entry::load(name).unwrap();
        assert_eq!(e.name, name);
        assert!(!e.kind.classes().is_empty());
    }
}

/// The numbers that published measurements on this scene depend on.
#[test]
fn mirror_wall_is_the_published_scene() {
    let e = entry::load("mirror-wall").unwrap();
    let Kind::PlanarMirror(PlanarMirrorScene {
        light,
        floor,
        mirror,
    }) = &e.kind
    else {
        panic!("wrong kind")
    };
    assert_eq!((light.position, light.intensity), ([0.25, 0.0, 2.0], 1.0));
    assert_eq!(
        (floor.center, floor.half_width, floor.albedo),
        ([0.0, 0.0], [3.0, 3.0], 0.5)
    );
    assert_eq!(
        (mirror.center, mirror.normal, mirror.edge),
        ([0.0, 1.0, 0.625], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0])
    );
    assert_eq!(
        (mirror.half_width, mirror.half_height, mirror.reflectance),
        (0.75, 0.5, 1.0)
    );
    let c = &e.camera;
    assert_eq!(
        (c.position, c.look_at, c.up),
        ([0.0, -3.0, 2.0], [0.0, 0.6, 0.3], [0.0, 0.0, 1.0])
    );
    assert_eq!(
        (c.field_of_view_degrees, c.width, c.height),
        (45.0, 128, 128)
    );
}

/// A forgotten factor must show: no intensity, reflectance or albedo of 1 (or 1/2), no distance of 1.
#[test]
fn other_entries_use_generic_constants() {
    for name in entry::names().filter(|&n| n != "mirror-wall") {
        let value = toml::from_str::<toml::Table>(
            &std::fs::read_to_string(format!("scenes/{name}.toml")).unwrap(),
        );
        for (_, table) in value
            .as_ref()
            .unwrap()
            .iter()
            .filter(|(k, _)| *k != "camera")
        {
            let toml::Value::Table(table) = table else {
                continue;
            };
            for (key, v) in table {
                let numbers: Vec<f64> = match v {
                    toml::Value::Array(a) => a.iter().filter_map(toml::Value::as_float).collect(),
                    v => v.as_float().into_iter().collect(),
                };
                assert!(
                    numbers.iter().all(|n| n.abs() != 1.0 && *n != 0.5),
                    "{name}: {key} = {numbers:?}"
                );
            }
        }
    }
}

#[test]
fn unknown_and_missing_keys_are_named() {
    assert_complains(
        &CUP.replace("reflectance =", "reflectence ="),
        &["reflectence", "`reflectance`", "line 18"],
    );
    assert_complains(
        &CUP.replace("reflectance = 0.9", ""),
        &["missing field `reflectance`"],
    );
    assert_complains(
        &format!("{CUP}\n[mirror]\n"),
        &["unknown field `mirror`", "`wall`"],
    );
    assert_complains(
        &CUP.replace("kind =", "knd ="),
        &["`kind` is missing", "cylinder-cup"],
    );
    assert_complains(
        &CUP.replace("cylinder-cup", "teapot"),
        &["teapot", "flat-interface"],
    );
    assert_complains("kind = 3", &["`kind` is 3"]);
    assert_complains("kind = \"diffuse\"\nname = [", &["line 2"]);
    assert_complains("", &["`kind` is missing"]);
}

#[test]
fn values_out_of_range_are_named_with_the_range() {
    for (from, to, parts) in [
        (
            "reflectance = 0.9",
            "reflectance = 1.5",
            ["wall.reflectance", "1.5", "at most 1"],
        ),
        (
            "reflectance = 0.9",
            "reflectance = nan",
            ["wall.reflectance", "NaN", "finite"],
        ),
        (
            "reflectance = 0.9",
            "reflectance = -0.1",
            ["wall.reflectance", "-0.1", "greater than 0"],
        ),
        (
            "radius = 1.2",
            "radius = inf",
            ["wall.radius", "inf", "finite"],
        ),
        (
            "radius = 1.2",
            "radius = 0",
            ["wall.radius", "0", "from 0.000000001"],
        ),
        (
            "height = 0.69",
            "height = 0.8",
            ["wall.height", "0.8", "meets the wall once"],
        ),
        (
            "half_arc_degrees = 60.0",
            "half_arc_degrees = 61.0",
            ["wall.half_arc_degrees", "61", "60"],
        ),
        (
            "elevation_degrees = 30.0",
            "elevation_degrees = 0.0",
            ["light.elevation_degrees", "0", "from 1 to 85"],
        ),
        (
            "irradiance = 3.4",
            "irradiance = 1e300",
            ["light.irradiance", "1000", "finite"],
        ),
        (
            "albedo = 0.7",
            "albedo = 0.0",
            ["floor.albedo", "0", "greater than 0"],
        ),
        (
            "field_of_view_degrees = 45.0",
            "field_of_view_degrees = 180.0",
            ["camera.field_of_view_degrees", "180", "150"],
        ),
        (
            "width = 128",
            "width = 0",
            ["camera.width", "0", "from 1 to 8192"],
        ),
        (
            "name = \"cup\"",
            "name = \"My Cup\"",
            ["name", "My Cup", "lower-case"],
        ),
        // A low camera on the open side sees the wall in the wall: LDSSE would belong to the closure.
        (
            "position = [-1.8, -0.72, 2.16]",
            "position = [-1.8, -0.72, 0.75]",
            ["camera.position", "0.75", "twice"],
        ),
        (
            "position = [-1.8, -0.72, 2.16]",
            "position = [1.8, -0.72, 2.16]",
            ["camera.position", "1.8", "x less than"],
        ),
    ] {
        let text = CUP.replacen(from, to, 1);
        assert_ne!(text, CUP, "{from} must occur");
        assert_complains(&text, &parts);
    }
    assert_complains(
        &MIRROR_WALL.replace("edge = [1.0, 0.0, 0.0]", "edge = [1.0, 0.2, 0.0]"),
        &["mirror.edge", "perpendicular"],
    );
    assert_complains(
        &MIRROR_WALL.replace("position = [0.25, 0.0, 2.0]", "position = [0.25, 1.5, 2.0]"),
        &["light.position", "in front of the mirror"],
    );
    assert_complains(
        &POOL.replace("index = 1.333", "index = 1.0"),
        &["water.index", "greater than 1"],
    );
    assert_complains(
        &POOL.replace("position = [0.45, 0.3, 1.9]", "position = [0.45, 0.3, 0.9]"),
        &["light.position", "greater than 1.1"],
    );
}

#[test]
fn a_scene_that_is_neither_a_name_nor_a_file_is_refused_with_the_list() {
    let error = entry::load("cupp").unwrap_err();
    assert!(matches!(&error, Error::UnknownScene { known, .. } if known.contains("mirror-wall")));
    assert!(
        matches!(entry::load("no-such-file.toml").unwrap_err(), Error::Io { file, .. } if file == "no-such-file.toml")
    );
    assert!(matches!(entry::load("src").unwrap_err(), Error::Io { .. }));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, rng_seed: proptest::test_runner::RngSeed::Fixed(7), ..Default::default() })]

    /// Whatever a user's editor does to a file, the answer is an entry or an error, never a panic.
    #[test]
    fn damaged_files_never_panic(start in 0usize..400, length in 0usize..40, insert in "[ -~\n]{0,12}", which in 0usize..3) {
        let text = [CUP, MIRROR_WALL, POOL][which];
        let start = start.min(text.len());
        let end = (start + length).min(text.len());
        let damaged = format!("{}{insert}{}", &text[..start], &text[end..]);
        let _ = entry::from_toml("damaged.toml", &damaged);
    }
}
