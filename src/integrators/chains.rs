//! Light tracing and next event estimation where light takes chains of specular interactions to a floor that is seen
//! directly.
//!
//! The formulas are those of `lt.rs` and `pt.rs`; a photon is followed along every chain that the surface has, with the
//! Fresnel factors of the chain as its weight.

use glam::DVec3;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::emission::Emitter;
use crate::geometry::floor::Floor;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::settings::Defect;

/// Light tracing along chains.
pub(super) struct LightChains<L: Light, S> {
    scene: Scene<L, S>,
    /// One for each chain: photons are aimed at what the chain meets first, on its way to the floor that is seen.
    emitters: Vec<L::Narrow>,
    defect: Defect,
}

impl<L: Light, S: Chains> LightChains<L, S> {
    pub(super) fn new(scene: Scene<L, S>, defect: Defect) -> Self {
        let seen = seen_floor(&scene);
        let aimed = |chain| scene.light.narrow(&scene.surface.targets(chain, &seen));
        LightChains {
            emitters: (0..scene.surface.classes().len()).map(aimed).collect(),
            scene,
            defect,
        }
    }
}

/// Corners of a rectangle of the floor that contains all of it that is in the frame.
fn seen_floor<L, S>(scene: &Scene<L, S>) -> Vec<DVec3> {
    let mut corners = scene.floor.hull();
    let (columns, rows) = scene.camera.size();
    let eye = scene.camera.position;
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (u, v) in [(0.0, 0.0), (columns, 0.0), (0.0, rows), (columns, rows)] {
        let direction = scene.camera.direction(u, v);
        let t = Floor::meet(eye, direction);
        if !(t < f64::INFINITY) {
            // The horizon is in the frame.
            return corners;
        }
        let point = eye + direction * t;
        (low, high) = (low.min(point), high.max(point));
    }
    for corner in &mut corners {
        // Rounding at the frame's border: a margin far above it.
        let margin = 1e-9 * (high - low);
        corner.x = corner.x.min(high.x + margin.x).max(low.x - margin.x);
        corner.y = corner.y.min(high.y + margin.y).max(low.y - margin.y);
    }
    corners
}

impl<L: Light, S: Chains> Prepared for LightChains<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Scene {
            surface,
            floor,
            camera,
            ..
        } = &self.scene;
        let chains: Vec<_> = (0..)
            .zip(surface.classes())
            .zip(&self.emitters)
            .filter_map(|((chain, &class), emitter)| {
                let scale = emitter.flux() * floor.bsdf * self.defect.class_scale(class);
                film.layer_of(class)
                    .map(|layer| (chain, layer, scale, emitter))
            })
            .collect();
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            for (&u, &v) in u.iter().zip(&v).take(live) {
                for &(chain, layer, scale, emitter) in &chains {
                    let (origin, direction) = emitter.ray(u, v);
                    let leg = surface.follow(chain, origin, direction);
                    let t = Floor::meet(leg.origin, leg.direction);
                    if !(leg.weight > 0.0 && t < f64::INFINITY) {
                        continue;
                    }
                    let (x, y) = (
                        leg.origin.x + leg.direction.x * t,
                        leg.origin.y + leg.direction.y * t,
                    );
                    let vertex = DVec3::new(x, y, 0.0);
                    let (column, row, density) = camera.project_floor(vertex);
                    let seen = floor.contains(x, y) & (density > 0.0);
                    if !seen || surface.blocks(vertex, camera.position - vertex, 1.0) {
                        continue;
                    }
                    let d = leg.direction;
                    let cosine = -d.z / f64::sqrt(d.dot(d));
                    let radiance = scale * leg.weight * self.defect.beside_cosine(cosine);
                    add(film, layer, column, row, radiance * density);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}

/// Next event estimation at the floor point seen in a pixel.
pub(super) struct DirectLight<L, S> {
    scene: Scene<L, S>,
    defect: Defect,
}

impl<L: Light, S: Chains> DirectLight<L, S> {
    pub(super) fn new(scene: Scene<L, S>, defect: Defect) -> Self {
        DirectLight { scene, defect }
    }

    /// Radiance towards the pinhole from the floor point that a ray from it meets; 0 where there is none.
    fn radiance(&self, direction: DVec3) -> f64 {
        let Scene {
            light,
            surface,
            floor,
            camera,
        } = &self.scene;
        let origin = camera.position;
        let t = Floor::meet(origin, direction);
        let (x, y) = (origin.x + direction.x * t, origin.y + direction.y * t);
        if !(t < f64::INFINITY && floor.contains(x, y)) || surface.blocks(origin, direction, t) {
            return 0.0;
        }
        let vertex = DVec3::new(x, y, 0.0);
        let (towards, t_end) = light.towards(vertex);
        let cosine = towards.z / f64::sqrt(towards.dot(towards));
        if !(cosine > 0.0) || surface.blocks(vertex, towards, t_end) {
            return 0.0;
        }
        let irradiance = light.normal_irradiance(towards) * cosine;
        floor.bsdf * irradiance * self.defect.beside_cosine(cosine)
    }
}

impl<L: Light, S: Chains> Prepared for DirectLight<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        const LDE: nephroid_analytic::class::PathClass = nephroid_analytic::class::PathClass::LDE;
        let Some(layer) = film.layer_of(LDE) else {
            return;
        };
        let camera = &self.scene.camera;
        let (columns, rows) = camera.size();
        let scale = camera.pixels() * self.defect.class_scale(LDE);
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v): (Lanes, Lanes) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Film, &mut u, &mut v);
            for (&u, &v) in u.iter().zip(&v).take(live) {
                let (column, row) = (u * columns, v * rows);
                let value = scale * self.radiance(camera.direction(column, row));
                if value > 0.0 {
                    add(film, layer, column, row, value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}
