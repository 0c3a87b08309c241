//! Closed forms integrated over pixels: conservation of energy, bundles of rays.

mod bundle_weights;
mod cup;
mod energy;
mod energy_cup;
mod flux_bundles;
mod flux_cup;
mod flux_planar;
mod pool;
