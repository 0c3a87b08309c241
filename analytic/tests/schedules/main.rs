//! Schedules: the language, the classes, the laws, the table.

mod classes;
mod language;
mod laws;
mod table;
