//! One file per kind: its data, its path classes, its closure and its ranges.

mod closed_cup;
mod concave_sphere;
mod conic_mirrors;
mod conic_wall;
mod convex_sphere;
mod cylinder_cup;
mod cylinder_lamp;
mod diffuse;
mod flat_interface;
mod furnace;
mod glass_slab;
mod paraboloid;
mod pillar;
mod planar_mirror;
mod underwater;

pub use closed_cup::{ClosedCupScene, ClosedWall};
pub use concave_sphere::{ConcaveSphereScene, SphereCap};
pub use conic_mirrors::{Conic, ConicMirrorsScene};
pub use conic_wall::{ConicArc, ConicWallScene};
pub use convex_sphere::{Ball, ConvexSphereScene};
pub use cylinder_cup::CylinderCupScene;
pub use cylinder_lamp::{CircleLight, CylinderLampScene};
pub use diffuse::DiffuseScene;
pub use flat_interface::FlatInterfaceScene;
pub use furnace::{FurnaceScene, SphereWall};
pub use glass_slab::{GlassSlabScene, Slab};
pub use paraboloid::{Dish, ParaboloidScene};
pub use pillar::{MirrorPillar, PillarScene};
pub use planar_mirror::PlanarMirrorScene;
pub use underwater::UnderwaterScene;
