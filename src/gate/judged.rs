//! From checks and images to findings.

use super::blocks;
use super::checks::{Check, missing};
use super::stack::{Shared, Stack};
use super::truths::Truth;
use crate::judge::evidence::Sample;
use crate::judge::finding::{Finding, State};
use crate::judge::hypotheses::Levels;
use crate::judge::power;
use crate::judge::verdict::{Case, Measure, Part, Spent, decide_at};
use crate::regions::Regions;

/// Fewest images that are tested by their spread.
pub const FEWEST_IMAGES: usize = 4;
/// The most images that are asked for.
const MOST_IMAGES: usize = 1 << 14;
/// A class with less than this part of its light is missing.
const GONE: f64 = 0.1;

/// A look at the images so far.
#[derive(Clone, Copy)]
pub struct Look<'a> {
    /// What they should be.
    pub truth: &'a Truth,
    /// The areas.
    pub regions: &'a Regions,
    /// The pixels that are looked at.
    pub covered: &'a [bool],
    /// Equivalence margin relative to the truth.
    pub margin: f64,
    /// Error probabilities of a check.
    pub levels: Levels,
    /// Part of them that may be spent here.
    pub share: f64,
    /// Images that there may be in the end.
    pub most: u64,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// What follows.
    pub finding: Finding,
    /// What was measured.
    pub mean: f64,
    /// A first diagnosis: that a class is missing.
    pub looks_like: Option<String>,
}

impl Look<'_> {
    /// Judges a check on its images.
    pub fn judge(
        &self,
        check: &Check,
        stack: &Stack,
        shared: &Shared,
        spent: &mut Spent,
    ) -> Judged {
        let few = stack.images.len() < FEWEST_IMAGES;
        let sample_of = |k: usize| -> Sample {
            let functional = &check.statistics[k].functional;
            match stack.sample_by_variances(functional, self.regions) {
                Some(sample) if few => sample,
                _ => stack.sample(functional, shared, self.regions),
            }
        };
        let first = sample_of(0);
        let is_black = first.contributions == 0 || first.invalid.pixels() > 0;
        let mut finding = if few && stack.variances.is_none() && !is_black {
            self.by_blocks(check, stack, &first)
        } else {
            let parts = (1..check.statistics.len()).map(|k| {
                let statistic = &check.statistics[k];
                let mut sample = sample_of(k);
                if statistic.measure == Measure::Pixels {
                    // A mean of about zero shows no contributions by its spread; the image has them.
                    sample.fewest_contributions = first.fewest_contributions;
                }
                Part {
                    place: statistic.place.clone(),
                    weight: statistic.weight,
                    sample,
                    truth: statistic.truth,
                    measure: statistic.measure,
                }
            });
            let case = Case {
                sample: first,
                truth: check.statistics[0].truth,
                weight: check.statistics[0].weight,
                most: self.most,
                fewest: FEWEST_IMAGES,
                dependence: None,
                too_bright: None,
                parts: parts.collect(),
            };
            decide_at(&case, self.margin, self.levels, self.share, spent)
        };
        if finding.state == State::Undecided && !few {
            self.ask_for_more(check, &first, &mut finding);
        }
        let gone = finding.effect.is_some_and(|e| 1.0 + e < GONE) && finding.place.is_none();
        let is_one_class = check.classes.len() == 1;
        let looks_like = (finding.state == State::Different && gone && is_one_class)
            .then(|| missing(&check.class));
        if check.is_separated && finding.state == State::Undecided {
            // The image itself is judged; this is what else it could have told.
            finding.state = State::NotComparable;
            finding.replicates_needed = None;
            finding.reason = format!(
                "the image does not tell this class from the others within {} %: {}",
                100.0 * self.margin,
                finding.reason
            );
        }
        Judged {
            finding,
            mean: first.mean,
            looks_like,
        }
    }

    /// How many images would decide.
    fn ask_for_more(&self, check: &Check, sample: &Sample, finding: &mut Finding) {
        let statistic = &check.statistics[0];
        let levels = Levels {
            different: self.levels.different * statistic.weight,
            ..self.levels
        };
        let decides = |replicates: usize| {
            let larger = Sample {
                replicates,
                ..*sample
            };
            power::of_sample(&larger, statistic.truth, self.margin, levels).power
                >= power::PLANNED_DIFFERENCE
        };
        let mut count = sample.replicates.max(FEWEST_IMAGES) + 1;
        while count < MOST_IMAGES && !decides(count) {
            count += count.div_ceil(4);
        }
        let has_variance = sample.variance > 0.0 && sample.replicates >= FEWEST_IMAGES;
        finding.replicates_needed = (has_variance && decides(count)).then_some(count as u64);
        if let Some(n) = finding.replicates_needed {
            finding.reason = format!(
                "{}; about {n} images would decide, or more samples in each",
                finding.reason
            );
        }
    }

    /// Of an image or two, without variances.
    fn by_blocks(&self, check: &Check, stack: &Stack, sample: &Sample) -> Finding {
        const MORE: &str =
            "one image does not tell its own noise: give 8 or more with different seeds";
        let truth = check.statistics[0].truth;
        let mut finding = Finding::bare(State::Undecided, MORE);
        finding.effect = Some(sample.mean / truth.value - 1.0).filter(|e| e.is_finite());
        if !self.truth.has_pixels(&check.classes) || check.is_separated {
            return finding;
        }
        let [mut pixels, _] = self.truth.pixels(&check.classes);
        // Where nothing is looked at the images are black.
        pixels
            .iter_mut()
            .zip(self.covered)
            .for_each(|(v, c)| *v = if *c { *v } else { 0.0 });
        let Some(found) = blocks::factor(&stack.mean(), &pixels, stack.width) else {
            return finding;
        };
        let p = found.p;
        let off = (found.factor - 1.0).abs();
        if p <= self.levels.different * self.share && off > self.margin {
            finding.state = State::Different;
            finding.bias_established = true;
            finding.p_different = Some(p);
            finding.reason = "beyond any noise that the image itself shows".to_owned();
        }
        finding
    }
}
