//! Where an integrator can be made to deviate from what it should do: hooks that a healthy one compiles away.
//!
//! Methods are generic over [`Deviation`]. [`Sound`] has the trait's own functions, each the identity, inlined: no
//! instruction and no bit differs from code without hooks. [`super::defect::Defect`] is a fault, decided at run time.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use crate::film::Film;
use crate::geometry::pinhole::Pinhole;
use crate::stream::{Dimension, Lanes};

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
