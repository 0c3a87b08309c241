//! Progressive photon mapping with statistics of each pixel [Hachisuka et al. 2008; Hachisuka & Jensen 2009].
//!
//! A pixel keeps a radius r, a count N of photons and their flux τ. With M new photons of flux τ_M within r, all camera paths of the pixel in a pass
//! taken together,
//!
//! ```text
//! r'² = r² (N + aM)/(N + M)      τ' = (τ + τ_M) r'²/r²      N' = N + aM
//! L = f τ/(P π r²)               P = sum over the pixel's camera paths of the photons traced in their pass
//! ```
//!
//! [Hachisuka et al. 2008, eqs. (8), (11), (13)]; f is the BSDF. The scaling of τ takes the photons for uniform within r, so that the
//! estimate is consistent, without an exact expectation at any finite number of passes. The kernel is a disc, as τ needs it. There is no
//! smallest radius.

use core::f64::consts::PI;
use core::fmt;
use core::str::FromStr;

use libm::sqrt;
use nephroid_analytic::scene::Entry;

use super::Prepared;
use super::defect::Defect;
use super::deviation::Deviation;
use super::eye_block::{EyeBlock, Traced};
use super::learning::Learner;
use super::photon_mapping::{blocks, map_size};
use super::photon_maps::{PhotonMaps, Source};
use super::schedule::DEFAULT_REDUCTION;
use super::settings::Settings;
use crate::film::Film;
use crate::stream::Stream;

/// How the radii of progressive photon mapping shrink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Statistics {
    /// By a sequence that is given, the same for all pixels [Knaus & Zwicker 2011].
    #[default]
    Sequence,
    /// In each pixel by the photons that it meets.
    Pixel,
}

impl fmt::Display for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Statistics::Sequence => "sequence",
            Statistics::Pixel => "pixel",
        })
    }
}

impl FromStr for Statistics {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "sequence" => Ok(Statistics::Sequence),
            "pixel" => Ok(Statistics::Pixel),
            _ => Err("expected sequence or pixel".to_owned()),
        }
    }
}

/// Photons that a pixel has met.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PixelStatistics {
    /// Radius [m].
    pub radius: f64,
    /// N.
    pub count: f64,
    /// P.
    pub pairs: f64,
    /// τ of each class that is merged, throughput included [W].
    pub flux: Vec<f64>,
}

impl PixelStatistics {
    /// The update by a pass that met `met` photons, of so much flux in each class; `a` is the part of them that stays.
    pub fn update(&mut self, met: f64, flux: &[f64], a: f64) {
        let kept = self.count + a * met;
        let ratio = if met > 0.0 {
            kept / (self.count + met)
        } else {
            1.0
        };
        for (sum, new) in self.flux.iter_mut().zip(flux) {
            *sum = (*sum + new) * ratio;
        }
        self.radius *= sqrt(ratio);
        self.count = kept;
    }

    /// τ/(P π r²) of each class: times the BSDF it is a radiance. 0 for a pixel without a camera path.
    pub fn irradiance(&self, class: usize) -> f64 {
        let area = PI * self.radius * self.radius;
        if self.pairs > 0.0 && area > 0.0 {
            self.flux[class] / (self.pairs * area)
        } else {
            0.0
        }
    }
}

/// A scene prepared for statistics of pixels.
pub struct PixelProgressive {
    traced: Traced,
    sources: Vec<Source>,
    defect: Defect,
    reduction: f64,
    density: f64,
}

impl PixelProgressive {
    /// `None` for a scene without a floor.
    pub fn new(entry: &Entry, settings: &Settings) -> Option<Self> {
        PixelProgressive::with_reduction(entry, settings, DEFAULT_REDUCTION)
    }

    /// With another part a of photons that stay, from 0 to 1. At 1 the radius stays.
    pub fn with_reduction(entry: &Entry, settings: &Settings, reduction: f64) -> Option<Self> {
        let defect = Defect::new(settings.fault);
        let traced = Traced::new(entry, defect)?;
        let sources = Source::of_caustics(&traced);
        Some(PixelProgressive {
            density: PhotonMaps::pilot_density(&traced, &sources),
            traced,
            sources,
            defect,
            reduction,
        })
    }

    /// A run that tells its statistics.
    pub fn run(&self) -> PixelRun<'_> {
        PixelRun {
            scene: self,
            pixels: Vec::new(),
            maps: PhotonMaps::new(self.sources.len()),
            eye: EyeBlock::new(),
        }
    }
}

impl Prepared for PixelProgressive {
    /// An iteration of which nothing is known before.
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        self.run().iterate(seed, iteration, paths, bandwidth, film);
    }

    fn learner(&self) -> Option<Box<dyn Learner + '_>> {
        Some(Box::new(self.run()))
    }
}

/// The statistics of all pixels.
pub struct PixelRun<'a> {
    scene: &'a PixelProgressive,
    pixels: Vec<PixelStatistics>,
    maps: PhotonMaps,
    eye: EyeBlock,
}

impl PixelRun<'_> {
    /// Pixel by pixel, in the order of the film; empty before the first iteration.
    pub fn pixels(&self) -> &[PixelStatistics] {
        &self.pixels
    }
}

/// What a pixel meets in a pass.
#[derive(Clone, Default)]
struct Met {
    count: f64,
    pairs: f64,
    flux: Vec<f64>,
}

impl Learner for PixelRun<'_> {
    /// `bandwidth` is the radius of all pixels in the first iteration, and of no meaning later. The layers of merged classes are set, not
    /// added to: they are the run's estimate times the film's paths.
    fn iterate(&mut self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        let PixelProgressive {
            traced,
            sources,
            defect,
            reduction,
            density,
        } = self.scene;
        film.paths += paths;
        // A pixel has one radius for all its classes.
        let layers = traced.all_layers(film);
        // One sum for each source, seen straight and through the surface.
        let slots = 2 * sources.len();
        if self.pixels.is_empty() {
            let start = PixelStatistics {
                radius: bandwidth,
                flux: vec![0.0; slots],
                ..PixelStatistics::default()
            };
            self.pixels = vec![start; film.pixels()];
        }
        let before = film.nonzero.iter().sum();
        let (seed, iteration) = defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let widest = self.pixels.iter().fold(0.0, |r, p| f64::max(r, p.radius));
        let (width, height) = (film.width as usize, film.height as usize);
        let size = map_size(*density, widest);
        for start in (0..paths).step_by(size as usize) {
            let end = paths.min(start + size);
            let photons = (end - start) as f64;
            self.maps
                .fill(traced, sources, defect, &stream, [start, end], widest);
            let mut met = vec![Met::default(); film.pixels()];
            for (first, live) in blocks(start, end) {
                self.eye.draw(traced, defect, &stream, first, live);
                self.eye.light(traced);
                self.eye.next_event(traced, defect, &layers, |_| 1.0, film);
                let eye = &self.eye;
                for i in 0..live {
                    let (column, row) = (eye.column[i] as usize, eye.row[i] as usize);
                    let pixel = row.min(height - 1) * width + column.min(width - 1);
                    let here = &mut met[pixel];
                    here.pairs += photons;
                    if !(eye.weight[i] > 0.0) {
                        continue;
                    }
                    here.flux.resize(slots, 0.0);
                    let through = eye.through(i);
                    let (x, y) = (eye.landings.x[i], eye.landings.y[i]);
                    let radius = self.pixels[pixel].radius;
                    for (k, source) in sources.iter().enumerate() {
                        let Some(layer) = layers[source.chain][through] else {
                            continue;
                        };
                        let grid = self.maps.grid(k);
                        let count = grid.sum(x, y, radius, [1, 1], |_, _| 1.0);
                        if count > 0.0 {
                            let flux = grid.sum(x, y, radius, [1, 1], |_, flux| flux);
                            here.flux[2 * k + through] += source.flux() * flux * eye.weight[i];
                            here.count += count;
                            film.nonzero[layer] += 1;
                        }
                    }
                }
            }
            for (pixel, met) in self.pixels.iter_mut().zip(&met) {
                pixel.pairs += met.pairs;
                pixel.update(met.count, &met.flux, *reduction);
            }
        }
        // Weights of camera paths have the number of pixels in them, which a mean over a pixel's own paths has not.
        let bsdf = traced.tracer.outline().floor.bsdf;
        let scale = bsdf * film.paths as f64 / traced.tracer.outline().camera.pixels();
        for (k, source) in sources.iter().enumerate() {
            for (through, layer) in layers[source.chain].iter().enumerate() {
                if let Some(layer) = *layer {
                    let class = traced.classes[source.chain][through];
                    let scale = scale * class.map_or(0.0, |c| defect.class_scale(c));
                    for (value, pixel) in film.layers[layer].iter_mut().zip(&self.pixels) {
                        *value = scale * pixel.irradiance(2 * k + through);
                    }
                }
            }
        }
        defect.finish(paths, before, film);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hachisuka's recursion by hand: 6 photons, then 4 more, a = 1/2.
    #[test]
    fn two_passes_by_hand() {
        let mut p = PixelStatistics {
            radius: 2.0,
            flux: vec![0.0],
            pairs: 100.0,
            ..PixelStatistics::default()
        };
        p.update(6.0, &[3.0], 0.5);
        assert_eq!((p.count, p.flux[0]), (3.0, 1.5));
        assert!((p.radius * p.radius - 2.0).abs() < 1e-15);
        p.update(4.0, &[5.0], 0.5);
        let ratio: f64 = 5.0 / 7.0;
        assert_eq!(p.count, 5.0);
        assert!((p.flux[0] - 6.5 * ratio).abs() < 1e-15);
        assert!((p.radius * p.radius - 2.0 * ratio).abs() < 1e-15);
        assert!((p.irradiance(0) - 6.5 / (100.0 * PI * 2.0)).abs() < 1e-16);
        // A pass that meets nothing changes nothing.
        let same = p.clone();
        p.update(0.0, &[0.0], 0.5);
        assert_eq!(p, same);
    }
}
