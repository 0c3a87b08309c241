//! One file per kind: its data, its path classes, its closure and its ranges.

mod cylinder_cup;
mod diffuse;
mod flat_interface;
mod glass_slab;
mod planar_mirror;
mod underwater;

pub use cylinder_cup::CylinderCupScene;
pub use diffuse::DiffuseScene;
pub use flat_interface::FlatInterfaceScene;
pub use glass_slab::{GlassSlabScene, Slab};
pub use planar_mirror::PlanarMirrorScene;
pub use underwater::UnderwaterScene;
