//! The sensor.

use serde::{Deserialize, Serialize};

/// A pinhole camera with a box pixel filter. Row 0 is the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Position of the pinhole [m].
    pub position: [f64; 3],
    /// A point in the middle of the image [m].
    pub look_at: [f64; 3],
    /// Up direction, of any length.
    #[serde(default = "up")]
    pub up: [f64; 3],
    /// Full vertical field of view [degrees].
    pub field_of_view_degrees: f64,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

fn up() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}
