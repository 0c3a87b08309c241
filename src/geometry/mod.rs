//! The scene as integrators see it: rays, surfaces, lights and the pinhole.
//!
//! Derived from the plain scene data alone, and independent of the closed forms: nothing here calls the truth's camera,
//! optics or formulas, so an error on one side cannot hide on the other. Every function that runs per path is
//! branch-free (values first, selects last), so that a loop over a block of paths becomes vector code; results do not
//! depend on the width of the vectors.

pub mod arc;
pub mod ball;
pub mod chains;
pub mod compiled;
pub mod conic;
pub mod conic_wall;
pub mod cup_wall;
pub mod dielectric;
pub mod dish;
pub mod emission;
pub mod floor;
pub mod furnace;
pub mod glass_ball;
pub mod glass_pillar;
pub mod lens;
pub mod light;
pub mod manifold;
pub mod once;
pub mod pillar;
pub mod pinhole;
pub mod quadratic;
pub mod rectangle;
pub mod ripples;
pub mod scene;
pub mod slab;
pub mod specular;
pub mod sphere_cap;
pub mod tracer;
pub mod turn;
pub mod underwater;
pub mod water;
pub mod wedge;
