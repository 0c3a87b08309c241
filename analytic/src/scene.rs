//! What a scene is: plain data, no formulas.
//!
//! A *kind* is a parametrised family with a closed form; an *entry* is a kind with parameters and a camera. Metres,
//! watts, z up, right-handed, monochrome. The floor is the plane z = 0 with its normal up, clipped to a rectangle.
//! Everything here can be read from TOML (by the root crate) and says in [`Entry::validate`] what it cannot accept.

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::class::PathClass;

/// An isotropic point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointLight {
    /// Position [m].
    pub position: [f64; 3],
    /// Radiant intensity [W/sr], the same in every direction.
    pub intensity: f64,
}

/// A directional light that travels along +x and downwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectionalLight {
    /// Elevation of the light above the horizon [degrees].
    pub elevation_degrees: f64,
    /// Irradiance on a plane perpendicular to the beam [W/m²].
    pub irradiance: f64,
}

/// The Lambertian floor z = 0, clipped to |x - cx| ≤ wx, |y - cy| ≤ wy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floor {
    /// Centre (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Half widths along x and y [m].
    pub half_width: [f64; 2],
    /// Albedo ρ.
    pub albedo: f64,
}

/// A flat rectangular mirror: reflects on its front, absorbs on its back, occludes from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RectangleMirror {
    /// Centre [m].
    pub center: [f64; 3],
    /// Direction of the front, of any length.
    pub normal: [f64; 3],
    /// Direction of one edge, perpendicular to `normal`, of any length.
    pub edge: [f64; 3],
    /// Half of the extent along `edge` [m].
    pub half_width: f64,
    /// Half of the extent along `normal` × `edge` [m].
    pub half_height: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// A vertical arc of a circular cylinder about the z axis, standing on the floor: the points (a cos φ, a sin φ, z) with
/// |φ| ≤ half arc, 0 ≤ z ≤ height. It reflects on its inner side, absorbs on its outer side and occludes from both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArcWall {
    /// Radius a [m].
    pub radius: f64,
    /// Height [m].
    pub height: f64,
    /// Half of the arc [degrees]: the wall covers |φ| ≤ this.
    pub half_arc_degrees: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

/// An unbounded flat water surface, air above and water below; smooth dielectric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height of the surface above the floor [m].
    pub surface_z: f64,
    /// Refractive index n of the water relative to air.
    pub index: f64,
}

/// A pinhole camera with a box pixel filter. Row 0 is the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Position of the pinhole [m].
    pub position: [f64; 3],
    /// A point in the middle of the image [m].
    pub look_at: [f64; 3],
    /// Up direction, of any length.
    #[serde(default = "up")]
    pub up: [f64; 3],
    /// Full vertical field of view [degrees].
    pub field_of_view_degrees: f64,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

fn up() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

/// A parametrised family of scenes with a closed form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Kind {
    /// A floor under a point light; no specular surface.
    Diffuse {
        /// The light.
        light: PointLight,
        /// The receiver.
        floor: Floor,
    },
    /// A flat mirror over the floor, under a point light.
    PlanarMirror {
        /// The light.
        light: PointLight,
        /// The receiver.
        floor: Floor,
        /// The mirror.
        mirror: RectangleMirror,
    },
    /// A vertical circular wall on the floor, under a directional light.
    CylinderCup {
        /// The light.
        light: DirectionalLight,
        /// The receiver.
        floor: Floor,
        /// The mirror.
        wall: ArcWall,
    },
    /// A flat water surface over the floor, light and camera above it.
    FlatInterface {
        /// The light.
        light: PointLight,
        /// The receiver.
        floor: Floor,
        /// The interface.
        water: Water,
    },
}

impl Kind {
    /// The name of the kind, as written in TOML.
    pub const fn name(&self) -> &'static str {
        match self {
            Kind::Diffuse { .. } => "diffuse",
            Kind::PlanarMirror { .. } => "planar-mirror",
            Kind::CylinderCup { .. } => "cylinder-cup",
            Kind::FlatInterface { .. } => "flat-interface",
        }
    }

    /// The receiver.
    pub const fn floor(&self) -> &Floor {
        match self {
            Kind::Diffuse { floor, .. }
            | Kind::PlanarMirror { floor, .. }
            | Kind::CylinderCup { floor, .. }
            | Kind::FlatInterface { floor, .. } => floor,
        }
    }

    /// The path classes that the scene carries, in a fixed order: the layers of an image.
    pub const fn classes(&self) -> &'static [PathClass] {
        const LDE: PathClass = PathClass::LDE;
        const LSDE: PathClass = PathClass::LSDE;
        const LDSE: PathClass = PathClass::LDSE;
        const LSDSE: PathClass = PathClass::LSDSE;
        match self {
            Kind::Diffuse { .. } => &[LDE],
            Kind::PlanarMirror { .. } | Kind::CylinderCup { .. } => &[LDE, LSDE, LDSE, LSDSE],
            Kind::FlatInterface { .. } => &[LSDSE],
        }
    }
}

/// A scene with its camera: what a name in the catalogue, or a TOML file, stands for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Name: lower-case letters, digits and hyphens.
    pub name: String,
    /// One line that says what the scene is for.
    pub title: String,
    /// Family and parameters.
    #[serde(flatten)]
    pub kind: Kind,
    /// The camera.
    pub camera: Camera,
}

/// A parameter that is outside what the closed forms hold for.
#[derive(Clone, Debug, PartialEq)]
pub struct InvalidParameter {
    /// The key, as written in TOML: `mirror.reflectance`.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is allowed, and why where it is not obvious.
    pub allowed: String,
}

impl fmt::Display for InvalidParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` is {}, allowed: {}",
            self.key, self.found, self.allowed
        )
    }
}

impl core::error::Error for InvalidParameter {}
