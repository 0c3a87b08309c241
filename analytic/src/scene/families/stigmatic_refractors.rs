//! A lens that brings vertical light to one point in the glass below it, where floor and camera are as well.

use libm::{acos, sincos};
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, LARGEST, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, VerticalLight};

/// A lens over the floor, in light that comes straight down; glass from the lens to the floor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StigmaticRefractorsScene {
    /// The light, in the air above the lens.
    pub light: VerticalLight,
    /// The receiver, in the glass.
    pub floor: Floor,
    /// The front surface of the glass.
    pub lens: LensFront,
}

/// The part of an ellipsoid of revolution, eccentricity 1/n, that is seen from its lower focus within an angle from the
/// vertical. Around it, an opaque horizontal screen in the plane of its rim absorbs from both sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LensFront {
    /// The vertical axis, (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Height of the focus above the floor [m]; below it where negative. 0 is stigmatic: all light comes to one point of
    /// the floor.
    pub defocus: f64,
    /// Semi-major axis of the ellipsoid [m].
    pub semi_axis: f64,
    /// Refractive index n of the glass relative to air.
    pub index: f64,
    /// Half angle of the aperture, seen from the focus [degrees].
    pub half_angle_degrees: f64,
}

impl LensFront {
    /// Tangent of the half angle.
    pub fn aperture(&self) -> f64 {
        libm::tan(self.half_angle_degrees.to_radians())
    }

    /// Height of the rim above the floor [m].
    pub fn rim_z(&self) -> f64 {
        let (_, cosine) = sincos(self.half_angle_degrees.to_radians());
        let n = self.index;
        let distance = self.semi_axis * (n - 1.0) * (n + 1.0) / (n * (n - cosine));
        self.defocus + distance * cosine
    }

    fn validate(&self) -> Checked {
        coordinates("lens.center", &self.center)?;
        within("lens.defocus", self.defocus, -LARGEST, LARGEST)?;
        positive("lens.semi_axis", self.semi_axis)?;
        above("lens.index", self.index, 1.0, 10.0)?;
        // Beyond acos 1/n the ellipsoid turns away from the light; short of it the conditioning stays finite.
        let grazing = acos(1.0 / self.index).to_degrees();
        above(
            "lens.half_angle_degrees",
            self.half_angle_degrees,
            0.0,
            0.99 * grazing,
        )?;
        if self.rim_z() > 0.0 {
            return Ok(());
        }
        Err(invalid(
            "lens.defocus",
            self.defocus,
            "a focus from which the rim of the lens is above the floor",
        ))
    }
}

impl Family for StigmaticRefractorsScene {
    fn name(&self) -> &'static str {
        "stigmatic-refractors"
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
            reason: "light from the floor may be reflected back to it by the lens: LTDRDE has five edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        self.lens.validate()?;
        camera.check_under(self.lens.rim_z())
    }
}
