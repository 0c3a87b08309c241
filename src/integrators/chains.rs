//! Light tracing and next event estimation where light takes chains of specular interactions to a floor that is seen
//! directly.
//!
//! The formulas are those of `lt.rs` and `pt.rs`; a photon is followed along every chain that the surface has, with the
//! Fresnel factors of the chain as its weight.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::emission::Emitter;
use crate::geometry::floor::Floor;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;

/// Light tracing along chains.
pub(super) struct LightChains<L: Light, S> {
    scene: Scene<L, S>,
    /// One for each chain: photons are aimed at what the chain meets first, on its way to the floor that is seen.
    emitters: Vec<L::Narrow>,
    /// A chain is followed by one path in so many, a power of two, with as much more weight: bright classes need fewer.
    strides: Vec<u64>,
    defect: Defect,
}

/// Paths of the pilot that finds out how often each chain ends in the frame, and the largest stride.
const PILOT: u64 = 1 << 14;
const LONGEST_STRIDE: u64 = 16;

impl<L: Light, S: Chains> LightChains<L, S> {
    pub(super) fn new(scene: Scene<L, S>, defect: Defect) -> Self {
        let seen = scene.seen_floor();
        let targets: Vec<_> = (0..scene.surface.classes().len())
            .map(|chain| scene.surface.targets(chain, &seen))
            .collect();
        let highest = targets.iter().flatten().map(|p| p.z).fold(0.0, f64::max);
        let mut chains = LightChains {
            emitters: targets
                .iter()
                .map(|targets| scene.light.narrow(targets, highest))
                .collect(),
            strides: vec![1; targets.len()],
            scene,
            defect,
        };
        chains.strides = chains.pilot_strides();
        chains
    }

    /// Strides that make all chains end in the frame about as often. The pilot has a stream of its own.
    fn pilot_strides(&self) -> Vec<u64> {
        let stream = Stream::new(0, u32::MAX);
        let (mut u, mut v) = (zeros(), zeros());
        let mut hits = vec![0_u64; self.emitters.len()];
        for first in (0..PILOT).step_by(BLOCK) {
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            for (chain, (emitter, hits)) in self.emitters.iter().zip(&mut hits).enumerate() {
                let lands = |(&u, &v)| self.landing(chain, emitter, u, v).is_some();
                *hits += u.iter().zip(&v).filter(|&pair| lands(pair)).count() as u64;
            }
        }
        // A chain that the pilot does not see at all says nothing about the others.
        let seen = hits.iter().copied().filter(|&hits| hits > 0);
        let fewest = seen.min().unwrap_or(1);
        let stride = |&hits: &u64| {
            let more = (hits / fewest).clamp(1, LONGEST_STRIDE);
            1 << more.ilog2()
        };
        hits.iter().map(stride).collect()
    }

    /// Where the photon of two uniforms ends in the frame by a chain: column, row, and its weight there, times the pixels
    /// per square metre.
    fn landing(
        &self,
        chain: usize,
        emitter: &L::Narrow,
        u: f64,
        v: f64,
    ) -> Option<(f64, f64, f64)> {
        let Scene {
            surface,
            floor,
            camera,
            ..
        } = &self.scene;
        let (origin, direction) = emitter.ray(u, v);
        let leg = surface.follow(chain, origin, direction);
        let t = Floor::meet(leg.origin, leg.direction);
        if !(leg.weight > 0.0 && t < f64::INFINITY) {
            return None;
        }
        let (x, y) = (
            leg.origin.x + leg.direction.x * t,
            leg.origin.y + leg.direction.y * t,
        );
        let vertex = DVec3::new(x, y, 0.0);
        let (column, row, density) = camera.project_floor(vertex);
        let seen = floor.contains(x, y) & (density > 0.0);
        if !seen || surface.blocks(vertex, camera.position - vertex, 1.0) {
            return None;
        }
        let d = leg.direction;
        let cosine = -d.z / f64::sqrt(d.dot(d));
        let weight = leg.weight * self.defect.beside_cosine(cosine);
        Some((column, row, weight * density))
    }
}

impl<L: Light, S: Chains> Prepared for LightChains<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v) = (zeros(), zeros());
        let classes = self.scene.surface.classes().iter();
        let chains: Vec<_> = classes
            .zip(&self.emitters)
            .zip(&self.strides)
            .enumerate()
            .filter_map(|(chain, ((&class, emitter), &stride))| {
                // The first path of every stride is followed; the last stride may be cut.
                let share = paths as f64 / paths.div_ceil(stride) as f64;
                let scale =
                    emitter.flux() * self.scene.floor.bsdf * self.defect.class_scale(class) * share;
                let layer = film.layer_of(class)?;
                Some((chain, emitter, stride as usize, layer, scale))
            })
            .collect();
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            for &(chain, emitter, stride, layer, scale) in &chains {
                // A block is a multiple of every stride.
                for (&u, &v) in u[..live].iter().zip(&v[..live]).step_by(stride) {
                    if let Some((column, row, weight)) = self.landing(chain, emitter, u, v) {
                        add(film, layer, column, row, scale * weight);
                        film.nonzero[layer] += 1;
                    }
                }
            }
        }
    }
}

/// The floor point that a ray from the pinhole meets; `None` where there is none, or a surface is in the way.
pub(super) fn seen_vertex<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    direction: DVec3,
) -> Option<DVec3> {
    let origin = scene.camera.position;
    let t = Floor::meet(origin, direction);
    let (x, y) = (origin.x + direction.x * t, origin.y + direction.y * t);
    let met = t < f64::INFINITY && scene.floor.contains(x, y);
    (met && !scene.surface.blocks(origin, direction, t)).then(|| DVec3::new(x, y, 0.0))
}

/// Radiance that direct light leaves a floor point with, by next event estimation.
pub(super) fn direct_radiance<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    defect: &Defect,
    vertex: DVec3,
) -> f64 {
    let (towards, t_end) = scene.light.towards(vertex);
    let cosine = towards.z / f64::sqrt(towards.dot(towards));
    if !(cosine > 0.0) || scene.surface.blocks(vertex, towards, t_end) {
        return 0.0;
    }
    let irradiance = scene.light.normal_irradiance(towards) * cosine;
    scene.floor.bsdf * irradiance * defect.beside_own_cosine(cosine)
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
}

impl<L: Light, S: Chains> Prepared for DirectLight<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Some(layer) = film.layer_of(PathClass::LDE) else {
            return;
        };
        let camera = &self.scene.camera;
        let (columns, rows) = camera.size();
        let scale = camera.pixels() * self.defect.class_scale(PathClass::LDE);
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v): (Lanes, Lanes) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Film, &mut u, &mut v);
            for (&u, &v) in u.iter().zip(&v).take(live) {
                let (column, row) = (u * columns, v * rows);
                let Some(vertex) = seen_vertex(&self.scene, camera.direction(column, row)) else {
                    continue;
                };
                let value = scale * direct_radiance(&self.scene, &self.defect, vertex);
                if value > 0.0 {
                    add(film, layer, column, row, value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}
