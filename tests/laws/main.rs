//! Laws that every closed form obeys, whatever its formula: on random variations of every entry of the catalogue.
//!
//! Entries are changed as TOML, key by key, so that the laws hold for kinds to come without a line here. No expected value
//! comes from the code: each law compares two scenes that it makes itself, whose parameters differ. What a kind's
//! parameters cannot express is listed with its reason, and the lists are complete (tested).

mod folds;
mod motions;
mod reciprocity;
mod splitting;
mod units;
mod varied;
