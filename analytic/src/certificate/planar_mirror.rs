//! A flat mirror over a floor, under a point light: the mirror image of the light. Theory block B.

use crate::certificate::radiometry::{Bundle, Facing, Point, point_light_enclosed};
use crate::certificate::scene::Seen;
use crate::certificate::{Certified, Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::optics::reflect;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// A flat mirror, unbounded or a rectangle, over the floor z = 0.
#[derive(Clone, Copy, Debug)]
pub struct PlanarMirror {
    light: Point,
    intensity: Enclosure,
    reflectance: Enclosure,
    point: Point,
    normal: Point,
    extent: Option<Extent>,
}

#[derive(Clone, Copy, Debug)]
struct Extent {
    edge: Point,
    other: Point,
    half_width: Enclosure,
    half_height: Enclosure,
}

/// A vector over its length.
fn unit(v: Point) -> Point {
    v * (Enclosure::ONE / v.length())
}

impl PlanarMirror {
    /// The mirror of `light`, `I`, `R`, `mirror_point`, `mirror_normal`, and, if it is clipped, `extent.edge`,
    /// `extent.half_width`, `extent.half_height`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let mirror = PlanarMirror {
            light: p.point("light")?,
            intensity: p.number("I")?,
            reflectance: p.number("R")?,
            point: p.point("mirror_point")?,
            normal: unit(p.point("mirror_normal")?),
            extent: None,
        };
        if !p.has("extent.half_width") {
            return Some(mirror);
        }
        Some(mirror.clipped(
            p.point("extent.edge")?,
            p.number("extent.half_width")?,
            p.number("extent.half_height")?,
        ))
    }

    /// The same mirror, clipped to a rectangle around its point, with `half_width` along `edge`.
    pub fn clipped(self, edge: Point, half_width: Enclosure, half_height: Enclosure) -> Self {
        let edge = unit(edge);
        PlanarMirror {
            extent: Some(Extent {
                edge,
                other: self.normal.cross(edge),
                half_width,
                half_height,
            }),
            ..self
        }
    }

    fn side(&self, x: Point) -> Enclosure {
        (x - self.point).dot(self.normal)
    }

    /// Whether a point of the mirror's plane is on the mirror.
    fn holds(&self, at: Point) -> Lit {
        let Some(extent) = self.extent else {
            return Lit::Yes;
        };
        let d = at - self.point;
        Lit::where_not_negative(extent.half_width - d.dot(extent.edge).abs()).and(
            Lit::where_not_negative(extent.half_height - d.dot(extent.other).abs()),
        )
    }

    /// Irradiance of a floor point by the image of the light, and whether the mirror shows it.
    pub fn caustic_enclosed(&self, x: Point) -> Bundle {
        let image = self.point + reflect(self.light - self.point, self.normal);
        let (near, far) = (self.side(x), self.side(self.light));
        let (e, above) = point_light_enclosed(image, self.intensity, x, Facing::Up);
        let at = x + (image - x) * (near / (near + far));
        let lit = above
            .and(Lit::where_positive(near))
            .and(Lit::where_positive(far))
            .and(self.holds(at));
        Bundle::single(self.reflectance * e, lit)
    }

    /// Direct irradiance; the mirror's plane occludes where the mirror is.
    pub fn direct_enclosed(&self, x: Point) -> Certified {
        let (e, above) = point_light_enclosed(self.light, self.intensity, x, Facing::Up);
        let (near, far) = (self.side(x), self.side(self.light));
        let same = Lit::where_positive(near * far);
        let at = x + (self.light - x) * (near / (near - far));
        let blocked = same.inverted().and(self.holds(at));
        let mut sum = Certified::NONE;
        sum.add(e, above.and(blocked.inverted()));
        sum
    }

    /// The floor point that the camera sees in the mirror.
    pub fn look_enclosed(&self, camera: Point, aim: Point) -> Seen {
        let ray = aim - camera;
        let (height, approach) = (self.side(camera), -ray.dot(self.normal));
        let hit = camera + ray * (height / approach);
        let reflected = reflect(ray, self.normal);
        let floor = hit - reflected * (hit.z / reflected.z);
        let lit = Lit::where_positive(height)
            .and(Lit::where_positive(approach))
            .and(self.holds(hit))
            .and(Lit::where_not_negative(hit.z))
            .and(Lit::where_positive(-reflected.z));
        Seen {
            weight: self.reflectance,
            transmittance: None,
            at: vec3(floor.x, floor.y, Enclosure::ZERO),
            arrives: lit,
        }
    }
}
