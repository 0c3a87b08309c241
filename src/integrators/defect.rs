//! What each fault does at the hooks of [`super::deviation`].

use glam::DVec3;
use libm::{pow, sqrt};
use nephroid_analytic::class::PathClass;

use super::deviation::Deviation;
use super::fault::Fault;
use super::schedule::{DEFAULT_REDUCTION, progressive_ratio};
use crate::film::Film;
use crate::geometry::pinhole::Pinhole;
use crate::geometry::scene::Overrides;
use crate::stream::{Dimension, Lanes};

/// Part of the paths that survive a wrong or needless roulette.
const SURVIVAL: f64 = 0.75;
/// See [`Fault::BandwidthFloor`] [rad or m].
const FLOOR: f64 = 0.6;
/// See [`Fault::SinglePrecision`] [m].
const FAR: f64 = 1e6;

/// A fault, or none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Defect {
    fault: Option<Fault>,
}

impl Defect {
    pub(super) fn new(fault: Option<Fault>) -> Self {
        Defect { fault }
    }

    #[inline(always)]
    fn is(&self, fault: Fault) -> bool {
        self.fault == Some(fault)
    }

    #[inline(always)]
    fn factor(&self, fault: Fault, factor: f64) -> f64 {
        if self.is(fault) { factor } else { 1.0 }
    }

    /// What the fault does to the scene's constants.
    pub(super) fn overrides(&self) -> Overrides {
        self.fault.map(Fault::overrides).unwrap_or_default()
    }
}

impl Deviation for Defect {
    #[inline(always)]
    fn beside_cosine(&self, cosine: f64) -> f64 {
        self.factor(Fault::CosineTwice, cosine)
    }

    #[inline(always)]
    fn beside_own_cosine(&self, cosine: f64) -> f64 {
        if self.is(Fault::CosineForgotten) {
            1.0 / cosine
        } else {
            self.beside_cosine(cosine)
        }
    }

    fn class_scale(&self, class: PathClass) -> f64 {
        match self.fault {
            Some(Fault::ClassDropped(lost)) if lost == class => 0.0,
            Some(Fault::DirectLightTwice) if class == PathClass::LDE => 2.0,
            _ => 1.0,
        }
    }

    fn address(&self, seed: u64, iteration: u32) -> (u64, u32) {
        match self.fault {
            Some(Fault::SeedTruncated) => (seed & 0x3f, iteration),
            Some(Fault::IterationsShareNumbers) => (seed, 0),
            _ => (seed, iteration),
        }
    }

    fn numbers(&self, dimension: Dimension, u: &mut Lanes, v: &mut Lanes) {
        match (self.fault, dimension) {
            (Some(Fault::SameNumberTwice), Dimension::Emission | Dimension::Direction) => *v = *u,
            (Some(Fault::EmissionWarped), Dimension::Emission) => {
                v.iter_mut().for_each(|v| *v *= *v);
            }
            _ => {}
        }
    }

    fn placed(&self, camera: &Pinhole, column: f64, row: f64) -> (f64, f64, f64) {
        let (columns, rows) = camera.size();
        match self.fault {
            Some(Fault::ImageOneRowLow) => (column, row + 1.0, f64::from(row + 1.0 < rows)),
            Some(Fault::ImageHalfPixelOff) => {
                let (column, row) = (column + 0.5, row + 0.5);
                (column, row, f64::from((column < columns) & (row < rows)))
            }
            Some(Fault::ImageFlipped) => (column, rows - row, 1.0),
            Some(Fault::LastRowLost) => {
                let inside = (column < columns - 1.0) & (row < rows - 1.0);
                (column, row, f64::from(inside))
            }
            _ => (column, row, 1.0),
        }
    }

    fn at_sensor(&self, direction: DVec3) -> f64 {
        self.factor(
            Fault::SensorCosine,
            1.0 / f64::sqrt(direction.dot(direction)),
        )
    }

    fn at_connection(&self, camera: &Pinhole, vertex: DVec3) -> f64 {
        match self.fault {
            Some(Fault::ConnectionWithoutCosine) => {
                let d = camera.position - vertex;
                f64::sqrt(d.dot(d)) / d.z
            }
            Some(Fault::PixelSideForArea) => camera.pixel_side(),
            _ => 1.0,
        }
    }

    fn falloff(&self, irradiance: f64, towards: DVec3) -> f64 {
        let square = towards.dot(towards);
        match self.fault {
            Some(Fault::NoFalloff) => irradiance * square,
            Some(Fault::InverseDistance) => irradiance * f64::sqrt(square),
            _ => irradiance,
        }
    }

    fn lit(&self, free: bool) -> bool {
        free | self.is(Fault::ShadowRayForgotten)
    }

    fn seen(&self, free: bool) -> bool {
        free | self.is(Fault::ConnectionThroughSurface)
    }

    fn landed(&self, vertex: DVec3) -> DVec3 {
        if !self.is(Fault::SinglePrecision) {
            return vertex;
        }
        let rounded = |v: f64| f64::from((v + FAR) as f32) - FAR;
        DVec3::new(rounded(vertex.x), rounded(vertex.y), vertex.z)
    }

    fn flux(&self, flux: f64) -> f64 {
        flux * self.factor(Fault::HemisphereForSphere, 2.0)
    }

    fn unaimed(&self) -> bool {
        self.is(Fault::EmissionUnaimed)
    }

    fn roulette(&self, u: f64) -> f64 {
        let weight = match self.fault {
            Some(Fault::RouletteUnweighted) => 1.0,
            Some(Fault::RouletteWeighted) => 1.0 / SURVIVAL,
            _ => return 1.0,
        };
        // The later digits of a number are uniform too.
        let digits = 4096.0 * u;
        if digits - f64::floor(digits) < SURVIVAL {
            weight
        } else {
            0.0
        }
    }

    fn scattered(&self, v: f64) -> (f64, f64) {
        if self.is(Fault::UniformForCosine) {
            (f64::sqrt(1.0 - v * v), v)
        } else {
            (f64::sqrt(v), f64::sqrt(1.0 - v))
        }
    }

    fn at_specular(&self, before: DVec3, after: DVec3) -> f64 {
        // A mirror turns a direction by twice its cosine along the normal.
        let turn = after - before;
        let cosine = 0.5 * f64::sqrt(turn.dot(turn));
        match self.fault {
            Some(Fault::DeltaCosineKept) => 1.0 / cosine,
            Some(Fault::CosineAtSpecularVertex) => cosine,
            _ => 1.0,
        }
    }

    fn sample(&self, value: f64, pixels: f64) -> f64 {
        if self.is(Fault::SamplesClamped) & (value > pixels) {
            pixels
        } else {
            value
        }
    }

    fn bandwidth(&self, iteration: u32, bandwidth: f64) -> f64 {
        let ratio = |i: u32| progressive_ratio(i, DEFAULT_REDUCTION);
        match self.fault {
            Some(Fault::BandwidthFloor) if bandwidth < FLOOR => FLOOR,
            Some(Fault::TinyBandwidthFloor) if bandwidth < 1e-7 => 1e-7,
            Some(Fault::RadiusNotShrinking) => bandwidth / sqrt(ratio(iteration)),
            Some(Fault::ScheduleExponentHalved) => bandwidth / pow(ratio(iteration), 0.25),
            Some(Fault::RecursionOnRadius) => bandwidth * sqrt(ratio(iteration)),
            Some(Fault::RecursionOffByOne) => {
                bandwidth * sqrt(ratio(iteration + 1) / ratio(iteration))
            }
            _ => bandwidth,
        }
    }

    fn stored(&self, via: bool) -> bool {
        via | self.is(Fault::DirectPhotonsMerged)
    }

    fn divisor(&self, emitted: u64, stored: usize) -> f64 {
        if self.is(Fault::DividedByStoredPhotons) {
            stored as f64
        } else {
            emitted as f64
        }
    }

    fn reach(&self) -> [i64; 2] {
        if self.is(Fault::FourCellsOfNine) {
            [0, 1]
        } else {
            [1, 1]
        }
    }

    fn cell(&self) -> f64 {
        self.factor(Fault::CellsTooSmall, 0.5)
    }

    fn begin(&self, iteration: u32, film: &mut Film) {
        if !self.is(Fault::NewestNormalization) || iteration == 0 {
            return;
        }
        let ratio = |i: u32| progressive_ratio(i, DEFAULT_REDUCTION);
        let scale = ratio(iteration - 1) / ratio(iteration);
        for class in [PathClass::LSDE, PathClass::LSDSE] {
            if let Some(layer) = film.layer_of(class) {
                film.layers[layer].iter_mut().for_each(|v| *v *= scale);
            }
        }
    }

    fn finish(&self, paths: u64, contributions_before: u64, film: &mut Film) {
        let pixels = film.pixels() as u64;
        let arrived = film.nonzero.iter().sum::<u64>() - contributions_before;
        let counted = match self.fault {
            Some(Fault::SplatsPerSurvivor) => arrived,
            Some(Fault::SplatsPerPixelCount) => pixels,
            Some(Fault::SplatScaleOnCameraPaths) => paths * (paths / pixels).max(2),
            _ => paths,
        };
        film.paths = film.paths - paths + counted;
        let impossible = match self.fault {
            Some(Fault::NotANumberPixel) => f64::NAN,
            Some(Fault::InfinitePixel) => f64::INFINITY,
            Some(Fault::NegativePixel) => -1.0,
            _ => return,
        };
        // The middle of the top row, in the first class that has light.
        let lit = film.nonzero.iter().position(|&n| n > 0);
        if let Some(layer) = lit {
            let middle = film.width as usize / 2;
            film.layers[layer][middle] = impossible;
        }
    }
}
