//! Command line of nephroid: see `nephroid --help`.

use std::process::ExitCode;

fn main() -> ExitCode {
    nephroid::cli::main()
}
