//! A flat mirror over a floor, under a point light.
//!
//! The mirror through m with unit normal n shows the light y at y' = y - 2((y - m)·n) n, and the floor point x is lit as
//! by a light of intensity R I at y':
//!
//! ```text
//! E_LSDE = R I (y' - x)_z / |y' - x|³,      E_LDE = I (y - x)_z / |y - x|³,
//! ```
//!
//! if light and point are in front of the mirror and the segment x y' crosses it inside its rectangle. The mirror
//! occludes: a point behind it has no direct light where the segment x y crosses the rectangle. Theory block B. No
//! singularity. **Accuracy**: a few units of rounding times the size of the coordinates over |y' - x|.

use crate::kinds::{Estimate, rounding_error};
use crate::optics::reflect;
use crate::scalar::Scalar;
use crate::scene::{PointLight, RectangleMirror};
use crate::vector::{Vec3, vec3};

/// The rectangle that a mirror is clipped to, centred at the mirror's point.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle<S> {
    /// Unit vector along one edge.
    pub edge: Vec3<S>,
    /// Unit vector along the other edge, normal × edge.
    pub other: Vec3<S>,
    /// Half of the extent along `edge` [m].
    pub half_width: S,
    /// Half of the extent along `other` [m].
    pub half_height: S,
}

/// A flat mirror with its light.
#[derive(Clone, Copy, Debug)]
pub struct PlanarMirror<S> {
    /// Position of the light [m].
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Specular reflectance R.
    pub reflectance: S,
    /// A point of the mirror [m]: its centre if it is clipped.
    pub point: Vec3<S>,
    /// Unit normal of the front.
    pub normal: Vec3<S>,
    /// The clipping rectangle; `None` for an unbounded mirror.
    pub extent: Option<Rectangle<S>>,
    image: Vec3<S>,
}

/// The reflection that lights a floor point.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    /// Where the mirror reflects [m].
    pub specular_point: Vec3<S>,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the coordinates.
    pub conditioning: S,
    /// How far inside the rectangle the specular point is [m], negative outside; infinite without a rectangle.
    pub inside: S,
}

/// A floor point seen in the mirror.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Where the ray meets the mirror [m].
    pub first_hit: Vec3<S>,
    /// The floor point [m].
    pub floor: Vec3<S>,
    /// Bound of the rounding error of the floor point [m].
    pub error: S,
}

impl PlanarMirror<f64> {
    /// The mirror of a catalogue entry.
    pub fn from_entry(light: &PointLight, mirror: &RectangleMirror) -> Self {
        let normal = Vec3::from_f64(mirror.normal).normalized();
        let edge = Vec3::from_f64(mirror.edge).normalized();
        let extent = Rectangle {
            edge,
            other: normal.cross(edge),
            half_width: mirror.half_width,
            half_height: mirror.half_height,
        };
        Self::new(
            Vec3::from_f64(light.position),
            light.intensity,
            mirror.reflectance,
            Vec3::from_f64(mirror.center),
            normal,
            Some(extent),
        )
    }
}

impl<S: Scalar> PlanarMirror<S> {
    /// A mirror through `point` with unit `normal`.
    pub fn new(
        light: Vec3<S>,
        intensity: S,
        reflectance: S,
        point: Vec3<S>,
        normal: Vec3<S>,
        extent: Option<Rectangle<S>>,
    ) -> Self {
        PlanarMirror {
            light,
            intensity,
            reflectance,
            point,
            normal,
            extent,
            image: point + reflect(light - point, normal),
        }
    }

    /// The mirror image of the light [m].
    #[inline(always)]
    pub fn image(&self) -> Vec3<S> {
        self.image
    }

    /// Signed distance from the mirror's plane, positive in front [m].
    #[inline(always)]
    pub fn side(&self, point: Vec3<S>) -> S {
        (point - self.point).dot(self.normal)
    }

    /// How far inside the rectangle a point of the plane is, negative outside [m].
    #[inline(always)]
    fn inside(&self, point: Vec3<S>) -> S {
        match &self.extent {
            None => S::ONE / S::ZERO,
            Some(r) => {
                let d = point - self.point;
                let u = r.half_width - d.dot(r.edge).abs();
                let v = r.half_height - d.dot(r.other).abs();
                u.min(v)
            }
        }
    }

    /// The reflection that lights `x` from above, whether inside the rectangle or not; `None` if light or point are
    /// behind the mirror, or the image is not above the point.
    #[inline(always)]
    pub fn reflection(&self, x: Vec3<S>) -> Option<Root<S>> {
        let to_image = self.image - x;
        let (near, far) = (self.side(x), self.side(self.light));
        if !(near > S::ZERO && far > S::ZERO && to_image.z > S::ZERO) {
            return None;
        }
        let specular_point = x + to_image * (near / (near + far));
        let distance_squared = to_image.length_squared();
        let distance = distance_squared.sqrt();
        let size = self.image.length() + x.length() + self.point.length();
        Some(Root {
            specular_point,
            irradiance: self.reflectance * self.intensity * to_image.z
                / (distance_squared * distance),
            conditioning: size * (S::ONE / to_image.z + S::from_f64(3.0) / distance),
            inside: self.inside(specular_point),
        })
    }

    /// Caustic irradiance at `x` [W/m²], without its error bound: for inner loops.
    #[inline(always)]
    pub fn caustic_value(&self, x: Vec3<S>) -> S {
        match self.reflection(x) {
            Some(root) if root.inside >= S::ZERO => root.irradiance,
            _ => S::ZERO,
        }
    }

    /// Caustic irradiance (LSDE) at `x` [W/m²].
    pub fn caustic(&self, x: Vec3<S>) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        if let Some(root) = self.reflection(x) {
            if root.inside >= S::ZERO {
                sum.add(root.irradiance, root.conditioning);
            }
            let size = self.image.length() + x.length() + self.point.length();
            if root.inside.abs() <= rounding_error(size, root.conditioning) {
                sum.error += root.irradiance;
            }
        }
        sum
    }

    /// Whether the mirror stands between the light and `x`, and how far from its edge the segment passes [m].
    #[inline(always)]
    pub fn shadow(&self, x: Vec3<S>) -> (bool, S) {
        let (near, far) = (self.side(x), self.side(self.light));
        if (near > S::ZERO) == (far > S::ZERO) {
            return (false, S::ONE / S::ZERO);
        }
        let crossing = x + (self.light - x) * (near / (near - far));
        let inside = self.inside(crossing);
        (inside >= S::ZERO, inside)
    }

    /// Direct irradiance (LDE) of a point facing up [W/m²].
    pub fn direct(&self, x: Vec3<S>) -> Estimate<S> {
        let (shadowed, inside) = self.shadow(x);
        let free = crate::kinds::diffuse::direct(self.light, self.intensity, x);
        let mut sum = if shadowed { Estimate::NONE } else { free };
        let size = self.light.length() + x.length() + self.point.length();
        if inside.abs() <= rounding_error(size, free.conditioning()) {
            sum.error += free.value;
        }
        sum
    }

    /// The point of the floor z = `floor_z` that the ray from `camera` through `aim` reaches after the mirror; `None` if
    /// the ray does not meet the front of the mirror or does not come down.
    pub fn look(&self, camera: Vec3<S>, aim: Vec3<S>, floor_z: S) -> Option<Seen<S>> {
        let ray = aim - camera;
        let (height, approach) = (self.side(camera), -ray.dot(self.normal));
        if !(height > S::ZERO && approach > S::ZERO) {
            return None;
        }
        let to_hit = height / approach;
        let first_hit = camera + ray * to_hit;
        let above = first_hit.z - floor_z;
        if !(self.inside(first_hit) >= S::ZERO && above >= S::ZERO) {
            return None;
        }
        let reflected = reflect(ray, self.normal);
        if !(reflected.z < S::ZERO) {
            return None;
        }
        let rest = -above / reflected.z;
        let floor = first_hit + reflected * rest;
        let size = camera.length() + aim.length() + self.point.length() + floor.length();
        let slant = ray.length() / approach + ray.length() / -reflected.z;
        let ratio = (S::ONE + slant) * (S::ONE + size / ray.length());
        Some(Seen {
            first_hit,
            floor: vec3(floor.x, floor.y, floor_z),
            error: S::EPSILON * S::from_f64(8.0) * size * ratio,
        })
    }
}
