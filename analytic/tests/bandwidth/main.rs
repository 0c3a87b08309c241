//! Expectations at finite bandwidth: tables, second routes, laws.

mod chains;
mod film;
mod law;
mod planar;
mod routes;
mod table;

#[path = "../chain_tracer/mod.rs"]
mod chain_tracer;
#[path = "../mirror_entry/mod.rs"]
mod mirror_entry;
