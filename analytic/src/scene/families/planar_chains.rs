//! A wedge of two vertical mirrors over the floor.

use libm::{cos, sin};
use serde::{Deserialize, Serialize};

use crate::camera::Film;
use crate::class::PathClass;
use crate::scene::ranges::{Checked, above, invalid, within};
use crate::scene::{Camera, Closure, Family, Floor, PointLight};

/// Floor and point light in a wedge of two unbounded vertical mirrors, neither of which is in the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanarChainsScene {
    /// The light, between the mirrors.
    pub light: PointLight,
    /// The receiver, between the mirrors.
    pub floor: Floor,
    /// The mirrors.
    pub wedge: MirrorWedge,
}

/// By the number of reflections: up to m.
const CLASSES: &[PathClass] = &[
    PathClass::new(0, 0),
    PathClass::new(1, 0),
    PathClass::new(2, 0),
    PathClass::new(3, 0),
    PathClass::new(4, 0),
    PathClass::new(5, 0),
    PathClass::new(6, 0),
    PathClass::new(7, 0),
    PathClass::new(8, 0),
];

impl Family for PlanarChainsScene {
    fn name(&self) -> &'static str {
        "planar-chains"
    }

    fn floor(&self) -> Option<&Floor> {
        Some(&self.floor)
    }

    fn classes(&self) -> &'static [PathClass] {
        &CLASSES[..=(self.wedge.divisor as usize).clamp(1, CLASSES.len() - 1)]
    }

    fn closure(&self) -> Closure {
        Closure {
            longest: None,
            reason: "a wedge of the angle π/m reflects m times at most; vertical mirrors keep the sign of the vertical direction, and are not in the frame (checked)",
        }
    }

    fn validate(&self, camera: &Camera) -> Checked {
        self.light.validate(0.0)?;
        let w = &self.wedge;
        if !(1..CLASSES.len()).contains(&(w.divisor as usize)) {
            return Err(invalid(
                "wedge.divisor",
                w.divisor,
                &format!("a whole number from 1 to {}", CLASSES.len() - 1),
            ));
        }
        above("wedge.reflectance", w.reflectance, 0.0, 1.0)?;
        let [x, y, z] = self.light.position;
        w.check_between("light.position", [x, y], &[x, y, z])?;
        let ([cx, cy], [wx, wy]) = (self.floor.center, self.floor.half_width);
        for (sx, sy) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let corner = [cx + sx * wx, cy + sy * wy];
            w.check_between("floor.center", corner, &self.floor.center)?;
        }
        w.check_frame(camera)
    }
}

/// Mirrors on the half-planes at the polar angles 0 and π/m about the z axis, unbounded upwards and outwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MirrorWedge {
    /// m: the wedge has the angle π/m.
    pub divisor: u32,
    /// Specular reflectance R of both mirrors.
    pub reflectance: f64,
}

impl MirrorWedge {
    fn check_between(&self, key: &str, [x, y]: [f64; 2], shown: &[f64]) -> Checked {
        let opening = core::f64::consts::PI / f64::from(self.divisor);
        let inside = y.min(x * sin(opening) - y * cos(opening));
        if inside > 1e-9 * libm::hypot(x, y) {
            return Ok(());
        }
        let degrees = 180.0 / f64::from(self.divisor);
        Err(invalid(
            key,
            format!("{shown:?}"),
            &format!("what is wholly between the mirrors at the polar angles 0 and {degrees}°"),
        ))
    }

    /// The wedge is convex: what a ray meets first is the floor if pinhole and floor point are between the mirrors, and
    /// that holds for all of the frame if it does for its corners.
    fn check_frame(&self, camera: &Camera) -> Checked {
        let [x, y, z] = camera.position;
        self.check_between("camera.position", [x, y], &camera.position)?;
        let film = Film::new(camera);
        let (w, h) = (f64::from(film.width), f64::from(film.height));
        for (u, v) in [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)] {
            let d = film.direction(u, v);
            within("camera.look_at", -d.z / d.length(), 1e-6, 1.0).map_err(|_| {
                invalid(
                    "camera.look_at",
                    format!("{:?}", camera.look_at),
                    "a frame below the horizon",
                )
            })?;
            let t = z / -d.z;
            let point = [x + d.x * t, y + d.y * t];
            self.check_between("camera.look_at", point, &camera.look_at)?;
        }
        Ok(())
    }
}
