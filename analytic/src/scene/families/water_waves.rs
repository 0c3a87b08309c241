//! Rippled water in light that comes straight down, camera below it.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::kinds::water_waves::Refused;
use crate::kinds::water_waves::ripples::{PlaneWave, Ripples};
use crate::scene::ranges::{Checked, LARGEST, coordinates, invalid, within};
use crate::scene::{Camera, Closure, Family, Floor, InvalidParameter, VerticalLight, Water};

/// The most waves of a scene.
pub const MAX_WAVES: usize = 16;

/// The steepest slope that the waves together may have: at 30°, light that a slope reflects could meet another one.
const STEEPEST: f64 = 0.577;

/// Rippled water over the floor, in light that comes straight down, camera below the water.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaterWavesScene {
    /// The light, unbounded, in the air.
    pub light: VerticalLight,
    /// The receiver, under water.
    pub floor: Floor,
    /// The mean surface.
    pub water: Water,
    /// What the surface's height is the sum of, beside the mean.
    pub waves: Vec<Ripple>,
}

/// One wave A cos(k·(x, y) + p).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ripple {
    /// Amplitude A [m].
    pub amplitude: f64,
    /// Wave vector k [1/m].
    pub wave_vector: [f64; 2],
    /// Phase p [rad].
    pub phase: f64,
}

impl WaterWavesScene {
    /// The closed form.
    ///
    /// # Errors
    /// What [`Family::validate`] finds.
    pub fn ripples(&self) -> Result<Ripples<f64>, InvalidParameter> {
        let waves = self.waves.iter().map(|wave| PlaneWave {
            amplitude: wave.amplitude,
            wave_vector: wave.wave_vector,
            phase: wave.phase,
        });
        let (n, depth) = (self.water.index, self.water.surface_z);
        Ripples::new(n, depth, self.light.irradiance, waves.collect()).map_err(|refused| {
            let (key, found, allowed) = match refused {
                Refused::Index => ("water.index", n.to_string(), "greater than 1"),
                Refused::Depth => (
                    "water.surface_z",
                    depth.to_string(),
                    "more than the sum of all amplitudes: no trough may reach the floor",
                ),
                Refused::Steep => (
                    "waves",
                    "too steep".to_owned(),
                    "amplitudes times wave numbers small enough that refracted light does not meet the surface again",
                ),
                Refused::TooManyWavelengths => (
                    "waves",
                    "too short".to_owned(),
                    "waves of which at most about 16 can light one point of the floor",
                ),
            };
            invalid(key, found, allowed)
        })
    }
}

impl Family for WaterWavesScene {
    fn name(&self) -> &'static str {
        "water-waves"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(4),
            reason: "light from the floor may be reflected back to it by the surface: LTDRDE has five edges; slopes below 30° \
                     let no light meet the surface twice before the floor",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        self.water.validate()?;
        if self.waves.len() > MAX_WAVES {
            return Err(invalid(
                "waves",
                self.waves.len(),
                &format!("at most {MAX_WAVES} waves"),
            ));
        }
        for wave in &self.waves {
            within("waves.amplitude", wave.amplitude, -LARGEST, LARGEST)?;
            coordinates("waves.wave_vector", &wave.wave_vector)?;
            within("waves.phase", wave.phase, -1e3, 1e3)?;
        }
        let slope = self.waves.iter().fold(0.0, |sum, wave| {
            let [kx, ky] = wave.wave_vector;
            sum + wave.amplitude.abs() * libm::hypot(kx, ky)
        });
        if !(slope <= STEEPEST) {
            return Err(invalid(
                "waves",
                format!("as steep as {slope}"),
                &format!(
                    "waves of which amplitudes times wave numbers add up to at most {STEEPEST}: slopes below 30°"
                ),
            ));
        }
        camera.check_under(self.ripples()?.lowest())
    }
}
