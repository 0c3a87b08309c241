//! Diagnosis: what a residual that has been established looks like.
//!
//! Runs only after a "different", on replicates of its own, and decides nothing: a hint for the person who has to find the
//! mistake, with the numbers it is taken from. Where the truth is known pixel by pixel the residual image is compared with
//! [`patterns`]; where only the mean
//! of a class is known, at finite bandwidth, its ratio to the truth is compared with that at half the bandwidth.

pub mod constants;
pub mod covariates;
pub mod images;
pub mod patterns;
mod suite;
mod trend;

use nephroid_analytic::scene::Entry;

use crate::integrators::{Prepared, Technique, Treatment};
use crate::truth::TruthImage;
use crate::verify::replicates::{Canvas, Seeds, Shape};
use constants::{candidates, names};
use images::{Images, sample};
use patterns::{Fit, Pattern, Residual, is_one};
pub use suite::{annotate, means_at_half};

/// Phases of the streams, apart from those of pilots and of the test.
const PHASE: u32 = 1001;
const PHASE_MORE: u32 = 1002;
/// Replicates of the image, and of each variation of it.
const REPLICATES: u32 = 128;
const VARIED: u32 = 48;
/// By how much more paths a replicate has when it is asked whether their number matters.
const MORE: u64 = 4;
/// Standard errors beyond which two means are not the same.
const SURE: f64 = 5.0;

/// What is to be diagnosed: one class of one method on one scene.
pub struct Subject<'a> {
    /// The scene.
    pub entry: &'a Entry,
    /// The method on it.
    pub prepared: &'a dyn Prepared,
    /// The film's layer.
    pub layer: usize,
    /// What a replicate consists of.
    pub shape: &'a Shape,
    /// Where its seeds come from.
    pub seeds: Seeds,
    /// What is known of what should be.
    pub truth: Known<'a>,
}

/// What is known of what a class should be.
#[derive(Clone, Copy)]
pub enum Known<'a> {
    /// Every pixel.
    Pixels(&'a [f64]),
    /// The mean over the image [W m⁻² sr⁻¹], at the bandwidths and at half of each, of what this technique regularizes.
    Means(Technique, [f64; 2]),
}

impl<'a> Known<'a> {
    /// What is known of a class: of an image if it is sampled exactly, of means if it is regularized.
    pub fn of(
        treatment: Treatment,
        image: Option<&'a TruthImage>,
        layer: usize,
        means: Option<[f64; 2]>,
    ) -> Option<Self> {
        match treatment {
            Treatment::Exact(_) => Some(Known::Pixels(image?.layers.get(layer)?)),
            Treatment::Regularized(technique) => means.map(|m| Known::Means(technique, m)),
            Treatment::NotSampled => None,
        }
    }
}

/// What it looks like, in one sentence.
pub fn of(subject: &Subject) -> Option<String> {
    let images = subject.drawn(subject.shape, PHASE, REPLICATES);
    if let Some((p, v)) = images.impossible {
        let (column, row) = (p % subject.width(), p / subject.width());
        let what = if v.is_nan() {
            "an operation without a result (0/0, or a root of a negative number)"
        } else if v < 0.0 {
            "a negative contribution"
        } else {
            "a division by zero"
        };
        return Some(format!("looks like {what}, at column {column}, row {row}"));
    }
    let truth = match subject.truth {
        Known::Pixels(pixels) => pixels.iter().sum::<f64>() / pixels.len() as f64,
        Known::Means(_, [mean, _]) => mean,
    };
    if images.contributions == 0 {
        return (truth > 0.0).then(|| "looks like a class of paths that is missing".to_owned());
    }
    let [mean, error] = images.image_mean();
    if !(truth > 0.0) {
        return Some(format!(
            "looks like light through, or from, a surface that should absorb it: the truth has none, the mean is {mean:.3e}"
        ));
    }
    if let Some(text) = subject.depends_on_paths([mean, error]) {
        return Some(text);
    }
    match subject.truth {
        Known::Pixels(pixels) => subject.pattern(&images, pixels, [mean, error], truth),
        Known::Means(_, means) => subject.trend([mean, error], means),
    }
}

/// A factor with its standard error.
pub(crate) fn shown([factor, error]: [f64; 2]) -> String {
    // Two digits of the error.
    let digits = if error > 0.0 {
        1 - libm::floor(libm::log10(error)) as i32
    } else {
        4
    };
    let digits = digits.clamp(1, 6) as usize;
    format!("{factor:.digits$} ± {error:.digits$}")
}

impl Subject<'_> {
    fn width(&self) -> usize {
        self.entry.camera.width as usize
    }

    fn drawn(&self, shape: &Shape, phase: u32, replicates: u32) -> Images {
        let canvas = Canvas {
            width: self.entry.camera.width,
            height: self.entry.camera.height,
            classes: self.entry.kind.classes(),
        };
        let layers = [self.layer];
        sample(
            self.prepared,
            canvas,
            &layers,
            shape,
            self.seeds,
            phase,
            replicates,
        )
    }

    fn depends_on_paths(&self, [mean, error]: [f64; 2]) -> Option<String> {
        let shape = Shape {
            paths_per_iteration: MORE * self.shape.paths_per_iteration,
            ..self.shape.clone()
        };
        let [other, other_error] = self.drawn(&shape, PHASE_MORE, VARIED / 6).image_mean();
        let ratio = other / mean;
        let spread = libm::hypot(error, other_error) / mean;
        let differs = (ratio - 1.0).abs() > f64::max(2.0 * SURE * spread, 0.02);
        differs.then(|| {
            format!(
                "looks like a division by the wrong number of paths: {MORE} times the paths change the mean by a factor of {}",
                shown([ratio, ratio * spread])
            )
        })
    }

    /// From a residual image.
    fn pattern(
        &self,
        images: &Images,
        truth: &[f64],
        [mean, error]: [f64; 2],
        should_be: f64,
    ) -> Option<String> {
        let factor = [mean / should_be, error / should_be];
        let variance: Vec<f64> = images
            .variance
            .iter()
            .map(|v| v / images.replicates())
            .collect();
        let residual = Residual::new(self.width(), &images.mean, truth, &variance);
        let class = self.entry.kind.classes()[self.layer];
        let covariates = covariates::of(self.entry, class);
        let mut list = candidates(self.entry, None);
        let paths = self.shape.paths() as f64 * images.replicates();
        list.push(constants::Named {
            name: "paths per path that arrives".to_owned(),
            value: paths / images.arrived as f64,
        });
        let weight = covariates
            .iter()
            .find(|c| c.name == covariates::WEIGHT && c.varies());
        if let Some(mean) = weight
            .map(|w| w.mean(truth))
            .filter(|m| *m > 0.0 && *m < 1.0)
        {
            list.extend(constants::of_weight(mean));
        }
        let is_named = |[factor, error]: [f64; 2]| !names(&list, factor, error).is_empty();
        let fit = residual.and_then(|r| r.best(&covariates, is_named));
        let Some(fit) = fit else {
            let is_off = (factor[0] - 1.0).abs() > SURE * factor[1];
            let named = shown_names(&names(&list, factor[0], factor[1]));
            return is_off.then(|| match named.as_str() {
                "" => format!(
                    "looks like nothing on file: the mean is {} times what it should be, and no pattern fits",
                    shown(factor)
                ),
                _ => format!("looks like a factor of the mean {}{named}", shown(factor)),
            });
        };
        Some(sentence(&fit, factor, &list))
    }
}

/// A pattern in words: `factor` is that of the mean with its standard error, `list` has the names of factors.
pub(crate) fn sentence(fit: &Fit, factor: [f64; 2], list: &[constants::Named]) -> String {
    let part = 100.0 * fit.explained.min(1.0);
    match fit.pattern {
        Pattern::Constant => {
            let nearly = if fit.explained < 0.995 { "nearly " } else { "" };
            let name = shown_names(&names(list, factor[0], factor[1]));
            format!(
                "looks like a {nearly}constant factor {}{name}",
                shown(factor)
            )
        }
        Pattern::Power(name, power, [a, e]) => {
            let raised = match power {
                1 => format!("proportional to {name}"),
                -1 => format!("proportional to 1/({name})"),
                p => format!("proportional to ({name})^{p}"),
            };
            let beside = if is_one([a, e]) {
                String::new()
            } else {
                format!(
                    ", times {}{}",
                    shown([a, e]),
                    shown_names(&names(list, a, e))
                )
            };
            let what = match (name, power) {
                ("the cosine at the receiver", 1) => "a cosine applied twice: a factor ",
                ("the cosine at the receiver", -1) => "a cosine forgotten: a factor ",
                _ => "a factor ",
            };
            format!("looks like {what}{raised}{beside} ({part:.1} % of the residual)")
        }
        Pattern::Shift(dx, dy) => {
            let columns = (dx != 0.0).then(|| format!("{} columns to the right", -0.0 + dx));
            let rows = (dy != 0.0).then(|| format!("{} rows down", -0.0 + dy));
            let by = columns
                .into_iter()
                .chain(rows)
                .collect::<Vec<_>>()
                .join(" and ");
            format!("looks like an image moved by {by} ({part:.1} % of the residual)")
        }
        Pattern::Flip(across, down) => {
            let how = match (across, down) {
                (true, true) => "turned by 180°",
                (true, false) => "mirrored left and right",
                _ => "upside down",
            };
            format!("looks like an image {how} ({part:.1} % of the residual)")
        }
        Pattern::Frame(factor) => format!(
            "looks like contributions lost or doubled at the edge of the frame: {part:.0} % of the residual is in its \
                 outermost pixels, factor {factor:.2} there"
        ),
        Pattern::Dark => format!(
            "looks like light through a surface that should stop it: {part:.0} % of the residual is where the truth has no light"
        ),
        Pattern::Bright(factor) => {
            let what = if factor < 1.0 {
                "clamped contributions, or light lost near folds"
            } else {
                "too much light near folds, or where the density of samples is highest"
            };
            format!(
                "looks like {what}: {part:.0} % of the residual is in the brightest tenth, factor {factor:.2} there"
            )
        }
        Pattern::Edges => format!(
            "looks like a mistake at edges: {part:.0} % of the residual is where the picture changes abruptly"
        ),
    }
}

/// ` = π or 2`, or nothing.
pub(crate) fn shown_names(names: &[String]) -> String {
    if names.is_empty() {
        String::new()
    } else {
        format!(" = {}", names.join(" or "))
    }
}
