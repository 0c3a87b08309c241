//! Scenes in which light takes chains of specular interactions to a floor that is seen directly: one beam for each chain.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use super::super::chains::{Chains, Vertex};
use super::super::floor::Floor;
use super::super::light::Light;
use super::super::scene::{Scene, unit};
use super::{Aim, Emission, Landings, Outline, Rays, ToLight, Tracer, Vertices};
use crate::stream::{BLOCK, Lanes};

/// A scene behind the interface.
pub(super) struct Traced<L, S> {
    scene: Scene<L, S>,
    outline: Outline,
}

impl<L: Light, S: Chains> Traced<L, S> {
    pub(super) fn new(scene: Scene<L, S>) -> Self {
        let classes = scene.surface.classes();
        let outline = Outline {
            camera: scene.camera,
            floor: scene.floor,
            light: scene.light.position(),
            specular: classes.iter().any(PathClass::is_caustic),
            separates: !classes.contains(&PathClass::LDE),
            refracts: S::REFRACTS,
            meets_itself: S::MEETS_ITSELF,
            seen_through: false,
            radiance_scale: 1.0,
            radiance_gain: scene.surface.radiance_gain(),
        };
        Traced { scene, outline }
    }
}

impl<L: Light, S: Chains> Tracer for Traced<L, S> {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn chains(&self) -> &'static [PathClass] {
        self.scene.surface.classes()
    }

    fn emission(&self, aim: Aim) -> Emission {
        let Scene { light, surface, .. } = &self.scene;
        let seen = self.scene.seen_floor();
        let floor = match aim {
            Aim::Chain(_) => seen,
            _ => self.scene.floor.hull(),
        };
        let targets: Vec<_> = (0..surface.classes().len())
            .map(|chain| surface.targets(chain, &floor))
            .collect();
        let highest = targets.iter().flatten().map(|p| p.z).fold(0.0, f64::max);
        match aim {
            Aim::Scene => light.narrow(&targets.concat(), highest).into(),
            Aim::Table(chain) => light.spread(&targets[chain], highest).into(),
            Aim::Chain(chain) => light.narrow(&targets[chain], highest).into(),
        }
    }

    fn beams(&self) -> usize {
        self.scene.surface.classes().len()
    }

    fn aim(&self, beam: usize) -> Aim {
        Aim::Chain(beam)
    }

    fn land(&self, beam: usize, rays: &Rays, landings: &mut Landings) {
        let Scene { surface, floor, .. } = &self.scene;
        for i in 0..BLOCK {
            let leg = surface.follow(beam, rays.origin.get(i), rays.direction.get(i));
            let (o, d) = (leg.origin, leg.direction);
            let t = Floor::meet(o, d);
            let (x, y) = (o.x + d.x * t, o.y + d.y * t);
            let reaches = leg.weight > 0.0 && t < f64::INFINITY && floor.contains(x, y);
            landings.x[i] = if reaches { x } else { 0.0 };
            landings.y[i] = if reaches { y } else { 0.0 };
            landings.weight[i] = if reaches { leg.weight } else { 0.0 };
            landings.cosine[i] = -d.z / f64::sqrt(d.dot(d));
            landings.chain[i] = beam as f64;
        }
    }

    fn see(&self, rays: &Rays, landings: &mut Landings) {
        let Scene { surface, floor, .. } = &self.scene;
        for i in 0..BLOCK {
            let (o, d) = (rays.origin.get(i), rays.direction.get(i));
            let t = Floor::meet(o, d);
            let (x, y) = (o.x + d.x * t, o.y + d.y * t);
            let met = t < f64::INFINITY && floor.contains(x, y);
            let reaches = met && !surface.blocks(o, d, t);
            landings.x[i] = if reaches { x } else { 0.0 };
            landings.y[i] = if reaches { y } else { 0.0 };
            landings.weight[i] = if reaches { 1.0 } else { 0.0 };
            landings.cosine[i] = -d.z / f64::sqrt(d.dot(d));
            landings.chain[i] = 0.0;
        }
    }

    fn meet(&self, chain: usize, rays: &Rays, vertices: &mut Vertices) {
        let surface = &self.scene.surface;
        let single = surface.classes()[chain].light.len() == 1;
        for i in 0..BLOCK {
            let (origin, direction) = (rays.origin.get(i), rays.direction.get(i));
            let unit = unit(direction);
            let vertex = if direction.z > 0.0 {
                surface.trace_back(chain, origin, unit)
            } else {
                surface.strike(chain, origin, unit)
            };
            let Some(vertex) = vertex else {
                vertices.weight[i] = 0.0;
                continue;
            };
            let way = vertex.point - origin;
            let t = f64::sqrt(way.dot(way) / direction.dot(direction));
            vertices.point.set(i, vertex.point);
            vertices.exact.set(i, vertex.direction);
            vertices.normal.set(i, vertex.normal);
            vertices.weight[i] = vertex.weight;
            vertices.arrival[i] = f64::abs(vertex.normal.dot(unit));
            vertices.t[i] = if single { t } else { f64::INFINITY };
        }
    }

    fn to_light(&self, vertices: &Vertices, connections: &mut ToLight) {
        let Scene { surface, light, .. } = &self.scene;
        for i in 0..BLOCK {
            connections.irradiance[i] = 0.0;
            if !(vertices.weight[i] > 0.0) {
                continue;
            }
            let vertex = Vertex {
                point: vertices.point.get(i),
                direction: vertices.exact.get(i),
                normal: vertices.normal.get(i),
                weight: vertices.weight[i],
            };
            let (towards, t_end) = light.towards(vertex.point);
            let direction = unit(towards);
            let difference = vertex.direction - direction;
            let cosine = vertex.normal.dot(direction);
            connections.squared_chord[i] = difference.dot(difference);
            connections.cosine[i] = cosine;
            if cosine > 0.0 && surface.again(&vertex, towards) >= t_end {
                connections.irradiance[i] = light.normal_irradiance(towards);
            }
        }
    }

    fn lit(&self, x: &Lanes, y: &Lanes, irradiance: &mut Lanes, cosine: &mut Lanes) {
        let Scene { surface, light, .. } = &self.scene;
        for i in 0..BLOCK {
            let vertex = DVec3::new(x[i], y[i], 0.0);
            let (towards, t_end) = light.towards(vertex);
            cosine[i] = towards.z / f64::sqrt(towards.dot(towards));
            let free = cosine[i] > 0.0 && !surface.blocks(vertex, towards, t_end);
            irradiance[i] = if free {
                light.normal_irradiance(towards)
            } else {
                0.0
            };
        }
    }

    fn seen(&self, x: &Lanes, y: &Lanes, free: &mut Lanes) {
        let Scene {
            surface, camera, ..
        } = &self.scene;
        for i in 0..BLOCK {
            let vertex = DVec3::new(x[i], y[i], 0.0);
            let blocked = surface.blocks(vertex, camera.position - vertex, 1.0);
            free[i] = f64::from(!blocked);
        }
    }
}
