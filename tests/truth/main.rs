//! Truth through the commands that print it: tables, points, pixels, pictures.

mod bundles;
mod certify;
mod entries;
mod evaluate;
mod evaluate_bad_input;
mod evaluate_focusing;
mod evaluate_mirrors;
mod furnace;
mod golden;
mod pictures;
mod precision;
mod probe;
mod refraction;
mod render;
mod revolution;
mod unseen_parameters;
mod wall_pixels;

#[path = "../consistency/mod.rs"]
mod consistency;
#[path = "../gauss/mod.rs"]
mod gauss;
