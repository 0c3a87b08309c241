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

    fn normal_after(&self, _: &Meeting) -> DVec3 {
        self.normal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted() -> (RectangleMirror, Rectangle) {
        let mirror = RectangleMirror {
            center: [1.5, 0.3, 1.0],
            normal: [-1.6, 0.0, -1.2],
            edge: [0.0, 3.0, 0.0],
            half_width: 0.5,
            half_height: 0.4,
            reflectance: 0.8,
        };
        (mirror.clone(), Rectangle::new(&mirror, mirror.reflectance))
    }

    #[test]
    fn a_ray_is_reflected_as_if_it_came_from_the_image() {
        let (mirror, r) = tilted();
        let n = DVec3::new(-0.8, 0.0, -0.6);
        let center = DVec3::from_array(mirror.center);
        let origin = DVec3::new(0.2, -0.1, 0.4);
        let image = origin - n * (2.0 * (origin - center).dot(n));
        let target = center + DVec3::new(0.0, 0.2, 0.0) + DVec3::new(0.6, 0.0, -0.8) * 0.3;
        let m = r.meet(origin, target - origin);
        assert!((m.t - 1.0).abs() < 1e-14 && (m.point - target).length() < 1e-14);
        assert_eq!(m.weight, 0.8);
        assert!(m.direction.cross(target - image).length() < 1e-14);
        assert!(m.direction.dot(target - image) > 0.0);
    }

    #[test]
    fn the_back_absorbs_and_both_sides_block() {
        let (mirror, r) = tilted();
        let center = DVec3::from_array(mirror.center);
        let n = DVec3::new(-0.8, 0.0, -0.6);
        let back = r.meet(center - n, n);
        assert_eq!((back.t, back.weight), (1.0, 0.0));
        for (o, d) in [(center - n, n), (center + n, -n)] {
            assert!(r.blocks(o, d, 1.5) && !r.blocks(o, d, 0.9) && !r.blocks(o, -d, 9.0));
        }
        // Beyond the edges, and parallel to the plane.
        let off = DVec3::new(0.0, 0.51, 0.0);
        assert_eq!(r.meet(center + n + off, -n).t, f64::INFINITY);
        let off = DVec3::new(0.6, 0.0, -0.8) * 0.41;
        assert_eq!(r.meet(center + n + off, -n).t, f64::INFINITY);
        assert!(!r.blocks(center + n, DVec3::new(0.0, 1.0, 0.0), f64::INFINITY));
    }
}
