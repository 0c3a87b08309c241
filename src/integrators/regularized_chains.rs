//! Regularized path tracing where light takes chains of specular interactions to a floor that is seen directly.
//!
//! The formulas are those of `pt_reg.rs`. A direction drawn at the floor point is traced back along every chain of the
//! surface, exactly up to the interaction next to the light, which is mollified.
//!
//! With every vertex mollified ([`Mollified::Every`], chains among plane mirrors) the path goes on from each mirror in a
//! direction that is uniform over the hemisphere, with 2π R φ(g), g the angle to the exact reflection, and is connected to the
//! light from the last one with R φ(g). The directions know nothing of the kernels, as where two subpaths are connected
//! between two specular vertices; drawn from the kernel, all but the last would bring no variance with them, and no
//! α⁻²ᵏ.

use core::f64::consts::{PI, TAU};

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::light::Light;
use crate::geometry::manifold::tangents;
use crate::geometry::scene::Scene;
use crate::geometry::turn::sin_cos_of_turns;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::chains::{direct_radiance, seen_vertex};
use super::connection::to_light;
use super::defect::Defect;
use super::deviation::Deviation;
use super::kernel::{AngleKernel, Kernel};
use super::settings::{Mollified, Settings};

/// Regularized connections along chains.
pub(super) struct RegularizedChains<L, S> {
    scene: Scene<L, S>,
    kernel: Kernel,
    settings: Settings,
    defect: Defect,
}

/// A caustic: the chain's position, its film layer, and what its irradiance samples are multiplied by.
type Caustic = (usize, usize, f64);

impl<L: Light, S: Chains> RegularizedChains<L, S> {
    pub(super) fn new(scene: Scene<L, S>, kernel: Kernel, settings: Settings) -> Self {
        RegularizedChains {
            scene,
            kernel,
            settings,
            defect: Defect::new(settings.fault),
        }
    }

    fn caustics(&self, film: &Film) -> Vec<Caustic> {
        let Scene {
            surface,
            floor,
            camera,
            ..
        } = &self.scene;
        let common = camera.pixels() * floor.bsdf * PI * surface.radiance_gain();
        let classes = surface.classes().iter().enumerate();
        classes
            .filter(|(_, class)| class.is_caustic())
            .filter_map(|(chain, &class)| {
                let layer = film.layer_of(class)?;
                Some((chain, layer, common * self.defect.class_scale(class)))
            })
            .collect()
    }

    /// The same with every one of `count` vertices mollified. `turn` draws two uniforms for the direction at a vertex.
    fn sample_of_every(
        &self,
        count: usize,
        origin: DVec3,
        direction: DVec3,
        kernel: &AngleKernel,
        turn: impl Fn(u64) -> (f64, f64),
    ) -> Option<f64> {
        let Self { scene, .. } = self;
        let mut vertex = scene.surface.reflection(origin, direction)?;
        let mut weight = vertex.weight;
        for k in 1..count as u64 {
            let (u, v) = turn(k);
            let (sine, cosine) = sin_cos_of_turns(u);
            let r = f64::sqrt(1.0 - v * v);
            let [e1, e2] = tangents(vertex.normal);
            let onwards = e1 * (r * cosine) + e2 * (r * sine) + vertex.normal * v;
            let difference = vertex.direction - onwards;
            let squared_chord = difference.dot(difference);
            if !(squared_chord < kernel.support) {
                return None;
            }
            vertex = scene.surface.reflection(vertex.point, onwards)?;
            weight *= TAU * kernel.density(squared_chord) * vertex.weight;
        }
        let light = to_light(scene, &vertex, kernel.support)?;
        Some(weight * light.irradiance * kernel.density(light.squared_chord))
    }

    /// An irradiance sample of a chain at a floor point, but for the constants of the class.
    fn sample(
        &self,
        chain: usize,
        origin: DVec3,
        direction: DVec3,
        kernel: &AngleKernel,
    ) -> Option<f64> {
        let Self { scene, defect, .. } = self;
        let vertex = scene.surface.trace_back(chain, origin, direction)?;
        let light = to_light(scene, &vertex, kernel.support)?;
        let (towards, _) = scene.light.towards(vertex.point);
        let irradiance = defect.falloff(light.irradiance, towards);
        let deviations =
            defect.beside_own_cosine(direction.z) * defect.at_specular(direction, vertex.direction);
        Some(vertex.weight * irradiance * kernel.density(light.squared_chord) * deviations)
    }
}

impl<L: Light, S: Chains> Prepared for RegularizedChains<L, S> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Self { scene, defect, .. } = self;
        let (seed, iteration) = defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let before = film.nonzero.iter().sum();
        let bandwidth = defect.bandwidth(iteration, bandwidth);
        let kernel = AngleKernel::new(self.kernel, bandwidth, self.settings.fault);
        let pixels = scene.camera.pixels();
        let direct = film.layer_of(PathClass::LDE);
        let direct_scale = pixels * defect.class_scale(PathClass::LDE);
        let caustics = self.caustics(film);
        let (columns, rows) = scene.camera.size();
        let (mut u, mut v): (Lanes, Lanes) = (zeros(), zeros());
        let (mut turn, mut height) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Film, &mut u, &mut v);
            stream.pairs(first, Dimension::Direction, &mut turn, &mut height);
            defect.numbers(Dimension::Direction, &mut turn, &mut height);
            for i in 0..live {
                let (column, row) = (u[i] * columns, v[i] * rows);
                let Some(vertex) = seen_vertex(scene, scene.camera.direction(column, row)) else {
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
                let (sine, cosine) = sin_cos_of_turns(turn[i]);
                let (r, z) = defect.scattered(height[i]);
                let direction = DVec3::new(r * cosine, r * sine, z);
                for &(chain, layer, scale) in &caustics {
                    let count = scene.surface.classes()[chain].light.len();
                    let sample = if self.settings.mollified == Mollified::Every && count > 1 {
                        // The chains of a path have directions of their own.
                        let turn = |k| stream.trial(first + i as u64, k + 16 * chain as u64);
                        self.sample_of_every(count, vertex, direction, &kernel, turn)
                    } else {
                        self.sample(chain, vertex, direction, &kernel)
                    };
                    if let Some(sample) = sample {
                        splat(layer, defect.sample(scale * sample, pixels));
                    }
                }
            }
        }
        defect.finish(paths, before, film);
    }
}
