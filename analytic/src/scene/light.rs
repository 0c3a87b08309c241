//! Lights.

use serde::{Deserialize, Serialize};

/// An isotropic point light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PointLight {
    /// Position [m].
    pub position: [f64; 3],
    /// Radiant intensity [W/sr], the same in every direction.
    pub intensity: f64,
}

/// A directional light that travels along +x and downwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DirectionalLight {
    /// Elevation of the light above the horizon [degrees].
    pub elevation_degrees: f64,
    /// Irradiance on a plane perpendicular to the beam [W/m²].
    pub irradiance: f64,
}

/// Parallel light that travels straight down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VerticalLight {
    /// Irradiance on a horizontal plane [W/m²].
    pub irradiance: f64,
}

/// An isotropic point light at the focus of the scene's mirror.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FocalLight {
    /// Radiant intensity [W/sr].
    pub intensity: f64,
}
