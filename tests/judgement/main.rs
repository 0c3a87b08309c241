//! Verdicts, runs, diagnoses, and the museum of faults.

mod diagnosis;
mod excluded;
mod faults;
mod museum;
mod runs;
mod verdicts;

#[path = "../synthetic/mod.rs"]
mod synthetic;
