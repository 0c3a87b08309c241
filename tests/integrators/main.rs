//! Films of the integrators: bits, contents, means.

mod bits;
mod films;
mod means;

#[path = "../iteration/mod.rs"]
mod iteration;
