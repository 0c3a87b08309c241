//! Scenes with at most one specular interaction on either side of the floor: branch-free, by blocks.

use glam::DVec3;
use multiversion::multiversion;
use nephroid_analytic::class::PathClass;

use super::super::chains::Chains as _;
use super::super::floor::Floor;
use super::super::light::Light;
use super::super::once::Once;
use super::super::scene::{Scene, unit};
use super::super::specular::Specular;
use super::{Aim, Emission, Landings, Outline, Rays, ToLight, Tracer, Vertices};
use crate::stream::{BLOCK, Lanes};

/// Straight, and through the surface.
const CHAINS: [PathClass; 2] = [PathClass::LDE, PathClass::LSDE];

/// A scene behind the interface.
pub(super) struct Traced<L, S> {
    scene: Scene<L, S>,
    outline: Outline,
}

impl<L: Light, S: Specular> Traced<L, S> {
    pub(super) fn new(scene: Scene<L, S>) -> Self {
        let outline = Outline {
            camera: scene.camera,
            floor: scene.floor,
            light: scene.light.position(),
            specular: S::EXISTS,
            separates: S::SEPARATES,
            refracts: S::SEPARATES,
            meets_itself: S::MEETS_ITSELF,
            seen_through: S::EXISTS,
            radiance_scale: scene.surface.radiance_scale(),
            radiance_gain: 1.0 / scene.surface.radiance_scale(),
        };
        Traced { scene, outline }
    }
}

impl<L: Light, S: Specular> Tracer for Traced<L, S> {
    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn chains(&self) -> &'static [PathClass] {
        &CHAINS[..1 + usize::from(S::EXISTS)]
    }

    fn emission(&self, aim: Aim) -> Emission {
        let Scene {
            light,
            surface,
            floor,
            ..
        } = &self.scene;
        let (floor, hull) = (floor.hull(), surface.hull());
        match aim {
            Aim::Scene if S::EXISTS && hull.is_empty() => light.downwards(&floor).into(),
            Aim::Scene => light.aimed(&[floor, hull].concat()).into(),
            Aim::Table(0) => light.unaimed(&floor).into(),
            Aim::Table(_) => light.unaimed(&hull).into(),
            Aim::Chain(0) => light.narrow(&floor, 0.0).into(),
            Aim::Chain(_) if hull.is_empty() => light.downwards(&floor).into(),
            Aim::Chain(chain) => {
                let targets = Once(*surface).targets(chain.min(1), &floor);
                light.narrow(&targets, 0.0).into()
            }
        }
    }

    fn beams(&self) -> usize {
        1
    }

    fn aim(&self, _: usize) -> Aim {
        Aim::Scene
    }

    fn land(&self, _: usize, rays: &Rays, landings: &mut Landings) {
        land(&self.scene, rays, landings);
    }

    fn see(&self, rays: &Rays, landings: &mut Landings) {
        land(&self.scene, rays, landings);
    }

    fn meet(&self, _: usize, rays: &Rays, vertices: &mut Vertices) {
        meet(&self.scene.surface, rays, vertices);
    }

    fn to_light(&self, vertices: &Vertices, connections: &mut ToLight) {
        to_light(&self.scene, vertices, connections);
    }

    fn lit(&self, x: &Lanes, y: &Lanes, irradiance: &mut Lanes, cosine: &mut Lanes) {
        lit(&self.scene, x, y, irradiance, cosine);
    }

    fn seen(&self, x: &Lanes, y: &Lanes, free: &mut Lanes) {
        seen(&self.scene, x, y, free);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn land<L: Light, S: Specular>(scene: &Scene<L, S>, rays: &Rays, landings: &mut Landings) {
    for i in 0..BLOCK {
        let landing = scene.landing(rays.origin.get(i), rays.direction.get(i));
        landings.x[i] = landing.x;
        landings.y[i] = landing.y;
        landings.weight[i] = landing.weight;
        landings.cosine[i] = landing.cosine;
        landings.chain[i] = if landing.via { 1.0 } else { 0.0 };
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn meet<S: Specular>(surface: &S, rays: &Rays, vertices: &mut Vertices) {
    for i in 0..BLOCK {
        let (origin, direction) = (rays.origin.get(i), rays.direction.get(i));
        let meeting = surface.meet(origin, direction);
        let met = meeting.t < Floor::meet(origin, direction);
        let length = f64::sqrt(direction.dot(direction));
        let normal = surface.normal_after(&meeting);
        vertices.point.set(i, meeting.point);
        vertices.exact.set(i, meeting.direction / length);
        vertices.normal.set(i, normal);
        vertices.weight[i] = if met { meeting.weight } else { 0.0 };
        vertices.arrival[i] = f64::abs(normal.dot(direction)) / length;
        vertices.t[i] = meeting.t;
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn to_light<L: Light, S: Specular>(
    scene: &Scene<L, S>,
    vertices: &Vertices,
    connections: &mut ToLight,
) {
    for i in 0..BLOCK {
        let point = vertices.point.get(i);
        let (towards, t_end) = scene.light.towards(point);
        let direction = unit(towards);
        let difference = vertices.exact.get(i) - direction;
        let cosine = vertices.normal.get(i).dot(direction);
        let free = scene.surface.again(point, towards) >= t_end;
        let irradiance = scene.light.normal_irradiance(towards);
        let counts = free & (cosine > 0.0) & (vertices.weight[i] > 0.0);
        connections.squared_chord[i] = difference.dot(difference);
        connections.cosine[i] = cosine;
        connections.irradiance[i] = if counts { irradiance } else { 0.0 };
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn lit<L: Light, S: Specular>(
    scene: &Scene<L, S>,
    x: &Lanes,
    y: &Lanes,
    irradiance: &mut Lanes,
    cosine: &mut Lanes,
) {
    for i in 0..BLOCK {
        let vertex = DVec3::new(x[i], y[i], 0.0);
        let (towards, t_end) = scene.light.towards(vertex);
        let normal = scene.light.normal_irradiance(towards);
        let free = !scene.surface.blocks(vertex, towards, t_end);
        cosine[i] = towards.z / f64::sqrt(towards.dot(towards));
        irradiance[i] = if free & (cosine[i] > 0.0) {
            normal
        } else {
            0.0
        };
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn seen<L: Light, S: Specular>(scene: &Scene<L, S>, x: &Lanes, y: &Lanes, free: &mut Lanes) {
    for i in 0..BLOCK {
        let vertex = DVec3::new(x[i], y[i], 0.0);
        let towards = scene.camera.position - vertex;
        let blocked = scene.surface.blocks(vertex, towards, 1.0);
        free[i] = if blocked { 0.0 } else { 1.0 };
    }
}
