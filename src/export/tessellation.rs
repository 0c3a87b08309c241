//! How far a mesh moves the light, and how fine it must be.
//!
//! **A measured estimate from two nested tessellations.** The mesh of half the cell size has a vertex in the middle of every edge
//! and every cell of this one, where it is the exact surface; the middle of the coarse mesh is at the distance δ from its foot on the
//! surface, and its interpolated normal turned by the angle ε from the normal there.
//! Both are O(h²), and largest in the middle. A ray of the light, and of the eye where it sees the surface, is then followed twice
//! to the floor: as at the exact surface, and with the point moved by δ along the ray and the normal turned by ε along both
//! tangents. The largest distance between the landings, in pixels of the camera and times the interactions of a chain, is the
//! displacement η.
//!
//! **A pixel's error.** A picture that is moved by η of a pixel loses and gains at most the light in a strip of that width along
//! the pixel's four sides: 4η of the brightest pixel next to it, or itself. At a fold that is within η of a side, √η takes the place
//! of η for that side. Inside a region the strips cancel.

use glam::DVec3;
use nephroid_analytic::camera::Film;

use super::mesh::Mesh;
use super::model::{Element, Light, Material, Model, Patch};
use crate::geometry::dielectric::refract;
use crate::geometry::scene::unit;
use crate::geometry::specular::reflected;

/// The displacement that a mesh may cause [pixels]: 4η is then a tenth of a margin of 1 %.
pub const ALLOWED: f64 = 2.5e-4;
/// The most triangles of a mesh.
pub const MOST_TRIANGLES: u32 = 2_100_000;
/// Cells that are looked at along each side.
const SAMPLES: u32 = 48;

/// A mesh and what it does to the image.
#[derive(Clone, Debug)]
pub struct Tessellated {
    /// The mesh.
    pub mesh: Mesh,
    /// Columns and rows of cells.
    pub cells: [u32; 2],
    /// Displacement η [pixels].
    pub displacement: f64,
    /// Relative error of irradiance where the surface itself is diffuse.
    pub shading: f64,
}

impl Tessellated {
    /// A pixel's error relative to the brightest of the pixel and its eight neighbours.
    pub fn pixel_error(&self) -> f64 {
        4.0 * self.displacement + self.shading
    }
}

/// Refines a patch until what it does to the image is allowed; the finest mesh that is not too large if that is never.
pub fn tessellate(model: &Model, patch: &Patch, material: Material) -> Tessellated {
    let mut cells = if patch.ruled { [128, 1] } else { [64, 64] };
    loop {
        let (displacement, shading) = estimate(model, patch, material, cells);
        let finer = if patch.ruled {
            [2 * cells[0], 1]
        } else {
            cells.map(|c| 2 * c)
        };
        let enough = displacement <= ALLOWED && shading <= 4.0 * ALLOWED;
        if enough || 2 * finer[0] * finer[1] > MOST_TRIANGLES {
            return Tessellated {
                mesh: Mesh::of(patch, cells),
                cells,
                displacement,
                shading,
            };
        }
        cells = finer;
    }
}

/// Displacement [pixels] and relative error of irradiance of a mesh.
fn estimate(
    model: &Model,
    patch: &Patch,
    material: Material,
    [columns, rows]: [u32; 2],
) -> (f64, f64) {
    let film = Film::new(&model.camera);
    let (mut displacement, mut shading) = (0.0_f64, 0.0_f64);
    let step = |cells: u32| cells.div_ceil(SAMPLES).max(1) as usize;
    for j in (0..rows).step_by(step(rows)) {
        for i in (0..columns).step_by(step(columns)) {
            let at = |di: f64, dj: f64| {
                let s = (f64::from(i) + di) / f64::from(columns);
                let t = (f64::from(j) + dj) / f64::from(rows);
                (s, t)
            };
            // Along s, along t, and the diagonal of the cell's two triangles.
            for [a, b] in [
                [(0.0, 0.0), (1.0, 0.0)],
                [(0.0, 0.0), (0.0, 1.0)],
                [(0.0, 0.0), (1.0, 1.0)],
            ] {
                let ends = [at(a.0, a.1), at(b.0, b.1)].map(|(s, t)| (patch.at)(s, t));
                let middle = at(0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
                let Some(off) = Off::of(patch, ends, middle) else {
                    continue;
                };
                if let Material::Lambert { .. } = material {
                    shading = shading.max(off.shading(model));
                } else {
                    displacement = displacement.max(off.displacement(model, material, &film));
                }
            }
        }
    }
    (displacement * model.longest_chain.max(1) as f64, shading)
}

/// What a mesh is off by in the middle of an edge.
struct Off {
    point: DVec3,
    normal: DVec3,
    /// Along the normal [m].
    height: f64,
    /// Of the normal [rad].
    angle: f64,
}

impl Off {
    /// What is told between two vertices, against the exact surface at the foot of the perpendicular from there, which is
    /// near the parameters `near`.
    fn of(patch: &Patch, [a, b]: [Element; 2], near: (f64, f64)) -> Option<Self> {
        let chord = 0.5 * (a.0 + b.0);
        if !((b.0 - a.0).length() > 0.0) {
            return None;
        }
        let (mut s, mut t) = near;
        for _ in 0..3 {
            let step = 1e-5;
            let along = |ds: f64, dt: f64| {
                let (p, q) = ((patch.at)(s + ds, t + dt).0, (patch.at)(s - ds, t - dt).0);
                (p - q) / (2.0 * step)
            };
            let (u, v) = (along(step, 0.0), along(0.0, step));
            let miss = chord - (patch.at)(s, t).0;
            let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
            let determinant = uu * vv - uv * uv;
            if !(determinant > 1e-12 * uu * vv) {
                break;
            }
            s += (vv * u.dot(miss) - uv * v.dot(miss)) / determinant;
            t += (uu * v.dot(miss) - uv * u.dot(miss)) / determinant;
        }
        let (point, normal) = (patch.at)(s, t);
        Some(Off {
            point,
            normal,
            height: (chord - point).length(),
            angle: (unit(a.1 + b.1) - normal).length(),
        })
    }

    /// Relative change of the irradiance of a diffuse surface.
    fn shading(&self, model: &Model) -> f64 {
        let Light::Point { position, .. } = model.light else {
            return self.angle;
        };
        let to_light = position - self.point;
        let distance = to_light.length();
        let cosine = (to_light.dot(self.normal) / distance).abs().max(1e-3);
        2.0 * self.height / distance + self.angle / cosine
    }

    /// The largest displacement [pixels] of light that the surface turns, and of what the eye sees in it.
    fn displacement(&self, model: &Model, material: Material, film: &Film) -> f64 {
        let from_light = match model.light {
            Light::Point { position, .. } => self.point - position,
            Light::Directional { travel, .. } => travel,
        };
        let from_eye = self.point - DVec3::from_array(model.camera.position);
        [unit(from_light), unit(from_eye)]
            .into_iter()
            .map(|incoming| self.moved(model, material, film, incoming))
            .fold(0.0, f64::max)
    }

    fn moved(&self, model: &Model, material: Material, film: &Film, incoming: DVec3) -> f64 {
        let Some(exact) = landing(model, material, self.point, incoming, self.normal) else {
            return 0.0;
        };
        let cosine = incoming.dot(self.normal).abs().max(1e-3);
        let tangent = unit(self.normal.any_orthonormal_vector());
        let other = self.normal.cross(tangent);
        let mut largest = 0.0_f64;
        for turn in [tangent, -tangent, other, -other] {
            for side in [-1.0, 1.0] {
                let point = self.point + incoming * (side * self.height / cosine);
                let normal = unit(self.normal + turn * self.angle);
                if let Some(moved) = landing(model, material, point, incoming, normal) {
                    largest = largest.max(pixels(film, exact, moved));
                }
            }
        }
        largest
    }
}

/// Where a ray lands on the floor's rectangle after it has been turned at a surface; `None` elsewhere, and where the surface
/// absorbs or passes on less than half.
fn landing(
    model: &Model,
    material: Material,
    point: DVec3,
    incoming: DVec3,
    normal: DVec3,
) -> Option<DVec3> {
    let cosine = -incoming.dot(normal);
    let outgoing = match material {
        Material::Mirror { .. } if cosine > 0.0 => reflected(incoming, normal),
        Material::Dielectric { index, .. } => {
            let (normal, n) = if cosine > 0.0 {
                (normal, index)
            } else {
                (-normal, 1.0 / index)
            };
            let (outgoing, reflectance) = refract(incoming, normal, n);
            // At grazing incidence rays turn a lot, and carry little.
            if !(reflectance < 0.5) {
                return None;
            }
            outgoing
        }
        _ => return None,
    };
    let t = -point.z / outgoing.z;
    let floor = model.floor?;
    let at = point + outgoing * t;
    let inside = (0..2).all(|k| at[k] >= floor[k][0] && at[k] <= floor[k][1]);
    (t > 0.0 && inside).then_some(at)
}

/// The distance of two floor points seen from the camera [pixels], foreshortening apart, which could only make it less.
fn pixels(film: &Film, a: DVec3, b: DVec3) -> f64 {
    let eye = film.position;
    let distance = (a - DVec3::new(eye.x, eye.y, eye.z)).length();
    (a - b).length() / (distance * film.du.length())
}
