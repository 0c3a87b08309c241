//! The command line: one file per command, each a thin layer over the library.

mod evaluate;
mod explain;
mod list;
mod probe;
mod render;
