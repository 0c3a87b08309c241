//! A scene as any renderer takes it: lights, shapes with one material each, a camera. Plain data between the kinds of
//! [`nephroid_analytic::scene`] and the formats.
//!
//! Metres, watts, z up, right-handed. The front of a shape is the side of its normal.

use std::fmt;
use std::sync::Arc;

use glam::DVec3;
use nephroid_analytic::scene::Camera;

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// An isotropic point light.
    Point {
        /// Position [m].
        position: DVec3,
        /// Radiant intensity [W/sr].
        intensity: f64,
    },
    /// Parallel light.
    Directional {
        /// Unit direction in which it travels.
        travel: DVec3,
        /// Irradiance on a plane perpendicular to it [W/m²].
        irradiance: f64,
    },
}

/// What a surface does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Reflects diffusely on the front; its back is not seen.
    Lambert {
        /// Albedo ρ.
        albedo: f64,
    },
    /// Reflects on the front, absorbs on the back, occludes from both sides.
    Mirror {
        /// Specular reflectance R.
        reflectance: f64,
    },
    /// A smooth interface: air in front, the medium behind.
    Dielectric {
        /// Refractive index n of the medium.
        index: f64,
        /// Whether what the interface reflects is dropped.
        transmit_only: bool,
    },
    /// Absorbs everything.
    Black,
}

/// A point of a surface and the unit normal there.
pub type Element = (DVec3, DVec3);

/// A curved surface over the unit square.
#[derive(Clone)]
pub struct Patch {
    /// The point and the unit normal at (s, t).
    pub at: Arc<dyn Fn(f64, f64) -> Element + Send + Sync>,
    /// Whether lines of constant s are straight: then one cell along t is enough.
    pub ruled: bool,
}

impl fmt::Debug for Patch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Patch {{ ruled: {} }}", self.ruled)
    }
}

/// Where a surface is.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// The points center + a u + b v with |a|, |b| ≤ 1; the normal is along u × v.
    Rectangle {
        /// Middle [m].
        center: DVec3,
        /// Half of one edge [m].
        u: DVec3,
        /// Half of the other, perpendicular to it [m].
        v: DVec3,
    },
    /// A horizontal disk, normal up, with a hole if `inner` is not 0.
    Disk {
        /// Middle [m].
        center: DVec3,
        /// Radius of the hole [m].
        inner: f64,
        /// Radius [m].
        radius: f64,
    },
    /// A sphere; its front is the outer side unless `inward`.
    Sphere {
        /// Centre [m].
        center: DVec3,
        /// Radius [m].
        radius: f64,
        /// Whether the front is the inner side.
        inward: bool,
    },
    /// The part of a vertical cylinder at azimuths |φ| ≤ `half_arc`.
    Cylinder {
        /// A point of the axis, (x, y) [m].
        axis: [f64; 2],
        /// Radius [m].
        radius: f64,
        /// Lowest and highest z [m].
        z: [f64; 2],
        /// Half of the arc [rad]; π is a closed cylinder.
        half_arc: f64,
        /// Whether the front is the inner side.
        inward: bool,
    },
    /// Anything else.
    Patch(Patch),
}

/// A surface with its material.
#[derive(Clone, Debug)]
pub struct Shape {
    /// A name that is unique in the scene: a letter, then letters, digits and underscores.
    pub name: &'static str,
    /// Where it is.
    pub geometry: Geometry,
    /// What it does.
    pub material: Material,
}

/// The whole scene.
#[derive(Clone, Debug)]
pub struct Model {
    /// The light.
    pub light: Light,
    /// The surfaces.
    pub shapes: Vec<Shape>,
    /// The camera.
    pub camera: Camera,
    /// Refractive index of what is around the camera.
    pub camera_index: f64,
    /// The floor's bounds in x and y [m], where there is one.
    pub floor: Option<[[f64; 2]; 2]>,
    /// The most specular interactions in a row on one side of the diffuse vertex, of the classes that are compared.
    pub longest_chain: usize,
}

/// Whether an arc is a whole circle.
pub fn is_closed(half_arc: f64) -> bool {
    half_arc >= std::f64::consts::PI * (1.0 - 1e-15)
}

impl Geometry {
    /// The geometry as a patch; `None` for a rectangle, which two triangles are exactly.
    pub fn patch(&self) -> Option<Patch> {
        use std::f64::consts::{PI, TAU};
        let side = |inward: bool| if inward { -1.0 } else { 1.0 };
        match *self {
            Geometry::Rectangle { .. } => None,
            Geometry::Patch(ref patch) => Some(patch.clone()),
            Geometry::Disk {
                center,
                inner,
                radius,
            } => Some(Patch {
                at: Arc::new(move |s, t| {
                    let r = inner + (radius - inner) * t;
                    (center + round(TAU * s) * r, DVec3::Z)
                }),
                ruled: true,
            }),
            Geometry::Sphere {
                center,
                radius,
                inward,
            } => Some(Patch {
                at: Arc::new(move |s, t| {
                    let (sine, cosine) = libm::sincos(PI * t);
                    let n = round(TAU * s) * sine - DVec3::Z * cosine;
                    (center + n * radius, n * side(inward))
                }),
                ruled: false,
            }),
            Geometry::Cylinder {
                axis: [x, y],
                radius,
                z: [low, high],
                half_arc,
                inward,
            } => Some(Patch {
                at: Arc::new(move |s, t| {
                    let n = round(half_arc * (2.0 * s - 1.0));
                    let foot = DVec3::new(x, y, low + (high - low) * t);
                    (foot + n * radius, n * side(inward))
                }),
                ruled: true,
            }),
        }
    }
}

/// The horizontal unit vector at an azimuth.
pub fn round(azimuth: f64) -> DVec3 {
    let (sine, cosine) = libm::sincos(azimuth);
    DVec3::new(cosine, sine, 0.0)
}
