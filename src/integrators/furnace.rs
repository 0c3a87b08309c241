//! Path tracing and light tracing where light bounces between diffuse walls: classes LD+E.
//!
//! Both scatter by the cosine law, so that a bounce multiplies by the albedo alone. A camera path adds, at its k-th diffuse
//! vertex, the light's contribution to LDᵏE; a light path connects each of its vertices to the pinhole. Paths end at
//! the longest class of the scene: their length is not random.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::emission::Emitter;
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;

/// The direction at each vertex but the last.
const DIRECTIONS: [Dimension; 3] = [
    Dimension::Direction,
    Dimension::SecondDirection,
    Dimension::ThirdDirection,
];

/// Most diffuse vertices of a path.
pub(super) const VERTICES: usize = DIRECTIONS.len() + 1;

/// Layer of LDᵏE for k = 1, 2, …, where the film has one, and what a lost class is multiplied by.
pub(super) fn layers(film: &Film, defect: &Defect) -> [Option<(usize, f64)>; VERTICES] {
    core::array::from_fn(|k| {
        let class = PathClass {
            diffuse: k as u8 + 1,
            ..PathClass::LDE
        };
        let layer = film.layer_of(class);
        layer.map(|layer| (layer, defect.class_scale(class)))
    })
}

/// The directions of a block of paths, by vertex.
fn directions(stream: &Stream, first: u64, out: &mut [[Lanes; 2]; DIRECTIONS.len()]) {
    for (dimension, [u, v]) in DIRECTIONS.into_iter().zip(out) {
        stream.pairs(first, dimension, u, v);
    }
}

/// Next event estimation at every vertex of a camera path.
pub(super) struct CameraWalks {
    scene: Furnace,
    defect: Defect,
}

impl CameraWalks {
    pub(super) fn new(scene: Furnace, defect: Defect) -> Self {
        CameraWalks { scene, defect }
    }

    /// Radiance that a wall point scatters of the light's own, in all directions.
    fn direct(&self, point: DVec3, normal: DVec3) -> f64 {
        let (towards, _) = self.scene.light.towards(point);
        let cosine = towards.dot(normal) / f64::sqrt(towards.dot(towards));
        let irradiance = self.scene.light.normal_irradiance(towards) * cosine;
        let bsdf = self.scene.albedo / core::f64::consts::PI;
        bsdf * irradiance * self.defect.beside_own_cosine(cosine)
    }
}

impl Prepared for CameraWalks {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Furnace { camera, albedo, .. } = &self.scene;
        let layers = layers(film, &self.defect);
        let (columns, rows) = camera.size();
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v) = (zeros(), zeros());
        let mut turns = [[zeros(); 2]; DIRECTIONS.len()];
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Film, &mut u, &mut v);
            directions(&stream, first, &mut turns);
            for i in 0..live {
                let (column, row) = (u[i] * columns, v[i] * rows);
                let mut point = self
                    .scene
                    .hit(camera.position, camera.direction(column, row));
                let mut throughput = camera.pixels();
                for (k, layer) in layers.iter().enumerate() {
                    let normal = self.scene.normal(point);
                    if let Some((layer, scale)) = *layer {
                        let value = scale * throughput * self.direct(point, normal);
                        if value > 0.0 {
                            add(film, layer, column, row, value);
                            film.nonzero[layer] += 1;
                        }
                    }
                    if let Some([u, v]) = turns.get(k) {
                        let direction = Furnace::scattered(normal, u[i], v[i]);
                        point = self.scene.hit(point, direction);
                        throughput *= albedo;
                    }
                }
            }
        }
    }
}

/// Photons that bounce, connected to the pinhole from every vertex.
pub(super) struct LightWalks {
    scene: Furnace,
    defect: Defect,
}

impl LightWalks {
    pub(super) fn new(scene: Furnace, defect: Defect) -> Self {
        LightWalks { scene, defect }
    }
}

impl Prepared for LightWalks {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let Furnace { camera, albedo, .. } = &self.scene;
        let layers = layers(film, &self.defect);
        let emitter = self.scene.light.everywhere();
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v) = (zeros(), zeros());
        let mut turns = [[zeros(); 2]; DIRECTIONS.len()];
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            directions(&stream, first, &mut turns);
            for i in 0..live {
                let (mut origin, mut direction) = emitter.ray(u[i], v[i]);
                let mut radiance = emitter.flux() * albedo / core::f64::consts::PI;
                for (k, layer) in layers.iter().enumerate() {
                    let point = self.scene.hit(origin, direction);
                    let normal = self.scene.normal(point);
                    let (column, row, density) = camera.project(point, normal);
                    if let (Some((layer, scale)), true) = (*layer, density > 0.0) {
                        // The photon has the cosine of its arrival in its flux.
                        let cosine = -direction.dot(normal) / f64::sqrt(direction.dot(direction));
                        let beside = self.defect.beside_cosine(cosine);
                        let value = scale * radiance * beside * density;
                        if value > 0.0 {
                            add(film, layer, column, row, value);
                            film.nonzero[layer] += 1;
                        }
                    }
                    if let Some([u, v]) = turns.get(k) {
                        (origin, direction) = (point, Furnace::scattered(normal, u[i], v[i]));
                        radiance *= albedo;
                    }
                }
            }
        }
    }
}
