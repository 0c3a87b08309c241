//! Command line of nephroid.
fn main() {}
