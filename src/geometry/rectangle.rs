//! A flat rectangular mirror: reflects on its front, absorbs on its back, blocks from both sides.

use glam::DVec3;
use nephroid_analytic::scene::RectangleMirror;

use super::scene::unit;
use super::specular::{Meeting, Specular, reflected};

/// The mirror, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    center: DVec3,
    normal: DVec3,
    /// Unit vectors along the edges, divided by the half extents: inside means both coordinates in [-1, 1].
    across: DVec3,
    along: DVec3,
    /// Unit edges times half extents.
    half_across: DVec3,
    half_along: DVec3,
    reflectance: f64,
}

impl Rectangle {
    /// Prepares a validated mirror; `reflectance` replaces the scene's own.
    pub fn new(mirror: &RectangleMirror, reflectance: f64) -> Self {
        let normal = unit(DVec3::from_array(mirror.normal));
        let across = unit(DVec3::from_array(mirror.edge));
        let along = unit(normal.cross(across));
        Rectangle {
            center: DVec3::from_array(mirror.center),
            normal,
            across: across / mirror.half_width,
            along: along / mirror.half_height,
            half_across: across * mirror.half_width,
            half_along: along * mirror.half_height,
            reflectance,
        }
    }

    /// Ray parameter and whether the ray meets the rectangle there.
    #[inline(always)]
    fn crossing(&self, origin: DVec3, direction: DVec3) -> (f64, bool) {
        let t = (self.center - origin).dot(self.normal) / direction.dot(self.normal);
        let p = origin + direction * t - self.center;
        let inside = (f64::abs(p.dot(self.across)) <= 1.0) & (f64::abs(p.dot(self.along)) <= 1.0);
        (t, inside & (t > 0.0))
    }
}

impl Specular for Rectangle {
    fn hull(&self) -> Vec<DVec3> {
        let (a, b) = (self.half_across, self.half_along);
        [-a - b, a - b, b - a, a + b]
            .map(|corner| self.center + corner)
            .to_vec()
    }

    #[inline(always)]
    fn meet(&self, origin: DVec3, direction: DVec3) -> Meeting {
        let (t, met) = self.crossing(origin, direction);
        let front = direction.dot(self.normal) < 0.0;
        Meeting {
            t: if met { t } else { f64::INFINITY },
            point: origin + direction * t,
            direction: reflected(direction, self.normal),
            weight: if met & front { self.reflectance } else { 0.0 },
        }
    }

    #[inline(always)]
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let (t, met) = self.crossing(origin, direction);
        met & (t < t_end)
    }
}
