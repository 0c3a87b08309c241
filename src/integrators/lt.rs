//! `lt`: light tracing, photons connected to the pinhole from the floor.
//!
//! Photons are equally likely over everything that can reach the floor or the specular surface (a cap of directions
//! about a point light's downward axis, or a cross-section of a directional beam) and carry equal flux Φ. One that lands
//! in x adds Φ R (ρ/π) times the film area, in pixels, per unit of floor area at x: an exact sample of LDE or LSDE. The
//! pinhole cannot be met through a specular surface.

use glam::DVec3;
use multiversion::multiversion;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, takes_chains, visit};
use crate::geometry::emission::Emitter;
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::geometry::specular::Specular;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::camera_paths::{add, select};
use super::chains::LightChains;
use super::defect::Defect;
use super::deviation::{Deviation, Sound};
use super::furnace::LightWalks;
use super::plan::{not_sampled, plan_of, walk_plan};
use super::sampleable::Family;
use super::settings::Settings;
use super::{ClassPlan, Fault, Integrator, Plan, Prepared, Technique, Treatment};

/// Light tracing.
pub struct Lt {
    settings: Settings,
}

impl Lt {
    /// The method; the kernel is ignored.
    pub fn new(settings: Settings) -> Self {
        Lt { settings }
    }
}

/// The classes that a light path can end in: straight, or through the specular surface.
const CLASSES: [PathClass; 2] = [PathClass::LDE, PathClass::LSDE];

impl Integrator for Lt {
    fn name(&self) -> &'static str {
        "lt"
    }

    fn title(&self) -> &'static str {
        "light tracing to the pinhole"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        plan_of(entry, |class| {
            if class.diffuse > 1 {
                return walk_plan(class, Technique::LightTracing);
            }
            if class.eye.is_empty() {
                ClassPlan {
                    class,
                    treatment: Treatment::Exact(Technique::LightTracing),
                    reason: if takes_chains(entry) || entry.kind.floor().is_none() {
                        "photons, uniform over a cone (or beam) about what the class meets first, connected to the \
                         pinhole from the floor"
                    } else {
                        "photons, uniform over the smallest downward cap (or beam) that contains floor and specular \
                         surface, connected to the pinhole from the floor"
                    }
                    .to_owned(),
                }
            } else {
                not_sampled(
                    class,
                    "the pinhole is a point and the vertex next to it is specular: no light path can hit it",
                )
            }
        })
    }

    fn family(&self) -> Family {
        Family::LightTracing
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        let fault = self.settings.fault;
        visit(entry, Defect::new(fault).overrides(), Prepare { fault })
    }
}

/// What is prepared once the kind of the scene is known.
struct Prepare {
    fault: Option<Fault>,
}

impl Visitor for Prepare {
    type Output = Box<dyn Prepared>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        match self.fault {
            None => prepared(scene, Sound),
            fault => prepared(scene, Defect::new(fault)),
        }
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        Box::new(LightChains::new(scene, Defect::new(self.fault)))
    }

    fn furnace(self, scene: Furnace) -> Box<dyn Prepared> {
        Box::new(LightWalks::new(scene, Defect::new(self.fault)))
    }
}

fn prepared<L: Light, S: Specular, D: Deviation>(
    scene: Scene<L, S>,
    defect: D,
) -> Box<dyn Prepared> {
    let mut targets = scene.floor.hull();
    targets.extend(scene.surface.hull());
    let emitter = if defect.unaimed() {
        scene.light.unaimed(&targets)
    } else {
        scene.light.aimed(&targets)
    };
    Box::new(PreparedLt {
        scene,
        emitter,
        defect,
    })
}

struct PreparedLt<L: Light, S, D> {
    scene: Scene<L, S>,
    emitter: L::Emitter,
    defect: D,
}

impl<L: Light, S: Specular, D: Deviation> Prepared for PreparedLt<L, S, D> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        if S::SEPARATES {
            // Every line from the floor to the pinhole is interrupted: there is nothing to sample.
            return;
        }
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let before = film.nonzero.iter().sum();
        let mut block = Block::new();
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            trace(
                &self.scene,
                &self.emitter,
                &self.defect,
                &stream,
                first,
                live,
                &mut block,
                film,
            );
        }
        self.defect.finish(paths, before, film);
    }
}

struct Block {
    u: Lanes,
    v: Lanes,
    value: Lanes,
    via: Lanes,
}

impl Block {
    fn new() -> Self {
        Block {
            u: zeros(),
            v: zeros(),
            value: zeros(),
            via: zeros(),
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn trace<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    emitter: &L::Emitter,
    defect: &D,
    stream: &Stream,
    first: u64,
    live: usize,
    block: &mut Block,
    film: &mut Film,
) {
    let Block { u, v, value, via } = block;
    stream.pairs(first, Dimension::Emission, u, v);
    defect.numbers(Dimension::Emission, u, v);
    let flux = defect.flux(emitter.flux());
    let scale = CLASSES.map(|class| flux * scene.floor.bsdf * defect.class_scale(class));
    for i in 0..BLOCK {
        let (origin, direction) = emitter.ray(u[i], v[i]);
        let landing = scene.landing(origin, direction);
        let vertex = defect.landed(DVec3::new(landing.x, landing.y, 0.0));
        let (column, row, density) = scene.camera.project_floor(vertex);
        let (column, row, kept) = defect.placed(&scene.camera, column, row);
        let towards = scene.camera.position - vertex;
        let free = defect.seen(!scene.surface.blocks(vertex, towards, 1.0));
        let scale = if landing.via { scale[1] } else { scale[0] };
        let radiance = scale * landing.weight * defect.beside_cosine(landing.cosine);
        let radiance = radiance * kept * defect.at_connection(&scene.camera, vertex);
        let radiance = radiance * defect.roulette(u[i]);
        let counts = free & (landing.weight > 0.0) & (density > 0.0);
        u[i] = column;
        v[i] = row;
        value[i] = if counts { radiance * density } else { 0.0 };
        via[i] = if landing.via { 1.0 } else { 0.0 };
    }
    value[live..].fill(0.0);
    let mut list = [0_u16; BLOCK];
    for (k, class) in CLASSES.into_iter().enumerate() {
        let Some(layer) = film.layer_of(class) else {
            continue;
        };
        let wanted = k as f64;
        let n = select(&mut list, |i| (value[i] > 0.0) & (via[i] == wanted));
        for &i in &list[..n] {
            let i = usize::from(i);
            add(film, layer, u[i], v[i], value[i]);
        }
        film.nonzero[layer] += n as u64;
    }
}
