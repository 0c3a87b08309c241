//! A glass ball over the floor, in light that comes straight down.

use serde::{Deserialize, Serialize};

use crate::class::{PathClass, Specular};
use crate::scene::frame::Frame;
use crate::scene::ranges::{Checked, LARGEST, above, coordinates, invalid, positive, within};
use crate::scene::{Camera, Closure, Family, Floor, VerticalLight};

/// A glass ball over the floor, in light that comes straight down.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassSphereScene {
    /// The light, unbounded.
    pub light: VerticalLight,
    /// The receiver.
    pub floor: Floor,
    /// The ball.
    pub glass: GlassBall,
}

/// A sphere of smooth dielectric in air.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlassBall {
    /// Centre [m].
    pub center: [f64; 3],
    /// Radius [m].
    pub radius: f64,
    /// Refractive index n relative to air.
    pub index: f64,
}

/// Direct, reflected outside, refracted twice, refracted with two internal reflections.
///
/// With one internal reflection all light goes up again: |4r - 2i| stays below 90° for the indices that are accepted.
/// Three and more carry a few thousandths of what falls on the ball, on paths of seven edges or more.
const CLASSES: &[PathClass] = {
    const R: Specular = Specular::Reflection;
    const T: Specular = Specular::Transmission;
    &[
        PathClass::LDE,
        PathClass::caustic(&[R]),
        PathClass::caustic(&[T, T]),
        PathClass::caustic(&[T, R, R, T]),
    ]
};

impl Family for GlassSphereScene {
    fn name(&self) -> &'static str {
        "glass-sphere"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        CLASSES
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: Some(3),
            reason: "light from the floor may be reflected back to it by the ball: LDRDE has four edges, as many as LTTDE; \
                     the refracted classes are complete as layers of their own",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate()?;
        self.glass.validate()?;
        self.glass.check_beside(camera)
    }
}

impl GlassBall {
    fn validate(&self) -> Checked {
        coordinates("glass.center", &self.center)?;
        positive("glass.radius", self.radius)?;
        above("glass.center", self.center[2], self.radius, LARGEST).map_err(|e| {
            invalid(
                "glass.center",
                format!("{:?}", self.center),
                &format!("z {}", e.allowed),
            )
        })?;
        // |4r - 2i| reaches 90° below 1.13 and above 2.6.
        within("glass.index", self.index, 1.15, 2.5)
    }

    /// The ball is not in the frame.
    fn check_beside(&self, camera: &Camera) -> Checked {
        let [x, y, z] = self.center;
        Frame::new(camera).check_beside("the glass ball", |n| {
            n[0] * x + n[1] * y + n[2] * z + self.radius
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ball_may_be_beside_the_frame_or_behind_the_camera_only() {
        let camera = Camera {
            position: [0.0, -2.0, 1.3],
            look_at: [0.0, 0.0, 0.0],
            up: [0.0, 0.0, 1.0],
            field_of_view_degrees: 30.0,
            width: 30,
            height: 20,
        };
        let ball = |center| GlassBall {
            center,
            radius: 0.3,
            index: 1.5,
        };
        for (center, refused) in [
            ([0.0, 0.0, 0.5], true),
            ([0.0, -2.0, 1.2], true),
            ([0.0, -1.0, 0.9], true),
            ([0.0, 0.0, 1.4], false),
            ([0.0, -1.9, 0.4], false),
            ([1.6, 0.0, 0.4], false),
            ([-1.6, 0.0, 0.4], false),
            ([0.0, -3.0, 1.7], false),
        ] {
            let found = ball(center).check_beside(&camera);
            assert_eq!(found.is_err(), refused, "{center:?}");
        }
    }
}
