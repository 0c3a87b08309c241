//! How many paths a test needs: found by pilots, whose replicates are thrown away so that the looks of the final test
//! do not depend on its data.

use nephroid_analytic::camera::Bounded;

use super::replicates::{Canvas, Seeds, Shape, run};
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
const CONTRIBUTIONS_WANTED: u64 = 2 * FEWEST_CONTRIBUTIONS;
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

/// Runs pilots until they have seen enough, makes replicates large enough for normal means, then plans for the hardest
/// check.
pub fn plan(
    prepared: &dyn Prepared,
    canvas: Canvas,
    regions: &Regions,
    first: Shape,
    seeds: Seeds,
    checks: &[Check],
    demand: Demand,
) -> Size {
    let mut shape = first;
    let mut pilot = Vec::new();
    let mut factor = 1;
    let regions = regions.first();
    for phase in 1.. {
        let replicates = 0..PILOT_REPLICATES;
        pilot = run(prepared, canvas, &regions, &shape, seeds, phase, replicates);
        factor = growth(&pilot, checks, &shape, demand);
        let mut seen = checks
            .iter()
            .map(|c| Sample::of_layers(&pilot, &c.layers, 0))
            .filter(|s| s.contributions > 0);
        let enough = seen.all(|s| s.contributions >= CONTRIBUTIONS_FOR_VARIANCE);
        if factor <= 1 || enough || phase == MOST_PILOTS {
            break;
        }
        shape.paths_per_iteration *= factor;
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
        let mean = (s.contributions / replicates)
            .max(s.fewest_contributions)
            .max(1);
        CONTRIBUTIONS_WANTED
            .div_ceil(mean)
            .max(2)
            .next_power_of_two()
    };
    let for_seen = seen.map(wanted).max().unwrap_or(1);
    let most_for_seen = (demand.most_paths / (FEWEST_PLANNED * shape.paths()))
        .max(1)
        .next_power_of_two();
    for_seen.min(most_for_seen).min(1024)
}
