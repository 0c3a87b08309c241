//! Which pairs of scene and integrator a suite runs.

use nephroid_analytic::scene::Entry;

use super::expected::{is_judged, mollified};
use super::verdicts::NotRun;
use crate::expectation;
use crate::integrators::{ClassPlan, Integrator, Plan, Technique, Treatment};

/// A scene as the user named it.
pub struct Subject {
    /// A name in the catalogue or a file.
    pub argument: String,
    /// What it stands for.
    pub entry: Entry,
}

/// An integrator that takes part in no pair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// Its name.
    pub integrator: String,
    /// Why.
    pub reason: String,
}

/// How many of the pairs are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coverage {
    /// Each integrator on two entries or more, each entry by two integrators or more, where there are as many.
    Covering,
    /// All but those whose truth or paths take minutes.
    Affordable,
    /// All of them.
    Everything,
}

/// A pair of scene and integrator, by their positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Position of the scene.
    pub scene: usize,
    /// Position of the integrator.
    pub integrator: usize,
    /// What the integrator does about the scene's classes.
    pub plan: Plan,
    /// What it costs to know what it should find.
    pub truth: TruthCost,
    /// Whether its paths take long.
    pub has_dear_paths: bool,
}

/// What the truth of a pair costs, by what it is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TruthCost {
    /// Closed forms, or expectations of a picture with straight edges: a second at most.
    Low,
    /// Expectations with one mollified vertex at each of a thousand points: seconds.
    Points,
    /// The same through several vertices: up to minutes.
    Chains,
}

impl TruthCost {
    fn of(entry: &Entry, plan: &Plan) -> Self {
        let regularized = plan
            .iter()
            .filter(|c| matches!(c.treatment, Treatment::Regularized(_)));
        match regularized.map(|c| c.class.light.len()).max() {
            None => TruthCost::Low,
            Some(_) if expectation::is_planar(&entry.kind) => TruthCost::Low,
            Some(1) => TruthCost::Points,
            Some(_) => TruthCost::Chains,
        }
    }
}

impl Pair {
    /// The scene and the integrator at these positions.
    pub fn new(scene: usize, entry: &Entry, position: usize, integrator: &dyn Integrator) -> Self {
        let plan = integrator.plan(entry);
        Pair {
            scene,
            integrator: position,
            truth: TruthCost::of(entry, &plan),
            has_dear_paths: integrator.is_dear(entry),
            plan,
        }
    }

    /// Whether the integrator regularizes a class of the scene.
    fn regularizes(&self) -> bool {
        let regularized = |c: &ClassPlan| matches!(c.treatment, Treatment::Regularized(_));
        self.plan.iter().any(regularized)
    }

    /// Whether its truth or its paths take minutes.
    fn is_dear(&self) -> bool {
        self.truth != TruthCost::Low || self.has_dear_paths
    }

    /// Positions of the classes that the integrator claims.
    pub fn claimed(&self) -> Vec<usize> {
        let sampled =
            |(i, c): (usize, &ClassPlan)| (c.treatment != Treatment::NotSampled).then_some(i);
        self.plan.iter().enumerate().filter_map(sampled).collect()
    }

    /// Number of checks: one for each claimed class, and one for their sum if there are several.
    pub fn checks(&self) -> u64 {
        match self.claimed().len() as u64 {
            several @ 2.. => several + 1,
            one_or_none => one_or_none,
        }
    }
}

/// Entries and integrators that a covering subset gives each integrator and each entry, where there are as many.
const COVER: usize = 2;

/// Chooses what to run, in the order of scenes and then integrators, and says why the rest is left out.
pub fn select(
    scenes: &[Subject],
    integrators: &[Box<dyn Integrator>],
    coverage: Coverage,
) -> (Vec<Pair>, Vec<NotRun>) {
    let mut pairs = Vec::new();
    let mut not_run = Vec::new();
    for (s, subject) in scenes.iter().enumerate() {
        for (i, integrator) in integrators.iter().enumerate() {
            let pair = Pair::new(s, &subject.entry, i, integrator.as_ref());
            match without_truth(&subject.entry, integrator.as_ref(), &pair.plan) {
                Some(reason) => not_run.push((s, i, reason)),
                None => pairs.push(pair),
            }
        }
    }
    let keep = match coverage {
        Coverage::Covering => covering(&pairs, scenes.len(), integrators.len()),
        Coverage::Affordable => pairs.iter().map(|p| !p.is_dear()).collect(),
        Coverage::Everything => vec![true; pairs.len()],
    };
    let mut kept = keep.iter();
    pairs.retain(|p| {
        let keep = *kept.next().unwrap_or(&true);
        if !keep {
            let reason = if p.is_dear() {
                "takes minutes: at thorough, or with --scene and --integrator"
            } else {
                "not in the quick subset"
            };
            not_run.push((p.scene, p.integrator, reason.to_owned()));
        }
        keep
    });
    not_run.sort();
    let name = |(s, i, reason): (usize, usize, String)| NotRun {
        scene: scenes[s].entry.name.clone(),
        integrator: integrators[i].name().to_owned(),
        reason,
    };
    (pairs, not_run.into_iter().map(name).collect())
}

/// Why a plan cannot be judged on an entry.
fn without_truth(entry: &Entry, integrator: &dyn Integrator, plan: &Plan) -> Option<String> {
    if let Err(reason) = integrator.supports(entry) {
        return Some(reason);
    }
    let adaptive = Treatment::Regularized(Technique::AdaptiveMerge);
    if plan.iter().any(|c| c.treatment == adaptive) {
        return Some(
            "the radius depends on the photons: an expectation is known only given the radii of a run (tests hold it to that)"
                .to_owned(),
        );
    }
    let mut regularized: Vec<_> = plan
        .iter()
        .filter_map(|c| match c.treatment {
            Treatment::Regularized(technique) => Some(technique),
            _ => None,
        })
        .collect();
    regularized.dedup();
    regularized
        .into_iter()
        .find_map(|technique| match mollified(technique) {
            Some(technique) => expectation::unknown(entry, technique),
            None if is_judged(technique) => (!expectation::is_planar(&entry.kind)).then(|| {
                let kind = entry.kind.name();
                format!("no exact expectation of connections with merging for the kind {kind}")
            }),
            None => Some("no exact expectation of its technique".to_owned()),
        })
}

/// Marks a covering subset without dear pairs. Each integrator takes entries with a class that it regularizes first, then those with
/// more classes, of which three are as good as many; then entries that still lack integrators take the first that claim anything.
/// Ties go to the first. Pairs that claim nothing cost nothing and stay.
fn covering(pairs: &[Pair], scenes: usize, integrators: usize) -> Vec<bool> {
    const MANY: usize = 3;
    let classes: Vec<usize> = pairs.iter().map(|p| p.claimed().len()).collect();
    let mut keep: Vec<bool> = classes.iter().map(|&c| c == 0).collect();
    let worth = |k: usize| (pairs[k].regularizes(), classes[k].min(MANY));
    let cover = |belongs: &dyn Fn(&Pair) -> bool,
                 worth: &dyn Fn(usize) -> (bool, usize),
                 keep: &mut Vec<bool>| {
        let mut candidates: Vec<usize> = (0..pairs.len())
            .filter(|&k| classes[k] > 0 && belongs(&pairs[k]) && !pairs[k].is_dear())
            .collect();
        candidates.sort_by_key(|&k| (!keep[k], core::cmp::Reverse(worth(k))));
        for k in candidates.into_iter().take(COVER) {
            keep[k] = true;
        }
    };
    for i in 0..integrators {
        cover(&|p| p.integrator == i, &worth, &mut keep);
    }
    for s in 0..scenes {
        cover(&|p| p.scene == s, &|_| (false, 0), &mut keep);
    }
    keep
}
