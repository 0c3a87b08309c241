//! What is judged, and how: the checks that a set of layers allows.
//!
//! A layer of classes is judged by their sum. An image of all light is judged by the sum of the comparable classes, and each
//! class that has no layer of its own by its factor in the image (least squares): mostly that is decided by the pixels in
//! which the class dominates. If there is no image of all light, the sum of the layers takes its place. A class that should
//! be there and is not is missing.

use nephroid_analytic::camera::Bounded;
use nephroid_analytic::class::PathClass;

use super::fit::{factors, gradients, weights};
use super::images::Images;
use super::stack::{Functional, Stack};
use super::truths::Truth;
use crate::judge::finding::{Finding, State};
use crate::judge::verdict::Measure;
use crate::regions::{Area, Regions};
use crate::verify::verdicts::{ALL_CLASSES, MASK, WHOLE_IMAGE};

/// The word for the region of a class that is told from others by its picture.
pub const SEPARATED: &str = "separated";
/// An image that has moved by less than this is in its place [pixels].
pub const PLACE_TOLERANCE: f64 = 0.05;
/// A class dominates where it has at least this part of the light.
const DOMINATES: f64 = 0.9;
/// Fewest pixels of a region where a class dominates.
const FEWEST_PIXELS: usize = 64;

/// Shares of a check's error probability: image, tiles, places where a class dominates, columns and rows moved by.
const SHARES: Shares = Shares {
    image: 0.5,
    tiles: 0.2,
    dominated: 0.1,
    moved: 0.1,
};

struct Shares {
    image: f64,
    tiles: f64,
    dominated: f64,
    moved: f64,
}

/// Something that is measured in each image, and what it should be.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistic {
    /// Where, or in what respect.
    pub place: String,
    /// Its weight of the check's error probability.
    pub weight: f64,
    /// What it measures.
    pub measure: Measure,
    /// How.
    pub functional: Functional,
    /// What it should be.
    pub truth: Bounded,
}

/// A check: the first statistic decides about equivalence.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The class, classes with `+` between them, or `all`.
    pub class: String,
    /// The region of the first statistic.
    pub region: &'static str,
    /// The classes whose sum it is.
    pub classes: Vec<usize>,
    /// Whether it is the factor of one class in an image of several.
    pub is_separated: bool,
    /// Position of the images.
    pub images: usize,
    /// What is measured.
    pub statistics: Vec<Statistic>,
}

/// A verdict that needs no statistics.
#[derive(Clone, Debug, PartialEq)]
pub struct Known {
    /// The class.
    pub class: String,
    /// Its position, or that of the first of several.
    pub position: usize,
    /// The verdict.
    pub finding: Finding,
    /// What it looks like.
    pub looks_like: Option<String>,
}

/// What is judged.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The checks.
    pub checks: Vec<Check>,
    /// What is known already.
    pub known: Vec<Known>,
}

/// The diagnosis of a class that should be there and is not.
pub fn missing(class: &str) -> String {
    format!(
        "class missing: this integrator may be unable to sample it; declare it with `--cannot {class}`"
    )
}

/// What the classes are called.
fn label(classes: &[usize], of: &[PathClass]) -> String {
    let names: Vec<_> = classes.iter().map(|&c| of[c].to_string()).collect();
    names.join("+")
}

/// Classes up to the scene's closure, which an image of all light can hold; and those beyond.
pub fn comparable(truth: &Truth) -> (Vec<usize>, Vec<usize>) {
    let longest = truth.entry().kind.closure().longest;
    let fits = |&c: &usize| longest.is_none_or(|l| truth.classes()[c].edges() <= l);
    (0..truth.classes().len()).partition(fits)
}

/// Makes the plan. `cannot` are the classes that are declared impossible, `covered` the pixels that are looked at, which are
/// those of the regions.
pub fn plan(
    truth: &Truth,
    images: &mut Vec<Images>,
    cannot: &[usize],
    covered: &[bool],
    regions: &Regions,
) -> Plan {
    let builder = Builder {
        truth,
        covered,
        regions,
    };
    let mut plan = Plan::default();
    let mut has_layer = vec![false; truth.classes().len()];
    for (k, layer) in images.iter().enumerate() {
        let Some(classes) = layer.classes.clone() else {
            continue;
        };
        classes.iter().for_each(|&c| has_layer[c] = true);
        let claimed: Vec<usize> = classes
            .iter()
            .copied()
            .filter(|c| !cannot.contains(c))
            .collect();
        if claimed.is_empty() {
            plan.known.push(builder.declared(&classes, &layer.stack));
        } else {
            plan.checks
                .push(builder.layer(label(&claimed, truth.classes()), claimed, k));
        }
    }
    let without_layer = |c: &usize| !has_layer[*c];
    let beauty = images.iter().position(|i| i.classes.is_none());
    let (inside, beyond) = comparable(truth);
    match beauty {
        Some(k) => {
            let claimed: Vec<usize> = inside
                .iter()
                .copied()
                .filter(|c| !cannot.contains(c))
                .collect();
            builder.separated(&claimed, &has_layer, k, &mut plan);
            for &c in inside
                .iter()
                .filter(|c| cannot.contains(c))
                .filter(|c| without_layer(c))
            {
                plan.known.push(builder.cannot(c));
            }
            for &c in beyond.iter().filter(|c| without_layer(c)) {
                plan.known.push(builder.beyond(c));
            }
            if !claimed.is_empty() {
                plan.checks
                    .push(builder.layer(ALL_CLASSES.to_owned(), claimed, k));
            }
        }
        None => {
            for c in (0..truth.classes().len()).filter(without_layer) {
                plan.known.push(if cannot.contains(&c) {
                    builder.cannot(c)
                } else {
                    builder.absent(c)
                });
            }
            builder.sum(images, &mut plan);
        }
    }
    plan
}

struct Builder<'a> {
    truth: &'a Truth,
    covered: &'a [bool],
    regions: &'a Regions,
}

impl Builder<'_> {
    fn known(&self, class: usize, state: State, reason: String) -> Known {
        Known {
            class: self.truth.classes()[class].to_string(),
            position: class,
            finding: Finding::bare(state, reason),
            looks_like: None,
        }
    }

    fn cannot(&self, class: usize) -> Known {
        self.known(
            class,
            State::NotSampled,
            "declared with --cannot".to_owned(),
        )
    }

    fn beyond(&self, class: usize) -> Known {
        let closure = self.truth.entry().kind.closure();
        let longest = closure.longest.unwrap_or(0);
        let reason = format!(
            "{} edges: an image of all light is comparable up to {longest} edges only ({}); write this class as a layer of its own",
            self.truth.classes()[class].edges(),
            closure.reason
        );
        self.known(class, State::NotComparable, reason)
    }

    /// A class of which no file has a layer, in files of layers.
    fn absent(&self, class: usize) -> Known {
        let mut known = self.known(
            class,
            State::Different,
            "no layer of the files holds this class".to_owned(),
        );
        known.finding.effect = Some(-1.0);
        known.finding.bias_established = true;
        known.looks_like = Some(missing(&known.class));
        known
    }

    /// A layer of classes that are declared impossible must be black.
    fn declared(&self, classes: &[usize], stack: &Stack) -> Known {
        let lit: usize = stack
            .images
            .iter()
            .map(|i| i.iter().filter(|v| **v != 0.0).count())
            .sum();
        let finding = if lit > 0 {
            Finding::bare(
                State::Different,
                format!("declared impossible, yet {lit} pixels are not black"),
            )
        } else {
            Finding::bare(State::NotSampled, "declared with --cannot")
        };
        Known {
            class: label(classes, self.truth.classes()),
            position: classes.first().copied().unwrap_or(0),
            finding,
            looks_like: None,
        }
    }

    fn first_region(&self) -> &'static str {
        match self.regions.areas()[0] {
            Area::Mask(_) => MASK,
            _ => WHOLE_IMAGE,
        }
    }

    /// The check of a layer: its mean, its tiles, its place.
    fn layer(&self, class: String, classes: Vec<usize>, images: usize) -> Check {
        let areas = self.truth.areas(&classes, self.regions);
        let mut statistics: Vec<Statistic> =
            (self.regions.weights().iter().zip(&areas).enumerate())
                .map(|(k, (weight, &truth))| Statistic {
                    place: self.regions.areas()[k].to_string(),
                    weight: if k == 0 {
                        SHARES.image
                    } else {
                        2.0 * SHARES.tiles * weight
                    },
                    measure: Measure::Radiance,
                    functional: Functional::Area(k),
                    truth,
                })
                .collect();
        if self.truth.has_pixels(&classes) {
            statistics.extend(self.places(&classes));
            if classes.len() > 1 {
                statistics.extend(self.dominated(&classes));
            }
        }
        Check {
            class,
            region: self.first_region(),
            classes,
            is_separated: false,
            images,
            statistics,
        }
    }

    /// Zero where it is not looked at.
    fn covered(&self, mut image: Vec<f64>) -> Vec<f64> {
        image
            .iter_mut()
            .zip(self.covered)
            .for_each(|(v, c)| *v = if *c { *v } else { 0.0 });
        image
    }

    /// How far the image has moved, whatever the factors of its classes are: with T its truth, the factor of -∂T/∂x.
    fn places(&self, classes: &[usize]) -> Vec<Statistic> {
        let [all, errors] = self.truth.pixels(classes);
        let pictures: Vec<Vec<f64>> = classes
            .iter()
            .map(|&c| self.covered(self.truth.pixels(&[c])[0].clone()))
            .collect();
        let lit = || pictures.iter().filter(|p| p.iter().any(|v| *v > 0.0));
        let width = self.truth.image.width as usize;
        let slopes = gradients(&all, width, self.covered)
            .map(|g| g.iter().map(|v| -v).collect::<Vec<f64>>());
        let weights = weights(&all, self.covered);
        let columns: Vec<&[f64]> = lit()
            .map(Vec::as_slice)
            .chain(slopes.iter().map(Vec::as_slice))
            .collect();
        let first = columns.len() - 2;
        let Some(found) = factors(&columns, &weights) else {
            return Vec::new();
        };
        let place = |(name, functional): (&str, &Vec<f64>)| {
            let error: f64 = functional
                .iter()
                .zip(&errors)
                .map(|(w, e)| w.abs() * e)
                .sum();
            Statistic {
                place: name.to_owned(),
                weight: SHARES.moved,
                measure: Measure::Pixels,
                functional: Functional::Weighted(functional.clone()),
                truth: Bounded {
                    value: 0.0,
                    error: PLACE_TOLERANCE + error,
                },
            }
        };
        ["moved to the right", "moved down"]
            .into_iter()
            .zip(&found[first..])
            .map(place)
            .collect()
    }

    /// Where one class has nearly all of the light.
    fn dominated(&self, classes: &[usize]) -> Vec<Statistic> {
        let [all, _] = self.truth.pixels(classes);
        let regions_of = |&c: &usize| {
            let [own, errors] = self.truth.pixels(&[c]);
            let is_there: Vec<bool> = (0..all.len())
                .map(|i| self.covered[i] && own[i] > DOMINATES * all[i])
                .collect();
            let count = is_there.iter().filter(|t| **t).count();
            (count >= FEWEST_PIXELS).then_some((c, is_there, errors, count as f64))
        };
        let found: Vec<_> = classes.iter().filter_map(regions_of).collect();
        let share = SHARES.dominated / found.len().max(1) as f64;
        let statistic = |(c, is_there, _, count): &(usize, Vec<bool>, Vec<f64>, f64)| {
            let weights: Vec<f64> = is_there
                .iter()
                .map(|t| if *t { 1.0 / count } else { 0.0 })
                .collect();
            let [_, errors] = self.truth.pixels(classes);
            let sum = |values: &[f64]| weights.iter().zip(values).map(|(w, v)| w * v).sum();
            Statistic {
                place: format!("where {} dominates", self.truth.classes()[*c]),
                weight: share,
                measure: Measure::Radiance,
                truth: Bounded {
                    value: sum(&all),
                    error: sum(&errors),
                },
                functional: Functional::Weighted(weights),
            }
        };
        found.iter().map(statistic).collect()
    }

    /// The factor of each class in an image of several.
    fn separated(&self, claimed: &[usize], has_layer: &[bool], images: usize, plan: &mut Plan) {
        if !self.truth.has_pixels(claimed) {
            return;
        }
        let pictures: Vec<Vec<f64>> = claimed
            .iter()
            .map(|&c| self.covered(self.truth.pixels(&[c])[0].clone()))
            .collect();
        let is_lit = |k: usize| pictures[k].iter().any(|v| *v > 0.0);
        let lit: Vec<usize> = (0..claimed.len()).filter(|&k| is_lit(k)).collect();
        for &k in (0..claimed.len())
            .filter(|&k| !is_lit(k))
            .collect::<Vec<_>>()
            .iter()
        {
            if !has_layer[claimed[k]] {
                plan.known.push(self.known(
                    claimed[k],
                    State::NotComparable,
                    "this image shows no light of this class".to_owned(),
                ));
            }
        }
        // With one class alone the sum says it all.
        if lit.len() < 2 {
            return;
        }
        let [all, errors] = self.truth.pixels(claimed);
        let columns: Vec<&[f64]> = lit.iter().map(|&k| pictures[k].as_slice()).collect();
        let found = factors(&columns, &weights(&all, self.covered));
        for (position, &k) in lit.iter().enumerate() {
            let class = claimed[k];
            if has_layer[class] {
                continue;
            }
            let Some(found) = &found else {
                plan.known.push(self.known(
                    class,
                    State::NotComparable,
                    "its picture is too like that of other classes: write it as a layer of its own".to_owned(),
                ));
                continue;
            };
            let functional = found[position].clone();
            let error: f64 = functional
                .iter()
                .zip(&errors)
                .map(|(w, e)| w.abs() * e)
                .sum();
            plan.checks.push(Check {
                class: self.truth.classes()[class].to_string(),
                region: SEPARATED,
                classes: vec![class],
                is_separated: true,
                images,
                statistics: vec![Statistic {
                    place: SEPARATED.to_owned(),
                    weight: 1.0,
                    measure: Measure::Radiance,
                    functional: Functional::Weighted(functional),
                    truth: Bounded { value: 1.0, error },
                }],
            });
        }
    }

    /// The sum of layers that share no class, where there are several.
    fn sum(&self, images: &mut Vec<Images>, plan: &mut Plan) {
        let mut classes: Vec<usize> = plan.checks.iter().flat_map(|c| c.classes.clone()).collect();
        let count = classes.len();
        classes.sort_unstable();
        classes.dedup();
        if plan.checks.len() < 2 || classes.len() < count {
            return;
        }
        let parts: Vec<&Stack> = plan
            .checks
            .iter()
            .map(|c| &images[c.images].stack)
            .collect();
        let image = |r: usize| {
            let pixel = |i: usize| parts.iter().map(|s| s.images[r][i]).sum();
            (0..self.covered.len()).map(pixel).collect()
        };
        let stack = Stack {
            width: parts[0].width,
            images: (0..parts[0].images.len()).map(image).collect(),
            variances: None,
        };
        images.push(Images {
            name: ALL_CLASSES.to_owned(),
            classes: Some(classes.clone()),
            stack,
        });
        plan.checks
            .push(self.layer(ALL_CLASSES.to_owned(), classes, images.len() - 1));
    }
}
