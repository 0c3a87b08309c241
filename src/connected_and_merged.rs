//! Expected class means of vertex connection and merging at finite radius, for a floor with or without a plane mirror.
//!
//! At a floor point x that a film point sees, connections give the closed form L(x), merging the convolution (k * L)(x); a connection has
//! the share 1 - w(x), a merge w(x). So the mean of an area is
//!
//! ```text
//! ∫ L + w (k * L - L)            direct light: LDE, LDSE
//! ∫ k * L - (1 - w)(k * L - L)   caustics: LSDE; the first term is the exact expectation of merging
//! ```
//!
//! divided by the area. The shares are those of the balance heuristic, stated here from what the method documents and not from its code, with
//! η = π r² N:
//!
//! ```text
//! LDE    w = p_c p_l η/(p_c + p_l + p_c p_l η)      LDSE    w = p_l η/(1 + p_l η)      LSDE    w = p_c η/(1 + p_c η)
//! p_c = h/(t³ A)     camera h above the floor, x at the depth t, A the film's area at depth 1
//! p_l = I cos θ/(d² Φ), Φ = 2π I (1 + z), z the largest vertical component of the directions to the corners of floor and mirror; 0 where no light comes
//! ```
//!
//! [Georgiev et al. 2012, eqs. (10), (13); derived here for one vertex on the floor]. Quadrature: points in each pixel, and for the convolution rings of
//! equal area with a turned ring of points each. The error is estimated by a coarser rule.

use core::f64::consts::{PI, TAU};

use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::camera::{Bounded, Film};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{
    DiffuseScene, Entry, Floor, InvalidParameter, Kind, PlanarMirrorScene, PointLight,
};
use nephroid_analytic::vector::Vec3;
use rayon::prelude::*;

use crate::expectation::{self, Interpolation};
use crate::film::compensated_sum;
use crate::integrators::vcm::MAP;
use crate::regions::Regions;
use crate::truth::TruthImage;

type V = Vec3<f64>;

/// Points along a side of a pixel, rings of a disc and points of a ring: of the rule and of the coarser one.
const RULES: [[u32; 3]; 2] = [[4, 8, 16], [3, 6, 12]];
/// Nodes of the interpolation over the bandwidths of a schedule.
const NODES: usize = 5;

/// Means over the areas of the regions of the classes that are connected and merged, [W m⁻² sr⁻¹]: the truth image is that of the entry, the
/// kernel one on the radius, the bandwidths those of iterations of equal weight.
///
/// # Errors
/// A kind other than `diffuse` and `planar-mirror`, a kernel that does not fit, a bandwidth out of range.
pub fn area_means(
    entry: &Entry,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: f64,
    regions: &Regions,
    truth: &TruthImage,
) -> Result<Vec<(PathClass, Vec<Bounded>)>, InvalidParameter> {
    let merge = Technique::Merge;
    let none = [tolerance, f64::INFINITY];
    let merged = expectation::area_moments(entry, merge, kernel, bandwidths, none, regions)?;
    let Some(scene) = Scene::of(entry) else {
        return Ok(Vec::new());
    };
    let low = bandwidths.iter().copied().fold(f64::INFINITY, f64::min);
    let high = bandwidths.iter().copied().fold(0.0, f64::max);
    let varies = high > low * (1.0 + 1e-9);
    let rule = varies.then(|| Interpolation::new(NODES, low, high));
    let nodes = match &rule {
        Some(rule) => rule.bandwidths.clone(),
        None => vec![high],
    };
    let classes = [PathClass::LDE, PathClass::LSDE, PathClass::LDSE];
    let classes = classes.into_iter().filter(|c| truth.classes.contains(c));
    let of_class = |class: PathClass| {
        let layer = truth.classes.iter().position(|&c| c == class).unwrap_or(0);
        let start: Vec<Bounded> = match merged.iter().find(|(c, _)| *c == class) {
            Some((_, areas)) => areas.iter().map(|m| m.mean).collect(),
            None => truth.area_means(layer, regions),
        };
        let at_nodes: Vec<Vec<Bounded>> = nodes
            .iter()
            .map(|&r| scene.difference(class, kernel, r, regions))
            .collect();
        let areas = start.iter().enumerate().map(|(area, start)| {
            let values: Vec<Bounded> = at_nodes.iter().map(|n| n[area]).collect();
            let more = match &rule {
                Some(rule) => rule.average(&values, |_| 1.0, bandwidths),
                None => values[0],
            };
            Bounded {
                value: start.value + more.value,
                error: start.error + more.error,
            }
        });
        (class, areas.collect())
    };
    Ok(classes.map(of_class).collect())
}

/// A rectangular mirror.
struct Mirror {
    center: V,
    normal: V,
    edges: [V; 2],
    half: [f64; 2],
    reflectance: f64,
}

impl Mirror {
    /// Ray parameter at which o + t d meets the rectangle, from either side.
    fn meet(&self, o: V, d: V) -> Option<f64> {
        let t = (self.center - o).dot(self.normal) / d.dot(self.normal);
        let p = o + d * t - self.center;
        let inside = |k: usize| p.dot(self.edges[k]).abs() <= self.half[k];
        (t.is_finite() && t > 0.0 && inside(0) && inside(1)).then_some(t)
    }

    fn image(&self, p: V) -> V {
        p - self.normal * (2.0 * (p - self.center).dot(self.normal))
    }
}

/// The scene in the plainest terms.
struct Scene {
    light: V,
    intensity: f64,
    flux: f64,
    floor: Floor,
    mirror: Option<Mirror>,
    film: Film,
    film_area: f64,
}

/// What a film point sees.
struct Sight {
    x: V,
    /// Through the mirror.
    through: bool,
    /// Ray parameter of what is seen straight: the depth.
    depth: f64,
}

impl Scene {
    fn of(entry: &Entry) -> Option<Self> {
        let (light, floor, mirror): (&PointLight, &Floor, _) = match &entry.kind {
            Kind::Diffuse(DiffuseScene { light, floor }) => (light, floor, None),
            Kind::PlanarMirror(PlanarMirrorScene {
                light,
                floor,
                mirror,
            }) => {
                let (normal, edge) = (
                    Vec3::from_f64(mirror.normal).normalized(),
                    Vec3::from_f64(mirror.edge).normalized(),
                );
                let mirror = Mirror {
                    center: Vec3::from_f64(mirror.center),
                    normal,
                    edges: [edge, normal.cross(edge)],
                    half: [mirror.half_width, mirror.half_height],
                    reflectance: mirror.reflectance,
                };
                (light, floor, Some(mirror))
            }
            _ => return None,
        };
        let position = Vec3::from_f64(light.position);
        let signs = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let corners = signs.iter().map(|(a, b)| {
            let ([cx, cy], [wx, wy]) = (floor.center, floor.half_width);
            Vec3::from_f64([cx + a * wx, cy + b * wy, 0.0])
        });
        let of_mirror = mirror.iter().flat_map(|m| {
            let side = |k: usize, s: f64| m.edges[k] * (s * m.half[k]);
            signs.map(|(a, b)| m.center + side(0, a) + side(1, b))
        });
        let highest = corners
            .chain(of_mirror)
            .map(|c| (c - position).normalized().z)
            .fold(-1.0, f64::max);
        // Photons of a cap that would be more than a hemisphere are drawn over the sphere.
        let highest = if highest > 0.0 { 1.0 } else { highest };
        let film = Film::new(&entry.camera);
        let (w, h) = (f64::from(film.width), f64::from(film.height));
        Some(Scene {
            light: position,
            intensity: light.intensity,
            flux: TAU * light.intensity * (1.0 + highest),
            floor: floor.clone(),
            mirror,
            film_area: w * h * film.du.dot(film.du).sqrt() * film.dv.dot(film.dv).sqrt(),
            film,
        })
    }

    fn on_floor(&self, x: V) -> bool {
        let ([cx, cy], [wx, wy]) = (self.floor.center, self.floor.half_width);
        (x.x - cx).abs() <= wx && (x.y - cy).abs() <= wy
    }

    fn sight(&self, u: f64, v: f64) -> Option<Sight> {
        let (o, d) = (self.film.position, self.film.direction(u, v));
        let to_floor = |o: V, d: V| (d.z < 0.0).then(|| -o.z / d.z).filter(|t| *t > 0.0);
        let straight = to_floor(o, d);
        let met = self.mirror.as_ref().and_then(|m| Some((m, m.meet(o, d)?)));
        let sight = match met.filter(|(_, t)| straight.is_none_or(|s| *t < s)) {
            Some((m, t)) => {
                if d.dot(m.normal) >= 0.0 {
                    return None;
                }
                let s = o + d * t;
                let out = d - m.normal * (2.0 * d.dot(m.normal));
                Sight {
                    x: s + out * to_floor(s, out)?,
                    through: true,
                    depth: f64::INFINITY,
                }
            }
            None => {
                let depth = straight?;
                Sight {
                    x: o + d * depth,
                    through: false,
                    depth,
                }
            }
        };
        self.on_floor(sight.x).then_some(sight)
    }

    /// Irradiance at a floor point of the light that comes straight, or by the mirror.
    fn irradiance(&self, caustic: bool, x: V) -> f64 {
        if !self.on_floor(x) {
            return 0.0;
        }
        let (from, factor) = match (&self.mirror, caustic) {
            (Some(m), true) => {
                let image = m.image(self.light);
                let front = |p: V| (p - m.center).dot(m.normal) > 0.0;
                if !(front(x) && front(self.light)) {
                    return 0.0;
                }
                match m.meet(x, image - x) {
                    Some(t) if t < 1.0 => (image, m.reflectance),
                    _ => return 0.0,
                }
            }
            (Some(m), false) => match m.meet(x, self.light - x) {
                Some(t) if t < 1.0 => return 0.0,
                _ => (self.light, 1.0),
            },
            (None, true) => return 0.0,
            (None, false) => (self.light, 1.0),
        };
        let d = from - x;
        let square = d.dot(d);
        factor * self.intensity * d.z / (square * square.sqrt())
    }

    /// The share of merging at what is seen.
    fn share(&self, class: PathClass, sight: &Sight, eta: f64) -> f64 {
        let height = self.film.position.z;
        let camera = height / (sight.depth * sight.depth * sight.depth * self.film_area);
        let light = self.irradiance(false, sight.x) / self.flux;
        let [connections, merging] = match class {
            PathClass::LDE => [camera + light, camera * light * eta],
            PathClass::LDSE => [1.0, light * eta],
            _ => [1.0, camera * eta],
        };
        if merging > 0.0 {
            merging / (connections + merging)
        } else {
            0.0
        }
    }

    /// What is to be added: the mean over each area of w (k * L - L), or of -(1 - w)(k * L - L) for a caustic.
    fn difference(
        &self,
        class: PathClass,
        kernel: Kernel,
        r: f64,
        regions: &Regions,
    ) -> Vec<Bounded> {
        let [fine, coarse] = RULES.map(|rule| {
            let disc = disc(kernel, rule);
            let image: Vec<f64> = (0..self.film.height)
                .into_par_iter()
                .flat_map_iter(|row| {
                    let pixel = |column| self.pixel(class, r, rule[0], &disc, column, row);
                    (0..self.film.width).map(pixel).collect::<Vec<_>>()
                })
                .collect();
            regions.reduce(&image)
        });
        let areas = fine.iter().zip(&coarse).zip(regions.pixels());
        areas
            .map(|((&(fine, _), &(coarse, _)), pixels)| Bounded {
                value: fine / pixels as f64,
                error: f64::abs(fine - coarse) / pixels as f64,
            })
            .collect()
    }

    fn pixel(
        &self,
        class: PathClass,
        r: f64,
        side: u32,
        disc: &[([f64; 2], f64)],
        column: u32,
        row: u32,
    ) -> f64 {
        let caustic = !class.light.is_empty();
        let eta = PI * r * r * MAP as f64;
        let at = |k: u32| (f64::from(k) + 0.5) / f64::from(side);
        let mut values = Vec::new();
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let (u, v) = (f64::from(column) + at(i), f64::from(row) + at(j));
            let Some(sight) = self.sight(u, v) else {
                continue;
            };
            if sight.through == class.eye.is_empty() {
                continue;
            }
            let w = self.share(class, &sight, eta);
            let factor = if caustic { w - 1.0 } else { w };
            if factor == 0.0 {
                continue;
            }
            let sharp = self.irradiance(caustic, sight.x);
            let merged: f64 = disc
                .iter()
                .map(|&([dx, dy], weight)| {
                    let x = sight.x + Vec3::from_f64([r * dx, r * dy, 0.0]);
                    weight * self.irradiance(caustic, x)
                })
                .sum();
            values.push(factor * (merged - sharp));
        }
        let reflected = match (&self.mirror, class.eye.is_empty()) {
            (Some(m), false) => m.reflectance,
            _ => 1.0,
        };
        reflected * self.floor.albedo / PI * compensated_sum(&values) / f64::from(side * side)
    }
}

/// Points of the unit disc and weights that sum to 1.
fn disc(kernel: Kernel, [_, rings, around]: [u32; 3]) -> Vec<([f64; 2], f64)> {
    // The golden angle keeps the points of neighbouring rings apart.
    const TURN: f64 = 0.381_966_011_250_105;
    let mut points = Vec::new();
    for ring in 0..rings {
        let s = (f64::from(ring) + 0.5) / f64::from(rings);
        let profile = match kernel {
            Kernel::Epanechnikov => 1.0 - s,
            Kernel::Biweight => (1.0 - s) * (1.0 - s),
            Kernel::Cone => 1.0 - s.sqrt(),
            _ => 1.0,
        };
        for k in 0..around {
            let turns = f64::from(k) / f64::from(around) + TURN * f64::from(ring);
            let (sin, cos) = libm::sincos(TAU * turns);
            points.push(([s.sqrt() * cos, s.sqrt() * sin], profile));
        }
    }
    let total: f64 = points.iter().map(|p| p.1).sum();
    points.iter_mut().for_each(|p| p.1 /= total);
    points
}
