//! What the acceptance rules of other renderers' tests say to the same faults, at the same number of paths.
//!
//! Three rules, as their public sources have them:
//!
//! - pbrt-v4 (src/pbrt/cpu/integrators_test.cpp, `CheckSceneAverage`): the mean of the image within an absolute 0.025 of
//!   an expected value that is about 1. Here: the mean divided by its truth.
//! - Mitsuba 3 (src/render/tests/test_renders.py): a z test in each pixel with the variance of a reference rendered by the
//!   same code, floored at 1e-4; level 0.01, Šidák over the pixels; passed if 99.75 % of the pixels are.
//! - Blender (tests/python/modules/render_report.py, through `idiff`): 8-bit pictures; failed if more than 1 % of the
//!   pixels differ by more than 0.016. Here the reference's mean is exposed to 18 % grey.
//!
//! Mitsuba's reference is an image by the healthy integrator from four times as many paths or more. Blender's is an image
//! by the healthy integrator with the same seed, so that noise repeats: what its references are on one machine. Such a
//! reference knows no fault that was there when it was made.

use core::f64::consts::SQRT_2;

use libm::{erfc, expm1, log1p, pow, sqrt};

use super::trial::SetUp;
use crate::diagnosis::images::{Images, sample};
use crate::error::Error;
use crate::integrators::{Fault, Settings, by_name};
use crate::verify::replicates::{Canvas, Seeds};

/// Phases of their own, so that no replicate is one of the verdict's.
const MEASURED: u32 = 2001;
const REFERENCE: u32 = 2002;
/// Replicates of the image that is judged, at most, and of the reference, at least and at most.
const MOST_MEASURED: u64 = 256;
const REPLICATES: [u64; 2] = [64, 1024];

/// Who accepts an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Accepted {
    /// pbrt-v4's analytic scenes.
    pub pbrt: bool,
    /// Mitsuba 3's render test.
    pub mitsuba: bool,
    /// Blender's image difference.
    pub blender: bool,
}

/// pbrt-v4's rule on a mean over the image that should be 1.
pub fn pbrt(mean: f64) -> bool {
    (mean - 1.0).abs() <= 0.025
}

/// Mitsuba 3's rule: pixels, reference, the variance of one sample of each pixel, and samples per pixel.
pub fn mitsuba(image: &[f64], reference: &[f64], variance: &[f64], samples: f64) -> bool {
    const LEVEL: f64 = 0.01;
    const FLOOR: f64 = 1e-4;
    const TOLERATED: f64 = 0.9975;
    let pixels = image.len() as f64;
    let level = -expm1(log1p(-LEVEL) / pixels);
    let passes = |((&x, &r), &v): ((&f64, &f64), &f64)| {
        let z = (x - r).abs() / sqrt(f64::max(v, FLOOR) / samples);
        erfc(z / SQRT_2) > level
    };
    let passed = image
        .iter()
        .zip(reference)
        .zip(variance)
        .filter(|&p| passes(p))
        .count();
    passed as f64 >= TOLERATED * pixels
}

/// Blender's rule on two images, exposed alike.
pub fn blender(image: &[f64], reference: &[f64]) -> bool {
    const THRESHOLD: f64 = 0.016;
    const TOLERATED: f64 = 0.01;
    const GREY: f64 = 0.18;
    let mean = reference.iter().sum::<f64>() / reference.len() as f64;
    let stored = |v: f64| {
        let v = (v * GREY / mean).clamp(0.0, 1.0);
        let encoded = if v <= 0.003_130_8 {
            12.92 * v
        } else {
            1.055 * pow(v, 1.0 / 2.4) - 0.055
        };
        // A file of 8 bits has no NaN: the conversion gives 0.
        f64::from((255.0 * encoded + 0.5) as u8) / 255.0
    };
    let differ = |(&x, &r): (&f64, &f64)| (stored(x) - stored(r)).abs() > THRESHOLD;
    let failed = image.iter().zip(reference).filter(|&p| differ(p)).count();
    failed as f64 <= TOLERATED * image.len() as f64
}

/// The three rules on a fault at a stand, with about so many paths.
///
/// # Errors
/// A stand that names no integrator.
pub fn of(set_up: &SetUp, fault: Option<Fault>, seed: u64, paths: u64) -> Result<Accepted, Error> {
    let SetUp {
        stand,
        entry,
        shape,
        ..
    } = set_up;
    let canvas = Canvas {
        width: entry.camera.width,
        height: entry.camera.height,
        classes: entry.kind.classes(),
    };
    let means = set_up.means();
    let layers: Vec<usize> = (0..means.len()).filter(|&l| means[l].is_some()).collect();
    let truth: f64 = means.iter().flatten().sum();
    let seeds = Seeds::new(seed, stand.scene, stand.integrator);
    let drawn = |fault: Option<Fault>, phase: u32, replicates: u64| -> Result<Images, Error> {
        let settings = Settings {
            kernel: None,
            fault,
            ..Settings::default()
        };
        let integrator = by_name(stand.integrator, &settings)?;
        let prepared = integrator.prepare(entry);
        let count = replicates as u32;
        Ok(sample(
            prepared.as_ref(),
            canvas,
            &layers,
            shape,
            seeds,
            phase,
            count,
        ))
    };
    let measured = (paths / shape.paths()).clamp(1, MOST_MEASURED);
    let [least, most] = REPLICATES;
    let image = drawn(fault, MEASURED, measured)?;
    let reference = drawn(None, REFERENCE, (4 * measured).clamp(least, most))?;
    // Samples per pixel of a replicate, and the variance of one of them.
    let samples = shape.paths() as f64 / image.mean.len() as f64;
    let variance: Vec<f64> = reference.variance.iter().map(|v| v * samples).collect();
    let mean = image.mean.iter().sum::<f64>() / image.mean.len() as f64;
    let before = drawn(None, MEASURED, measured)?;
    Ok(Accepted {
        pbrt: pbrt(mean / truth),
        mitsuba: mitsuba(
            &image.mean,
            &reference.mean,
            &variance,
            samples * measured as f64,
        ),
        blender: blender(&image.mean, &before.mean),
    })
}
