//! A scene behind one interface that does not depend on its light and surface: 256 paths a call.
//!
//! Methods written against [`Tracer`] are compiled once, not once for each light and surface. What is generic is the scene's
//! own part, and that is one call per block: no dynamic dispatch per path. Vectors of a block are three arrays of numbers.
//!
//! Densities need no more than irradiances: photons that are equally likely over what they are drawn from carry Φ together, so
//! at a point that the light reaches with the irradiance E_n, normal to its direction, their density per area of a surface is
//! E_n cos θ/Φ, of a point light and of a directional one ([`Emission::flux`]).

mod chained;
mod emission;
mod once;

pub use emission::{Aim, Emission, Extent};

use glam::DVec3;
use multiversion::multiversion;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::chains::Chains;
use super::compiled::{Visitor, visit};
use super::floor::Floor;
use super::furnace::Furnace;
use super::light::Light;
use super::pinhole::Pinhole;
use super::scene::{Overrides, Scene};
use super::specular::Specular;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

/// One vector for each path of a block.
#[derive(Clone, Debug)]
pub struct Vectors {
    /// First coordinates.
    pub x: Lanes,
    /// Second coordinates.
    pub y: Lanes,
    /// Third coordinates.
    pub z: Lanes,
}

impl Vectors {
    /// All zero.
    pub fn new() -> Self {
        Vectors {
            x: zeros(),
            y: zeros(),
            z: zeros(),
        }
    }

    /// The vector of a path.
    #[inline(always)]
    pub fn get(&self, i: usize) -> DVec3 {
        DVec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// Sets the vector of a path.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: DVec3) {
        self.x[i] = v.x;
        self.y[i] = v.y;
        self.z[i] = v.z;
    }
}

impl Default for Vectors {
    fn default() -> Self {
        Vectors::new()
    }
}

/// A block of rays. Directions have any length.
#[derive(Clone, Debug, Default)]
pub struct Rays {
    /// Where they start [m].
    pub origin: Vectors,
    /// Where they go.
    pub direction: Vectors,
}

/// Where a block of rays ends on the floor, with whatever chain of specular interactions they took.
#[derive(Clone, Debug)]
pub struct Landings {
    /// The point, z = 0 [m]; 0 where the floor is not reached.
    pub x: Lanes,
    /// Its second coordinate [m].
    pub y: Lanes,
    /// Product of the reflectances and transmittances on the way, 1 for a straight ray; 0 where the floor is not reached.
    pub weight: Lanes,
    /// Cosine of the angle of arrival.
    pub cosine: Lanes,
    /// The chain taken: its position in [`Tracer::chains`], or for rays from the camera 1 through a surface, 0 straight.
    pub chain: Lanes,
}

impl Landings {
    /// None.
    pub fn new() -> Self {
        Landings {
            x: zeros(),
            y: zeros(),
            weight: zeros(),
            cosine: zeros(),
            chain: zeros(),
        }
    }
}

impl Default for Landings {
    fn default() -> Self {
        Landings::new()
    }
}

/// A block of specular vertices: the first meeting of each ray with the surface, where it takes an interaction there.
#[derive(Clone, Debug)]
pub struct Vertices {
    /// The points [m].
    pub point: Vectors,
    /// Unit directions in which the exact paths go on.
    pub exact: Vectors,
    /// Unit normals on the side to which they go on.
    pub normal: Vectors,
    /// Reflectances or transmittances (products of them along a chain), at the angles of the rays; 0 where there is no
    /// vertex.
    pub weight: Lanes,
    /// Cosines of the angles at which the rays arrive.
    pub arrival: Lanes,
    /// Ray parameters of the vertices; distances in metres for unit directions. After a chain of several interactions infinite.
    pub t: Lanes,
}

impl Vertices {
    /// None.
    pub fn new() -> Self {
        Vertices {
            point: Vectors::new(),
            exact: Vectors::new(),
            normal: Vectors::new(),
            weight: zeros(),
            arrival: zeros(),
            t: zeros(),
        }
    }
}

impl Default for Vertices {
    fn default() -> Self {
        Vertices::new()
    }
}

/// The connections of a block of vertices with the light.
#[derive(Clone, Debug)]
pub struct ToLight {
    /// Squared chords between the exact direction and the one to the light.
    pub squared_chord: Lanes,
    /// Irradiances normal to the direction to the light [W/m²]; 0 where something is in the way, or the light on the wrong
    /// side.
    pub irradiance: Lanes,
    /// Cosines at the vertices towards the light.
    pub cosine: Lanes,
}

impl ToLight {
    /// None.
    pub fn new() -> Self {
        ToLight {
            squared_chord: zeros(),
            irradiance: zeros(),
            cosine: zeros(),
        }
    }
}

impl Default for ToLight {
    fn default() -> Self {
        ToLight::new()
    }
}

/// What a scene has that is no work per path.
#[derive(Clone, Debug)]
pub struct Outline {
    /// The camera.
    pub camera: Pinhole,
    /// The floor.
    pub floor: Floor,
    /// Where the light is [m]; `None` if it is parallel.
    pub light: Option<DVec3>,
    /// Whether there is a specular surface.
    pub specular: bool,
    /// Whether every straight line from the floor to the light or to the camera is interrupted by the surface.
    pub separates: bool,
    /// Whether the interaction next to the light in a chain of unspecified kind, `S`, is a refraction.
    pub refracts: bool,
    /// Whether a ray that leaves the surface on the side of the light can meet it again.
    pub meets_itself: bool,
    /// Whether the floor can be seen through the surface.
    pub seen_through: bool,
    /// What radiance is multiplied by, apart from the weight, on its way from the floor through the surface to the camera.
    pub radiance_scale: f64,
    /// What it is multiplied by on its way from the light to the floor: n² into a medium of index n.
    pub radiance_gain: f64,
}

/// A scene with a floor, traced a block of paths at a time. Points given as `x`, `y` are on the floor.
pub trait Tracer: Send + Sync {
    /// What is no work per path.
    fn outline(&self) -> &Outline;

    /// The classes of light paths that end at the floor, seen directly: straight, or through the surface.
    fn chains(&self) -> &'static [PathClass];

    /// Photons of the light.
    fn emission(&self, aim: Aim) -> Emission;

    /// Number of beams: photons of a beam take any of its chains, and one is enough for scenes in which a ray has no choice. A
    /// chain belongs to one beam.
    fn beams(&self) -> usize;

    /// What the photons of a beam cover.
    fn aim(&self, beam: usize) -> Aim;

    /// Follows rays of light of a beam to the floor.
    fn land(&self, beam: usize, rays: &Rays, landings: &mut Landings);

    /// Follows rays from the camera to the floor, straight or through the surface.
    fn see(&self, rays: &Rays, landings: &mut Landings);

    /// The specular vertices of rays from the light, or from the floor upwards, that take the chain, up to the last interaction of it
    /// on their way.
    fn meet(&self, chain: usize, rays: &Rays, vertices: &mut Vertices);

    /// Connects vertices that were met by rays from the floor with the light.
    fn to_light(&self, vertices: &Vertices, connections: &mut ToLight);

    /// Irradiance normal to the direction of the light at floor points that it reaches straight [W/m²], 0 where it does not,
    /// and the cosine at the floor.
    fn lit(&self, x: &Lanes, y: &Lanes, irradiance: &mut Lanes, cosine: &mut Lanes);

    /// Whether the pinhole sees floor points straight: 1, or 0.
    fn seen(&self, x: &Lanes, y: &Lanes, free: &mut Lanes);
}

/// An entry, ready to be traced.
pub enum Traceable {
    /// A scene with a floor.
    Floor(Box<dyn Tracer>),
    /// A closed diffuse sphere.
    Furnace(Furnace),
}

/// The tracer of an entry; `None` for a scene without a floor.
pub fn tracer(entry: &Entry, overrides: Overrides) -> Option<Box<dyn Tracer>> {
    match traceable(entry, overrides) {
        Traceable::Floor(tracer) => Some(tracer),
        Traceable::Furnace(_) => None,
    }
}

/// Compiles an entry of any kind.
pub fn traceable(entry: &Entry, overrides: Overrides) -> Traceable {
    struct Build;
    impl Visitor for Build {
        type Output = Traceable;

        fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Self::Output {
            Traceable::Floor(Box::new(once::Traced::new(scene)))
        }

        fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output {
            Traceable::Floor(Box::new(chained::Traced::new(scene)))
        }

        fn furnace(self, furnace: Furnace) -> Self::Output {
            Traceable::Furnace(furnace)
        }
    }
    visit(entry, overrides, Build)
}

/// Two uniforms for each path of a block.
#[multiversion(targets("x86_64+avx2"))]
pub fn uniforms(stream: &Stream, first: u64, dimension: Dimension, u: &mut Lanes, v: &mut Lanes) {
    stream.pairs(first, dimension, u, v);
}

/// Rays through film positions, in pixels from the top left corner, with depth 1.
#[multiversion(targets("x86_64+avx2"))]
pub fn film_rays(camera: &Pinhole, column: &Lanes, row: &Lanes, rays: &mut Rays) {
    for i in 0..BLOCK {
        rays.origin.set(i, camera.position);
        rays.direction.set(i, camera.direction(column[i], row[i]));
    }
}
