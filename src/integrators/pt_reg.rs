//! `pt-reg`: path tracing with next event estimation, and a regularized connection where there is none.
//!
//! From the floor point x a direction is drawn with density cos θ/π. Where it meets the specular surface, at s, the
//! exactly reflected or refracted direction is compared with the direction to the light: the delta of the surface is
//! replaced by a kernel φ_α on the angle g between them [Kaplanyan & Dachsbacher 2013]. Technique `camera`: an irradiance
//! sample at x is π R I φ_α(g)/r₂², r₂ = |s - y| (directional light: π R E₀ φ_α(g)); at an interface
//! π n² T I φ_α(g)/r₂². There is no cosine at s: φ_α is a density in solid angle, as the delta is.

use core::f64::consts::PI;

use glam::DVec3;
use multiversion::multiversion;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind};

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::scene::{Scene, unit};
use crate::geometry::specular::Specular;
use crate::geometry::turn::sin_cos_of_turns;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::camera_paths::{CAUSTIC, CameraPaths, DIRECT, select};
use super::defect::Defect;
use super::deviation::{Deviation, Sound};
use super::kernel::{AngleKernel, Kernel};
use super::plan::{next_event_plan, not_sampled, plan_of};
use super::regularized_chains::RegularizedChains;
use super::settings::{Mollified, Settings};
use super::{
    ClassPlan, Integrator, Plan, Prepared, Technique, Treatment, Unsupported, regularizes,
};

/// Path tracing with regularized connections.
pub struct PtReg {
    kernel: Kernel,
    settings: Settings,
}

impl PtReg {
    /// The method, with a cone unless the settings name another kernel on the angle.
    pub fn new(settings: Settings) -> Self {
        PtReg {
            kernel: settings.kernel.unwrap_or(Kernel::Cone),
            settings,
        }
    }
}

impl Integrator for PtReg {
    fn name(&self) -> &'static str {
        "pt-reg"
    }

    fn title(&self) -> &'static str {
        "path tracing with next event estimation, caustics regularized at the specular vertex next to the light"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        let plane = matches!(entry.kind, Kind::PlanarChains(_));
        plan_of(entry, |class| {
            if self.settings.mollified == Mollified::Every && class.light.len() > 1 {
                return every_vertex(class, self.kernel, plane);
            }
            next_event_plan(class).unwrap_or_else(|| ClassPlan {
                class,
                treatment: Treatment::Regularized(Technique::Camera),
                reason: format!(
                    "irregular: light and specular vertex are both singular; {} kernel on the angle at the specular \
                     vertex next to the light, cosine-distributed direction from the floor{}",
                    self.kernel,
                    match class.light.len() {
                        0 | 1 => String::new(),
                        2 => ", the other interaction exact".to_owned(),
                        n => format!(", the other {} interactions exact", n - 1),
                    }
                ),
            })
        })
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        regularizes(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        let overrides = Defect::new(self.settings.fault).overrides();
        let (kernel, settings) = (self.kernel, self.settings);
        visit(entry, overrides, Prepare { kernel, settings })
    }
}

/// The plan for a chain of which every vertex is mollified.
fn every_vertex(class: PathClass, kernel: Kernel, among_plane_mirrors: bool) -> ClassPlan {
    if !among_plane_mirrors {
        return not_sampled(
            class,
            "every vertex of a chain is mollified among plane mirrors only; the one next to the light, on any surface",
        );
    }
    let count = class.light.len();
    ClassPlan {
        class,
        treatment: Treatment::Regularized(Technique::CameraEveryVertex),
        reason: format!(
            "irregular: {kernel} kernels on the angles at all {count} specular vertices, d = {}; cosine-distributed \
             direction from the floor, uniform ones from the mirrors",
            2 * count
        ),
    }
}

/// What is prepared once the kind of the scene is known.
struct Prepare {
    kernel: Kernel,
    settings: Settings,
}

impl Visitor for Prepare {
    type Output = Box<dyn Prepared>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        let Prepare { kernel, settings } = self;
        match settings.fault {
            None => Box::new(PreparedPtReg {
                scene,
                kernel,
                settings,
                defect: Sound,
            }),
            fault => Box::new(PreparedPtReg {
                scene,
                kernel,
                settings,
                defect: Defect::new(fault),
            }),
        }
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        Box::new(RegularizedChains::new(scene, self.kernel, self.settings))
    }

    fn furnace(self, _: Furnace) -> Box<dyn Prepared> {
        Box::new(Unsupported)
    }
}

struct PreparedPtReg<L, S, D> {
    scene: Scene<L, S>,
    kernel: Kernel,
    settings: Settings,
    defect: D,
}

impl<L: Light, S: Specular, D: Deviation> Prepared for PreparedPtReg<L, S, D> {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let before = film.nonzero.iter().sum();
        let bandwidth = self.defect.bandwidth(iteration, bandwidth);
        let kernel = AngleKernel::new(self.kernel, bandwidth, self.settings.fault);
        let mut block = Block::new();
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            trace(
                &self.scene,
                &self.defect,
                &kernel,
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
    paths: CameraPaths,
    value: Lanes,
    squared_chord: Lanes,
    u: Lanes,
    v: Lanes,
}

impl Block {
    fn new() -> Self {
        Block {
            paths: CameraPaths::new(),
            value: zeros(),
            squared_chord: zeros(),
            u: zeros(),
            v: zeros(),
        }
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn trace<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    defect: &D,
    kernel: &AngleKernel,
    stream: &Stream,
    first: u64,
    live: usize,
    block: &mut Block,
    film: &mut Film,
) {
    let Block {
        paths,
        value,
        squared_chord,
        u,
        v,
    } = block;
    paths.draw(scene, defect, stream, first, live);
    if !S::SEPARATES && film.reads(&DIRECT) {
        paths.next_event(scene, defect, value);
        paths.splat(film, DIRECT, value);
    }
    if S::EXISTS && film.reads(&CAUSTIC) {
        stream.pairs(first, Dimension::Direction, u, v);
        defect.numbers(Dimension::Direction, u, v);
        connect(scene, defect, paths, u, v, value, squared_chord);
        finish(scene.camera.pixels(), defect, kernel, value, squared_chord);
        paths.splat(film, CAUSTIC, value);
    }
}

/// Everything but the kernel: what it multiplies, and where it is evaluated.
#[inline(always)]
fn connect<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    defect: &D,
    paths: &CameraPaths,
    u: &Lanes,
    v: &Lanes,
    value: &mut Lanes,
    squared_chord: &mut Lanes,
) {
    // Into a medium of index n radiance grows by n², the inverse of what it loses on its way out.
    let common = scene.floor.bsdf * PI / scene.surface.radiance_scale();
    let scale = CAUSTIC.map(|class| common * defect.class_scale(class));
    for i in 0..BLOCK {
        let (sine, cosine) = sin_cos_of_turns(u[i]);
        let (r, z) = defect.scattered(v[i]);
        let origin = DVec3::new(paths.x[i], paths.y[i], 0.0);
        let direction = DVec3::new(r * cosine, r * sine, z);
        let meeting = scene.surface.meet(origin, direction);
        let (towards, _) = scene.light.towards(meeting.point);
        let difference = meeting.direction - unit(towards);
        let scale = if paths.via[i] > 0.5 {
            scale[1]
        } else {
            scale[0]
        };
        let irradiance = defect.falloff(scene.light.normal_irradiance(towards), towards);
        let sample = scale * paths.weight[i] * meeting.weight * irradiance;
        squared_chord[i] = difference.dot(difference);
        value[i] = if meeting.weight > 0.0 {
            sample * defect.beside_own_cosine(z) * defect.at_specular(direction, meeting.direction)
        } else {
            0.0
        };
    }
}

/// Multiplies by the kernel, where it is not zero.
#[inline(always)]
fn finish<D: Deviation>(
    pixels: f64,
    defect: &D,
    kernel: &AngleKernel,
    value: &mut Lanes,
    squared_chord: &Lanes,
) {
    let mut list = [0_u16; BLOCK];
    let n = select(&mut list, |i| {
        (value[i] > 0.0) & (squared_chord[i] < kernel.support)
    });
    let sample = core::mem::replace(value, zeros());
    for &i in &list[..n] {
        let i = usize::from(i);
        value[i] = defect.sample(sample[i] * kernel.density(squared_chord[i]), pixels);
    }
}
