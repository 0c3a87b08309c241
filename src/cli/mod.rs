//! The command line: one file per command, each a thin layer over the library.

mod answer;
mod bandwidth;
mod bandwidth_answer;
mod bench;
mod bias;
mod converge;
mod evaluate;
mod explain;
mod export;
mod faults;
mod gate;
mod golden;
mod list;
mod probe;
mod probe_certify;
mod ranges;
mod rates;
mod render;
mod run;
mod schedule;
mod stability;
mod verify;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::error::Error;
use crate::exit;

/// Test oracle for caustics and reflected caustics: exact radiance, exact bias at finite bandwidth, and verdicts with
/// known error probabilities.
///
/// Start with `nephroid verify`. Exit codes: 0 pass, 1 different, 2 bad usage or unreadable input, 3 undecided,
/// 4 nothing ran.
#[derive(Parser)]
#[command(name = "nephroid", version, max_term_width = 110)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Verify(verify::Args),
    Gate(gate::Args),
    List(list::Args),
    Bandwidth(bandwidth::Args),
    Bias(bias::Args),
    Converge(converge::Args),
    Evaluate(evaluate::Args),
    Probe(probe::Args),
    Explain(explain::Args),
    Export(export::Args),
    Render(render::Args),
    Run(run::Args),
    Faults(faults::Args),
    Schedule(schedule::Args),
    Golden(golden::Args),
    Stability(stability::Args),
    Bench(bench::Args),
}

/// Parses the command line, runs the command and turns the result into an exit code.
pub fn main() -> ExitCode {
    // A usage error exits with 2 through clap itself; --help and --version with 0.
    let cli = Cli::parse();
    let result = match cli.command {
        Command::Verify(args) => verify::run(&args),
        Command::Gate(args) => gate::run(&args),
        Command::List(args) => list::run(&args),
        Command::Bandwidth(args) => bandwidth::run(&args),
        Command::Bias(args) => bias::run(&args),
        Command::Converge(args) => converge::run(&args),
        Command::Evaluate(args) => evaluate::run(&args),
        Command::Probe(args) => probe::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Faults(args) => faults::run(&args),
        Command::Schedule(args) => schedule::run(&args),
        Command::Golden(args) => golden::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Bench(args) => bench::run(&args),
    };
    match result {
        Ok(code) => ExitCode::from(code),
        Err(error) => report(error),
    }
}

fn report(error: Error) -> ExitCode {
    eprintln!("{:?}", miette::Report::new(error));
    ExitCode::from(exit::BAD_INPUT)
}

/// Prints a line to standard output; a closed pipe (`nephroid list | head -1`) is not a failure.
pub(crate) fn print(text: &str) {
    use std::io::Write as _;
    let mut out = std::io::stdout().lock();
    let _ = writeln!(out, "{text}");
}

/// A count that may be written `30000000` or `3e7`.
pub(crate) fn count(text: &str) -> Result<u64, String> {
    const ALLOWED: &str = "expected a whole number from 1 to 1e15, such as 30000000 or 3e7";
    let value: f64 = text.parse().map_err(|_| ALLOWED.to_owned())?;
    let whole = (1.0..=1e15).contains(&value) && value.fract() == 0.0;
    if whole {
        Ok(value as u64)
    } else {
        Err(ALLOWED.to_owned())
    }
}
