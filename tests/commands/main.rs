//! The command line, its outputs and exit codes; the rule of which layer may know which.

mod architecture;
mod cli;
mod cli_run;
mod masks;
mod schedule;
