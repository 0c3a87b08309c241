//! Enclosures and double-double values of the closed forms.

mod double_double_tables;
mod enclosure;
mod forms;
mod lamp;
mod tables;
mod walls;

#[path = "../reference_table/mod.rs"]
mod reference_table;
