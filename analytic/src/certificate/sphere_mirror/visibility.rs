//! What the cap of a spherical mirror lets pass, and what a camera sees in it. Every decision in three values.

use super::{Light, SphereMirror, length, unit};
use crate::certificate::radiometry::{Facing, Point, point_light_enclosed};
use crate::certificate::scene::Seen;
use crate::certificate::{Certified, Lit};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

impl SphereMirror {
    /// Whether there is a mirror in a direction from the centre.
    fn on_cap(&self, normal: Point) -> Lit {
        match self.cap {
            None => Lit::Yes,
            Some(least) => Lit::where_not_negative(normal.dot(self.cap_axis) - least),
        }
    }

    /// Whether the mirror is there and, from inside, its far side in the way of neither leg.
    pub(super) fn free(&self, normal: Point, receiver: Point) -> Lit {
        let mut lit = self.on_cap(normal);
        if !self.concave {
            // Both legs stay in front of the tangent plane.
            return lit;
        }
        let source = match self.light {
            Light::Point(position, _) => {
                let leg = self.scaled(position) - normal;
                (unit(leg), Some(length(leg)))
            }
            Light::Beam(direction, _) => (-direction, None),
        };
        let leg = receiver - normal;
        for (direction, reach) in [source, (unit(leg), Some(length(leg)))] {
            let chord = -Enclosure::TWO * normal.dot(direction);
            let short = reach.map_or(Lit::No, |reach| Lit::where_not_negative(chord - reach));
            lit = lit.and(short.or(self.on_cap(normal + direction * chord).inverted()));
        }
        lit
    }

    /// Direct light at the receiver point (x, y), in the shadow of the mirror or not.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let x = vec3(x.x, x.y, self.receiver_z);
        let start = self.scaled(x);
        let (e, lit, direction, reach) = match self.light {
            Light::Point(position, intensity) => {
                let (e, lit) = point_light_enclosed(position, intensity, x, Facing::Up);
                let leg = self.scaled(position) - start;
                (e, lit, unit(leg), Some(length(leg)))
            }
            Light::Beam(direction, irradiance) => (
                irradiance * -direction.z,
                Lit::where_positive(-direction.z),
                -direction,
                None,
            ),
        };
        let mut sum = Certified::NONE;
        sum.add(e, lit.and(self.blocks(start, direction, reach).inverted()));
        sum
    }

    /// Whether the mirror meets a segment of a length, or a ray.
    fn blocks(&self, start: Point, direction: Point, reach: Option<Enclosure>) -> Lit {
        let Some((ahead, half, through)) = chord(start, direction) else {
            return Lit::No;
        };
        let at = |t: Enclosure| {
            let within = reach.map_or(Lit::Yes, |reach| Lit::where_positive(reach - t));
            Lit::where_positive(t)
                .and(within)
                .and(self.on_cap(start + direction * t))
        };
        through.and(at(ahead - half).or(at(ahead + half)))
    }

    /// The receiver point that the camera sees after one reflection at the front.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Seen {
        let start = self.scaled(camera);
        let ray = unit(aim - camera);
        let dark = Seen {
            weight: Enclosure::ZERO,
            transmittance: None,
            at: camera,
            arrives: Lit::No,
        };
        let Some((ahead, half, through)) = chord(start, ray) else {
            return dark;
        };
        let met = |t: Enclosure| Lit::where_positive(t).and(self.on_cap(start + ray * t));
        let (enter, exit) = (ahead - half, ahead + half);
        let (to_hit, hits) = if self.concave {
            (exit, met(exit).and(met(enter).inverted()))
        } else {
            (enter, met(enter))
        };
        let normal = start + ray * to_hit;
        let cosine = ray.dot(normal);
        let reflected = ray - normal * (Enclosure::TWO * cosine);
        let height = normal.z - (self.receiver_z - self.centre.z) / self.radius;
        let rest = -height / reflected.z;
        let mut arrives = through
            .and(hits)
            .and(Lit::where_positive(-reflected.z))
            .and(Lit::where_not_negative(height));
        if self.concave {
            let chord = Enclosure::TWO * half;
            let short = Lit::where_not_negative(chord - rest);
            let open = self.on_cap(normal + reflected * chord).inverted();
            arrives = arrives.and(short.or(open));
        }
        let point = self.centre + (normal + reflected * rest) * self.radius;
        Seen {
            weight: self.reflectance,
            transmittance: None,
            at: vec3(point.x, point.y, self.receiver_z),
            arrives,
        }
    }
}

/// Where a ray is next to the centre of the unit sphere, half the length of its chord, and whether there is one; `None` if
/// there certainly is not.
fn chord(start: Point, direction: Point) -> Option<(Enclosure, Enclosure, Lit)> {
    let across = length(start.cross(direction));
    let squared = (Enclosure::ONE - across) * (Enclosure::ONE + across);
    let through = Lit::where_positive(squared);
    (through != Lit::No).then(|| (-start.dot(direction), squared.sqrt(), through))
}
