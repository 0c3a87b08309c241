//! The final test of one integrator on one scene: replicates in growing numbers, judged at each look until all is decided.

use nephroid_analytic::camera::Bounded;

use super::expected::Expected;
use super::replicates::{Canvas, FINAL, Seeds, Shape, run_without};
use super::sizing::{self, Check, Demand, Group, PATHS_BEFORE_MISSING, Size, Source};
use crate::integrators::Prepared;
use crate::judge::betting::Bet;
use crate::judge::evidence::{FEWEST_REPLICATES, Invalid, Replicate, Sample, Tally};
use crate::judge::finding::{Finding, State};
use crate::judge::heavy::{self, TailIndex};
use crate::judge::hypotheses::dependence_p;
use crate::judge::spending::{Look, looks};
use crate::judge::verdict::{Case, Measure, Part, Spent, decide_at};
use crate::regions::Regions;

/// Replicates that are held in memory at a time.
const AT_A_TIME: u32 = 256;
/// Weights of the betting test and of the test of independence in the image's share of a check's error probability.
const BETTING: f64 = 0.1;
const INDEPENDENCE: f64 = 0.1;

/// What is checked: a class, or the sum of those claimed.
struct Subject {
    /// Position of the class, `None` for the sum.
    class: Option<usize>,
    layers: Vec<usize>,
    expected: Expected,
    /// One for each area of which the truth is known, the image first.
    tallies: Vec<Tally>,
    bet: Bet,
    spent: Spent,
    finding: Option<Finding>,
    drawn: Drawn,
}

/// A finding about one check.
pub struct Judged {
    /// Position of the class, `None` for the sum of those claimed.
    pub class: Option<usize>,
    /// What the mean over the image should be.
    pub truth: Option<Bounded>,
    /// What it is.
    pub mean: Option<f64>,
    /// What follows.
    pub finding: Finding,
    /// Tail index of the largest pixels of the replicates, where there are enough.
    pub tail: Option<TailIndex>,
    /// What was drawn for it.
    pub drawn: Drawn,
}

/// How much was drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// Replicates.
    pub replicates: u32,
    /// Paths of each.
    pub paths_per_replicate: u64,
    /// Looks that were taken.
    pub looks: u32,
}

impl Drawn {
    /// Paths in all.
    pub fn paths(&self) -> u64 {
        u64::from(self.replicates) * self.paths_per_replicate
    }
}

/// What a test came to.
pub struct Evidence {
    /// A finding for every class in order, and then for their sum.
    pub judged: Vec<Judged>,
    /// What was planned for the checks that need most.
    pub size: Size,
    /// Replicates that were drawn for them.
    pub replicates: u32,
    /// Paths of all replicates.
    pub paths: u64,
    /// The fewest contributions of a claimed class in any replicate.
    pub fewest_contributions: u64,
    /// Looks that were taken.
    pub looks: u32,
}

/// Plans and runs the test of one integrator on one scene. `expected` has the means of each class, `None` for what is not
/// sampled.
pub fn gather(
    prepare: impl FnOnce() -> Box<dyn Prepared>,
    canvas: Canvas,
    regions: &Regions,
    shape: Shape,
    seeds: Seeds,
    expected: &[Option<Expected>],
    demand: Demand,
) -> Evidence {
    let end = End::AllDecided;
    gather_until(
        end, prepare, canvas, regions, shape, seeds, expected, demand,
    )
}

/// When a test ends, apart from its budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// All checks are decided.
    AllDecided,
    /// A check says different, or all are decided.
    FirstDifference,
}

/// The same, up to an end of choice.
pub fn gather_until(
    end: End,
    prepare: impl FnOnce() -> Box<dyn Prepared>,
    canvas: Canvas,
    regions: &Regions,
    shape: Shape,
    seeds: Seeds,
    expected: &[Option<Expected>],
    demand: Demand,
) -> Evidence {
    let mut subjects = subjects(expected);
    let mut layers: Vec<Layer> = vec![Layer::default(); expected.len()];
    let unplanned = Size {
        shape: shape.clone(),
        replicates: 0,
        most: 0,
    };
    if subjects.is_empty() {
        return Evidence {
            judged: in_order(subjects, &layers),
            size: unplanned,
            replicates: 0,
            paths: 0,
            fewest_contributions: 0,
            looks: 0,
        };
    }
    let prepared = prepare();
    let source = Source {
        prepared: prepared.as_ref(),
        canvas,
        regions,
        seeds,
    };
    let checks: Vec<Check> = subjects.iter().map(Subject::check).collect();
    let groups = sizing::plan(source, shape, &checks, demand);
    let (mut paths, mut last) = (0, Drawn::default());
    for group in &groups {
        last = test(source, group, &mut subjects, &mut layers, end, demand);
        paths += last.paths();
        if end == End::FirstDifference && subjects.iter().any(Subject::is_different) {
            break;
        }
    }
    let tested = |s: &&Subject| s.class.is_some() && s.drawn.replicates > 0;
    let fewest = subjects.iter().filter(tested);
    Evidence {
        fewest_contributions: fewest
            .map(|s| s.tallies[0].sample().fewest_contributions)
            .min()
            .unwrap_or(0),
        judged: in_order(subjects, &layers),
        size: groups.last().map_or(unplanned, |g| g.size.clone()),
        replicates: last.replicates,
        paths,
        looks: last.looks,
    }
}

/// Draws replicates for a group of checks and judges them at each look, until all are decided.
fn test(
    source: Source,
    group: &Group,
    subjects: &mut [Subject],
    layers: &mut [Layer],
    end: End,
    demand: Demand,
) -> Drawn {
    let Source {
        prepared,
        canvas,
        regions,
        seeds,
    } = source;
    let Size { shape, .. } = &group.size;
    let mut drawn = Drawn {
        paths_per_replicate: shape.paths(),
        ..Drawn::default()
    };
    let mut members: Vec<&mut Subject> = subjects
        .iter_mut()
        .enumerate()
        .filter_map(|(i, s)| group.checks.contains(&i).then_some(s))
        .collect();
    let most = u64::from(group.size.most);
    for look in looks(u64::from(group.size.replicates), most) {
        while u64::from(drawn.replicates) < look.replicates {
            let start = drawn.replicates;
            let stop = (start + AT_A_TIME).min(look.replicates as u32);
            let unread = group.unread;
            for r in run_without(
                unread,
                prepared,
                canvas,
                regions,
                shape,
                seeds,
                FINAL,
                start..stop,
            ) {
                members.iter_mut().for_each(|s| s.push(&r));
                for (l, layer) in layers.iter_mut().enumerate() {
                    if !unread.contain(l) {
                        layer.push(&r, l, shape.paths());
                    }
                }
            }
            drawn.replicates = stop;
        }
        drawn.looks += 1;
        for subject in &mut members {
            subject.decide(regions, demand, look, &group.size);
            subject.drawn = drawn;
        }
        let suffices = end == End::FirstDifference && members.iter().any(|s| s.is_different());
        if suffices || members.iter().all(|s| s.is_settled()) {
            break;
        }
    }
    drawn
}

/// What is kept of every layer, claimed or not.
#[derive(Clone, Default)]
struct Layer {
    contributions: u64,
    invalid: Invalid,
    largest: Vec<f64>,
    drawn: Drawn,
}

impl Layer {
    fn push(&mut self, r: &Replicate, layer: usize, paths: u64) {
        self.contributions += r.contributions(layer, 0);
        if self.invalid.first.is_none() {
            self.invalid = r.invalid[layer];
        }
        // The largest pixels of replicates of one size.
        if self.drawn.paths_per_replicate != paths {
            self.largest.clear();
            self.drawn = Drawn::default();
        }
        self.largest.push(r.largest[layer]);
        self.drawn.paths_per_replicate = paths;
        self.drawn.replicates += 1;
    }
}

/// Each claimed class, and their sum if there are several.
fn subjects(expected: &[Option<Expected>]) -> Vec<Subject> {
    let claimed = || {
        let some = |(i, e): (usize, &Option<Expected>)| Some((i, e.clone()?));
        expected.iter().enumerate().filter_map(some)
    };
    let mut subjects: Vec<_> = claimed()
        .map(|(i, e)| Subject::new(Some(i), vec![i], e))
        .collect();
    if subjects.len() > 1 {
        let all: Vec<Expected> = claimed().map(|(_, e)| e).collect();
        let layers = claimed().map(|(i, _)| i).collect();
        subjects.push(Subject::new(None, layers, sum(&all)));
    }
    subjects
}

fn sum(parts: &[Expected]) -> Expected {
    let add = |a: Bounded, b: Bounded| Bounded {
        value: a.value + b.value,
        error: a.error + b.error,
    };
    let area = |k: usize| {
        parts
            .iter()
            .fold(Bounded::default(), |s, e| add(s, e.areas()[k]))
    };
    let areas = parts.iter().map(|e| e.areas().len()).min().unwrap_or(0);
    Expected::new(area(0), (1..areas).map(area))
}

impl Subject {
    fn new(class: Option<usize>, layers: Vec<usize>, expected: Expected) -> Self {
        let tallies = vec![Tally::default(); expected.areas().len()];
        Subject {
            class,
            layers,
            expected,
            tallies,
            bet: Bet::default(),
            spent: Spent::default(),
            finding: None,
            drawn: Drawn::default(),
        }
    }

    fn check(&self) -> Check {
        Check {
            layers: self.layers.clone(),
            truth: self.expected.first(),
        }
    }

    fn push(&mut self, r: &Replicate) {
        for (area, tally) in self.tallies.iter_mut().enumerate() {
            tally.push(r, &self.layers, area);
        }
        let most = self.expected.first().value + self.expected.first().error;
        if most > 0.0 {
            let x: f64 = self.layers.iter().map(|&l| r.mean(l, 0)).sum();
            self.bet.push(x / most);
        }
    }

    fn is_decided(&self) -> bool {
        self.finding
            .as_ref()
            .is_some_and(|f| f.state != State::Undecided)
    }

    fn is_different(&self) -> bool {
        self.finding
            .as_ref()
            .is_some_and(|f| f.state == State::Different)
    }

    /// Whether it is decided, or more replicates would not help.
    fn is_settled(&self) -> bool {
        let open = |f: &Finding| f.state == State::Undecided && f.replicates_needed.is_some();
        self.finding.as_ref().is_some_and(|f| !open(f))
    }

    fn decide(&mut self, regions: &Regions, demand: Demand, look: Look, size: &Size) {
        // A verdict stands; the sample goes on for the sake of others.
        if self.is_decided() {
            return;
        }
        let samples: Vec<Sample> = self.tallies.iter().map(Tally::sample).collect();
        let weights = regions.weights();
        let several = samples.len() > 1;
        let weight = if several { weights[0] } else { 1.0 };
        let parts = samples.iter().enumerate().skip(1).map(|(k, &sample)| Part {
            place: regions.areas()[k].to_string(),
            weight: weights[k],
            sample,
            truth: self.expected.areas()[k],
            measure: Measure::Radiance,
        });
        let case = Case {
            sample: samples[0],
            truth: self.expected.first(),
            weight: weight * (1.0 - BETTING - INDEPENDENCE),
            most: u64::from(size.most),
            fewest: FEWEST_REPLICATES,
            dependence: Some((
                dependence_p(self.tallies[0].correlation(), samples[0].replicates),
                weight * INDEPENDENCE,
            )),
            too_bright: Some((self.bet.p(), weight * BETTING)),
            parts: parts.collect(),
        };
        let Demand { margin, levels, .. } = demand;
        let mut finding = decide_at(&case, margin, levels, look.share, &mut self.spent);
        let paths = look.replicates * size.shape.paths();
        let is_missing = finding.state == State::Different && case.sample.contributions == 0;
        if is_missing && paths < PATHS_BEFORE_MISSING {
            finding = Finding::bare(
                State::Undecided,
                format!(
                    "no contribution in {paths} paths; {PATHS_BEFORE_MISSING} are drawn before a class is called missing"
                ),
            );
            finding.replicates_needed = Some(PATHS_BEFORE_MISSING.div_ceil(size.shape.paths()));
        }
        self.finding = Some(finding);
    }
}

/// Findings for every class in order, and then for the sum.
fn in_order(subjects: Vec<Subject>, layers: &[Layer]) -> Vec<Judged> {
    let mut subjects = subjects.into_iter().peekable();
    let decided = |s: Subject| {
        let sample = s.tallies[0].sample();
        let tail = s.class.and_then(|c| heavy::hill(&layers[c].largest));
        Judged {
            class: s.class,
            truth: Some(s.expected.first()),
            mean: Some(sample.mean),
            drawn: s.drawn,
            finding: s
                .finding
                .unwrap_or_else(|| Finding::bare(State::Undecided, "nothing was drawn")),
            tail,
        }
    };
    let mut judged = Vec::new();
    for (position, layer) in layers.iter().enumerate() {
        match subjects.next_if(|s| s.class == Some(position)) {
            Some(subject) => judged.push(decided(subject)),
            None => judged.push(not_sampled(layer, position)),
        }
    }
    judged.extend(subjects.map(decided));
    judged
}

/// A class that is declared impossible must indeed stay empty.
fn not_sampled(layer: &Layer, position: usize) -> Judged {
    let finding = if layer.contributions > 0 || layer.invalid.pixels() > 0 {
        Finding::bare(
            State::Different,
            format!(
                "declared impossible, yet it has {} contributions",
                layer.contributions
            ),
        )
    } else {
        Finding::bare(
            State::NotSampled,
            "the method cannot build paths of this class",
        )
    };
    Judged {
        class: Some(position),
        truth: None,
        mean: None,
        finding,
        tail: None,
        drawn: layer.drawn,
    }
}
