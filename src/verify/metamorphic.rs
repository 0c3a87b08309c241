//! Metamorphic checks: an integrator on a changed scene, judged by the truth of the unchanged one.
//!
//! What a change does to the image follows from units and geometry, not from a closed form: all lengths times k divide
//! the radiance under a point light by k², a moved scene has the same image, twice the light twice the radiance, twice the
//! rows and columns the same mean, a cropped view the mean of the part that it shows, more or fewer paths in a replicate
//! the same mean. Absolute epsilons, forgotten units, splats scaled by the wrong count and coordinates in too few digits
//! do not survive them.

use std::time::Instant;

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::scene::Entry;

use super::expected::{Expected, Truths};
use super::run::{Job, Request, first_shape};
use super::suite::Pair;
use super::verdicts::{NotRun, Verdict};
use crate::error::Error;
use crate::integrators::{Integrator, NO_BANDWIDTH, Treatment};
use crate::judge::hypotheses::Levels;
use crate::regions::Regions;
use crate::variation::Variation;

/// A change of the scene, or of the number of paths in a replicate.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Change {
    Scene(Variation),
    /// Paths per replicate times this.
    Paths(f64),
}

const CHANGES: [Change; 8] = [
    Change::Scene(Variation::Scaled(1e3)),
    Change::Scene(Variation::Scaled(1e-3)),
    Change::Scene(Variation::Moved([1e4, -1e4])),
    Change::Scene(Variation::Brighter(2.0)),
    Change::Scene(Variation::Finer),
    Change::Scene(Variation::Cropped),
    Change::Paths(4.0),
    Change::Paths(0.25),
];

/// An integrator on a changed scene.
pub(super) struct Varied {
    /// Position of the pair that is varied.
    pub pair: usize,
    change: Change,
    entry: Entry,
    factor: f64,
    argument: String,
}

/// The pair on which each integrator is varied: the first that claims the most classes.
fn chosen<'a>(pairs: &'a [Pair], integrators: usize) -> impl Iterator<Item = usize> + 'a {
    (0..integrators).filter_map(move |i| {
        let of = |p: &usize| pairs[*p].integrator == i && pairs[*p].checks() > 0;
        (0..pairs.len())
            .filter(of)
            .min_by_key(|&p| (core::cmp::Reverse(pairs[p].checks()), p))
    })
}

/// What is to be run. A scene that cannot express a change, or that validation refuses once changed, is not.
pub(super) fn jobs(request: &Request, pairs: &[Pair]) -> Vec<Varied> {
    if !request.variations {
        return Vec::new();
    }
    let mut jobs = Vec::new();
    for pair in chosen(pairs, request.integrators.len()) {
        let subject = &request.scenes[pairs[pair].scene];
        for change in CHANGES {
            let changed = match change {
                Change::Scene(v) => v.of(&subject.argument).ok().flatten(),
                Change::Paths(_) => Some((subject.entry.clone(), 1.0)),
            };
            jobs.extend(changed.map(|(entry, factor)| Varied {
                pair,
                change,
                entry,
                factor,
                argument: subject.argument.clone(),
            }));
        }
    }
    jobs
}

/// What is said of them when they are not asked for.
pub(super) fn left_out(request: &Request, pairs: &[Pair]) -> Vec<NotRun> {
    chosen(pairs, request.integrators.len())
        .map(|p| NotRun {
            scene: request.scenes[pairs[p].scene].entry.name.clone(),
            integrator: request.integrators[pairs[p].integrator].name().to_owned(),
            reason: "changed scenes: with --variations, or at standard".to_owned(),
        })
        .collect()
}

impl Varied {
    /// How the scene is changed.
    pub fn name(&self) -> String {
        match self.change {
            Change::Scene(v) => v.name(),
            Change::Paths(k) => format!("paths per replicate times {k}"),
        }
    }

    /// Runs and judges it.
    ///
    /// # Errors
    /// A kernel or a bandwidth that does not fit.
    pub fn run(
        &self,
        request: &Request,
        pair: &Pair,
        levels: Levels,
        checks: u64,
        truths: &mut Truths,
    ) -> Result<Vec<Verdict>, Error> {
        let started = Instant::now();
        let integrator = request.integrators[pair.integrator].as_ref();
        let original = &request.scenes[pair.scene].entry;
        let mut shape = first_shape(integrator, &pair.plan, request.bandwidth, original);
        let expected = self.expected(request, pair, &shape.bandwidths, truths)?;
        match self.change {
            Change::Paths(k) => {
                shape.paths_per_iteration = (k * shape.paths_per_iteration as f64) as u64;
            }
            Change::Scene(v) if is_radius(integrator, pair) => {
                shape.bandwidths.iter_mut().for_each(|b| *b *= v.length());
            }
            Change::Scene(_) => {}
        }
        let times = |b: Bounded| Bounded {
            value: self.factor * b.value,
            error: self.factor * b.error + 1e-12 * (self.factor * b.value).abs(),
        };
        let expected = expected
            .into_iter()
            .map(|e| e.map(|e| Expected::of_first(times(e.first()))))
            .collect();
        let job = Job {
            integrator: pair.integrator,
            argument: &self.argument,
            entry: &self.entry,
            plan: &pair.plan,
            shape,
            regions: Regions::image(self.entry.camera.width, self.entry.camera.height),
            expected,
            excluded: None,
            variation: Some(self.name()),
        };
        Ok(job.run(request, levels, checks, started))
    }

    /// The truth of the unchanged scene: of the whole image, or of the part that is left of it.
    fn expected(
        &self,
        request: &Request,
        pair: &Pair,
        bandwidths: &[f64],
        truths: &mut Truths,
    ) -> Result<Vec<Option<Expected>>, Error> {
        let original = &request.scenes[pair.scene].entry;
        let (width, height) = (original.camera.width, original.camera.height);
        // The regions of the unchanged run, whose truth is known already.
        let whole = Regions::quadtree(width, height);
        let regions = if self.change == Change::Scene(Variation::Cropped) {
            let inside = |i: u32, n: u32| (n / 4..n - n / 4).contains(&i);
            let selected: Vec<bool> = (0..width * height)
                .map(|k| inside(k % width, width) && inside(k / width, height))
                .collect();
            Regions::mask(width, height, &selected).unwrap_or(whole)
        } else {
            whole
        };
        let kernel = request.truth_kernel();
        truths.of(
            pair.scene, original, &pair.plan, &regions, kernel, bandwidths,
        )
    }
}

/// Whether the bandwidth is a length.
fn is_radius(integrator: &dyn Integrator, pair: &Pair) -> bool {
    use crate::integrators::Technique::Merge;
    let merges = pair
        .plan
        .iter()
        .any(|c| c.treatment == Treatment::Regularized(Merge));
    merges && integrator.schedule(1.0).bandwidth(0) > NO_BANDWIDTH
}
