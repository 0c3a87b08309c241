//! `appm`: adaptive progressive photon mapping [Kaplanyan & Dachsbacher 2013]: each pixel merges within a radius of its own, the one
//! that balances the bias and the variance that it has estimated. See `adaptive_radius.rs` for the radius.
//!
//! An iteration is cut into maps of so many photons each, as in `photon_mapping.rs`; a map is a pass. A pixel's radius in a map
//! depends on the photons of earlier maps alone, so that given the radius the pass has the expectation of merging at
//! that radius. The bandwidth of an iteration is R in the first pass: the largest radius, and the one with which derivatives
//! are estimated. Contributions are averaged over passes as those of photon mapping are.

use nephroid_analytic::scene::Entry;

use super::adaptive_radius::{Estimates, Seen};
use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;
use super::eye_block::{EyeBlock, Traced};
use super::kernel::{Kernel, RadiusKernel};
use super::learning::Learner;
use super::photon_mapping::{adaptive_plan, blocks, kernel_of, map_size};
use super::photon_maps::{PhotonMaps, Source};
use super::settings::Settings;
use super::{Fault, Integrator, Plan, Prepared, Unsupported, regularizes};
use crate::film::Film;
use crate::stream::Stream;

/// Adaptive progressive photon mapping.
pub struct Appm {
    settings: Settings,
}

impl Appm {
    /// The method, with a disc unless the settings name another kernel on the distance.
    pub fn new(settings: Settings) -> Self {
        Appm { settings }
    }

    /// A run of which the radii can be asked; `None` for a scene without a floor.
    pub fn run(&self, entry: &Entry) -> Option<AdaptiveRun> {
        Some(AdaptiveRun::new(PreparedAppm::new(entry, self.settings)?))
    }
}

/// Flux [W] of all the light that the photons of the first chain that is merged are drawn from: 4π I, or a beam's cross-section times
/// its irradiance. `None` without such a chain.
pub fn photon_flux(entry: &Entry) -> Option<f64> {
    let traced = Traced::new(entry, Defect::new(None))?;
    let sources = Source::of_caustics(&traced);
    sources.first().map(Source::flux)
}

impl Integrator for Appm {
    fn name(&self) -> &'static str {
        "appm"
    }

    fn title(&self) -> &'static str {
        "adaptive progressive photon mapping: each pixel's radius from estimated bias and variance"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        let kernel = kernel_of(&self.settings);
        adaptive_plan(
            entry,
            &format!(
                "merged ({kernel} kernel) within a radius that each pixel chooses from its past photons; only given these radii is \
                 the expectation known"
            ),
        )
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        regularizes(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        match PreparedAppm::new(entry, self.settings) {
            Some(prepared) => Box::new(prepared),
            None => Box::new(Unsupported),
        }
    }
}

struct PreparedAppm {
    entry: Entry,
    traced: Traced,
    sources: Vec<Source>,
    settings: Settings,
    defect: Defect,
    density: f64,
}

impl PreparedAppm {
    fn new(entry: &Entry, settings: Settings) -> Option<Self> {
        let defect = Defect::new(settings.fault);
        let traced = Traced::new(entry, defect)?;
        let sources = Source::of_caustics(&traced);
        Some(PreparedAppm {
            entry: entry.clone(),
            density: PhotonMaps::pilot_density(&traced, &sources),
            traced,
            sources,
            settings,
            defect,
        })
    }
}

impl Prepared for PreparedAppm {
    /// An iteration of which nothing is known before.
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        State::new(self).iterate(self, seed, iteration, paths, bandwidth, film);
    }

    fn learner(&self) -> Option<Box<dyn Learner + '_>> {
        Some(Box::new(Borrowed(self, State::new(self))))
    }
}

struct Borrowed<'a>(&'a PreparedAppm, State);

impl Learner for Borrowed<'_> {
    fn iterate(&mut self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        self.1
            .iterate(self.0, seed, iteration, paths, bandwidth, film);
    }
}

/// A run that tells its radii.
pub struct AdaptiveRun {
    prepared: PreparedAppm,
    state: State,
}

impl AdaptiveRun {
    fn new(prepared: PreparedAppm) -> Self {
        let state = State::new(&prepared);
        AdaptiveRun { prepared, state }
    }

    /// Photons of a map, at this bandwidth: an iteration of as many paths is one pass.
    pub fn photons_per_map(&self, bandwidth: f64) -> u64 {
        map_size(self.prepared.density, bandwidth)
    }

    /// The radius [m] of a pixel (`row * width + column`) in the next full map, for the first class that is merged and seen
    /// straight.
    pub fn radius(&self, pixel: usize, bandwidth: f64) -> f64 {
        let kernel = kernel_of(&self.prepared.settings);
        let size = self.photons_per_map(bandwidth) as f64;
        let pixel = self.state.pixels.get(2 * pixel).and_then(|p| p.first());
        let seen = pixel.map_or(Seen::default(), Pixel::learned);
        seen.radius(bandwidth, kernel, size)
    }
}

impl Learner for AdaptiveRun {
    fn iterate(&mut self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        self.state
            .iterate(&self.prepared, seed, iteration, paths, bandwidth, film);
    }
}

/// A pixel and a class.
#[derive(Clone, Copy, Debug, Default)]
struct Pixel {
    seen: Seen,
    /// From the latest map in which the pixel was met, and that map's photons.
    latest: Option<(Estimates, f64)>,
    /// That map, counted from 1.
    map: u64,
    radius: f64,
}

impl Pixel {
    /// What is known, the latest map included.
    fn learned(&self) -> Seen {
        let mut seen = self.seen;
        if let Some((estimates, photons)) = self.latest {
            seen.learn(estimates, photons);
        }
        seen
    }
}

/// What a run remembers.
struct State {
    /// `pixels[2 * pixel + seen through]`: one for each source.
    pixels: Vec<Vec<Pixel>>,
    maps: PhotonMaps,
    eye: EyeBlock,
    /// Maps so far.
    count: u64,
}

impl State {
    fn new(prepared: &PreparedAppm) -> Self {
        let camera = &prepared.entry.camera;
        let pixels = camera.width as usize * camera.height as usize;
        let sources = prepared.sources.len();
        State {
            pixels: vec![vec![Pixel::default(); sources]; 2 * pixels],
            maps: PhotonMaps::new(sources),
            eye: EyeBlock::new(),
            count: 0,
        }
    }

    fn iterate(
        &mut self,
        prepared: &PreparedAppm,
        seed: u64,
        iteration: u32,
        paths: u64,
        bandwidth: f64,
        film: &mut Film,
    ) {
        let PreparedAppm {
            traced,
            sources,
            settings,
            defect,
            ..
        } = prepared;
        film.paths += paths;
        let before = film.nonzero.iter().sum();
        let (seed, iteration) = defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let first_radius = defect.bandwidth(iteration, bandwidth);
        let size = map_size(prepared.density, first_radius);
        for start in (0..paths).step_by(size as usize) {
            let end = paths.min(start + size);
            self.count += 1;
            self.maps
                .fill(traced, sources, defect, &stream, [start, end], first_radius);
            let photons = (end - start) as f64;
            for (first, live) in blocks(start, end) {
                self.eye.draw(traced, defect, &stream, first, live);
                self.eye.light(traced);
                let layers = traced.layers(film);
                self.eye.next_event(traced, defect, &layers, |_| 1.0, film);
                self.merge(prepared, kernel_of(settings), first_radius, photons, film);
            }
        }
        defect.finish(paths, before, film);
    }

    /// Merges a block of camera paths with the map.
    fn merge(
        &mut self,
        prepared: &PreparedAppm,
        kernel: Kernel,
        first_radius: f64,
        photons: f64,
        film: &mut Film,
    ) {
        let traced = &prepared.traced;
        let layers = traced.layers(film);
        let bsdf = traced.tracer.outline().floor.bsdf;
        let fault = prepared.settings.fault;
        let (width, height) = (film.width as usize, film.height as usize);
        let eye = &self.eye;
        for i in (0..eye.weight.len()).filter(|&i| eye.weight[i] > 0.0) {
            let (column, row) = (eye.column[i] as usize, eye.row[i] as usize);
            let pixel = row.min(height - 1) * width + column.min(width - 1);
            let through = eye.through(i);
            let point = [eye.landings.x[i], eye.landings.y[i]];
            for (k, source) in prepared.sources.iter().enumerate() {
                let Some(layer) = layers[source.chain][through] else {
                    continue;
                };
                let grid = self.maps.grid(k);
                let own = &mut self.pixels[2 * pixel + through][k];
                if own.map != self.count {
                    // The first path of the pixel in this map chooses the radius, without a look at it.
                    own.map = self.count;
                    own.seen = own.learned();
                    let wide = own.seen.wide(first_radius);
                    let here = Estimates::at(grid, point, wide, photons);
                    own.latest = Some((here, photons));
                    let chosen_from = match fault {
                        Some(Fault::RadiusFromCurrentPhotons) => own.learned(),
                        _ => own.seen,
                    };
                    own.radius = chosen_from.radius(first_radius, kernel, photons);
                }
                let kernel = RadiusKernel::new(kernel, own.radius, fault);
                let sum = grid.gather(point[0], point[1], &kernel, [1, 1]);
                let scale = kernel.norm * source.flux() / photons * bsdf;
                let class = traced.classes[source.chain][through];
                let scale = scale * class.map_or(0.0, |c| prepared.defect.class_scale(c));
                let value = eye.weight[i] * scale * sum;
                if value > 0.0 {
                    add(film, layer, eye.column[i], eye.row[i], value);
                    film.nonzero[layer] += 1;
                }
            }
        }
    }
}
