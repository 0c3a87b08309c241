//! Bidirectional path tracing where light bounces between diffuse walls: all techniques of the classes LD+E.
//!
//! A path of LDᵏE has the diffuse vertices x₁ … x_k, from the light to the eye. From the light, x₁ has the density
//! E_n cos θ₁/Φ per area and x_{i+1} the density cos θ cos θ'/(π d²), seen from x_i; from the eye, x_k has q/P, of P pixels, q of them
//! per area, and x_{i-1} again cos θ cos θ'/(π d²). Technique (s, t) draws x₁ … x_{s-1} from the light and the rest from
//! the eye: its density is the product. What the path brings, per area of all its vertices, is
//!
//! ```text
//! f = E_n cos θ₁ (ρ/π)ᵏ q ∏ cos θ cos θ'/d²
//! ```
//!
//! and each of the k + 1 techniques adds f/p w.

use core::f64::consts::PI;

use glam::DVec3;

use crate::film::Film;
use crate::geometry::emission::Emitter;
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::tracer::uniforms;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::Prepared;
use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;
use super::furnace::{VERTICES, layers};
use super::settings::Settings;

/// The directions of light subpaths, after the first diffuse vertex, and of camera subpaths.
const LIGHT_TURNS: [Dimension; VERTICES - 1] = [
    Dimension::LightDirection,
    Dimension::SecondLightDirection,
    Dimension::ThirdLightDirection,
];
const EYE_TURNS: [Dimension; VERTICES - 1] = [
    Dimension::Direction,
    Dimension::SecondDirection,
    Dimension::ThirdDirection,
];

/// Bidirectional path tracing in a closed diffuse sphere.
pub(super) struct BidirectionalWalks {
    scene: Furnace,
    settings: Settings,
}

/// A path through the diffuse vertices of LDᵏE, the first one next to the light.
#[derive(Clone, Copy)]
pub(super) struct Walk {
    pub(super) vertices: [DVec3; VERTICES],
    pub(super) length: usize,
}

/// A full path's measures.
pub(super) struct Measures {
    /// Of technique (s, k + 2 - s), at s - 1: its density per area of all vertices.
    pub(super) densities: [f64; VERTICES + 1],
    /// What the path brings to its pixel, per area of all vertices.
    pub(super) brought: f64,
}

impl BidirectionalWalks {
    pub(super) fn new(scene: Furnace, settings: Settings) -> Self {
        BidirectionalWalks { scene, settings }
    }

    /// cos θ cos θ'/d² between two points of the wall.
    fn coupling(&self, a: DVec3, b: DVec3) -> f64 {
        let d = b - a;
        let square = d.dot(d);
        let product = self.scene.normal(a).dot(d) * -self.scene.normal(b).dot(d);
        product / (square * square)
    }

    /// The densities of all techniques, and the contribution, of a full path.
    pub(super) fn measures(&self, walk: &Walk) -> Measures {
        let Furnace {
            light,
            camera,
            albedo,
            ..
        } = &self.scene;
        let path = &walk.vertices[..walk.length];
        let couplings: [f64; VERTICES - 1] = core::array::from_fn(|i| match path.get(i + 1) {
            Some(&next) => self.coupling(path[i], next),
            None => 1.0,
        });
        let (towards, _) = light.towards(path[0]);
        let cosine = self.scene.normal(path[0]).dot(towards) / f64::sqrt(towards.dot(towards));
        let arriving = light.normal_irradiance(towards) * cosine;
        let last = path[walk.length - 1];
        let (_, _, seen) = camera.project(last, self.scene.normal(last));
        let flux = light.everywhere().flux();
        let mut densities = [0.0; VERTICES + 1];
        for (drawn, density) in densities.iter_mut().enumerate().take(walk.length + 1) {
            // `drawn` vertices from the light, the others from the eye.
            let from_light = |i: usize| {
                if i == 0 {
                    arriving / flux
                } else {
                    couplings[i - 1] / PI
                }
            };
            let from_eye = |i: usize| {
                if i + 1 == walk.length {
                    seen / camera.pixels()
                } else {
                    couplings[i] / PI
                }
            };
            let light: f64 = (0..drawn).map(from_light).product();
            let eye: f64 = (drawn..walk.length).map(from_eye).product();
            *density = light * eye;
        }
        let bounces: f64 = (0..walk.length).map(|_| albedo / PI).product();
        Measures {
            densities,
            brought: arriving
                * bounces
                * seen
                * couplings[..walk.length - 1].iter().product::<f64>(),
        }
    }

    /// What a technique adds with a path of its own, weighted.
    fn sample(&self, walk: &Walk, drawn: usize) -> f64 {
        let m = self.measures(walk);
        let own = m.densities[drawn];
        if !(own > 0.0) {
            return 0.0;
        }
        let densities = &m.densities[..=walk.length];
        m.brought / own * self.settings.heuristic.weight(drawn, densities)
    }

    /// Where a light subpath meets the wall, time after time.
    fn light_subpath(&self, u: f64, v: f64, turns: &[[Lanes; 2]], i: usize) -> [DVec3; VERTICES] {
        let (origin, direction) = self.scene.light.everywhere().ray(u, v);
        self.walk(self.scene.hit(origin, direction), turns, i)
    }

    fn walk(&self, first: DVec3, turns: &[[Lanes; 2]], i: usize) -> [DVec3; VERTICES] {
        let mut points = [first; VERTICES];
        for (k, [u, v]) in turns.iter().enumerate() {
            let normal = self.scene.normal(points[k]);
            let direction = Furnace::scattered(normal, u[i], v[i]);
            points[k + 1] = self.scene.hit(points[k], direction);
        }
        points
    }
}

/// The path that the first `drawn` vertices of a light subpath and the first `length - drawn` of a camera subpath make.
fn joined(light: &[DVec3; VERTICES], eye: &[DVec3; VERTICES], drawn: usize, length: usize) -> Walk {
    let vertices = core::array::from_fn(|i| {
        if i < drawn {
            light[i]
        } else if i < length {
            eye[length - 1 - i]
        } else {
            light[0]
        }
    });
    Walk { vertices, length }
}

impl Prepared for BidirectionalWalks {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let camera = &self.scene.camera;
        let defect = Defect::new(self.settings.fault);
        let (seed, iteration) = defect.address(seed, iteration);
        let layers = layers(film, &defect);
        let (columns, rows) = camera.size();
        let stream = Stream::new(seed, iteration);
        let (mut column, mut row) = (zeros(), zeros());
        let (mut u, mut v) = (zeros(), zeros());
        let mut light_turns = [[zeros(); 2]; LIGHT_TURNS.len()];
        let mut eye_turns = [[zeros(); 2]; EYE_TURNS.len()];
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            uniforms(&stream, first, Dimension::Film, &mut column, &mut row);
            uniforms(&stream, first, Dimension::Emission, &mut u, &mut v);
            for (k, [u, v]) in light_turns.iter_mut().enumerate() {
                uniforms(&stream, first, LIGHT_TURNS[k], u, v);
            }
            for (k, [u, v]) in eye_turns.iter_mut().enumerate() {
                uniforms(&stream, first, EYE_TURNS[k], u, v);
            }
            for i in 0..live {
                let (column, row) = (column[i] * columns, row[i] * rows);
                let light = self.light_subpath(u[i], v[i], &light_turns, i);
                let seen = self
                    .scene
                    .hit(camera.position, camera.direction(column, row));
                let eye = self.walk(seen, &eye_turns, i);
                for (k, layer) in layers.iter().enumerate() {
                    let Some((layer, scale)) = *layer else {
                        continue;
                    };
                    let length = k + 1;
                    for drawn in 0..=length {
                        let walk = joined(&light, &eye, drawn, length);
                        let value = scale * self.sample(&walk, drawn);
                        if !(value > 0.0) {
                            continue;
                        }
                        let (column, row) = if drawn == length {
                            let last = walk.vertices[length - 1];
                            let (u, v, _) = camera.project(last, self.scene.normal(last));
                            (u, v)
                        } else {
                            (column, row)
                        };
                        add(film, layer, column, row, value);
                        film.nonzero[layer] += 1;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entry;
    use crate::geometry::tracer::{Traceable, traceable};
    use crate::integrators::mis::Heuristic;

    fn walks(heuristic: Heuristic) -> BidirectionalWalks {
        let entry = entry::load("furnace").unwrap();
        let scene = match traceable(&entry, Default::default()) {
            Traceable::Furnace(scene) => scene,
            Traceable::Floor(_) => panic!("a furnace has no floor"),
        };
        let settings = Settings {
            heuristic,
            ..Settings::default()
        };
        BidirectionalWalks::new(scene, settings)
    }

    /// Every technique alone, unweighted, has the mean of the others: their densities are those of what they draw. LDDE
    /// and LDDDE, 3 000 000 paths each: within 6 standard errors of the one that knows it best (2e-9 each); it would catch 2 %.
    #[test]
    fn every_technique_alone_has_the_same_mean() {
        let walks = walks(Heuristic::Balance);
        let camera = &walks.scene.camera;
        let (columns, rows) = camera.size();
        let n = 3_000_000_usize;
        let mut sums = [[[0.0; 2]; VERTICES + 1]; 3];
        let (mut column, mut row, mut u, mut v) = (zeros(), zeros(), zeros(), zeros());
        let mut turns = [[[zeros(); 2]; 3], [[zeros(); 2]; 3]];
        let stream = Stream::new(8, 8);
        for first in (0..n as u64).step_by(BLOCK) {
            stream.pairs(first, Dimension::Film, &mut column, &mut row);
            stream.pairs(first, Dimension::Emission, &mut u, &mut v);
            for (turns, dimensions) in turns.iter_mut().zip([LIGHT_TURNS, EYE_TURNS]) {
                for ([u, v], dimension) in turns.iter_mut().zip(dimensions) {
                    stream.pairs(first, dimension, u, v);
                }
            }
            for i in 0..BLOCK {
                let light = walks.light_subpath(u[i], v[i], &turns[0], i);
                let direction = camera.direction(column[i] * columns, row[i] * rows);
                let seen = walks.scene.hit(camera.position, direction);
                let eye = walks.walk(seen, &turns[1], i);
                for length in 1..=3 {
                    for (drawn, sum) in sums[length - 1][..=length].iter_mut().enumerate() {
                        let m = walks.measures(&joined(&light, &eye, drawn, length));
                        let value = if m.brought > 0.0 {
                            m.brought / m.densities[drawn]
                        } else {
                            0.0
                        };
                        sum[0] += value;
                        sum[1] += value * value;
                    }
                }
            }
        }
        let n = (n as f64 / BLOCK as f64).ceil() * BLOCK as f64;
        for (k, sums) in sums.iter().enumerate() {
            let figures: Vec<_> = sums[..k + 2]
                .iter()
                .map(|[sum, square]| {
                    let mean = sum / n;
                    // Rounding can make a variance that is next to nothing negative.
                    let variance = (square / n - mean * mean).max(0.0);
                    (mean, f64::sqrt(variance / n) + 1e-9 * mean)
                })
                .collect();
            let best = figures.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            let (mean, sure) = best.copied().unwrap_or_default();
            for (value, error) in &figures {
                println!("{}: {:.4} ± {:.4}", k + 1, value / mean, error / mean);
                assert!(
                    (value - mean).abs() < 6.0 * (error + sure) + 1e-12 * mean,
                    "{k} {figures:?}"
                );
                assert!(6.0 * error < 0.02 * mean, "{k}: {error} of {mean}");
            }
        }
    }

    #[test]
    fn weights_of_a_walk_sum_to_one() {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let walks = walks(heuristic);
            for k in 0..50 {
                let at = |m: u32| {
                    let v = f64::from(7 * k + m) * 0.618_033_988_749_894_8 + 0.1;
                    v - f64::floor(v)
                };
                let (u, v) = ([at(1); BLOCK], [at(2); BLOCK]);
                let turns = [[u, v]; 3];
                let path = walks.light_subpath(at(3), at(4), &turns, 0);
                for length in 1..=VERTICES {
                    let walk = Walk {
                        vertices: path,
                        length,
                    };
                    let m = walks.measures(&walk);
                    let densities = &m.densities[..=length];
                    let sum: f64 = (0..=length)
                        .filter(|&s| densities[s] > 0.0)
                        .map(|s| heuristic.weight(s, densities))
                        .sum();
                    assert!((sum - 1.0).abs() < 1e-12);
                }
            }
        }
    }
}
