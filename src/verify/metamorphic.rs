//! Metamorphic checks: an integrator on a changed scene, judged by the truth of the unchanged one.
//!
//! What a change does to the image follows from units and geometry, not from a closed form: all lengths times k divide
//! the radiance under a point light by k², a moved scene has the same image, twice the light twice the radiance, twice the
//! rows and columns the same mean, a cropped view the mean of the part that it shows, more or fewer paths in a replicate
//! the same mean. Absolute epsilons, forgotten units, splats scaled by the wrong count and coordinates in too few digits
//! do not survive them.

use std::time::Instant;

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::scene::{Camera, Entry};

use super::excluded::crossed_by_folds;
use super::expected::{Expected, Truths};
use super::run::{Job, Request, first_shape};
use super::suite::Pair;
use super::verdicts::{NotRun, Verdict};
use crate::error::Error;
use crate::integrators::{Integrator, NO_BANDWIDTH, Technique, Treatment};
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

/// A view is cropped where each class keeps this part of its light: the paths that decide about a class grow as that part
/// falls.
const KEPT_BY_CROP: f64 = 0.25;

/// For each integrator the pairs on which it may be varied: those with a cheap truth first, since more than one may be asked, of these
/// those that claim the most classes, then in their order. Of a method whose variance is infinite at folds, the first whose image no
/// fold crosses.
fn candidates<'a>(
    request: &'a Request,
    pairs: &'a [Pair],
) -> impl Iterator<Item = Vec<usize>> + 'a {
    (0..request.integrators.len()).filter_map(move |i| {
        let of = |p: &usize| pairs[*p].integrator == i && pairs[*p].checks() > 0;
        let mut all: Vec<usize> = (0..pairs.len()).filter(of).collect();
        all.sort_by_key(|&p| (pairs[p].truth, core::cmp::Reverse(pairs[p].checks())));
        if request.integrators[i].has_infinite_variance_at_folds() {
            let entry = |p: &usize| &request.scenes[pairs[*p].scene].entry;
            let whole = all
                .into_iter()
                .find(|p| !crossed_by_folds(entry(p)).contains(&true));
            return whole.map(|p| vec![p]);
        }
        (!all.is_empty()).then_some(all)
    })
}

/// What is to be run, and what cannot be. A change that a scene cannot express, or that validation refuses, is left out.
///
/// # Errors
/// A kernel or a bandwidth that does not fit.
pub(super) fn jobs(
    request: &Request,
    pairs: &[Pair],
    truths: &mut Truths,
) -> Result<(Vec<Varied>, Vec<NotRun>), Error> {
    let (mut jobs, mut not_run) = (Vec::new(), Vec::new());
    if !request.variations {
        return Ok((jobs, not_run));
    }
    for candidates in candidates(request, pairs) {
        for change in CHANGES {
            let whole_view = |&p: &usize| {
                let combined = Treatment::Regularized(Technique::ConnectionAndMerging);
                pairs[p].plan.iter().any(|c| c.treatment == combined)
            };
            if change == Change::Scene(Variation::Cropped) && candidates.iter().any(whole_view) {
                let [scene, integrator] = names(request, &pairs[candidates[0]]);
                not_run.push(NotRun {
                    scene,
                    integrator,
                    reason: "cropped to the middle: weights depend on all of the view, so that the mean of a part changes"
                        .to_owned(),
                });
                continue;
            }
            let chosen = match change {
                Change::Scene(Variation::Cropped) => {
                    first_to_crop(request, pairs, &candidates, truths)?
                }
                _ => Some(candidates[0]),
            };
            let Some(pair) = chosen else {
                let [scene, integrator] = names(request, &pairs[candidates[0]]);
                not_run.push(NotRun {
                    scene,
                    integrator,
                    reason: "cropped to the middle: a class would lose most of its light"
                        .to_owned(),
                });
                continue;
            };
            let subject = &request.scenes[pairs[pair].scene];
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
    Ok((jobs, not_run))
}

/// The first pair of which each class keeps enough of its light in the middle of the view.
fn first_to_crop(
    request: &Request,
    pairs: &[Pair],
    candidates: &[usize],
    truths: &mut Truths,
) -> Result<Option<usize>, Error> {
    for &p in candidates {
        let pair = &pairs[p];
        let camera = &request.scenes[pair.scene].entry.camera;
        let [whole, part] = [None, Some(middle(camera))];
        let whole = unchanged(request, pair, whole, truths)?;
        let part = unchanged(request, pair, part, truths)?;
        // The part has a quarter of the pixels.
        let keeps = |(w, p): (&Option<Expected>, &Option<Expected>)| match (w, p) {
            (Some(w), Some(p)) => 0.25 * p.first().value >= KEPT_BY_CROP * w.first().value,
            _ => true,
        };
        if whole.iter().zip(&part).all(keeps) {
            return Ok(Some(p));
        }
    }
    Ok(None)
}

/// The pixels that a cropped view shows.
fn middle(camera: &Camera) -> Regions {
    let (width, height) = (camera.width, camera.height);
    let inside = |i: u32, n: u32| (n / 4..n - n / 4).contains(&i);
    let selected: Vec<bool> = (0..width * height)
        .map(|k| inside(k % width, width) && inside(k / width, height))
        .collect();
    Regions::mask(width, height, &selected).unwrap_or(Regions::image(width, height))
}

/// The truth of an unchanged scene: of the whole image, or of a part of it.
fn unchanged(
    request: &Request,
    pair: &Pair,
    part: Option<Regions>,
    truths: &mut Truths,
) -> Result<Vec<Option<Expected>>, Error> {
    let entry = &request.scenes[pair.scene].entry;
    let integrator = request.integrators[pair.integrator].as_ref();
    let shape = first_shape(
        integrator,
        &pair.plan,
        request.bandwidth,
        entry,
        request.effort,
    );
    // The regions of the unchanged run, whose truth serves that as well.
    let regions =
        part.unwrap_or_else(|| Regions::quadtree(entry.camera.width, entry.camera.height));
    let kernel = request.truth_kernel();
    truths.of(
        pair.scene,
        entry,
        &pair.plan,
        &regions,
        kernel,
        &shape.bandwidths,
    )
}

fn names(request: &Request, pair: &Pair) -> [String; 2] {
    [
        request.scenes[pair.scene].entry.name.clone(),
        request.integrators[pair.integrator].name().to_owned(),
    ]
}

/// What is said of them when they are not asked for.
pub(super) fn left_out(request: &Request, pairs: &[Pair]) -> Vec<NotRun> {
    candidates(request, pairs)
        .map(|candidates| {
            let [scene, integrator] = names(request, &pairs[candidates[0]]);
            NotRun {
                scene,
                integrator,
                reason: "changed scenes: with --variations, or at standard".to_owned(),
            }
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
        let mut shape = first_shape(
            integrator,
            &pair.plan,
            request.bandwidth,
            original,
            request.effort,
        );
        let part =
            (self.change == Change::Scene(Variation::Cropped)).then(|| middle(&original.camera));
        let expected = unchanged(request, pair, part, truths)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrators::{Settings, by_name};
    use crate::judge::hypotheses::LEVEL;
    use crate::verify::effort::Effort;
    use crate::verify::suite::{Coverage, Subject, select};

    /// The scene and the integrator of each job that crops, and what is said of those that do not.
    fn cropped(scenes: &[&str], integrator: &str) -> (Vec<String>, Vec<String>) {
        let subject = |name: &&str| Subject {
            argument: (*name).to_owned(),
            entry: crate::entry::load(name).unwrap(),
        };
        let request = Request {
            scenes: scenes.iter().map(subject).collect(),
            integrators: vec![by_name(integrator, &Settings::default()).unwrap()],
            left_out: Vec::new(),
            effort: Effort::Quick,
            coverage: Coverage::Everything,
            margin: 0.5,
            level: LEVEL,
            checks: None,
            seed: 1,
            bandwidth: 0.2,
            most_paths: 1,
            variations: true,
            kernel: None,
            mask: None,
        };
        let (pairs, _) = select(&request.scenes, &request.integrators, request.coverage);
        let mut truths = Truths::for_margin(request.margin);
        let (jobs, not_run) = jobs(&request, &pairs, &mut truths).unwrap();
        // All other changes take the first of the pairs that claim the most.
        let others = jobs
            .iter()
            .filter(|j| j.name() != Variation::Cropped.name());
        assert!(others.clone().count() >= 6 && others.clone().all(|j| j.argument == scenes[0]));
        let crops = jobs
            .iter()
            .filter(|j| j.name() == Variation::Cropped.name());
        (
            crops.map(|j| j.argument.clone()).collect(),
            not_run.into_iter().map(|n| n.reason).collect(),
        )
    }

    /// In the middle of the view of `glass-column` there is a 10⁻⁵th of the light of LTTDE that is in all of it, and
    /// none of LTRTDE; that of `mirror-wall` keeps most of each class, regularized or not.
    #[test]
    fn a_view_is_cropped_where_its_classes_keep_their_light() {
        let (crops, not_run) = cropped(&["glass-column"], "lt");
        assert!(crops.is_empty() && not_run.len() == 1, "{not_run:?}");
        assert!(not_run[0].starts_with("cropped"), "{not_run:?}");
        let (crops, not_run) = cropped(&["glass-column", "mirror-wall"], "lt");
        assert_eq!((crops, not_run.len()), (vec!["mirror-wall".to_owned()], 0));
        let (crops, not_run) = cropped(&["mirror-wall"], "pm");
        assert_eq!((crops, not_run.len()), (vec!["mirror-wall".to_owned()], 0));
    }
}
