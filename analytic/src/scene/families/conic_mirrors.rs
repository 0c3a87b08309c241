//! A conic of revolution above the floor, with the light at one of its foci.

use libm::sqrt;
use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::ranges::{Checked, LARGEST, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, FocalLight};

/// An ellipsoid that images the light to a point next to the floor, or a hyperboloid that spreads it as from a point above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConicMirrorsScene {
    /// The light, at a focus: the upper one of an ellipsoid, the lower one of a hyperboloid.
    pub light: FocalLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub conic: Conic,
}

/// A mirror that is a conic of revolution about a vertical axis; it absorbs on its other side and occludes from both.
///
/// Eccentricity e < 1: the part above `rim_z` of an ellipsoid, which reflects inside. e > 1: the part below `rim_z` of the
/// upper sheet of a hyperboloid, which reflects on its convex lower side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Conic {
    /// Where the axis meets the floor, (x, y) [m].
    #[serde(default)]
    pub center: [f64; 2],
    /// Distance a between centre and vertex [m].
    pub semi_axis: f64,
    /// Eccentricity e ≠ 1.
    pub eccentricity: f64,
    /// Height above the floor of the light's image, the other focus [m]: the lower one of an ellipsoid (negative: below the
    /// floor), the upper one of a hyperboloid, behind its mirror.
    pub image_z: f64,
    /// Height of the rim [m].
    pub rim_z: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

impl Conic {
    /// Whether the mirror is an ellipsoid.
    pub fn is_ellipsoid(&self) -> bool {
        self.eccentricity < 1.0
    }

    /// Height of the light, at the focus that is not the image [m].
    pub fn light_z(&self) -> f64 {
        self.center_z() + self.towards_light()
    }

    /// Height of the centre [m].
    pub fn center_z(&self) -> f64 {
        self.image_z + self.towards_light()
    }

    /// From the centre to the light, upwards [m].
    fn towards_light(&self) -> f64 {
        let up = if self.is_ellipsoid() { 1.0 } else { -1.0 };
        up * self.semi_axis * self.eccentricity
    }

    /// Radius of the rim [m].
    pub fn rim_radius(&self) -> f64 {
        let (a, e, z) = (
            self.semi_axis,
            self.eccentricity,
            self.rim_z - self.center_z(),
        );
        sqrt((a - z) * (a + z) * (1.0 - e) * (1.0 + e))
    }

    /// The largest radius of the mirror [m]: in the middle of an ellipsoid, if that is above its rim.
    pub fn widest(&self) -> f64 {
        let (a, e) = (self.semi_axis, self.eccentricity);
        if self.is_ellipsoid() && self.rim_z <= self.center_z() {
            return a * sqrt((1.0 - e) * (1.0 + e));
        }
        self.rim_radius()
    }

    /// Height of the vertex [m]: the highest point of an ellipsoid, the lowest one of a hyperboloid's sheet.
    pub fn vertex_z(&self) -> f64 {
        self.center_z() + self.semi_axis
    }

    fn validate(&self) -> Checked {
        coordinates("conic.center", &self.center)?;
        positive("conic.semi_axis", self.semi_axis)?;
        let e = self.eccentricity;
        if !((0.0..=0.999).contains(&e) || (1.001..=1000.0).contains(&e)) {
            return Err(invalid(
                "conic.eccentricity",
                e,
                "from 0 to 0.999 (ellipsoid) or from 1.001 to 1000 (hyperboloid)",
            ));
        }
        above("conic.reflectance", self.reflectance, 0.0, 1.0)?;
        within("conic.image_z", self.image_z, -LARGEST, LARGEST)?;
        let light_z = self.light_z();
        if !(light_z > 0.0) {
            return Err(invalid(
                "conic.image_z",
                self.image_z,
                &format!("a conic with the light above the floor (it is at {light_z})"),
            ));
        }
        if !self.is_ellipsoid() {
            return above("conic.rim_z", self.rim_z, self.vertex_z(), LARGEST);
        }
        // On the floor the image is a point focus: flux without an irradiance, and reported as such.
        if self.image_z != 0.0 && !(self.image_z.abs() >= 1e-9 * self.semi_axis) {
            return Err(invalid(
                "conic.image_z",
                self.image_z,
                "0, or at least 1e-9 × semi_axis from 0",
            ));
        }
        let lowest = self.image_z.max(0.0);
        if self.rim_z > lowest && self.rim_z < self.vertex_z() {
            return Ok(());
        }
        Err(invalid(
            "conic.rim_z",
            self.rim_z,
            &format!(
                "greater than {lowest} (floor and image) and less than {} (vertex)",
                self.vertex_z()
            ),
        ))
    }
}

impl Family for ConicMirrorsScene {
    fn name(&self) -> &'static str {
        "conic-mirrors"
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
            reason: "light may go from the floor by the mirror back to the floor: LDSDE has four edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        positive("light.intensity", self.light.intensity)?;
        self.conic.validate()?;
        let lowest = self.conic.rim_z.min(self.conic.vertex_z());
        camera.check_under(lowest)
    }
}
