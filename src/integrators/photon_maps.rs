//! Photons of each chain of a scene behind [`Tracer`](crate::geometry::tracer::Tracer), with the density of the tables of expectations,
//! sorted for queries.

use super::defect::Defect;
use super::deviation::Deviation;
use super::eye_block::Traced;
use super::photon_grid::{PhotonGrid, Photons};
use super::photon_mapping::{PILOT, blocks};
use crate::geometry::tracer::{Aim, Emission, Landings, Rays};
use crate::stream::{Dimension, Lanes, Stream, zeros};

/// A chain of specular interactions, and the photons that take it.
pub(super) struct Source {
    /// Its position among the tracer's.
    pub(super) chain: usize,
    emission: Emission,
}

impl Source {
    /// The chains with a specular interaction.
    pub(super) fn of_caustics(traced: &Traced) -> Vec<Source> {
        let chains = traced.tracer.chains().iter().enumerate();
        chains
            .filter(|(_, class)| !class.light.is_empty())
            .map(|(chain, _)| Source {
                chain,
                emission: traced.tracer.emission(Aim::Table(chain)),
            })
            .collect()
    }

    /// Flux of all the light that photons are drawn from [W].
    pub(super) fn flux(&self) -> f64 {
        self.emission.flux()
    }
}

/// The photons of a chain.
#[derive(Default)]
struct Map {
    photons: Photons,
    grid: PhotonGrid,
}

/// The photons of each source.
pub(super) struct PhotonMaps {
    maps: Vec<Map>,
    u: Lanes,
    v: Lanes,
    rays: Rays,
    landings: Landings,
}

impl PhotonMaps {
    pub(super) fn new(sources: usize) -> Self {
        PhotonMaps {
            maps: (0..sources).map(|_| Map::default()).collect(),
            u: zeros(),
            v: zeros(),
            rays: Rays::default(),
            landings: Landings::new(),
        }
    }

    /// Traces the photons of paths `start .. end` and sorts them for queries within `radius`.
    pub(super) fn fill(
        &mut self,
        traced: &Traced,
        sources: &[Source],
        defect: &Defect,
        stream: &Stream,
        [start, end]: [u64; 2],
        radius: f64,
    ) {
        self.maps.iter_mut().for_each(|m| m.photons.clear());
        for (first, live) in blocks(start, end) {
            stream.pairs(first, Dimension::Emission, &mut self.u, &mut self.v);
            defect.numbers(Dimension::Emission, &mut self.u, &mut self.v);
            for (source, map) in sources.iter().zip(&mut self.maps) {
                source.emission.rays(&self.u, &self.v, &mut self.rays);
                let beam = traced.beam(source.chain);
                traced.tracer.land(beam, &self.rays, &mut self.landings);
                let wanted = source.chain as f64;
                let l = &self.landings;
                for i in 0..live {
                    if (l.weight[i] > 0.0) & (l.chain[i] == wanted) {
                        let deviations =
                            defect.beside_cosine(l.cosine[i]) * defect.roulette(self.u[i]);
                        map.photons.push(l.x[i], l.y[i], l.weight[i] * deviations);
                    }
                }
            }
        }
        for map in &mut self.maps {
            map.grid.build(&map.photons, radius * defect.cell());
        }
    }

    /// The photons of a source.
    pub(super) fn grid(&self, source: usize) -> &PhotonGrid {
        &self.maps[source].grid
    }

    /// Photons per photon traced and square metre of their bounding box, as a pilot of a fixed stream finds it, for the
    /// densest of the sources; 0 without any.
    pub(super) fn pilot_density(traced: &Traced, sources: &[Source]) -> f64 {
        let mut maps = PhotonMaps::new(sources.len());
        let stream = Stream::new(u64::MAX, u32::MAX);
        let sound = Defect::new(None);
        maps.fill(traced, sources, &sound, &stream, [0, PILOT], 1.0);
        let density = |map: &Map| map.photons.x.len() as f64 / map.photons.area();
        let densities = maps.maps.iter().map(density);
        densities.filter(|d| *d < f64::INFINITY).fold(0.0, f64::max) / PILOT as f64
    }
}
