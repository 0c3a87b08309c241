//! How many paths a test needs: found by pilots, whose replicates are thrown away so that the looks of the final test
//! do not depend on its data.

use nephroid_analytic::camera::Bounded;

use super::replicates::{Canvas, Seeds, Shape, run_without};
use crate::film::Layers;
use crate::integrators::Prepared;
use crate::judge::evidence::{FEWEST_CONTRIBUTIONS, FEWEST_REPLICATES, Replicate, Sample};
use crate::judge::hypotheses::Levels;
use crate::judge::power::{FEWEST_PLANNED, replicates_needed};
use crate::regions::Regions;

/// Replicates of a pilot: a variance to about 20 %.
const PILOT_REPLICATES: u32 = 48;
/// The pilot's variance is multiplied by this before it is used: it may have been lucky.
const VARIANCE_ALLOWANCE: f64 = 1.2;
/// The planned look has half of the error probability, and the image, where it has tiles, half of that.
const SHARE_PLANNED: f64 = 0.25;
/// A replicate is made large enough for this many contributions on average, so that none of the final test falls below
/// [`FEWEST_CONTRIBUTIONS`].
const CONTRIBUTIONS_WANTED: u64 = FEWEST_CONTRIBUTIONS * 3 / 2;
/// A further pilot's replicates are so many times shorter than those of the final test would be: its variance needs no more.
const SHORTER_PILOT: u64 = 4;
/// The fewest contributions in any replicate of the pilot that are taken as a sign of this.
const CONTRIBUTIONS_SAFE: u64 = FEWEST_CONTRIBUTIONS * 5 / 4;
/// Each pilot makes replicates larger by a factor of up to 1024.
const MOST_PILOTS: u32 = 4;
/// Contributions in all of a pilot that give its variance to about 10 %, so that larger replicates need no pilot of
/// their own.
const CONTRIBUTIONS_FOR_VARIANCE: u64 = 1000;
/// A class that is claimed and was not seen in the pilot gets at least this many paths in the final test before it is
/// called missing: one contribution in a million paths would be seen with probability 1 - 2e-9.
pub const PATHS_BEFORE_MISSING: u64 = 20_000_000;
/// The most replicates, so that what is kept of them stays small.
const MOST_REPLICATES: u64 = 1 << 20;

/// One check: a sum of layers against a truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Positions of the film's layers.
    pub layers: Vec<usize>,
    /// What their sum should be [W m⁻² sr⁻¹].
    pub truth: Bounded,
}

/// What the checks of one run share.
#[derive(Clone, Copy, Debug)]
pub struct Demand {
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Error probabilities of one check.
    pub levels: Levels,
    /// The most paths in the final test.
    pub most_paths: u64,
}

/// Sample size of a final test.
#[derive(Clone, Debug, PartialEq)]
pub struct Size {
    /// What a replicate consists of.
    pub shape: Shape,
    /// How many are planned.
    pub replicates: u32,
    /// How many there may be in the end.
    pub most: u32,
}

/// Checks that are tested with the same replicates.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// Their positions.
    pub checks: Vec<usize>,
    /// Sample size of their test.
    pub size: Size,
    /// Layers that none of them reads.
    pub unread: Layers,
}

/// What pilots are drawn from.
#[derive(Clone, Copy)]
pub struct Source<'a> {
    /// The integrator on its scene.
    pub prepared: &'a dyn Prepared,
    /// Where it draws.
    pub canvas: Canvas,
    /// The areas of the image.
    pub regions: &'a Regions,
    /// Where seeds come from.
    pub seeds: Seeds,
}

/// Plans the tests of the checks of a run. A first pilot tells which of them need larger replicates; these are tested by
/// themselves, so that the paths of rare classes are not spent on the others as well.
pub fn plan(source: Source, first: Shape, checks: &[Check], demand: Demand) -> Vec<Group> {
    let pilot = source.pilot(1, &first, Layers::default());
    let grows = |i: &usize| growth(&pilot, &checks[*i..=*i], &first, demand) > 1;
    let (rare, common): (Vec<_>, Vec<_>) = (0..checks.len()).partition(grows);
    let mut groups = vec![common, rare];
    if groups.iter().any(Vec::is_empty) {
        groups = vec![groups.concat()];
    }
    let size = |members: Vec<usize>| {
        let own: Vec<Check> = members.iter().map(|&i| checks[i].clone()).collect();
        let others = checks.iter().flat_map(|c| c.layers.iter().copied());
        let is_read = |layer: &usize| own.iter().any(|c| c.layers.contains(layer));
        let unread = others.filter(|l| !is_read(l)).collect();
        Group {
            size: plan_together(source, pilot.clone(), first.clone(), unread, &own, demand),
            checks: members,
            unread,
        }
    };
    groups.into_iter().map(size).collect()
}

impl Source<'_> {
    fn pilot(&self, phase: u32, shape: &Shape, unread: Layers) -> Vec<Replicate> {
        run_without(
            unread,
            self.prepared,
            self.canvas,
            &self.regions.first(),
            shape,
            self.seeds,
            phase,
            0..PILOT_REPLICATES,
        )
    }
}

/// Runs pilots, of which there is one, until they have seen enough, makes replicates large enough for normal means, then
/// plans for the hardest check.
fn plan_together(
    source: Source,
    mut pilot: Vec<Replicate>,
    mut shape: Shape,
    unread: Layers,
    checks: &[Check],
    demand: Demand,
) -> Size {
    let mut factor = 1;
    for phase in 1.. {
        if phase > 1 {
            pilot = source.pilot(phase, &shape, unread);
        }
        factor = growth(&pilot, checks, &shape, demand);
        let mut seen = checks
            .iter()
            .map(|c| Sample::of_layers(&pilot, &c.layers, 0))
            .filter(|s| s.contributions > 0);
        let enough = seen.all(|s| s.contributions >= CONTRIBUTIONS_FOR_VARIANCE);
        if factor <= 1 || enough || phase == MOST_PILOTS {
            break;
        }
        shape.paths_per_iteration *= factor.div_ceil(SHORTER_PILOT);
    }
    shape.paths_per_iteration *= factor;
    let most = (demand.most_paths / shape.paths()).clamp(FEWEST_REPLICATES as u64, MOST_REPLICATES);
    let samples = checks
        .iter()
        .map(|c| (Sample::of_layers(&pilot, &c.layers, 0), c.truth));
    let levels = Levels {
        different: SHARE_PLANNED * demand.levels.different,
        equivalent: 2.0 * SHARE_PLANNED * demand.levels.equivalent,
    };
    let needed = samples.map(|(sample, truth)| {
        if sample.contributions == 0 {
            return PATHS_BEFORE_MISSING.div_ceil(shape.paths());
        }
        // Paths are independent (photon maps too, being of bounded size), so the variance of a mean falls as 1/paths.
        let variance = VARIANCE_ALLOWANCE * sample.variance / factor as f64;
        replicates_needed(variance, truth, demand.margin, levels).unwrap_or(0)
    });
    let replicates = needed.max().unwrap_or(0);
    Size {
        replicates: replicates.max(FEWEST_PLANNED).min(most) as u32,
        most: most as u32,
        shape,
    }
}

/// By how much replicates must grow.
fn growth(pilot: &[Replicate], checks: &[Check], shape: &Shape, demand: Demand) -> u64 {
    let samples = || {
        checks
            .iter()
            .map(|c| Sample::of_layers(pilot, &c.layers, 0))
    };
    // What is not a number stays so with more paths.
    let seen = samples().filter(|s| s.contributions > 0 && s.invalid.pixels() == 0);
    let replicates = u64::from(PILOT_REPLICATES);
    let wanted = |s: Sample| {
        if s.fewest_contributions >= CONTRIBUTIONS_SAFE {
            return 1;
        }
        // Wanted over the mean.
        let wanted = CONTRIBUTIONS_WANTED * replicates;
        wanted.div_ceil(s.contributions).max(2)
    };
    let for_seen = seen.map(wanted).max().unwrap_or(1);
    let most_for_seen = (demand.most_paths / (FEWEST_PLANNED * shape.paths())).max(1);
    for_seen.min(most_for_seen).min(1024)
}
