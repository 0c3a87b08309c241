//! A mirror ball above the floor.

use serde::{Deserialize, Serialize};

use crate::class::PathClass;
use crate::scene::frame::Frame;
use crate::scene::ranges::{Checked, above, coordinates, invalid, positive};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// A mirror ball above the floor, under a point light; the ball is not in the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConvexSphereScene {
    /// The light.
    pub light: PointLight,
    /// The receiver.
    pub floor: Floor,
    /// The mirror.
    pub ball: Ball,
}

/// A sphere that reflects on its outer side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Centre [m].
    pub center: [f64; 3],
    /// Radius a [m].
    pub radius: f64,
    /// Specular reflectance R.
    pub reflectance: f64,
}

impl Ball {
    fn validate(&self) -> Checked {
        coordinates("ball.center", &self.center)?;
        positive("ball.radius", self.radius)?;
        above("ball.reflectance", self.reflectance, 0.0, 1.0)?;
        if self.center[2] > self.radius {
            return Ok(());
        }
        Err(invalid(
            "ball.center",
            format!("{:?}", self.center),
            "a ball above the floor: z greater than its radius",
        ))
    }
}

impl Family for ConvexSphereScene {
    fn name(&self) -> &'static str {
        "convex-sphere"
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
            reason: "light may go from the floor by the ball back to the floor: LDSDE has four edges",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.ball.validate()?;
        // A light above the ball's top casts an elliptical shadow; the other nappe of its cone goes up.
        self.light
            .validate(self.ball.center[2] + self.ball.radius)?;
        let [x, y, z] = self.ball.center;
        let reach = |n: [f64; 3]| n[0] * x + n[1] * y + n[2] * z + self.ball.radius;
        Frame::new(camera).check_beside("the ball", reach)
    }
}
