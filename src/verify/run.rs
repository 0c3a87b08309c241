//! Runs a suite: one run per pair of scene and integrator serves all its checks.

use std::time::Instant;

use nephroid_analytic::bandwidth::Kernel as TruthKernel;
use nephroid_analytic::scene::Entry;

use super::effort::Effort;
use super::excluded::{Excluded, Kept};
use super::expected::{Expected, Truths};
use super::gather::{Judged, gather};
use super::metamorphic;
use super::replicates::{Canvas, Seeds, Shape};
use super::sizing::Demand;
use super::suite::{Coverage, LeftOut, Pair, Subject, select};
use super::verdicts::{ALL_CLASSES, MASK, NotRun, Outcome, Program, Verdict, WHOLE_IMAGE};
use crate::error::Error;
use crate::integrators::{Integrator, Kernel, Plan, Technique, Treatment};
use crate::judge::family::holm;
use crate::judge::hypotheses::{EQUIVALENCE_LEVEL, Levels};
use crate::mask::Mask;
use crate::regions::Regions;

/// Iterations of a replicate of a method that merges: each has its own photon map, and a progressive one its own radius.
const MERGING_ITERATIONS: u32 = 8;
/// Paths of a replicate for each pixel: clearing and summing the film costs a third of drawing them,
/// and a tile of 16 by 16 pixels gets the contributions that a test asks for.
const PATHS_PER_PIXEL: u64 = 2;
/// Fewest paths of a replicate.
const FEWEST_PATHS: u64 = 1 << 15;
/// Replicates that are judged as a whole are so many times shorter.
const PART_WITHOUT_TILES: u64 = 4;
/// Replicates are so many times shorter at the margin of the effort `quick`.
const PART_WHEN_QUICK: u64 = 4;

/// What to verify.
pub struct Request {
    /// The scenes.
    pub scenes: Vec<Subject>,
    /// The integrators.
    pub integrators: Vec<Box<dyn Integrator>>,
    /// Integrators that were not asked for by name and cannot take part.
    pub left_out: Vec<LeftOut>,
    /// How much to do.
    pub effort: Effort,
    /// Which pairs to run.
    pub coverage: Coverage,
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Probability of any false "different".
    pub level: f64,
    /// Share the error probabilities among at least this many checks.
    pub checks: Option<u64>,
    /// The seed.
    pub seed: u64,
    /// Angle α [rad] or radius r [m].
    pub bandwidth: f64,
    /// The most paths of one pair of scene and integrator.
    pub most_paths: u64,
    /// Whether integrators are also run on changed scenes, of which the change of the image is known.
    pub variations: bool,
    /// The mollifier; `None` for each method's default.
    pub kernel: Option<Kernel>,
    /// Judge these pixels only.
    pub mask: Option<Mask>,
}

/// Runs the suite. `truths` belongs to the request's list of scenes and can serve several requests. `progress` hears of each pair before it starts: its position, their number, scene and integrator.
///
/// # Errors
/// A kernel or a bandwidth that does not fit.
pub fn run(
    request: &Request,
    truths: &mut Truths,
    progress: &dyn Fn(usize, usize, &str, &str),
) -> Result<Outcome, Error> {
    let started = Instant::now();
    let (pairs, mut not_run) = select(&request.scenes, &request.integrators, request.coverage);
    for subject in &request.scenes {
        not_run.extend(request.left_out.iter().map(|l| NotRun {
            scene: subject.entry.name.clone(),
            integrator: l.integrator.clone(),
            reason: l.reason.clone(),
        }));
    }
    let (varied, unvaried) = metamorphic::jobs(request, &pairs, truths)?;
    not_run.extend(unvaried);
    let planned: u64 = pairs.iter().map(Pair::checks).sum::<u64>()
        + varied.iter().map(|v| pairs[v.pair].checks()).sum::<u64>();
    let checks = planned.max(request.checks.unwrap_or(0));
    let levels = Levels::shared(request.level, EQUIVALENCE_LEVEL, checks);
    let mut verdicts = Vec::new();
    let of = pairs.len() + varied.len();
    for (position, pair) in pairs.iter().enumerate() {
        let scene = &request.scenes[pair.scene].entry.name;
        let integrator = request.integrators[pair.integrator].name();
        progress(position, of, scene, integrator);
        match run_pair(request, pair, levels, checks, truths)? {
            Some(found) => verdicts.extend(found),
            None => not_run.push(NotRun {
                scene: scene.clone(),
                integrator: integrator.to_owned(),
                reason: "a fold crosses every pixel, and this method's variance is infinite there"
                    .to_owned(),
            }),
        }
    }
    for (position, varied) in (pairs.len()..).zip(&varied) {
        let pair = &pairs[varied.pair];
        let integrator = request.integrators[pair.integrator].name();
        progress(position, of, &varied.name(), integrator);
        verdicts.extend(varied.run(request, pair, levels, checks, truths)?);
    }
    if !request.variations && request.mask.is_none() {
        not_run.extend(metamorphic::left_out(request, &pairs));
    }
    settle(&mut verdicts, request.level, checks);
    crate::diagnosis::annotate(request, &mut verdicts, truths)?;
    Ok(Outcome {
        program: Program::Verify,
        verdicts,
        not_run,
        notes: Vec::new(),
        effort: Some(request.effort),
        level: request.level,
        equivalence_level: EQUIVALENCE_LEVEL,
        checks,
        margin: request.margin,
        bandwidth: Some(request.bandwidth),
        seed: request.seed,
        seconds: started.elapsed().as_secs_f64(),
    })
}

/// What is still undecided is decided by the error probability that the decided checks leave: Holm's procedure.
pub(crate) fn settle(verdicts: &mut [Verdict], level: f64, checks: u64) {
    let p = |of: fn(&Verdict) -> Option<f64>| -> Vec<f64> {
        verdicts.iter().map(|v| of(v).unwrap_or(f64::NAN)).collect()
    };
    let different = holm(&p(|v| v.finding.p_different), level, checks);
    let equivalent = holm(&p(|v| v.finding.p_equivalent), EQUIVALENCE_LEVEL, checks);
    for (verdict, (different, equivalent)) in verdicts
        .iter_mut()
        .zip(different.into_iter().zip(equivalent))
    {
        let levels = Levels {
            different: different.unwrap_or(verdict.levels.different),
            equivalent: equivalent.unwrap_or(verdict.levels.equivalent),
        };
        verdict.finding.settle(levels);
        verdict.levels = levels;
    }
}

/// One integrator on one scene, as it is run.
pub(super) struct Job<'a> {
    /// Position of the integrator.
    pub integrator: usize,
    /// What the scene is called on the command line.
    pub argument: &'a str,
    /// The scene.
    pub entry: &'a Entry,
    /// What the integrator does about its classes.
    pub plan: &'a Plan,
    /// What a replicate consists of, at first.
    pub shape: Shape,
    /// The areas of its image.
    pub regions: Regions,
    /// What each class should be.
    pub expected: Vec<Option<Expected>>,
    /// Pixels that are no part of this.
    pub excluded: Option<Excluded>,
    /// How the scene was changed; `None` if it was not.
    pub variation: Option<String>,
}

/// The verdicts on one pair; `None` if folds leave nothing of the image.
fn run_pair(
    request: &Request,
    pair: &Pair,
    levels: Levels,
    checks: u64,
    truths: &mut Truths,
) -> Result<Option<Vec<Verdict>>, Error> {
    let started = Instant::now();
    let subject = &request.scenes[pair.scene];
    let integrator = request.integrators[pair.integrator].as_ref();
    let entry = &subject.entry;
    let shape = first_shape(
        integrator,
        &pair.plan,
        request.bandwidth,
        entry,
        request.effort,
    );
    let mut expected = |regions: &Regions| {
        let kernel = request.truth_kernel();
        let bandwidths = &shape.bandwidths;
        truths.of(pair.scene, entry, &pair.plan, regions, kernel, bandwidths)
    };
    let selected = request.mask.as_ref().map(Mask::selected);
    let (regions, expected, excluded) = if integrator.has_infinite_variance_at_folds() {
        let Some(kept) = Kept::of(entry, selected) else {
            return Ok(None);
        };
        let (left, all) = (expected(&kept.regions)?, expected(&kept.all)?);
        let excluded = kept.excluded(&left, &all);
        (kept.regions, left, Some(excluded))
    } else {
        let (width, height) = (entry.camera.width, entry.camera.height);
        let regions = match selected.and_then(|s| Regions::mask(width, height, s)) {
            Some(mask) => mask,
            None => Regions::quadtree(width, height),
        };
        let expected = expected(&regions)?;
        (regions, expected, None)
    };
    let job = Job {
        integrator: pair.integrator,
        argument: &subject.argument,
        entry,
        plan: &pair.plan,
        shape,
        regions,
        expected,
        excluded,
        variation: None,
    };
    Ok(Some(job.run(request, levels, checks, started)))
}

impl Request {
    /// The mollifier, as the truth knows it.
    pub(super) fn truth_kernel(&self) -> Option<TruthKernel> {
        self.kernel.and_then(|k| k.to_string().parse().ok())
    }
}

impl Job<'_> {
    /// Runs it and judges it. `started` is when its truth began to be computed.
    pub fn run(
        self,
        request: &Request,
        levels: Levels,
        checks: u64,
        started: Instant,
    ) -> Vec<Verdict> {
        let integrator = request.integrators[self.integrator].as_ref();
        let entry = self.entry;
        let canvas = Canvas {
            width: entry.camera.width,
            height: entry.camera.height,
            classes: entry.kind.classes(),
        };
        let demand = Demand {
            margin: request.margin,
            levels,
            most_paths: request.most_paths,
        };
        let mut identity = entry.name.clone();
        if let Some(variation) = &self.variation {
            identity.push('/');
            identity.push_str(variation);
        }
        let seeds = Seeds::new(request.seed, &identity, integrator.name());
        let evidence = gather(
            || integrator.prepare(entry),
            canvas,
            &self.regions,
            self.shape,
            seeds,
            &self.expected,
            demand,
        );
        let seconds = started.elapsed().as_secs_f64();
        let mut command = command(request, self.argument, integrator, checks);
        if self.variation.is_some() {
            command.push_str(" --variations");
        }
        let first = match request.mask {
            Some(_) => MASK,
            None => WHOLE_IMAGE,
        };
        let verdict = |judged: Judged| {
            let treatment = judged.class.map(|c| self.plan[c].treatment);
            let regularized = match treatment {
                Some(t) => is_regularized(t),
                None => self.plan.iter().any(|c| is_regularized(c.treatment)),
            };
            let class = judged.class.map(|c| self.plan[c].class.to_string());
            let place = judged.finding.place.clone();
            Verdict {
                scene: entry.name.clone(),
                variation: self.variation.clone(),
                integrator: integrator.name().to_owned(),
                class: class.unwrap_or_else(|| ALL_CLASSES.to_owned()),
                region: place.unwrap_or_else(|| first.to_owned()),
                paths_needed: judged
                    .finding
                    .replicates_needed
                    .map(|n| n * judged.drawn.paths_per_replicate),
                finding: judged.finding,
                truth: judged.truth,
                mean: judged.mean,
                margin: request.margin,
                levels,
                bandwidth: regularized.then_some(request.bandwidth),
                tail: judged.tail,
                excluded: self.excluded,
                looks_like: None,
                replicates: judged.drawn.replicates,
                looks: judged.drawn.looks,
                paths: judged.drawn.paths(),
                seed: request.seed,
                seconds,
                command: command.clone(),
            }
        };
        evidence.judged.into_iter().map(verdict).collect()
    }
}

fn is_regularized(treatment: Treatment) -> bool {
    matches!(treatment, Treatment::Regularized(_))
}

/// The replicates that pilots start with. A wide margin needs few paths in all, but a test never takes fewer than 256
/// replicates: they are shorter then, and fewer of the small tiles can be judged.
pub(crate) fn first_shape(
    integrator: &dyn Integrator,
    plan: &Plan,
    bandwidth: f64,
    entry: &Entry,
    effort: Effort,
) -> Shape {
    let pixels = u64::from(entry.camera.width) * u64::from(entry.camera.height);
    let schedule = integrator.schedule(bandwidth);
    let merges = |t: Treatment| t == Treatment::Regularized(Technique::Merge);
    let iterations = if plan.iter().any(|c| merges(c.treatment)) {
        MERGING_ITERATIONS
    } else {
        1
    };
    let paths = (PATHS_PER_PIXEL * pixels).max(FEWEST_PATHS);
    // Without tiles a replicate needs fewer paths, which such methods take their time for.
    let paths = match effort {
        _ if integrator.has_infinite_variance_at_folds() => paths / PART_WITHOUT_TILES,
        Effort::Quick => paths / PART_WHEN_QUICK,
        Effort::Standard | Effort::Thorough => paths,
    };
    Shape {
        bandwidths: (0..iterations).map(|i| schedule.bandwidth(i)).collect(),
        paths_per_iteration: paths / u64::from(iterations),
    }
}

/// The command that gives the same verdicts on one pair: what the suite had as defaults is written out.
fn command(request: &Request, scene: &str, integrator: &dyn Integrator, checks: u64) -> String {
    let mut text = format!(
        "nephroid verify --scene {} --integrator {} --seed {} --effort {}",
        quoted(scene),
        integrator.name(),
        request.seed,
        request.effort
    );
    let mut add = |option: &str, value: String, default: String| {
        if value != default {
            text.push_str(&format!(" {option} {value}"));
        }
    };
    add(
        "--margin",
        request.margin.to_string(),
        request.effort.margin().to_string(),
    );
    add(
        "--level",
        request.level.to_string(),
        crate::judge::hypotheses::LEVEL.to_string(),
    );
    add(
        "--budget",
        request.most_paths.to_string(),
        request.effort.most_paths().to_string(),
    );
    add(
        "--bandwidth",
        request.bandwidth.to_string(),
        super::effort::BANDWIDTH.to_string(),
    );
    if let Some(kernel) = request.kernel {
        text.push_str(&format!(" --kernel {kernel}"));
    }
    text.push_str(&integrator.options());
    if let Some(mask) = &request.mask {
        text.push_str(&format!(" --mask {}", quoted(mask.file())));
    }
    text.push_str(&format!(" --checks {checks}"));
    text
}

/// An argument as a POSIX shell reads it back.
pub(crate) fn quoted(argument: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./".contains(c);
    if argument.chars().all(plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}
