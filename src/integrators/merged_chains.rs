//! Photon mapping where light takes chains of specular interactions to a floor that is seen directly.
//!
//! As in `photon_mapping.rs`, with a map for each chain, so that each class of the film has its own estimate. One
//! photon is followed along every chain.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::emission::Emitter;
use crate::geometry::floor::Floor;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::stream::{Dimension, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::chains::{direct_radiance, seen_vertex};
use super::defect::Defect;
use super::deviation::Deviation;
use super::kernel::RadiusKernel;
use super::photon_grid::{PhotonGrid, Photons};
use super::photon_mapping::{PILOT, blocks, kernel_of, map_size};
use super::settings::Settings;

/// A chain of specular interactions, and the photons that can take it.
struct Caustic<E> {
    chain: usize,
    class: PathClass,
    emitter: E,
}

/// Photon mapping along chains.
pub(super) struct MergedChains<L: Light, S> {
    scene: Scene<L, S>,
    caustics: Vec<Caustic<L::Emitter>>,
    settings: Settings,
    defect: Defect,
    /// Photons that reach the floor per photon traced and square metre of their bounding box, as a pilot found it, for the
    /// densest of the chains.
    density: f64,
}

/// The photons of a chain.
#[derive(Default)]
struct Map {
    photons: Photons,
    grid: PhotonGrid,
}

/// Photons of the density of the tables of expectations for a chain: over the sphere of a point light, over the beam that
/// covers what the chain meets first on its way to the floor.
pub(super) fn emitter<L: Light, S: Chains>(scene: &Scene<L, S>, chain: usize) -> L::Emitter {
    let floor = scene.floor.hull();
    let targets: Vec<_> = (0..scene.surface.classes().len())
        .map(|chain| scene.surface.targets(chain, &floor))
        .collect();
    let highest = targets.iter().flatten().map(|p| p.z).fold(0.0, f64::max);
    scene.light.spread(&targets[chain], highest)
}

/// Where a photon lands on the clipped floor by a chain, the cosine of its arrival, and the weight of the chain.
#[inline(always)]
pub(super) fn landing<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    chain: usize,
    origin: DVec3,
    direction: DVec3,
) -> Option<(f64, f64, f64, f64)> {
    let leg = scene.surface.follow(chain, origin, direction);
    let t = Floor::meet(leg.origin, leg.direction);
    if !(leg.weight > 0.0 && t < f64::INFINITY) {
        return None;
    }
    let (o, d) = (leg.origin, leg.direction);
    let (x, y) = (o.x + d.x * t, o.y + d.y * t);
    let cosine = -d.z / f64::sqrt(d.dot(d));
    scene
        .floor
        .contains(x, y)
        .then_some((x, y, cosine, leg.weight))
}

impl<L: Light, S: Chains> MergedChains<L, S> {
    pub(super) fn new(scene: Scene<L, S>, settings: Settings) -> Self {
        let classes = scene.surface.classes().iter().enumerate();
        let mut merged = MergedChains {
            caustics: classes
                .filter(|(_, class)| class.is_caustic())
                .map(|(chain, &class)| Caustic {
                    chain,
                    class,
                    emitter: emitter(&scene, chain),
                })
                .collect(),
            scene,
            settings,
            defect: Defect::new(settings.fault),
            density: 0.0,
        };
        merged.density = merged.pilot_density();
        merged
    }

    fn pilot_density(&self) -> f64 {
        let stream = Stream::new(u64::MAX, u32::MAX);
        let mut maps = self.maps();
        self.emit(&stream, 0, PILOT, &mut maps);
        let density = |map: &Map| map.photons.x.len() as f64 / map.photons.area();
        let densest = maps.iter().map(density).filter(|d| *d < f64::INFINITY);
        densest.fold(0.0, f64::max) / PILOT as f64
    }

    fn maps(&self) -> Vec<Map> {
        self.caustics.iter().map(|_| Map::default()).collect()
    }

    /// Adds the photons of paths `start .. end` to the maps.
    fn emit(&self, stream: &Stream, start: u64, end: u64, maps: &mut [Map]) {
        let (mut u, mut v) = (zeros(), zeros());
        for (first, live) in blocks(start, end) {
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            self.defect.numbers(Dimension::Emission, &mut u, &mut v);
            for (caustic, map) in self.caustics.iter().zip(&mut *maps) {
                for (&u, &v) in u.iter().zip(&v).take(live) {
                    let (origin, direction) = caustic.emitter.ray(u, v);
                    let lands = landing(&self.scene, caustic.chain, origin, direction);
                    if let Some((x, y, cosine, weight)) = lands {
                        let deviations =
                            self.defect.beside_cosine(cosine) * self.defect.roulette(u);
                        map.photons.push(x, y, weight * deviations);
                    }
                }
            }
        }
    }
}

impl<L: Light, S: Chains> Prepared for MergedChains<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Self { scene, defect, .. } = self;
        let before = film.nonzero.iter().sum();
        defect.begin(iteration, film);
        let bandwidth = defect.bandwidth(iteration, bandwidth);
        let (seed, iteration) = defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let kernel = RadiusKernel::new(kernel_of(&self.settings), bandwidth, self.settings.fault);
        let pixels = scene.camera.pixels();
        let direct = film.layer_of(PathClass::LDE);
        let direct_scale = pixels * defect.class_scale(PathClass::LDE);
        let layers: Vec<_> = self
            .caustics
            .iter()
            .map(|c| film.layer_of(c.class))
            .collect();
        let (columns, rows) = scene.camera.size();
        let (mut u, mut v) = (zeros(), zeros());
        let mut maps = self.maps();
        let size = map_size(self.density, kernel.radius);
        for start in (0..paths).step_by(size as usize) {
            let end = paths.min(start + size);
            maps.iter_mut().for_each(|map| map.photons.clear());
            self.emit(&stream, start, end, &mut maps);
            let cell = kernel.radius * defect.cell();
            maps.iter_mut()
                .for_each(|map| map.grid.build(&map.photons, cell));
            let scales: Vec<_> = self
                .caustics
                .iter()
                .zip(&maps)
                .map(|(c, map)| {
                    let divisor = defect.divisor(end - start, map.photons.x.len());
                    let norm = kernel.norm * defect.flux(c.emitter.flux()) / divisor;
                    norm * scene.floor.bsdf * pixels * defect.class_scale(c.class)
                })
                .collect();
            for (first, live) in blocks(start, end) {
                stream.pairs(first, Dimension::Film, &mut u, &mut v);
                for i in 0..live {
                    let (column, row) = (u[i] * columns, v[i] * rows);
                    let Some(vertex) = seen_vertex(scene, scene.camera.direction(column, row))
                    else {
                        continue;
                    };
                    let mut splat = |layer: usize, value: f64| {
                        if value > 0.0 {
                            add(film, layer, column, row, value);
                            film.nonzero[layer] += 1;
                        }
                    };
                    if let Some(layer) = direct {
                        splat(layer, direct_scale * direct_radiance(scene, defect, vertex));
                    }
                    for ((map, scale), layer) in maps.iter().zip(&scales).zip(&layers) {
                        if let Some(layer) = *layer {
                            let (x, y) = (vertex.x, vertex.y);
                            let sum = map.grid.gather(x, y, &kernel, defect.reach());
                            splat(layer, scale * sum);
                        }
                    }
                }
            }
        }
        defect.finish(paths, before, film);
    }
}
