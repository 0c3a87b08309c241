//! One fault at one stand: is it noticed, by what, after how many paths?

use std::time::Instant;

use nephroid_analytic::scene::Entry;

use super::exhibits::{Check, Stand, scene};
use crate::diagnosis::{self, Known, Subject, means_at_half};
use crate::error::Error;
use crate::integrators::{Fault, Integrator, Kernel, Plan, Prepared, Settings, by_name};
use crate::judge::finding::State;
use crate::judge::hypotheses::{EQUIVALENCE_LEVEL, LEVEL, Levels};
use crate::regions::Regions;
use crate::verify::effort::Effort;
use crate::verify::excluded::Kept;
use crate::verify::expected::{Expected, Truths};
use crate::verify::gather::{End, Evidence, gather_until};
use crate::verify::replicates::{Canvas, FINAL, Seeds, Shape, run as run_replicates};
use crate::verify::run::first_shape;
use crate::verify::sizing::Demand;
use crate::verify::suite::Pair;

/// The most paths of a trial: what two cores draw in about ten seconds.
pub const MOST_PATHS: u64 = 400_000_000;
/// A path of a method that walks on specular surfaces takes so many times longer.
const COST_OF_WALKS: u64 = 64;
/// Replicates among which [`Check::Repeats`] looks for equal ones.
const REPLICATES: u32 = 64;

/// What came of one fault at one stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Whether it was noticed.
    pub noticed: bool,
    /// By what, in a few words; empty if it was not.
    pub by: String,
    /// Relative difference of the class's mean, where that is what was noticed.
    pub effect: Option<f64>,
    /// Paths that were judged.
    pub paths: u64,
    /// Wall-clock time, pilots included, truths and diagnosis not.
    pub seconds: f64,
    /// What it looks like.
    pub looks_like: Option<String>,
}

/// The scenes of all stands, with their truths: computed once.
pub struct Hall {
    scenes: Vec<(&'static str, Entry)>,
    truths: Truths,
    /// Checks among which the level is shared: those of a whole suite.
    checks: u64,
}

impl Hall {
    /// A hall for stands of an effort, of which a whole suite has so many checks.
    pub fn new(effort: Effort, checks: u64) -> Self {
        Hall {
            scenes: Vec::new(),
            truths: Truths::for_margin(effort.margin()),
            checks,
        }
    }

    /// Position of a scene.
    fn scene(&mut self, name: &'static str) -> Result<usize, Error> {
        if let Some(found) = self.scenes.iter().position(|(n, _)| *n == name) {
            return Ok(found);
        }
        self.scenes.push((name, scene(name)?));
        Ok(self.scenes.len() - 1)
    }

    /// Everything about a stand but the fault.
    pub fn set_up(&mut self, stand: &Stand) -> Result<SetUp, Error> {
        let scene = self.scene(stand.scene)?;
        let entry = self.scenes[scene].1.clone();
        let sound = by_name(stand.integrator, &Settings::default())?;
        let (width, height) = (entry.camera.width, entry.camera.height);
        let pair = Pair::new(scene, &entry, 0, sound.as_ref());
        let shape = first_shape(
            sound.as_ref(),
            &pair.plan,
            stand.bandwidth,
            &entry,
            Effort::Standard,
        );
        let whole = || Regions::quadtree(width, height);
        let regions = if sound.has_infinite_variance_at_folds() {
            Kept::of(&entry, None).map_or_else(whole, |kept| kept.regions)
        } else {
            whole()
        };
        let kernel = None;
        let expected = self.truths.of(
            scene,
            &entry,
            &pair.plan,
            &regions,
            kernel,
            &shape.bandwidths,
        )?;
        let at_half = means_at_half(&mut self.truths, &entry, &pair, &regions, None, &shape)?;
        Ok(SetUp {
            stand: *stand,
            scene,
            plan: pair.plan,
            shape,
            regions,
            expected,
            at_half,
            entry,
        })
    }

    /// Tries a fault, or none, at a stand. `end` is the first difference for a fault, and all checks without one.
    ///
    /// # Errors
    /// A stand that names no integrator or scene.
    pub fn trial(
        &self,
        set_up: &SetUp,
        fault: Option<Fault>,
        seed: u64,
        most_paths: u64,
        diagnose: bool,
    ) -> Result<Trial, Error> {
        let started = Instant::now();
        let settings = Settings {
            kernel: None::<Kernel>,
            fault,
            ..Settings::default()
        };
        let SetUp { stand, entry, .. } = set_up;
        let integrator = by_name(stand.integrator, &settings)?;
        let most_paths = if integrator.has_infinite_variance_at_folds() {
            most_paths / COST_OF_WALKS
        } else {
            most_paths
        };
        let seeds = Seeds::new(seed, stand.scene, stand.integrator);
        let prepared = integrator.prepare(entry);
        let prepared = prepared.as_ref();
        let (mut trial, class) = match stand.check {
            Check::Verify => self.verified(set_up, integrator.as_ref(), seeds, most_paths),
            Check::Repeats => (set_up.repeats(prepared, seeds), None),
        };
        trial.seconds = started.elapsed().as_secs_f64();
        if diagnose && trial.noticed && stand.check == Check::Verify {
            // If the sum of the classes is different, the first of them that looks like something.
            let classes = class.map_or(0..set_up.plan.len(), |c| c..c + 1);
            trial.looks_like = classes
                .filter_map(|class| self.looks_like(set_up, prepared, seeds, class))
                .next();
        }
        Ok(trial)
    }

    fn looks_like(
        &self,
        set_up: &SetUp,
        prepared: &dyn Prepared,
        seeds: Seeds,
        class: usize,
    ) -> Option<String> {
        let expected = set_up.expected[class].as_ref().map(|e| e.first().value);
        let means = expected
            .zip(set_up.at_half[class])
            .map(|(mean, half)| [mean, half]);
        let image = self.truths.image(set_up.scene);
        diagnosis::of(&Subject {
            entry: &set_up.entry,
            prepared,
            layer: class,
            shape: &set_up.shape,
            seeds,
            truth: Known::of(set_up.plan[class].treatment, image, class, means)?,
        })
    }

    /// The trial, and the position of the class that was different.
    fn verified(
        &self,
        set_up: &SetUp,
        integrator: &dyn Integrator,
        seeds: Seeds,
        most_paths: u64,
    ) -> (Trial, Option<usize>) {
        let demand = Demand {
            margin: Effort::Standard.margin(),
            levels: Levels::shared(LEVEL, EQUIVALENCE_LEVEL, self.checks),
            most_paths,
        };
        let evidence = gather_until(
            End::FirstDifference,
            || integrator.prepare(&set_up.entry),
            set_up.canvas(),
            &set_up.regions,
            set_up.shape.clone(),
            seeds,
            &set_up.expected,
            demand,
        );
        // A class rather than the sum of all.
        let different = evidence
            .judged
            .iter()
            .find(|j| j.finding.state == State::Different);
        let by = different.map(|j| {
            let class = j
                .class
                .map_or("all".to_owned(), |c| set_up.plan[c].class.to_string());
            let finding = &j.finding;
            match (&finding.place, finding.effect) {
                (Some(place), _) => format!("{class}, {place}"),
                (None, Some(effect)) => format!("{class}, {:+.1} %", 100.0 * effect),
                (None, None) => format!("{class}: {}", finding.reason),
            }
        });
        let trial = Trial {
            noticed: different.is_some(),
            by: by.unwrap_or_default(),
            effect: different.and_then(|j| j.finding.effect),
            paths: paths(&evidence),
            seconds: 0.0,
            looks_like: None,
        };
        (trial, different.and_then(|j| j.class))
    }
}

fn paths(evidence: &Evidence) -> u64 {
    evidence.paths
}

/// Everything about a stand but the fault.
pub struct SetUp {
    /// The stand.
    pub stand: Stand,
    /// What the integrator claims.
    pub plan: Plan,
    /// Replicates that pilots start with.
    pub shape: Shape,
    /// The scene.
    pub entry: Entry,
    scene: usize,
    regions: Regions,
    expected: Vec<Option<Expected>>,
    at_half: Vec<Option<f64>>,
}

impl SetUp {
    fn canvas(&self) -> Canvas {
        Canvas {
            width: self.entry.camera.width,
            height: self.entry.camera.height,
            classes: self.entry.kind.classes(),
        }
    }

    /// What the mean of each class over the image should be; `None` where it is not sampled.
    pub fn means(&self) -> Vec<Option<f64>> {
        let value = |e: &Option<Expected>| e.as_ref().map(|e| e.first().value);
        self.expected.iter().map(value).collect()
    }

    /// Two replicates with different seeds that are the same: sums of thousands of random numbers are not equal by chance.
    fn repeats(&self, prepared: &dyn Prepared, seeds: Seeds) -> Trial {
        let (canvas, regions) = (self.canvas(), &self.regions);
        let found = run_replicates(
            prepared,
            canvas,
            regions,
            &self.shape,
            seeds,
            FINAL,
            0..REPLICATES,
        );
        let mut sums: Vec<Vec<u64>> = found
            .iter()
            .map(|r| {
                (0..self.plan.len())
                    .map(|l| r.mean(l, 0).to_bits())
                    .collect()
            })
            .collect();
        let all = sums.len();
        sums.sort();
        sums.dedup();
        let same = all - sums.len();
        Trial {
            noticed: same > 0,
            by: if same > 0 {
                format!("{same} of {all} replicates repeat another one")
            } else {
                String::new()
            },
            effect: None,
            paths: u64::from(REPLICATES) * self.shape.paths(),
            seconds: 0.0,
            looks_like: (same > 0)
                .then(|| "looks like a seed of which only some bits are used".to_owned()),
        }
    }
}
