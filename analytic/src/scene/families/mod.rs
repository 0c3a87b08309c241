//! One file per kind: its data, its path classes, its closure and its ranges.

mod conic_wall;
mod cylinder_cup;
mod diffuse;
mod flat_interface;
mod glass_pillar;
mod glass_slab;
mod pillar;
mod planar_chains;
mod planar_mirror;

pub use conic_wall::{ConicArc, ConicWallScene};
pub use cylinder_cup::CylinderCupScene;
pub use diffuse::DiffuseScene;
pub use flat_interface::FlatInterfaceScene;
pub use glass_pillar::{GlassCylinder, GlassPillarScene};
pub use glass_slab::{GlassSlabScene, Slab};
pub use pillar::{MirrorPillar, PillarScene};
pub use planar_chains::{MirrorWedge, PlanarChainsScene};
pub use planar_mirror::PlanarMirrorScene;
