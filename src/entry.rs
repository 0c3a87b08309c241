//! Scene entries: the catalogue, and TOML files that users write.

use std::path::Path;

use nephroid_analytic::scene::{
    ArcWall, Camera, DirectionalLight, Entry, Floor, Kind, PointLight, RectangleMirror, Water,
};
use serde::Deserialize;

use crate::error::Error;

/// The built-in entries, in the order in which they are listed.
const CATALOGUE: [(&str, &str); 4] = [
    ("floor", include_str!("../scenes/floor.toml")),
    ("mirror-wall", include_str!("../scenes/mirror-wall.toml")),
    ("cup", include_str!("../scenes/cup.toml")),
    ("pool", include_str!("../scenes/pool.toml")),
];

/// Names of the built-in entries.
pub fn names() -> impl Iterator<Item = &'static str> {
    CATALOGUE.iter().map(|(name, _)| *name)
}

/// Finds an entry: a name in the catalogue, or the path of a TOML file.
///
/// # Errors
/// [`Error::UnknownScene`] if it is neither; what [`from_toml`] says about the file otherwise.
pub fn load(scene: &str) -> Result<Entry, Error> {
    if let Some((name, text)) = CATALOGUE.iter().find(|(name, _)| *name == scene) {
        return from_toml(&format!("{name}.toml"), text);
    }
    let path = Path::new(scene);
    if !scene.ends_with(".toml") && !path.exists() {
        return Err(Error::UnknownScene {
            name: scene.to_owned(),
            known: names().collect::<Vec<_>>().join(", "),
        });
    }
    let text = std::fs::read_to_string(path).map_err(|source| Error::read(scene, source))?;
    from_toml(scene, &text)
}

#[derive(Deserialize)]
struct KindOnly {
    kind: Option<toml::Value>,
}

macro_rules! entry_file {
    ($name:ident, $kind:ident { $($field:ident : $type:ty),* }) => {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct $name {
            name: String,
            title: String,
            #[serde(rename = "kind")]
            _kind: String,
            camera: Camera,
            $($field: $type),*
        }

        impl From<$name> for Entry {
            fn from(f: $name) -> Entry {
                Entry { name: f.name, title: f.title, camera: f.camera, kind: Kind::$kind { $($field: f.$field),* } }
            }
        }
    };
}

entry_file!(
    DiffuseFile,
    Diffuse {
        light: PointLight,
        floor: Floor
    }
);
entry_file!(
    PlanarMirrorFile,
    PlanarMirror {
        light: PointLight,
        floor: Floor,
        mirror: RectangleMirror
    }
);
entry_file!(
    CylinderCupFile,
    CylinderCup {
        light: DirectionalLight,
        floor: Floor,
        wall: ArcWall
    }
);
entry_file!(
    FlatInterfaceFile,
    FlatInterface {
        light: PointLight,
        floor: Floor,
        water: Water
    }
);

/// Reads and validates an entry.
///
/// # Errors
/// [`Error::Toml`] for a syntax error, an unknown or missing key or a value of the wrong type;
/// [`Error::Parameter`] for a value out of range or not finite. Both name the file, the key and what is allowed.
pub fn from_toml(file: &str, text: &str) -> Result<Entry, Error> {
    let syntax = |e: toml::de::Error| Error::toml(file, text, &e);
    let kind = toml::from_str::<KindOnly>(text).map_err(syntax)?.kind;
    let parameter = |key: &str, found: String, allowed: &str| Error::Parameter {
        file: file.to_owned(),
        key: key.to_owned(),
        found,
        allowed: allowed.to_owned(),
    };
    const KINDS: &str =
        "one of \"diffuse\", \"planar-mirror\", \"cylinder-cup\", \"flat-interface\"";
    let entry = match &kind {
        Some(toml::Value::String(kind)) => match kind.as_str() {
            "diffuse" => toml::from_str::<DiffuseFile>(text).map(Entry::from),
            "planar-mirror" => toml::from_str::<PlanarMirrorFile>(text).map(Entry::from),
            "cylinder-cup" => toml::from_str::<CylinderCupFile>(text).map(Entry::from),
            "flat-interface" => toml::from_str::<FlatInterfaceFile>(text).map(Entry::from),
            other => return Err(parameter("kind", format!("{other:?}"), KINDS)),
        }
        .map_err(syntax)?,
        Some(other) => return Err(parameter("kind", other.to_string(), KINDS)),
        None => return Err(parameter("kind", "missing".to_owned(), KINDS)),
    };
    entry
        .validate()
        .map_err(|e| parameter(&e.key, e.found, &e.allowed))?;
    Ok(entry)
}
