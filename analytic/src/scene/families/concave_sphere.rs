//! A concave spherical cap above the floor, opening downward.

use libm::cos;
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, above, coordinates, invalid, positive};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A concave spherical cap above the floor, point light and camera below its rim.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConcaveSphereScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub cap: SphereCap,
}

/// The part of a sphere within an angle of +z. It reflects on its inner side, absorbs on its outer side and occludes from
/// both.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SphereCap {
    /// Centre of the sphere [m].
    pub center: [f64; 3],
    /// Radius a [m].
    pub radius: f64,
    /// Angle between the axis and the rim, seen from the centre [degrees].
    pub half_angle_degrees: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

impl SphereCap {
    /// Height of the rim, the lowest part of the cap [m].
    pub fn rim_z(&self) -> f64 {
        self.center[2] + self.radius * cos(self.half_angle_degrees.to_radians())
    }

    fn validate(&self) -> Checked {
        coordinates("cap.center", &self.center)?;
        positive("cap.radius", self.radius)?;
        above("cap.half_angle_degrees", self.half_angle_degrees, 0.0, 90.0)?;
        above("cap.reflectance", self.reflectance, 0.0, 1.0)?;
        if self.rim_z() > 0.0 {
            return Ok(());
        }
        Err(invalid(
            "cap.center",
            format!("{:?}", self.center),
            "a cap that is above z = 0",
        ))
    }
}

impl Family for ConcaveSphereScene {
    fn name(&self) -> &'static str {
        "concave-sphere"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &[PathClass::LDE, PathClass::LSDE]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(3),
            reason: "light may meet the cap twice (LSSDE), or go from the floor by the cap back to the floor (LDSDE): four edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.cap.validate()?;
        self.light.validate(0.0)?;
        let rim = self.cap.rim_z();
        // Between the floor and a light below the rim there is no part of the cap: it does not shade direct light.
        if !(self.light.position[2] < rim) {
            return Err(invalid(
                "light.position",
                format!("{:?}", self.light.position),
                &format!("a light below the rim of the cap: z less than {rim}"),
            ));
        }
        camera.check_under(rim)
    }
}
