//! Run time against error: mean squared error and CPU time of integrators, at checkpoints of growing numbers of paths.
//!
//! For each pair of scene and integrator, independent replicates run the same iterations; at 1, 2, 4, … of them the image of
//! each class is compared with the truth, pixel by pixel. Errors do not depend on the machine; times do. The efficiency of a
//! method without bias is 1/(V T); with bias, a fair comparison is at equal error: the CPU time until the root mean square
//! error of a class's pixels is [`TARGET`] of the class's mean, mostly extrapolated by the laws of [`target`]. Regularizing methods
//! are run at several bandwidths, and have the time of the best. Pixels that folds cross are left out for all methods alike, because some have no variance there.

mod clock;
mod measure;
pub mod plot;
mod target;

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::integrators::{Integrator, Treatment};
use crate::truth;
use crate::verify::excluded::crossed_by_folds;

pub use target::Reached;

/// Root mean square error over the mean.
pub const TARGET: f64 = 0.01;
/// Independent replicates.
pub const REPLICATES: u32 = 8;
/// Iterations of a replicate: a power of two.
pub const ITERATIONS: u32 = 32;
/// Paths of an iteration for each pixel.
const PATHS_PER_PIXEL: u64 = 1;
/// Bandwidths at which regularizing methods are run: angles [rad] or radii [m].
pub const BANDWIDTHS: [f64; 4] = [0.2, 0.1, 0.05, 0.025];
/// Relative tolerance of the truth.
const TOLERANCE: f64 = 1e-4;

/// A checkpoint of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Iterations so far.
    pub iterations: u32,
    /// Mean over replicates and pixels of the squared error, over the squared mean of the class.
    pub error: f64,
    /// The part of it that is variance.
    pub variance: f64,
    /// An unbiased estimate of the part that is bias: it can be negative.
    pub squared_bias: f64,
    /// Its standard error, from its spread over the pixels.
    pub bias_error: f64,
}

/// One class at one bandwidth.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Where the method regularizes.
    pub bandwidth: Option<f64>,
    /// In the order of iterations.
    pub checkpoints: Vec<Checkpoint>,
    /// CPU seconds of an iteration.
    pub seconds: f64,
}

/// One class of a pair.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassResult {
    /// The class.
    pub class: PathClass,
    /// A curve for each bandwidth.
    pub curves: Vec<Curve>,
    /// The time to the target.
    pub reached: Reached,
}

impl ClassResult {
    /// The curve that is shown: at the bandwidth nearest to the best one, or else the one with the least error in the end.
    pub fn shown(&self) -> Option<&Curve> {
        let rank = |c: &&Curve| match (self.reached.bandwidth(), c.bandwidth) {
            (Some(best), Some(own)) => libm::log(own / best).abs(),
            _ => c.checkpoints.last().map_or(f64::INFINITY, |p| p.error),
        };
        self.curves
            .iter()
            .min_by(|a, b| rank(a).total_cmp(&rank(b)))
    }
}

/// One integrator on one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PairResult {
    /// Name of the scene.
    pub scene: String,
    /// Name of the integrator.
    pub integrator: &'static str,
    /// Million paths per CPU-second.
    pub mpaths_per_cpu_s: f64,
    /// Paths of an iteration.
    pub paths: u64,
    /// Pixels that are left out.
    pub crossed: usize,
    /// The classes that it samples.
    pub classes: Vec<ClassResult>,
}

/// A scene with what all integrators are compared with.
pub struct Subject {
    entry: Entry,
    /// Whether a pixel counts.
    counts: Vec<bool>,
    truth: truth::TruthImage,
}

impl Subject {
    /// Computes the truth of a validated entry.
    pub fn new(entry: Entry) -> Self {
        let counts = crossed_by_folds(&entry).iter().map(|c| !c).collect();
        let truth = truth::image(&entry, TOLERANCE);
        Subject {
            entry,
            counts,
            truth,
        }
    }

    /// The entry.
    pub fn entry(&self) -> &Entry {
        &self.entry
    }
}

/// Runs an integrator that supports the scene; `None` if it samples none of its classes, or folds cross all pixels.
pub fn run(subject: &Subject, integrator: &dyn Integrator, seed: u64) -> Option<PairResult> {
    let Subject { entry, counts, .. } = subject;
    let plan = integrator.plan(entry);
    let layers: Vec<usize> = (0..plan.len())
        .filter(|&k| plan[k].treatment != Treatment::NotSampled)
        .collect();
    if layers.is_empty() || !counts.contains(&true) {
        return None;
    }
    let is_regularized = |k: &usize| matches!(plan[*k].treatment, Treatment::Regularized(_));
    let bandwidths = if layers.iter().any(is_regularized) {
        &BANDWIDTHS[..]
    } else {
        &BANDWIDTHS[..1]
    };
    let paths = PATHS_PER_PIXEL * u64::from(entry.camera.width) * u64::from(entry.camera.height);
    let runs: Vec<measure::Run> = bandwidths
        .iter()
        .map(|&b| measure::run(subject, integrator, paths, b, seed))
        .collect();
    let schedule = integrator.schedule(1.0);
    let fixed = schedule.bandwidth(0) == schedule.bandwidth(ITERATIONS - 1);
    let classes = layers
        .iter()
        .map(|&layer| {
            let regularized = is_regularized(&layer);
            // What is not regularized has nothing from a bandwidth.
            let runs = if regularized { &runs[..] } else { &runs[..1] };
            let curves = runs.iter().zip(bandwidths).map(|(run, &b)| Curve {
                bandwidth: regularized.then_some(b),
                checkpoints: run.checkpoints[layer].clone(),
                seconds: run.seconds,
            });
            let curves: Vec<Curve> = curves.collect();
            let reached = match (regularized, fixed) {
                (false, _) => target::unbiased(&curves[0]),
                (true, true) => target::fixed(&curves),
                (true, false) => target::shrinking(&curves),
            };
            ClassResult {
                class: plan[layer].class,
                curves,
                reached,
            }
        })
        .collect();
    let seconds: f64 = runs.iter().map(|r| r.seconds).sum();
    Some(PairResult {
        scene: entry.name.clone(),
        integrator: integrator.name(),
        mpaths_per_cpu_s: 1e-6 * paths as f64 * runs.len() as f64 / seconds,
        paths,
        crossed: counts.iter().filter(|c| !**c).count(),
        classes,
    })
}
