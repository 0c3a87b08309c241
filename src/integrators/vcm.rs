//! `vcm`: vertex connection and merging [Georgiev et al. 2012; Hachisuka, Pantaleoni & Jensen 2012].
//!
//! A path is one light subpath and one camera subpath, both up to the floor. Three techniques build paths: next event estimation at
//! the camera's vertex, light tracing (the light's vertex connected to the pinhole), and merging of a camera vertex x with the light
//! vertices within r of it. Their densities, per floor area, with p_c that of camera vertices seen straight, p_l that of light vertices that come
//! straight, and η = π r² N for a map of N light vertices [Georgiev et al. 2012, eq. (10)]:
//!
//! ```text
//! class    next event   light tracing   merging
//! L D E    p_c          p_l             p_c p_l η
//! L S+ D E  –           p_l             p_c p_l η      (p_l of the chain cancels)
//! L D S E  p_c          –               p_c p_l η      (p_c of the chain cancels)
//! L S+ D S E –          –               all of it
//! ```
//!
//! The balance heuristic weights them. All densities are taken at one point, the camera's vertex in a merge and the vertex itself in a
//! connection, so that weights at a floor point sum to 1 and the expectation there is w L + (1 - w) (k * L), w the share of the connections. A
//! light ray that arrives at x with the irradiance E has p_l = E/Φ; photons are uniform over the smallest downward cap (or beam) that contains
//! floor and specular surface.
//!
//! Merging is *full*, or *selective*: only the classes that no connection samples are merged, and the others are what bidirectional path
//! tracing gives, bit by bit. A map always stands for [`MAP`] photons in the weights, also where it has fewer: so they do not depend on
//! how many paths are asked for.

use core::f64::consts::PI;
use core::fmt;
use core::str::FromStr;

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;
use super::eye_block::{EyeBlock, Traced};
use super::kernel::RadiusKernel;
use super::photon_grid::{PhotonGrid, Photons};
use super::photon_mapping::{blocks, kernel_of};
use super::plan::{not_sampled, plan_of};
use super::settings::Settings;
use super::{
    ClassPlan, Fault, Integrator, Plan, Prepared, Technique, Treatment, Unsupported, regularizes,
};
use crate::film::Film;
use crate::geometry::tracer::{Aim, Emission, Landings, Rays};
use crate::stream::{Dimension, Lanes, Stream, zeros};

/// Photons of a map.
pub const MAP: u64 = 1 << 14;

/// What vertex connection and merging merges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Merging {
    /// Every class.
    #[default]
    Full,
    /// Only the classes that no connection samples.
    Selective,
    /// Nothing: connections alone.
    None,
}

impl fmt::Display for Merging {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Merging::Full => "full",
            Merging::Selective => "selective",
            Merging::None => "none",
        })
    }
}

impl FromStr for Merging {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        [Merging::Full, Merging::Selective, Merging::None]
            .into_iter()
            .find(|m| m.to_string() == text)
            .ok_or_else(|| "expected full, selective or none".to_owned())
    }
}

/// Whether a connection samples a class: where light or eye see the floor straight.
const fn is_connected(class: PathClass) -> bool {
    class.light.is_empty() || class.eye.is_empty()
}

impl Merging {
    const fn merges(self, class: PathClass) -> bool {
        match self {
            Merging::Full => true,
            Merging::Selective => !is_connected(class),
            Merging::None => false,
        }
    }
}

/// Vertex connection and merging.
pub struct Vcm {
    settings: Settings,
}

impl Vcm {
    /// The method, with a disc unless the settings name another kernel on the distance.
    pub fn new(settings: Settings) -> Self {
        Vcm { settings }
    }
}

impl Integrator for Vcm {
    fn name(&self) -> &'static str {
        "vcm"
    }

    fn title(&self) -> &'static str {
        "vertex connection and merging at a fixed radius"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        let merging = self.settings.merging;
        let kernel = kernel_of(&self.settings);
        plan_of(entry, |class| {
            let connections = match (class.light.is_empty(), class.eye.is_empty()) {
                (true, true) => "next event estimation and light tracing",
                (true, false) => "next event estimation",
                (false, true) => "light tracing",
                (false, false) => "no connection",
            };
            let (treatment, reason) = match (is_connected(class), merging.merges(class)) {
                (true, false) => (
                    Treatment::Exact(Technique::Connection),
                    format!("{connections}, balance heuristic; connections suffice, so not merged"),
                ),
                (true, true) => (
                    Treatment::Regularized(Technique::ConnectionAndMerging),
                    format!(
                        "{connections}, and merging ({kernel} kernel, maps of {MAP} photons), balance heuristic"
                    ),
                ),
                (false, true) => (
                    Treatment::Regularized(Technique::Merge),
                    format!(
                        "irregular: every connection ends in a specular vertex; merged alone ({kernel} kernel)"
                    ),
                ),
                (false, false) => {
                    return not_sampled(
                        class,
                        "irregular: every connection ends in a specular vertex, and nothing is merged",
                    );
                }
            };
            ClassPlan {
                class,
                treatment,
                reason,
            }
        })
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        regularizes(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        let defect = Defect::new(self.settings.fault);
        let Some(traced) = Traced::new(entry, defect) else {
            return Box::new(Unsupported);
        };
        Box::new(PreparedVcm {
            emission: traced.tracer.emission(Aim::Scene),
            traced,
            settings: self.settings,
            defect,
        })
    }
}

struct PreparedVcm {
    traced: Traced,
    emission: Emission,
    settings: Settings,
    defect: Defect,
}

/// Densities of the techniques at a floor point, over that of the one that all have in common.
#[derive(Clone, Copy, Debug, Default)]
struct Densities {
    next_event: f64,
    light_tracing: f64,
    merging: f64,
}

impl Densities {
    /// Of a class, from p_c, p_l and η there; η is 0 where it is not merged.
    #[inline(always)]
    fn of(direct: bool, through: bool, camera: f64, light: f64, eta: f64) -> Self {
        match (direct, through) {
            (true, false) => Densities {
                next_event: camera,
                light_tracing: light,
                merging: camera * light * eta,
            },
            (true, true) => Densities {
                next_event: 1.0,
                light_tracing: 0.0,
                merging: light * eta,
            },
            (false, false) => Densities {
                next_event: 0.0,
                light_tracing: 1.0,
                merging: camera * eta,
            },
            (false, true) => Densities {
                merging: 1.0,
                ..Densities::default()
            },
        }
    }

    #[inline(always)]
    fn share(&self, density: f64) -> f64 {
        let sum = self.next_event + self.light_tracing + self.merging;
        if density > 0.0 { density / sum } else { 0.0 }
    }
}

/// Memory of an iteration.
struct Work {
    u: Lanes,
    v: Lanes,
    rays: Rays,
    landings: Landings,
    irradiance: Lanes,
    cosine: Lanes,
    free: Lanes,
    eye: EyeBlock,
    photons: Vec<Photons>,
    grids: Vec<PhotonGrid>,
}

impl Work {
    fn new(chains: usize) -> Self {
        Work {
            u: zeros(),
            v: zeros(),
            rays: Rays::default(),
            landings: Landings::new(),
            irradiance: zeros(),
            cosine: zeros(),
            free: zeros(),
            eye: EyeBlock::new(),
            photons: (0..chains).map(|_| Photons::default()).collect(),
            grids: (0..chains).map(|_| PhotonGrid::default()).collect(),
        }
    }
}

impl Prepared for PreparedVcm {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let before = film.nonzero.iter().sum();
        let bandwidth = self.defect.bandwidth(iteration, bandwidth);
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let kernel = RadiusKernel::new(kernel_of(&self.settings), bandwidth, self.settings.fault);
        let layers = self.traced.layers(film);
        let mut work = Work::new(layers.len());
        for start in (0..paths).step_by(MAP as usize) {
            let end = paths.min(start + MAP);
            work.photons.iter_mut().for_each(Photons::clear);
            for (first, live) in blocks(start, end) {
                self.light_subpaths(&stream, first, live, &kernel, &layers, &mut work, film);
            }
            for (photons, grid) in work.photons.iter().zip(&mut work.grids) {
                grid.build(photons, kernel.radius * self.defect.cell());
            }
            let photons = match self.settings.fault {
                // The other count at hand.
                Some(Fault::MergesByNominalCount) => MAP,
                _ => end - start,
            };
            for (first, live) in blocks(start, end) {
                self.camera_subpaths(
                    &stream, first, live, &kernel, photons, &layers, &mut work, film,
                );
            }
        }
        self.defect.finish(paths, before, film);
    }
}

type Layers = [[Option<usize>; 2]];

impl PreparedVcm {
    /// η of a class.
    fn eta(&self, class: Option<PathClass>, radius: f64) -> f64 {
        match class {
            // Without a radius nothing is merged, and connections are alone.
            Some(class) if self.settings.merging.merges(class) && radius.is_finite() => {
                PI * radius * radius * MAP as f64
            }
            _ => 0.0,
        }
    }

    /// Traces light subpaths, connects their vertices to the pinhole, and keeps those that are to be merged.
    fn light_subpaths(
        &self,
        stream: &Stream,
        first: u64,
        live: usize,
        kernel: &RadiusKernel,
        layers: &Layers,
        work: &mut Work,
        film: &mut Film,
    ) {
        let Work {
            u,
            v,
            rays,
            landings,
            irradiance,
            cosine,
            free,
            photons,
            ..
        } = work;
        let tracer = self.traced.tracer.as_ref();
        let outline = tracer.outline();
        let (camera, pixels) = (&outline.camera, outline.camera.pixels());
        let direct = self.traced.direct();
        let flux = self.defect.flux(self.emission.flux());
        stream.pairs(first, Dimension::Emission, u, v);
        self.defect.numbers(Dimension::Emission, u, v);
        self.emission.rays(u, v, rays);
        for beam in 0..tracer.beams() {
            tracer.land(beam, rays, landings);
            let classes = &self.traced.classes;
            let any_seen = layers.iter().any(|l| l[0].is_some());
            if any_seen {
                tracer.seen(&landings.x, &landings.y, free);
                tracer.lit(&landings.x, &landings.y, irradiance, cosine);
            }
            for i in (0..live).filter(|&i| landings.weight[i] > 0.0) {
                let chain = landings.chain[i] as usize;
                let (x, y) = (landings.x[i], landings.y[i]);
                let deviations =
                    self.defect.beside_cosine(landings.cosine[i]) * self.defect.roulette(u[i]);
                let weight = landings.weight[i] * deviations;
                let merges =
                    |c: &Option<PathClass>| c.is_some_and(|c| self.settings.merging.merges(c));
                if classes[chain].iter().any(merges) {
                    photons[chain].push(x, y, weight);
                }
                let Some(layer) = layers[chain][0] else {
                    continue;
                };
                let (column, row, density) = camera.project_floor(DVec3::new(x, y, 0.0));
                let (column, row, kept) = self.defect.placed(camera, column, row);
                let value = flux * outline.floor.bsdf * weight * density * free[i] * kept;
                if !(value > 0.0) {
                    continue;
                }
                let class = classes[chain][0];
                let d = Densities::of(
                    Some(chain) == direct,
                    false,
                    density / pixels,
                    irradiance[i] * cosine[i] / self.emission.flux(),
                    self.eta(class, kernel.radius),
                );
                let share = match self.settings.fault {
                    Some(Fault::ConnectedAndMerged) if d.merging > 0.0 => 1.0,
                    _ => d.share(d.light_tracing),
                };
                let scale = class.map_or(0.0, |c| self.defect.class_scale(c));
                let value = value * share * scale;
                if value > 0.0 {
                    add(film, layer, column, row, value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }

    /// Traces camera subpaths, connects their vertices with the light, and merges them with light vertices.
    fn camera_subpaths(
        &self,
        stream: &Stream,
        first: u64,
        live: usize,
        kernel: &RadiusKernel,
        photons: u64,
        layers: &Layers,
        work: &mut Work,
        film: &mut Film,
    ) {
        let eye = &mut work.eye;
        eye.draw(&self.traced, &self.defect, stream, first, live);
        eye.light(&self.traced);
        let eye = &work.eye;
        let outline = self.traced.tracer.outline();
        let (camera, pixels) = (&outline.camera, outline.camera.pixels());
        let direct = self.traced.direct();
        // p_c and p_l at the vertices.
        let (mut seen, mut lit) = (zeros(), zeros());
        for i in (0..live).filter(|&i| eye.weight[i] > 0.0) {
            let vertex = DVec3::new(eye.landings.x[i], eye.landings.y[i], 0.0);
            seen[i] = camera.project_floor(vertex).2 / pixels;
            lit[i] = eye.irradiance[i] * eye.cosine[i] / self.emission.flux();
        }
        let densities = |chain: usize, i: usize| {
            let through = eye.through(i);
            let class = self.traced.classes[chain][through];
            let eta = self.eta(class, kernel.radius);
            Densities::of(Some(chain) == direct, through > 0, seen[i], lit[i], eta)
        };
        if let Some(direct) = direct {
            let share = |i: usize| {
                let d = densities(direct, i);
                d.share(d.next_event)
            };
            eye.next_event(&self.traced, &self.defect, layers, share, film);
        }
        let flux = self.defect.flux(self.emission.flux());
        let norm = kernel.norm * flux / photons as f64 * outline.floor.bsdf;
        for (chain, grid) in work.grids.iter().enumerate() {
            for i in (0..live).filter(|&i| eye.weight[i] > 0.0) {
                let through = eye.through(i);
                let class = self.traced.classes[chain][through];
                let (Some(layer), Some(class)) = (layers[chain][through], class) else {
                    continue;
                };
                if !self.settings.merging.merges(class) {
                    continue;
                }
                let mut d = densities(chain, i);
                if self.settings.fault == Some(Fault::MergingWeightByRadius) {
                    d.merging *= if is_connected(class) {
                        kernel.radius
                    } else {
                        1.0
                    };
                }
                let share = match self.settings.fault {
                    Some(Fault::ConnectedAndMerged) => 1.0,
                    Some(Fault::BidirectionalWeightOnMerges) => 1.0 - d.share(d.merging),
                    _ => d.share(d.merging),
                };
                if !(share > 0.0) {
                    continue;
                }
                let (x, y) = (eye.landings.x[i], eye.landings.y[i]);
                let sum = grid.gather(x, y, kernel, self.defect.reach());
                let scale = norm * self.defect.class_scale(class);
                let value = eye.weight[i] * scale * sum * share;
                if value > 0.0 {
                    add(film, layer, eye.column[i], eye.row[i], value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_class_sum_to_one() {
        for direct in [true, false] {
            for through in [true, false] {
                for (camera, light, eta) in [(0.1, 0.02, 2000.0), (3.0, 1e-9, 0.0), (0.2, 0.0, 1.0)]
                {
                    let d = Densities::of(direct, through, camera, light, eta);
                    let sum: f64 = [d.next_event, d.light_tracing, d.merging]
                        .iter()
                        .map(|&p| d.share(p))
                        .sum();
                    assert!((sum - 1.0).abs() < 1e-15);
                }
            }
        }
    }

    #[test]
    fn words_are_read_back() {
        for merging in [Merging::Full, Merging::Selective, Merging::None] {
            assert_eq!(merging.to_string().parse(), Ok(merging));
        }
        assert!("all".parse::<Merging>().is_err());
    }
}
