//! `pt`: path tracing with next event estimation at the first diffuse vertex.
//!
//! A camera path cannot meet a point light or a directional one by chance, so only light that reaches the floor in a
//! straight line is sampled: LDE and LDSE.

use multiversion::multiversion;
use nephroid_analytic::scene::Entry;

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::geometry::specular::Specular;
use crate::stream::{BLOCK, Lanes, Stream, zeros};

use super::camera_paths::{CameraPaths, DIRECT};
use super::chains::DirectLight;
use super::defect::Defect;
use super::deviation::{Deviation, Sound};
use super::furnace::CameraWalks;
use super::plan::{next_event_plan, not_sampled, plan_of, walk_plan};
use super::settings::Settings;
use super::{Fault, Integrator, Plan, Prepared, Technique};

/// Path tracing with next event estimation.
pub struct Pt {
    settings: Settings,
}

impl Pt {
    /// The method; the kernel is ignored.
    pub fn new(settings: Settings) -> Self {
        Pt { settings }
    }
}

impl Integrator for Pt {
    fn name(&self) -> &'static str {
        "pt"
    }

    fn title(&self) -> &'static str {
        "path tracing with next event estimation"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        plan_of(entry, |class| {
            if class.diffuse > 1 {
                return walk_plan(class, Technique::NextEvent);
            }
            next_event_plan(class).unwrap_or_else(|| {
                not_sampled(
                    class,
                    "the light is a point or a direction and the vertex next to it is specular: no camera path hits it",
                )
            })
        })
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
            None => Box::new(PreparedPt {
                scene,
                defect: Sound,
            }),
            fault => Box::new(PreparedPt {
                scene,
                defect: Defect::new(fault),
            }),
        }
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        Box::new(DirectLight::new(scene, Defect::new(self.fault)))
    }

    fn furnace(self, scene: Furnace) -> Box<dyn Prepared> {
        Box::new(CameraWalks::new(scene, Defect::new(self.fault)))
    }
}

struct PreparedPt<L, S, D> {
    scene: Scene<L, S>,
    defect: D,
}

impl<L: Light, S: Specular, D: Deviation> Prepared for PreparedPt<L, S, D> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        if S::SEPARATES {
            // Every line from the floor to the light or to the eye is interrupted: there is nothing to sample.
            return;
        }
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let before = film.nonzero.iter().sum();
        let mut block = (CameraPaths::new(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            trace(
                &self.scene,
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

#[multiversion(targets("x86_64+avx2"))]
fn trace<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    defect: &D,
    stream: &Stream,
    first: u64,
    live: usize,
    block: &mut (CameraPaths, Lanes),
    film: &mut Film,
) {
    let (paths, value) = block;
    paths.draw(scene, defect, stream, first, live);
    paths.next_event(scene, defect, value);
    paths.splat(film, DIRECT, value);
}
