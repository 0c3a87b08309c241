//! Where an integrator can be made to deviate from what it should do: hooks that a healthy one compiles away.
//!
//! Methods are generic over [`Deviation`]. [`Sound`] has the trait's own functions, each the identity, inlined: no
//! instruction and no bit differs from code without hooks. [`Defect`] is a fault, decided at run time.

use glam::DVec3;
use libm::{pow, sqrt};
use nephroid_analytic::class::PathClass;

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

/// What a method does differently from what it should.
pub(super) trait Deviation: Copy + Send + Sync + 'static {
    /// The factor that belongs beside the cosine at the receiver.
    #[inline(always)]
    fn beside_cosine(&self, _cosine: f64) -> f64 {
        1.0
    }

    /// The same where there is a cosine that can be forgotten, in next event estimation.
    #[inline(always)]
    fn beside_own_cosine(&self, cosine: f64) -> f64 {
        self.beside_cosine(cosine)
    }

    /// The factor of a class.
    #[inline(always)]
    fn class_scale(&self, _class: PathClass) -> f64 {
        1.0
    }

    /// The seed that is used for a seed, and the iteration for an iteration.
    #[inline(always)]
    fn address(&self, seed: u64, iteration: u32) -> (u64, u32) {
        (seed, iteration)
    }

    /// Looks at random numbers before they are used.
    #[inline(always)]
    fn numbers(&self, _dimension: Dimension, _u: &mut Lanes, _v: &mut Lanes) {}

    /// Film position and a factor for one.
    #[inline(always)]
    fn placed(&self, _camera: &Pinhole, column: f64, row: f64) -> (f64, f64, f64) {
        (column, row, 1.0)
    }

    /// The factor of a camera path in a direction of depth 1.
    #[inline(always)]
    fn at_sensor(&self, _direction: DVec3) -> f64 {
        1.0
    }

    /// The factor of the connection of a floor point to the pinhole.
    #[inline(always)]
    fn at_connection(&self, _camera: &Pinhole, _vertex: DVec3) -> f64 {
        1.0
    }

    /// Irradiance normal to the direction towards the light.
    #[inline(always)]
    fn falloff(&self, irradiance: f64, _towards: DVec3) -> f64 {
        irradiance
    }

    /// Whether a point sees the light.
    #[inline(always)]
    fn lit(&self, free: bool) -> bool {
        free
    }

    /// Whether a point is seen by the pinhole.
    #[inline(always)]
    fn seen(&self, free: bool) -> bool {
        free
    }

    /// Where a photon lands.
    #[inline(always)]
    fn landed(&self, vertex: DVec3) -> DVec3 {
        vertex
    }

    /// Flux of the light that is drawn from.
    #[inline(always)]
    fn flux(&self, flux: f64) -> f64 {
        flux
    }

    /// Whether photons are drawn over everything.
    fn unaimed(&self) -> bool {
        false
    }

    /// The factor of a photon drawn with this number.
    #[inline(always)]
    fn roulette(&self, _u: f64) -> f64 {
        1.0
    }

    /// Sine and cosine of the angle to the normal from a uniform number.
    #[inline(always)]
    fn scattered(&self, v: f64) -> (f64, f64) {
        (f64::sqrt(v), f64::sqrt(1.0 - v))
    }

    /// The factor at a specular vertex, from the unit directions before and after it.
    #[inline(always)]
    fn at_specular(&self, _before: DVec3, _after: DVec3) -> f64 {
        1.0
    }

    /// A regularized sample, which is the number of pixels times a radiance.
    #[inline(always)]
    fn sample(&self, value: f64, _pixels: f64) -> f64 {
        value
    }

    /// The bandwidth that is used for one.
    fn bandwidth(&self, _iteration: u32, bandwidth: f64) -> f64 {
        bandwidth
    }

    /// Whether a photon is stored, that came through the specular surface or not.
    #[inline(always)]
    fn stored(&self, via: bool) -> bool {
        via
    }

    /// By how many photons a map is divided.
    fn divisor(&self, emitted: u64, _stored: usize) -> f64 {
        emitted as f64
    }

    /// Cells to look at below and above the point's own.
    #[inline(always)]
    fn reach(&self) -> [i64; 2] {
        [1, 1]
    }

    /// Width of a cell in units of what it should be.
    fn cell(&self) -> f64 {
        1.0
    }

    /// Looks at the film before an iteration.
    fn begin(&self, _iteration: u32, _film: &mut Film) {}

    /// Looks at the film after so many paths of an iteration, which found it with so many contributions.
    fn finish(&self, _paths: u64, _contributions_before: u64, _film: &mut Film) {}
}

/// No deviation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sound;

impl Deviation for Sound {}

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
