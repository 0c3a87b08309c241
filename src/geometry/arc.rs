//! A vertical arc of a circular cylinder standing on the floor: its inner side reflects, its outer side absorbs, both
//! block.
//!
//! A ray enters the full cylinder at the smaller root of |o + t d|² = a² (in plan), where it meets the outer side, and
//! leaves it at the larger root, where it meets the inner side. The arc is at most 60° to either side of +x, so a point
//! of the circle belongs to it where x ≥ a cos(half arc). Light and camera are such that no ray meets the inner side
//! twice (the entry's validation proves it), so nothing is asked again after a reflection.

use glam::DVec3;
use nephroid_analytic::scene::ArcWall;

use super::specular::{Meeting, Specular, reflected};

/// The wall, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    radius: f64,
    height: f64,
    /// The arc is where x is at least this [m].
    x_min: f64,
    half_chord: f64,
    reflectance: f64,
}

impl Arc {
    /// Prepares a validated wall; `reflectance` replaces the scene's own.
    pub fn new(wall: &ArcWall, reflectance: f64) -> Self {
        let half_arc = wall.half_arc_degrees.to_radians();
        Arc {
            radius: wall.radius,
            height: wall.height,
            x_min: wall.radius * libm::cos(half_arc),
            half_chord: wall.radius * libm::sin(half_arc),
            reflectance,
        }
    }

    /// Ray parameters at the outer and the inner side, infinite where the wall is not met.
    #[inline(always)]
    fn crossings(&self, o: DVec3, d: DVec3) -> (f64, f64) {
        let a = d.x * d.x + d.y * d.y;
        let b = o.x * d.x + o.y * d.y;
        let c = o.x * o.x + o.y * o.y - self.radius * self.radius;
        // NaN, and thus no meeting, where the ray misses the circle or is vertical.
        let root = f64::sqrt(b * b - a * c);
        // The root in which nothing cancels, then the other from their product c/a.
        let q = if b < 0.0 { root - b } else { -(root + b) };
        let (first, second) = (q / a, c / q);
        let (outer, inner) = if b < 0.0 {
            (second, first)
        } else {
            (first, second)
        };
        let on_wall = |t: f64| {
            let (x, z) = (o.x + d.x * t, o.z + d.z * t);
            let met = (t > 0.0) & (x >= self.x_min) & (z >= 0.0) & (z <= self.height);
            if met { t } else { f64::INFINITY }
        };
        (on_wall(outer), on_wall(inner))
    }
}

impl Specular for Arc {
    const MEETS_ITSELF: bool = true;

    fn hull(&self) -> Vec<DVec3> {
        let mut corners = Vec::with_capacity(8);
        for x in [self.x_min, self.radius] {
            for y in [-self.half_chord, self.half_chord] {
                corners.extend([0.0, self.height].map(|z| DVec3::new(x, y, z)));
            }
        }
        corners
    }

    #[inline(always)]
    fn meet(&self, origin: DVec3, direction: DVec3) -> Meeting {
        let (outer, inner) = self.crossings(origin, direction);
        let reflects = inner < outer;
        let t = if reflects { inner } else { outer };
        let point = origin + direction * t;
        let normal = DVec3::new(point.x, point.y, 0.0) / self.radius;
        Meeting {
            t,
            point,
            direction: reflected(direction, normal),
            weight: if reflects { self.reflectance } else { 0.0 },
        }
    }

    #[inline(always)]
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let (outer, inner) = self.crossings(origin, direction);
        (outer < t_end) | (inner < t_end)
    }

    fn normal_after(&self, meeting: &Meeting) -> DVec3 {
        DVec3::new(-meeting.point.x, -meeting.point.y, 0.0) / self.radius
    }

    fn again(&self, point: DVec3, direction: DVec3) -> f64 {
        // The ray comes in where it starts; it can only go out.
        let (_, inner) = self.crossings(point, direction);
        inner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HALF_ARC: f64 = 50.0;

    fn wall() -> Arc {
        let wall = ArcWall {
            radius: 1.2,
            height: 0.6,
            half_arc_degrees: HALF_ARC,
            reflectance: 0.9,
        };
        Arc::new(&wall, wall.reflectance)
    }

    fn at(degrees: f64, z: f64) -> DVec3 {
        let (s, c) = libm::sincos(degrees.to_radians());
        DVec3::new(1.2 * c, 1.2 * s, z)
    }

    #[test]
    fn the_inner_side_reflects_with_equal_angles() {
        let wall = wall();
        for (origin, degrees, z) in [
            (DVec3::new(-2.0, 0.3, 1.5), 20.0, 0.3),
            (DVec3::new(0.1, -0.4, 0.0), -49.9, 0.59),
            (DVec3::new(0.1, -0.4, 0.0), 0.0, 0.0),
        ] {
            let target = at(degrees, z);
            let m = wall.meet(origin, target - origin);
            assert!((m.point - target).length() < 1e-12 && m.weight == 0.9);
            // In plan the direction turns by π - 2i about the vertical; its slope stays.
            let (d, normal) = (target - origin, at(degrees, 0.0) / 1.2);
            assert!((m.direction.dot(normal) + d.dot(normal)).abs() < 1e-12);
            assert!((m.direction.z - d.z).abs() < 1e-15);
            let tangent = DVec3::new(-normal.y, normal.x, 0.0);
            assert!((m.direction.dot(tangent) - d.dot(tangent)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_outer_side_absorbs_and_what_is_no_wall_lets_pass() {
        let wall = wall();
        let outside = DVec3::new(3.0, 0.1, 0.2);
        let m = wall.meet(outside, at(5.0, 0.3) - outside);
        assert!((m.t - 1.0).abs() < 1e-12 && m.weight == 0.0);
        let inside = DVec3::new(0.1, 0.2, 0.1);
        for target in [
            at(HALF_ARC + 0.1, 0.3),
            at(-HALF_ARC - 0.1, 0.3),
            at(10.0, 0.61),
            at(180.0, 0.3),
        ] {
            let d = target - inside;
            assert_eq!(wall.meet(inside, d).t, f64::INFINITY);
            assert!(!wall.blocks(inside, d, f64::INFINITY));
        }
        let d = at(10.0, 0.3) - inside;
        assert!(wall.blocks(inside, d, 1.1) && !wall.blocks(inside, d, 0.9));
        assert!(wall.blocks(outside, at(5.0, 0.3) - outside, f64::INFINITY));
        // Over the rim of the near side onto the inner side of the far one there is none: the arc is less than half.
        assert_eq!(
            wall.meet(inside, DVec3::new(0.0, 0.0, 1.0)).t,
            f64::INFINITY
        );
        assert_eq!(
            wall.meet(DVec3::new(5.0, 5.0, 0.1), DVec3::new(1.0, 0.0, 0.0))
                .t,
            f64::INFINITY
        );
    }
}
