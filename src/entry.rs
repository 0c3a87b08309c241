//! Scene entries: the catalogue, and TOML files that users write.

use std::path::Path;

use nephroid_analytic::scene::{
    self, ArcWall, Ball, Camera, CircleLight, ClosedWall, Conic, ConicArc, DirectionalLight, Dish,
    Entry, Floor, FocalLight, GlassBall, GlassCylinder, Kind, LensFront, MirrorPillar, MirrorWedge,
    PointLight, RectangleMirror, Ripple, Slab, SphereCap, SphereWall, VerticalLight, Water,
};
use serde::Deserialize;

use crate::error::Error;

/// The built-in entries, in the order in which they are listed.
const CATALOGUE: &[(&str, &str)] = &[
    ("floor", include_str!("../scenes/floor.toml")),
    ("mirror-wall", include_str!("../scenes/mirror-wall.toml")),
    ("cup", include_str!("../scenes/cup.toml")),
    ("pool", include_str!("../scenes/pool.toml")),
    ("slab", include_str!("../scenes/slab.toml")),
    ("pillar", include_str!("../scenes/pillar.toml")),
    ("conic-wall", include_str!("../scenes/conic-wall.toml")),
    ("glass-pillar", include_str!("../scenes/glass-pillar.toml")),
    ("glass-column", include_str!("../scenes/glass-column.toml")),
    ("corner", include_str!("../scenes/corner.toml")),
    ("dome", include_str!("../scenes/dome.toml")),
    ("ball", include_str!("../scenes/ball.toml")),
    ("dish", include_str!("../scenes/dish.toml")),
    ("ellipsoid", include_str!("../scenes/ellipsoid.toml")),
    ("hyperboloid", include_str!("../scenes/hyperboloid.toml")),
    ("furnace", include_str!("../scenes/furnace.toml")),
    ("underwater", include_str!("../scenes/underwater.toml")),
    ("glass-ball", include_str!("../scenes/glass-ball.toml")),
    ("ripple-pool", include_str!("../scenes/ripple-pool.toml")),
    ("lens", include_str!("../scenes/lens.toml")),
    ("cup-rim", include_str!("../scenes/cup-rim.toml")),
    ("deep-cup", include_str!("../scenes/deep-cup.toml")),
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
    let (file, text) = text(scene)?;
    from_toml(&file, &text)
}

/// The file name and the TOML text of an entry.
///
/// # Errors
/// [`Error::UnknownScene`] if it is neither in the catalogue nor a file; a file that cannot be read.
pub fn text(scene: &str) -> Result<(String, String), Error> {
    if let Some((name, text)) = CATALOGUE.iter().find(|(name, _)| *name == scene) {
        return Ok((format!("{name}.toml"), (*text).to_owned()));
    }
    let path = Path::new(scene);
    if !scene.ends_with(".toml") && !path.exists() {
        return Err(Error::UnknownScene {
            name: scene.to_owned(),
            known: names().collect::<Vec<_>>().join(", "),
        });
    }
    let text = std::fs::read_to_string(path).map_err(|source| Error::read(scene, source))?;
    Ok((scene.to_owned(), text))
}

#[derive(Deserialize)]
struct KindOnly {
    kind: Option<toml::Value>,
}

/// A kind: the file that its entries are written in, and how it is read.
macro_rules! kinds {
    ($($name:literal => $kind:ident($data:ident { $($field:ident : $type:ty),* $(,)? })),* $(,)?) => {
        /// What reads the entries of a kind.
        type Reader = fn(&str) -> Result<Entry, toml::de::Error>;

        /// Every kind by the name that TOML files use.
        const KINDS: &[(&str, Reader)] = &[
            $(($name, |text| {
                #[derive(Deserialize)]
                #[serde(deny_unknown_fields)]
                struct File {
                    name: String,
                    title: String,
                    #[serde(rename = "kind")]
                    _kind: String,
                    camera: Camera,
                    $($field: $type),*
                }
                let f: File = toml::from_str(text)?;
                let kind = Kind::$kind(scene::$data { $($field: f.$field),* });
                Ok(Entry { name: f.name, title: f.title, camera: f.camera, kind })
            })),*
        ];
    };
}

kinds! {
    "diffuse" => Diffuse(DiffuseScene { light: PointLight, floor: Floor }),
    "planar-mirror" => PlanarMirror(PlanarMirrorScene {
        light: PointLight, floor: Floor, mirror: RectangleMirror,
    }),
    "cylinder-cup" => CylinderCup(CylinderCupScene {
        light: DirectionalLight, floor: Floor, wall: ArcWall,
    }),
    "flat-interface" => FlatInterface(FlatInterfaceScene { light: PointLight, floor: Floor, water: Water }),
    "concave-sphere" => ConcaveSphere(ConcaveSphereScene { light: PointLight, floor: Floor, cap: SphereCap }),
    "convex-sphere" => ConvexSphere(ConvexSphereScene { light: PointLight, floor: Floor, ball: Ball }),
    "paraboloid" => Paraboloid(ParaboloidScene { light: FocalLight, floor: Floor, dish: Dish }),
    "conic-mirrors" => ConicMirrors(ConicMirrorsScene { light: FocalLight, floor: Floor, conic: Conic }),
    "furnace" => Furnace(FurnaceScene { light: PointLight, wall: SphereWall }),
    "glass-slab" => GlassSlab(GlassSlabScene { light: PointLight, floor: Floor, slab: Slab }),
    "glass-sphere" => GlassSphere(GlassSphereScene { light: VerticalLight, floor: Floor, glass: GlassBall }),
    "underwater" => Underwater(UnderwaterScene { light: PointLight, floor: Floor, water: Water }),
    "pillar" => Pillar(PillarScene { light: PointLight, floor: Floor, pillar: MirrorPillar }),
    "glass-pillar" => GlassPillar(GlassPillarScene { light: DirectionalLight, floor: Floor, pillar: GlassCylinder }),
    "planar-chains" => PlanarChains(PlanarChainsScene { light: PointLight, floor: Floor, wedge: MirrorWedge }),
    "conic-wall" => ConicWall(ConicWallScene { light: PointLight, floor: Floor, wall: ConicArc }),
    "water-waves" => WaterWaves(WaterWavesScene {
        light: VerticalLight, floor: Floor, water: Water, waves: Vec<Ripple>,
    }),
    "stigmatic-refractors" => StigmaticRefractors(StigmaticRefractorsScene {
        light: VerticalLight, floor: Floor, lens: LensFront,
    }),
    "closed-cup" => ClosedCup(ClosedCupScene { light: DirectionalLight, floor: Floor, wall: ClosedWall }),
    "cylinder-lamp" => CylinderLamp(CylinderLampScene { light: CircleLight, floor: Floor, wall: ArcWall }),
}

/// The kinds, as an error message lists them.
fn kinds() -> String {
    let names: Vec<_> = KINDS.iter().map(|(name, _)| format!("{name:?}")).collect();
    format!("one of {}", names.join(", "))
}

/// What each key of an entry may be: the help beside a missing key or a value of the wrong type. The exact bounds that
/// depend on other keys come from [`Entry::validate`].
const ALLOWED: &[(&str, &str)] = &[
    (
        "name",
        "a string of 1 to 64 lower-case letters, digits and hyphens",
    ),
    ("title", "a string"),
    (
        "camera",
        "a table with position, look_at, field_of_view_degrees, width and height",
    ),
    (
        "light",
        "a table: position and intensity (point), elevation_degrees and irradiance (directional), or azimuth_degrees, height, intensity, and inset if it is not 0 (beside a circular wall)",
    ),
    (
        "floor",
        "a table with half_width and albedo, and center if it is not [0, 0]",
    ),
    (
        "mirror",
        "a table with center, normal, edge, half_width, half_height and reflectance",
    ),
    (
        "wall",
        "a table: height, half_arc_degrees, reflectance and radius (arc) or direction, parameter, eccentricity and focus (conic), or center, radius and albedo (closed sphere)",
    ),
    (
        "pillar",
        "a table with radius and height, reflectance (mirror) or index (glass), and center if it is not [0, 0]",
    ),
    ("water", "a table with surface_z and index"),
    ("slab", "a table with bottom, top and index"),
    ("ball", "a table with center, radius and reflectance"),
    (
        "dish",
        "a table with vertex_z, focal_length, inner_radius, outer_radius and reflectance, and center if it is not [0, 0]",
    ),
    (
        "conic",
        "a table with semi_axis, eccentricity, image_z, rim_z and reflectance, and center if it is not [0, 0]",
    ),
    ("vertex_z", "a finite number from 1e-9 to 1e9 (metres)"),
    (
        "focal_length",
        "a finite number from 1e-9 to 1e9, less than vertex_z (metres)",
    ),
    (
        "inner_radius",
        "a finite number from 0, less than outer_radius (metres)",
    ),
    (
        "outer_radius",
        "a finite number greater than inner_radius (metres)",
    ),
    ("semi_axis", "a finite number from 1e-9 to 1e9 (metres)"),
    ("image_z", "a finite number from -1e9 to 1e9 (metres)"),
    ("rim_z", "a finite number greater than 0 (metres)"),
    (
        "cap",
        "a table with center, radius, half_angle_degrees and reflectance",
    ),
    (
        "half_angle_degrees",
        "a finite number greater than 0, at most 90",
    ),
    (
        "pillar",
        "a table with radius and height, reflectance (mirror) or index (glass), and center if it is not [0, 0]",
    ),
    (
        "waves",
        "a list of tables with amplitude, wave_vector and phase",
    ),
    ("amplitude", "a finite number (metres)"),
    ("wave_vector", "two finite numbers (radians per metre)"),
    ("phase", "a finite number from -1000 to 1000 (radians)"),
    (
        "lens",
        "a table with defocus, semi_axis, index and half_angle_degrees, and axis if it is not [0, 0]",
    ),
    ("defocus", "a finite number from -1e9 to 1e9 (metres)"),
    ("glass", "a table with center, radius and index"),
    ("bottom", "a finite number from 1e-9 to 1e9 (metres)"),
    ("top", "a finite number greater than bottom (metres)"),
    ("position", "three finite numbers from -1e9 to 1e9 (metres)"),
    ("look_at", "three finite numbers from -1e9 to 1e9 (metres)"),
    (
        "center",
        "finite numbers from -1e9 to 1e9 (metres): two for a floor, a pillar, or the axis of a dish or conic, three otherwise",
    ),
    ("normal", "three finite numbers: a direction of any length"),
    (
        "edge",
        "three finite numbers: a direction perpendicular to normal",
    ),
    (
        "half_width",
        "finite numbers from 1e-9 to 1e9 (metres): one for a mirror, two for a floor",
    ),
    ("half_height", "a finite number from 1e-9 to 1e9 (metres)"),
    ("radius", "a finite number from 1e-9 to 1e9 (metres)"),
    ("intensity", "a finite number from 1e-9 to 1e9 (W/sr)"),
    ("irradiance", "a finite number from 1e-9 to 1e9 (W/m²)"),
    ("elevation_degrees", "a finite number from 1 to 85"),
    (
        "half_arc_degrees",
        "a finite number greater than 0, at most 60 (a circle in the sun) or 180 (a conic, or a circle with a lamp)",
    ),
    ("azimuth_degrees", "a finite number from -360 to 360"),
    (
        "inset",
        "0 (on the circle), or a finite number from a hundredth of the wall's radius to all of it (metres)",
    ),
    ("wedge", "a table with divisor and reflectance"),
    (
        "divisor",
        "a whole number from 1 to 8: the wedge has the angle π/divisor",
    ),
    ("focus", "two finite numbers from -1e9 to 1e9 (metres)"),
    ("direction", "two finite numbers: a direction of any length"),
    ("parameter", "a finite number from 1e-9 to 1e9 (metres)"),
    (
        "eccentricity",
        "a finite number from 0 to 10 (conic wall), or to 1000 and not within 0.001 of 1 (conic of revolution)",
    ),
    ("field_of_view_degrees", "a finite number from 0.1 to 150"),
    ("surface_z", "a finite number from 1e-9 to 1e9 (metres)"),
    ("index", "a finite number greater than 1, at most 10"),
];

/// Allowed values of a key that a TOML error is about, or nothing if the error is about something else.
fn allowed(error: &toml::de::Error, line: &str) -> Option<&'static str> {
    let missing = error
        .message()
        .strip_prefix("missing field `")
        .and_then(|m| m.split('`').next());
    let key = missing.unwrap_or_else(|| line.split('=').next().unwrap_or_default().trim());
    match key {
        "albedo" | "reflectance" => Some("a finite number greater than 0, at most 1"),
        "width" | "height" if missing.is_none() => {
            Some("a whole number from 1 to 8192 (pixels), or metres for a wall")
        }
        "width" => Some("a whole number from 1 to 8192"),
        "height" => {
            Some("a whole number from 1 to 8192 (camera), or a finite number of metres (wall)")
        }
        key => ALLOWED
            .iter()
            .find(|(k, _)| *k == key)
            .map(|(_, allowed)| *allowed),
    }
}

/// Reads and validates an entry.
///
/// # Errors
/// [`Error::Toml`] for a syntax error, an unknown or missing key or a value of the wrong type;
/// [`Error::Parameter`] for a value out of range or not finite. Both name the file, the key and what is allowed.
pub fn from_toml(file: &str, text: &str) -> Result<Entry, Error> {
    let syntax = |e: toml::de::Error| Error::toml(file, text, &e, |line| allowed(&e, line));
    let kind = toml::from_str::<KindOnly>(text).map_err(syntax)?.kind;
    let parameter = |key: &str, found: String, allowed: &str| Error::Parameter {
        file: file.to_owned(),
        key: key.to_owned(),
        found,
        allowed: allowed.to_owned(),
    };
    let entry = match &kind {
        Some(toml::Value::String(kind)) => {
            let reader = KINDS.iter().find(|(name, _)| name == kind);
            let (_, read) =
                reader.ok_or_else(|| parameter("kind", format!("{kind:?}"), &kinds()))?;
            read(text).map_err(syntax)?
        }
        Some(other) => return Err(parameter("kind", other.to_string(), &kinds())),
        None => return Err(parameter("kind", "missing".to_owned(), &kinds())),
    };
    entry
        .validate()
        .map_err(|e| parameter(&e.key, e.found, &e.allowed))?;
    Ok(entry)
}
