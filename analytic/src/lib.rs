//! Independent truth for light transport that ordinary tests cannot judge.
//!
//! This crate holds closed forms and exact expectations. It knows nothing of how light is sampled: it never imports an
//! integrator, a ray tracer or a random number generator, and it does no I/O.

pub mod bandwidth;
pub mod camera;
pub mod certificate;
pub mod class;
mod decimal;
pub mod double_double;
pub mod enclosure;
pub mod entries;
pub mod flux;
pub mod gradient;
pub mod kinds;
pub mod optics;
pub mod pixel;
pub mod quadrature;
pub mod roots;
pub mod scalar;
pub mod scene;
pub mod schedule;
pub mod vector;
