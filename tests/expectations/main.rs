//! Expectations at finite bandwidth, over films and schedules, and measured.

mod films;
mod law;
mod predictions;
