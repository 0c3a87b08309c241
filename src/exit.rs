//! Exit codes: a contract with CI.

/// Every verdict that counts is "equivalent", or the command has done what was asked.
pub const PASS: u8 = 0;
/// At least one verdict is "different".
pub const DIFFERENT: u8 = 1;
/// Bad usage or unreadable input.
pub const BAD_INPUT: u8 = 2;
/// Nothing is different, but something is undecided.
pub const UNDECIDED: u8 = 3;
/// Nothing ran.
pub const NOTHING_RAN: u8 = 4;

/// The code of mixed results: 2 > 1 > 3 > 4 > 0.
pub fn combine(a: u8, b: u8) -> u8 {
    const ORDER: [u8; 5] = [BAD_INPUT, DIFFERENT, UNDECIDED, NOTHING_RAN, PASS];
    ORDER
        .into_iter()
        .find(|c| [a, b].contains(c))
        .unwrap_or(PASS)
}
