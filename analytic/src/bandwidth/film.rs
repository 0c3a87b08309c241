//! Pixels and regions at finite bandwidth.
