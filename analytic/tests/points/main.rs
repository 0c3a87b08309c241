//! Closed forms at points: tables, second derivations, rays traced forward.

mod circular_walls;
mod glass_pillar;
mod pillar;
mod plane_tracing;
mod precision;
mod ripples;
mod second_routes;
mod second_routes_cup;
mod sphere_singularities;
mod sphere_tracing;
mod tables;
mod wall_bundles;

#[path = "../forward/mod.rs"]
mod forward;
#[path = "../reference_table/mod.rs"]
mod reference_table;
#[path = "../sphere_tracer/mod.rs"]
mod sphere_tracer;
