//! What `pm` and `ppm` do in an iteration: photons that came through the specular surface, merged with camera paths at
//! their first diffuse vertex.
//!
//! Light that reaches the floor directly is sampled by next event estimation, never merged, so in a scene without a
//! specular surface the radius changes no bit. An iteration of N paths is N photons and N camera paths. It is cut into maps
//! of so many photons each that a camera path meets about [`MET`] of them, so that memory and the cost of a path are
//! constant; the expectation does not depend on the size of a map. Photons are uniform over the sphere of
//! a point light (a cross-section of a directional beam that covers the mirror); one that lands in X adds
//! Φ k(|X - x|)/N to the irradiance at x, in which the cosine is already.

use std::sync::Arc;

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

use super::aim_of_photons::{Aimed, Aims, part_of};
use super::camera_paths::{CAUSTIC, CameraPaths, DIRECT, select};
use super::defect::Defect;
use super::deviation::{Deviation, Sound};
use super::kernel::{Kernel, RadiusKernel};
use super::merged_chains::MergedChains;
use super::photon_grid::{PhotonGrid, Photons};
use super::plan::{next_event_plan, plan_of};
use super::probes::aim::Part;
use super::settings::Settings;
use super::{ClassPlan, Plan, Prepared, Technique, Treatment, Unsupported};

/// Photons that a camera path meets in the nine cells around its vertex, about.
const MET: f64 = 128.0;
/// Photons traced for a map, at least and at most: powers of two.
const MAP: [u64; 2] = [1 << 12, 1 << 18];
/// Photons traced to find out how dense they lie.
pub(super) const PILOT: u64 = 1 << 13;

pub(super) fn kernel_of(settings: &Settings) -> Kernel {
    settings.kernel.unwrap_or(Kernel::Disc)
}

pub(super) fn merging_plan(entry: &Entry, kernel: Kernel) -> Plan {
    plan_of(entry, |class: PathClass| {
        next_event_plan(class).unwrap_or_else(|| ClassPlan {
            class,
            treatment: Treatment::Regularized(Technique::Merge),
            reason: format!(
                "irregular: light and specular vertex are both singular; merged with photons that came through the \
                 specular surface (uniform over the sphere of a point light, over the smallest beam that covers {} of \
                 a directional one), {kernel} kernel on the distance on the floor",
                if takes_chains(entry) {
                    "what the class meets first"
                } else {
                    "the mirror"
                }
            ),
        })
    })
}

/// The plan of a method that merges at radii of its own choice.
pub(super) fn adaptive_plan(entry: &Entry, how: &str) -> Plan {
    plan_of(entry, |class| {
        next_event_plan(class).unwrap_or_else(|| ClassPlan {
            class,
            treatment: Treatment::Regularized(Technique::AdaptiveMerge),
            reason: format!("irregular: light and specular vertex are both singular; {how}"),
        })
    })
}

pub(super) fn prepare(entry: &Entry, settings: &Settings) -> Box<dyn Prepared> {
    let overrides = Defect::new(settings.fault).overrides();
    let settings = *settings;
    visit(entry, overrides, Prepare { settings })
}

/// What is prepared once the kind of the scene is known.
struct Prepare {
    settings: Settings,
}

impl Visitor for Prepare {
    type Output = Box<dyn Prepared>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        let defect = Defect::new(self.settings.fault);
        prepared(scene, &self.settings, defect)
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        Box::new(MergedChains::new(scene, self.settings))
    }

    fn furnace(self, _: Furnace) -> Box<dyn Prepared> {
        Box::new(Unsupported)
    }
}

fn prepared<L: Light, S: Specular>(
    scene: Scene<L, S>,
    settings: &Settings,
    defect: Defect,
) -> Box<dyn Prepared> {
    match settings.fault {
        None => deviating(scene, settings, Sound),
        Some(_) => deviating(scene, settings, defect),
    }
}

fn deviating<L: Light, S: Specular, D: Deviation>(
    scene: Scene<L, S>,
    settings: &Settings,
    defect: D,
) -> Box<dyn Prepared> {
    let emitter = scene.light.unaimed(&scene.surface.hull());
    let mut mapping = PhotonMapping {
        scene,
        emitter,
        settings: *settings,
        defect,
        density: 0.0,
        aims: settings.aims_photons.then(Aims::default),
    };
    if S::EXISTS {
        mapping.density = mapping.pilot_density(None);
    }
    Box::new(mapping)
}

struct PhotonMapping<L: Light, S, D> {
    scene: Scene<L, S>,
    emitter: L::Emitter,
    settings: Settings,
    defect: D,
    /// Photons that reach the floor per photon traced and square metre of their bounding box, as a pilot found it.
    density: f64,
    /// Parts of the emission, if photons are aimed.
    aims: Option<Aims>,
}

/// Memory of an iteration.
struct Work {
    photons: Photons,
    grid: PhotonGrid,
    paths: CameraPaths,
    value: Lanes,
    u: Lanes,
    v: Lanes,
}

impl Work {
    fn new() -> Self {
        Work {
            photons: Photons::default(),
            grid: PhotonGrid::default(),
            paths: CameraPaths::new(),
            value: zeros(),
            u: zeros(),
            v: zeros(),
        }
    }
}

/// First path and number of paths of each block.
pub(super) fn blocks(start: u64, end: u64) -> impl Iterator<Item = (u64, usize)> {
    (start..end)
        .step_by(BLOCK)
        .map(move |first| (first, (end - first).min(BLOCK as u64) as usize))
}

impl<L: Light, S: Specular, D: Deviation> PhotonMapping<L, S, D> {
    /// Traces photons of a fixed stream, so that the size of a map depends on the scene and the radius alone, not on the
    /// photons that it will hold (which would bias it).
    fn pilot_density(&self, part: Option<&Part>) -> f64 {
        let stream = Stream::new(u64::MAX, u32::MAX);
        let mut work = Work::new();
        for (first, live) in blocks(0, PILOT) {
            emit(
                &self.scene,
                &self.emitter,
                part,
                &self.defect,
                &stream,
                first,
                live,
                &mut work,
            );
        }
        work.photons.x.len() as f64 / (PILOT as f64 * work.photons.area())
    }

    /// Where photons of a radius > 0 are aimed, if they are.
    fn aimed(&self, radius: f64) -> Option<Arc<Aimed>> {
        let make = |radius: f64| {
            let part = part_of(&self.scene, &self.emitter, radius);
            let density = if part.is_empty() {
                0.0
            } else {
                self.pilot_density(Some(&part))
            };
            Aimed { part, density }
        };
        let aims = self.aims.as_ref().filter(|_| S::EXISTS && radius > 0.0)?;
        Some(aims.of(radius, make))
    }
}

/// Photons for a map, from their density per photon traced.
pub(super) fn map_size(density: f64, radius: f64) -> u64 {
    map_size_of_at_least(MAP[0], density, radius)
}

/// The same, a power of two of at least `least`.
fn map_size_of_at_least(least: u64, density: f64, radius: f64) -> u64 {
    let met = density * 9.0 * radius * radius;
    let mut size = least;
    // No photon at all gives NaN, and the smallest map.
    while size < MAP[1] && (2 * size) as f64 * met <= MET {
        size *= 2;
    }
    size
}

impl<L: Light, S: Specular, D: Deviation> Prepared for PhotonMapping<L, S, D> {
    fn share_of_emission(&self, bandwidth: f64) -> f64 {
        self.aimed(bandwidth)
            .map_or(1.0, |aimed| aimed.part.share())
    }

    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let before = film.nonzero.iter().sum();
        self.defect.begin(iteration, film);
        let bandwidth = self.defect.bandwidth(iteration, bandwidth);
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let kernel = RadiusKernel::new(kernel_of(&self.settings), bandwidth, self.settings.fault);
        let mut work = Work::new();
        let aimed = self.aimed(kernel.radius);
        let part = aimed.as_ref().map(|a| &a.part);
        let density = aimed.as_ref().map_or(self.density, |a| a.density);
        let share = part.map_or(1.0, Part::share);
        // Photons that are aimed are so dense that a block of them is map enough.
        let least = if part.is_some() { BLOCK as u64 } else { MAP[0] };
        let size = map_size_of_at_least(least, density, kernel.radius);
        for start in (0..paths).step_by(size as usize) {
            let end = paths.min(start + size);
            if S::EXISTS {
                work.photons.clear();
                for (first, live) in blocks(start, end) {
                    emit(
                        &self.scene,
                        &self.emitter,
                        part,
                        &self.defect,
                        &stream,
                        first,
                        live,
                        &mut work,
                    );
                }
                work.grid
                    .build(&work.photons, kernel.radius * self.defect.cell());
            }
            let divisor = self.defect.divisor(end - start, work.photons.x.len());
            let norm = kernel.norm * self.defect.flux(self.emitter.flux()) * share / divisor;
            for (first, live) in blocks(start, end) {
                trace(
                    &self.scene,
                    &self.defect,
                    &stream,
                    &kernel,
                    norm,
                    first,
                    live,
                    &mut work,
                    film,
                );
            }
        }
        self.defect.finish(paths, before, film);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn emit<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    emitter: &L::Emitter,
    part: Option<&Part>,
    defect: &D,
    stream: &Stream,
    first: u64,
    live: usize,
    work: &mut Work,
) {
    let Work {
        photons,
        u,
        v,
        value,
        ..
    } = work;
    stream.pairs(first, Dimension::Emission, u, v);
    defect.numbers(Dimension::Emission, u, v);
    if let Some(part) = part {
        if part.is_empty() {
            return;
        }
        for i in 0..BLOCK {
            (u[i], v[i]) = part.place(u[i], v[i]);
        }
    }
    for i in 0..BLOCK {
        let (origin, direction) = emitter.ray(u[i], v[i]);
        let landing = scene.landing(origin, direction);
        let weight = landing.weight * defect.beside_cosine(landing.cosine) * defect.roulette(u[i]);
        u[i] = landing.x;
        v[i] = landing.y;
        value[i] = if defect.stored(landing.via) & (landing.weight > 0.0) {
            weight
        } else {
            0.0
        };
    }
    value[live..].fill(0.0);
    let mut list = [0_u16; BLOCK];
    let n = select(&mut list, |i| value[i] > 0.0);
    for &i in &list[..n] {
        let i = usize::from(i);
        photons.push(u[i], v[i], value[i]);
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn trace<L: Light, S: Specular, D: Deviation>(
    scene: &Scene<L, S>,
    defect: &D,
    stream: &Stream,
    kernel: &RadiusKernel,
    norm: f64,
    first: u64,
    live: usize,
    work: &mut Work,
    film: &mut Film,
) {
    let Work {
        grid, paths, value, ..
    } = work;
    paths.draw(scene, defect, stream, first, live);
    if !S::SEPARATES {
        paths.next_event(scene, defect, value);
        paths.splat(film, DIRECT, value);
    }
    if S::EXISTS {
        let scale = CAUSTIC.map(|class| norm * scene.floor.bsdf * defect.class_scale(class));
        let mut list = [0_u16; BLOCK];
        let n = select(&mut list, |i| paths.weight[i] > 0.0);
        *value = zeros();
        for &i in &list[..n] {
            let i = usize::from(i);
            let scale = if paths.via[i] > 0.5 {
                scale[1]
            } else {
                scale[0]
            };
            value[i] = paths.weight[i]
                * scale
                * grid.gather(paths.x[i], paths.y[i], kernel, defect.reach());
        }
        paths.splat(film, CAUSTIC, value);
    }
}
