//! What a camera ray sees in the wall, every decision on its way certain or the view undecided.

use super::CylinderCup;
use crate::certificate::Lit;
use crate::certificate::radiometry::{Point, plan_squared, power_enclosed};
use crate::certificate::scene::Seen;
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

impl CylinderCup {
    /// The floor point that the ray from `camera` through `aim` reaches after 1 to `max_bounces` reflections.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Seen {
        let a = self.radius;
        let ray = aim - camera;
        let plan = plan_squared(ray.x, ray.y).sqrt();
        let slope = ray.z / plan;
        let (mut dx, mut dy) = (ray.x / plan, ray.y / plan);
        let across = camera.x * dy - camera.y * dx;
        let ahead = camera.x * dx + camera.y * dy;
        let half_squared = (a - across) * (a + across);
        let half = half_squared.sqrt();
        let (enter, exit) = (-ahead - half, half - ahead);
        let hit = vec3(
            camera.x + exit * dx,
            camera.y + exit * dy,
            camera.z + slope * exit,
        );
        // From outside the ray comes in through the opening or over the rim.
        let entry_z = camera.z + slope * enter;
        let free = Lit::where_not_negative(entry_z).and(
            self.covers((camera.x + enter * dx) / a)
                .and(self.reaches(entry_z))
                .inverted(),
        );
        let inside = Lit::where_positive(-enter);
        let mut arrives = Lit::where_positive(-slope)
            .and(Lit::where_positive(half_squared))
            .and(inside.or(free))
            .and(Lit::where_positive(exit))
            .and(Lit::where_not_negative(hit.z))
            .and(self.covers(hit.x / a))
            .and(self.reaches(hit.z));
        let chord = Enclosure::TWO * half;
        let (mut px, mut py, mut rest) = (hit.x, hit.y, -hit.z / slope);
        for bounces in 1..=self.max_bounces {
            let (nx, ny) = (px / a, py / a);
            let normal = Enclosure::TWO * (dx * nx + dy * ny);
            (dx, dy) = (dx - normal * nx, dy - normal * ny);
            let (end_x, end_y) = (px + chord * dx, py + chord * dy);
            let ends = Lit::where_not_negative(chord - rest).or(self.covers(end_x / a).inverted());
            if ends != Lit::No {
                arrives = arrives.and(ends);
                return Seen {
                    weight: power_enclosed(self.reflectance, bounces),
                    transmittance: None,
                    at: vec3(px + rest * dx, py + rest * dy, Enclosure::ZERO),
                    arrives,
                };
            }
            (px, py, rest) = (end_x, end_y, rest - chord);
        }
        Seen {
            weight: Enclosure::ZERO,
            transmittance: None,
            at: camera,
            arrives: Lit::No,
        }
    }
}
