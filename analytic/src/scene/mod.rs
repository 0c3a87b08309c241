//! What a scene is: plain data, no formulas.
//!
//! A *kind* is a parametrised family with a closed form; an *entry* is a kind with parameters and a camera. Metres,
//! watts, z up, right-handed, monochrome. The floor is the plane z = 0 with its normal up, clipped to a rectangle.
//! Everything here can be read from TOML (by the root crate) and says in [`Entry::validate`] what it cannot accept.
//!
//! Each kind has a file in [`families`]: its data, its path classes, its closure and its ranges.

mod camera;
pub mod families;
mod frame;
mod light;
mod ranges;
mod surface;

use core::fmt;

use serde::{Deserialize, Serialize};

use crate::class::PathClass;

pub use camera::Camera;
pub use families::*;
pub use light::{DirectionalLight, FocalLight, PointLight, VerticalLight};
pub use surface::{ArcWall, Floor, RectangleMirror, Water};

/// Up to which path length an unrestricted renderer sees nothing but the listed classes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Closure {
    /// The longest path, in edges from the light to the eye; `None`: paths of any length.
    pub longest: Option<usize>,
    /// Why, in one sentence for a person.
    pub reason: &'static str,
}

/// What every kind says of its scenes.
pub trait Family {
    /// The name of the kind, as written in TOML.
    fn name(&self) -> &'static str;

    /// The receiver; `None` where it is no floor.
    fn floor(&self) -> Option<&Floor>;

    /// The path classes that the scene carries, in a fixed order: the layers of an image.
    fn classes(&self) -> &'static [PathClass];

    /// Up to which path length these are all there is.
    fn closure(&self) -> Closure;

    /// Checks what [`Entry::validate`] does not check for every kind: the ranges in which closed forms and closure hold.
    ///
    /// # Errors
    /// The first parameter that is out of range.
    fn validate(&self, camera: &Camera) -> Result<(), InvalidParameter>;
}

/// A parametrised family of scenes with a closed form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Kind {
    /// A floor under a point light; no specular surface.
    Diffuse(DiffuseScene),
    /// A flat mirror over the floor, under a point light.
    PlanarMirror(PlanarMirrorScene),
    /// A vertical circular wall on the floor, under a directional light.
    CylinderCup(CylinderCupScene),
    /// A flat water surface over the floor, light and camera above it.
    FlatInterface(FlatInterfaceScene),
    /// A parallel glass slab between a point light and the floor, camera below it.
    GlassSlab(GlassSlabScene),
    /// A convex vertical mirror on the floor, under a point light.
    Pillar(PillarScene),
    /// A vertical wall over an arc of a conic, under a point light.
    ConicWall(ConicWallScene),
    /// A vertical glass cylinder on the floor, under a directional light.
    GlassPillar(GlassPillarScene),
    /// Floor and point light in a wedge of two vertical mirrors.
    PlanarChains(PlanarChainsScene),
    /// A concave spherical cap above the floor, under a point light.
    ConcaveSphere(ConcaveSphereScene),
    /// A mirror ball above the floor, under a point light.
    ConvexSphere(ConvexSphereScene),
    /// A paraboloid above the floor, light at the focus.
    Paraboloid(ParaboloidScene),
    /// An ellipsoid or hyperboloid above the floor, light at a focus.
    ConicMirrors(ConicMirrorsScene),
    /// A closed diffuse sphere with a point light inside.
    Furnace(FurnaceScene),
    /// A flat water surface over the floor, light above it and camera below it.
    Underwater(UnderwaterScene),
    /// A glass ball over the floor, in light that comes straight down.
    GlassSphere(GlassSphereScene),
    /// Rippled water over the floor, in light that comes straight down, camera below the water.
    WaterWaves(WaterWavesScene),
    /// A lens with its focus near the floor, glass from the lens to the floor.
    StigmaticRefractors(StigmaticRefractorsScene),
    /// A vertical circular wall, under a point light inside its circle or on it.
    CylinderLamp(CylinderLampScene),
    /// A vertical wall all around the floor, under a directional light.
    ClosedCup(ClosedCupScene),
}

impl Kind {
    /// The family that this is a member of.
    pub const fn family(&self) -> &dyn Family {
        match self {
            Kind::Diffuse(s) => s,
            Kind::PlanarMirror(s) => s,
            Kind::CylinderCup(s) => s,
            Kind::FlatInterface(s) => s,
            Kind::GlassSlab(s) => s,
            Kind::Pillar(s) => s,
            Kind::ConicWall(s) => s,
            Kind::GlassPillar(s) => s,
            Kind::PlanarChains(s) => s,
            Kind::ConcaveSphere(s) => s,
            Kind::ConvexSphere(s) => s,
            Kind::Paraboloid(s) => s,
            Kind::ConicMirrors(s) => s,
            Kind::Furnace(s) => s,
            Kind::Underwater(s) => s,
            Kind::GlassSphere(s) => s,
            Kind::WaterWaves(s) => s,
            Kind::StigmaticRefractors(s) => s,
            Kind::CylinderLamp(s) => s,
            Kind::ClosedCup(s) => s,
        }
    }

    /// The name of the kind, as written in TOML.
    pub fn name(&self) -> &'static str {
        self.family().name()
    }

    /// The receiver; `None` where it is no floor.
    pub fn floor(&self) -> Option<&Floor> {
        self.family().floor()
    }

    /// The path classes that the scene carries, in a fixed order: the layers of an image.
    pub fn classes(&self) -> &'static [PathClass] {
        self.family().classes()
    }

    /// Up to which path length these are all there is.
    pub fn closure(&self) -> Closure {
        self.family().closure()
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
