//! Pixels: the integral of radiance over a pixel's box, per path class, with an error bound.

pub mod planar;
pub mod polygon;
pub mod rule;
