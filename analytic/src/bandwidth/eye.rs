//! What the eye sees of the floor through a film point: directly, through flat water, in a plane mirror or in a cylindrical wall.
//!
//! Two questions, apart on purpose. [`Eye::look`] is the way of the ray if every surface went on for ever: smooth across the edges of
//! what is seen, so that an interpolant may use it on both sides. [`Eye::sees`] is whether the scene has that path, edges, clipping and
//! what stands in between included: yes or no.

use super::Technique;
use super::light::unknown;
use crate::camera::Film;
use crate::class::PathClass;
use crate::kinds::cylinder_cup::CylinderCup;
use crate::optics::fresnel_transmittance;
use crate::scene::{Entry, Floor, InvalidParameter, Kind, RectangleMirror};
use crate::vector::{Vec3, vec3};

/// How the eye sees the floor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Way {
    /// Straight, past what stands on the floor.
    Direct(Option<Standing>),
    /// Through a flat surface at a height, into this index.
    Water { height: f64, index: f64 },
    /// By what stands on the floor, reflected once.
    Mirror(Standing),
}

/// A mirror in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Standing {
    Plane(Rectangle),
    Wall(CylinderCup<f64>),
}

/// A rectangle with unit vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    center: Vec3<f64>,
    normal: Vec3<f64>,
    axes: [(Vec3<f64>, f64); 2],
    reflectance: f64,
}

/// The eye's side of the paths of a class.
#[derive(Clone, Debug)]
pub(super) struct Eye {
    pub(super) film: Film,
    pub(super) way: Way,
    center: [f64; 2],
    half_width: [f64; 2],
}

impl Eye {
    /// The eye of a class of an entry with this floor.
    ///
    /// # Errors
    /// A kind of which the eye sees the floor in a way that is not known here.
    pub fn new(
        entry: &Entry,
        floor: &Floor,
        class: PathClass,
        technique: Technique,
    ) -> Result<Self, InvalidParameter> {
        let standing = match &entry.kind {
            Kind::PlanarMirror(s) => Some(Standing::Plane(Rectangle::new(&s.mirror))),
            Kind::CylinderCup(s) => {
                Some(Standing::Wall(CylinderCup::from_entry(&s.light, &s.wall)))
            }
            _ => None,
        };
        let way = match (&entry.kind, class.eye.len(), standing) {
            (Kind::FlatInterface(s), 1, _) => Way::Water {
                height: s.water.surface_z,
                index: s.water.index,
            },
            (_, 0, standing) => Way::Direct(standing),
            (_, 1, Some(standing)) => Way::Mirror(standing),
            _ => return Err(unknown(&entry.kind, technique)),
        };
        Ok(Eye {
            film: Film::new(&entry.camera),
            way,
            center: floor.center,
            half_width: floor.half_width,
        })
    }

    /// The floor point that a film point would show if all surfaces were unbounded and nothing were in the way, and the weight on
    /// that way. Not finite where there is none.
    pub fn look(&self, u: f64, v: f64) -> ([f64; 2], f64) {
        let (origin, d) = (self.film.position, self.film.direction(u, v));
        match &self.way {
            Way::Direct(_) => (on_floor(origin, d), 1.0),
            Way::Water { height, index } => {
                let at = origin + d * ((height - origin.z) / d.z);
                let unit = d.normalized();
                let c = -unit.z;
                let q = libm::sqrt(index * index - (1.0 - c) * (1.0 + c));
                let weight = fresnel_transmittance(1.0, c, *index, q) / (index * index);
                (on_floor(at, vec3(unit.x, unit.y, -q)), weight)
            }
            Way::Mirror(Standing::Plane(mirror)) => {
                let (at, out) = mirror.reflected(origin, d);
                (on_floor(at, out), mirror.reflectance)
            }
            Way::Mirror(Standing::Wall(cup)) => {
                let [_, out] = crossings(cup.wall.radius, origin, d);
                let at = origin + d * out;
                let n = vec3(at.x, at.y, 0.0) * (1.0 / cup.wall.radius);
                (on_floor(at, d - n * (2.0 * d.dot(n))), cup.reflectance)
            }
        }
    }

    /// Whether the scene has the path of [`Self::look`].
    pub fn sees(&self, u: f64, v: f64) -> bool {
        let (x, weight) = self.look(u, v);
        let is_on = |k: usize| f64::abs(x[k] - self.center[k]) <= self.half_width[k];
        if !(is_on(0) && is_on(1) && weight > 0.0) {
            return false;
        }
        let (origin, d) = (self.film.position, self.film.direction(u, v));
        if !(d.z < 0.0) {
            return false;
        }
        match &self.way {
            Way::Direct(standing) => !standing.is_some_and(|s| s.hides(origin, d)),
            Way::Water { height, .. } => origin.z > *height,
            Way::Mirror(Standing::Plane(mirror)) => mirror.shows(origin, d),
            Way::Mirror(Standing::Wall(cup)) => cup
                .look(origin, origin + d, 1)
                .is_some_and(|s| s.bounces == 1),
        }
    }
}

/// Where a ray meets the floor.
fn on_floor(origin: Vec3<f64>, d: Vec3<f64>) -> [f64; 2] {
    let t = origin.z / -d.z;
    [origin.x + d.x * t, origin.y + d.y * t]
}

/// Ray parameters at which a ray comes into a circle about the z axis in plan, and out of it; NaN where it does not.
fn crossings(radius: f64, origin: Vec3<f64>, d: Vec3<f64>) -> [f64; 2] {
    let a = d.x * d.x + d.y * d.y;
    let b = origin.x * d.x + origin.y * d.y;
    let across = origin.x * d.y - origin.y * d.x;
    let half = libm::sqrt(radius * radius * a - across * across);
    [(-b - half) / a, (half - b) / a]
}

impl Standing {
    /// Whether it stands between the eye and the floor on a ray that goes down.
    fn hides(&self, origin: Vec3<f64>, d: Vec3<f64>) -> bool {
        let end = origin.z / -d.z;
        match self {
            Standing::Plane(mirror) => {
                let t = mirror.height(origin) / -d.dot(mirror.normal);
                t > 0.0 && t < end && mirror.has(origin + d * t)
            }
            Standing::Wall(cup) => {
                let wall = &cup.wall;
                crossings(wall.radius, origin, d).into_iter().any(|t| {
                    let p = origin + d * t;
                    t > 0.0 && t < end && wall.covers(p.x / wall.radius) && wall.reaches(p.z)
                })
            }
        }
    }
}

impl Rectangle {
    fn new(mirror: &RectangleMirror) -> Self {
        let normal = Vec3::from_f64(mirror.normal).normalized();
        let edge = Vec3::from_f64(mirror.edge).normalized();
        Rectangle {
            center: Vec3::from_f64(mirror.center),
            normal,
            axes: [
                (edge, mirror.half_width),
                (normal.cross(edge), mirror.half_height),
            ],
            reflectance: mirror.reflectance,
        }
    }

    /// The mirror image of a point.
    pub(super) fn image(&self, p: Vec3<f64>) -> Vec3<f64> {
        p - self.normal * (2.0 * self.height(p))
    }

    fn height(&self, p: Vec3<f64>) -> f64 {
        (p - self.center).dot(self.normal)
    }

    /// Whether a point of the plane is in the rectangle.
    fn has(&self, p: Vec3<f64>) -> bool {
        let is_in = |(axis, half): &(Vec3<f64>, f64)| (p - self.center).dot(*axis).abs() <= *half;
        self.axes.iter().all(is_in)
    }

    /// The point of the plane that a ray meets, and its direction after.
    fn reflected(&self, origin: Vec3<f64>, d: Vec3<f64>) -> (Vec3<f64>, Vec3<f64>) {
        let along = d.dot(self.normal);
        let at = origin + d * (self.height(origin) / -along);
        (at, d - self.normal * (2.0 * along))
    }

    /// Whether a ray meets the front before it meets the floor, and goes down from there.
    fn shows(&self, origin: Vec3<f64>, d: Vec3<f64>) -> bool {
        let (at, out) = self.reflected(origin, d);
        let is_front = self.height(origin) > 0.0 && d.dot(self.normal) < 0.0;
        is_front && at.z >= 0.0 && out.z < 0.0 && self.has(at)
    }
}
