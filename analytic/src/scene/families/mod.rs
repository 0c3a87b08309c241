//! One file per kind: its data, its path classes, its closure and its ranges.

mod concave_sphere;
mod conic_mirrors;
mod conic_wall;
mod convex_sphere;
mod cylinder_cup;
mod diffuse;
mod flat_interface;
mod furnace;
mod glass_pillar;
mod glass_slab;
mod glass_sphere;
mod paraboloid;
mod pillar;
mod planar_chains;
mod planar_mirror;
mod stigmatic_refractors;
mod underwater;
mod water_waves;

pub use concave_sphere::{ConcaveSphereScene, SphereCap};
pub use conic_mirrors::{Conic, ConicMirrorsScene};
pub use conic_wall::{ConicArc, ConicWallScene};
pub use convex_sphere::{Ball, ConvexSphereScene};
pub use cylinder_cup::CylinderCupScene;
pub use diffuse::DiffuseScene;
pub use flat_interface::FlatInterfaceScene;
pub use furnace::{FurnaceScene, SphereWall};
pub use glass_pillar::{GlassCylinder, GlassPillarScene};
pub use glass_slab::{GlassSlabScene, Slab};
pub use glass_sphere::{GlassBall, GlassSphereScene};
pub use paraboloid::{Dish, ParaboloidScene};
pub use pillar::{MirrorPillar, PillarScene};
pub use planar_chains::{MirrorWedge, PlanarChainsScene};
pub use planar_mirror::PlanarMirrorScene;
pub use stigmatic_refractors::{LensFront, StigmaticRefractorsScene};
pub use underwater::UnderwaterScene;
pub use water_waves::{MAX_WAVES, Ripple, WaterWavesScene};
