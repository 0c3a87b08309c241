//! What a wrong image looks like: calibration (a unit, a place, an orientation, a field of view, an encoding) first, then classes
//! that are missing, then the patterns of [`crate::diagnosis`].
//!
//! Nothing of this is applied: it decides no verdict. A person reads the fitted value and says `--gain` or `--offset`.

use super::hypotheses::{Cause, Hypothesis, all, conventions};
use super::stack::Stack;
use super::truths::{Truth, is_offset};
use crate::diagnosis::constants::{candidates, names};
use crate::diagnosis::patterns::{Residual, is_one};
use crate::diagnosis::{covariates, sentence, shown, shown_names};

/// The part of a residual that a cause must explain.
const EXPLAINED: f64 = 0.9;
/// The same for a magnification, which is known in steps only.
const EXPLAINED_BY_ZOOM: f64 = 0.6;
/// Standard errors beyond which a factor is not 1.
const SURE: f64 = 5.0;
/// Factors that are units, not mistakes: they are worth a `--gain`.
const UNITS: [&str; 8] = ["π", "1/π", "4π", "1/(4π)", "2π", "1/(2π)", "2", "1/2"];

/// What is known of an image that is different.
pub struct Subject<'a> {
    /// What it should be.
    pub truth: &'a Truth,
    /// Of these classes.
    pub classes: &'a [usize],
    /// What it is.
    pub stack: &'a Stack,
    /// Where it is looked at.
    pub covered: &'a [bool],
}

/// A cause that fits, and the factor beside it with its standard error, if there is one.
struct Fit {
    cause: Cause,
    factor: Option<[f64; 2]>,
    misfit: f64,
}

/// What it looks like, in one sentence; `None` if there is nothing but noise.
pub fn of(subject: &Subject) -> Option<String> {
    let Subject {
        truth,
        classes,
        stack,
        covered,
    } = subject;
    let width = truth.image.width as usize;
    let mut expected = truth.pixels(classes)[0].clone();
    expected
        .iter_mut()
        .zip(*covered)
        .for_each(|(v, c)| *v = if *c { *v } else { 0.0 });
    let measured = stack.mean();
    let variance = stack.variance_of_mean(&expected);
    let factor = ratio(&measured, &expected, &variance);
    let Some(residual) = Residual::new(width, &measured, &expected, &variance) else {
        // Too noisy for a pattern; the sum may still be off.
        let is_off = (factor[0] - 1.0).abs() > SURE * factor[1];
        return is_off.then(|| subject.factor(factor));
    };
    let brightest = stack.images.iter().flatten().copied().fold(0.0, f64::max);
    let list = all(truth, classes, covered, brightest);
    let best = best(&residual, &list, &variance);
    let explained = residual.explained(best.misfit);
    let least = match best.cause {
        Cause::Zoomed(_) => EXPLAINED_BY_ZOOM,
        _ => EXPLAINED,
    };
    if explained >= least {
        return Some(format!(
            "{} ({:.1} % of the residual)",
            subject.sentence(&best),
            100.0 * explained.min(1.0)
        ));
    }
    let constants = candidates(truth.entry(), None);
    if let [only] = classes {
        let covariates = covariates::of(truth.entry(), truth.classes()[*only]);
        let is_named = |[factor, error]: [f64; 2]| !names(&constants, factor, error).is_empty();
        if let Some(fit) = residual.best(&covariates, is_named) {
            return Some(sentence(&fit, factor, &constants));
        }
    }
    let ratio = measured.iter().sum::<f64>() / expected.iter().sum::<f64>();
    Some(format!(
        "looks like nothing on file: the mean is {ratio:.4} times what it should be, and no pattern fits"
    ))
}

/// The cause that fits best; what is less simple must fit better by what noise does not give.
fn best(residual: &Residual, list: &[Hypothesis], variance: &[f64]) -> Fit {
    let gain = residual.least_gain();
    let mut best: Option<Fit> = None;
    let mut consider = |fit: Fit, must_gain: f64| {
        if best
            .as_ref()
            .is_none_or(|b| fit.misfit < b.misfit - must_gain)
        {
            best = Some(fit);
        }
    };
    // The factor alone first, then the causes as they are, then with a factor beside them.
    for with_factor in [false, true] {
        for h in list {
            let is_plain = h.cause == Cause::Factor;
            let factor = if is_plain || with_factor {
                Some(ratio(residual.measured, &h.picture, variance))
            } else {
                None
            };
            let scale = factor.map_or(1.0, |f| f[0]);
            if !scale.is_finite() || (with_factor && (is_plain || factor.is_some_and(is_one))) {
                continue;
            }
            // Of a pixel that came from beyond the frame nothing is said.
            let unknown = h.picture.iter().filter(|p| p.is_nan()).count() as f64;
            let predicted = |i: usize| match scale * h.picture[i] {
                v if v.is_nan() => residual.measured[i],
                v => v,
            };
            let misfit = residual.of(predicted) + unknown * residual.noise_of_pixel();
            consider(
                Fit {
                    cause: h.cause.clone(),
                    factor,
                    misfit,
                },
                gain,
            );
        }
    }
    best.unwrap_or(Fit {
        cause: Cause::Factor,
        factor: None,
        misfit: f64::INFINITY,
    })
}

/// The ratio of two images' sums with its standard error: other than least squares it does not depend on how noise and
/// weights go together.
fn ratio(measured: &[f64], picture: &[f64], variance: &[f64]) -> [f64; 2] {
    let (mut seen, mut total, mut spread) = (0.0, 0.0, 0.0);
    for ((m, p), v) in measured.iter().zip(picture).zip(variance) {
        if !p.is_nan() {
            (seen, total, spread) = (seen + m, total + p, spread + v);
        }
    }
    [seen / total, libm::sqrt(spread) / total]
}

impl Subject<'_> {
    fn sentence(&self, fit: &Fit) -> String {
        let beside = |f: [f64; 2]| format!("{}{}", shown(f), shown_names(&self.names(f)));
        let what = match &fit.cause {
            Cause::Factor => return self.factor(fit.factor.unwrap_or([1.0, 0.0])),
            Cause::Missing(absent) => {
                let names: Vec<String> = absent
                    .iter()
                    .map(|&c| self.truth.classes()[c].to_string())
                    .collect();
                let options: Vec<String> = names.iter().map(|n| format!("--cannot {n}")).collect();
                format!(
                    "class missing: {}: this integrator may be unable to sample it; declare it with `{}`",
                    names.join(" and "),
                    options.join(" ")
                )
            }
            Cause::Turned(how) => format!("looks like an image {}", turned(*how)),
            Cause::Moved(by) => {
                let total = [0, 1].map(|k| by[k] + self.truth.offset()[k]);
                let advice = if total.iter().all(|&o| is_offset(o)) {
                    format!(
                        "; if that is the renderer's convention, judge with `--offset {},{}`",
                        total[0], total[1]
                    )
                } else {
                    String::new()
                };
                format!(
                    "looks like an image moved by {} pixels to the right and {} down{advice}",
                    -0.0 + by[0],
                    -0.0 + by[1]
                )
            }
            Cause::Zoomed(zoom) => self.zoomed(*zoom),
            Cause::Encoded(name) => {
                format!("looks like values encoded for a display, not linear radiance: {name}")
            }
            Cause::Clamped(at) => format!("looks like values clamped at {at}"),
        };
        match fit.factor {
            Some(f) => format!("{what}; times a constant factor {}", beside(f)),
            None => what,
        }
    }

    /// Of a constant factor alone.
    fn factor(&self, factor: [f64; 2]) -> String {
        let names = self.names(factor);
        let advice = if names.iter().any(|n| UNITS.contains(&n.as_str())) {
            let exact = self.exact(&names, factor[0]);
            format!("; if that is the renderer's unit, judge with `--gain {exact:.6}`")
        } else {
            String::new()
        };
        let (value, named) = (shown(factor), shown_names(&names));
        format!("looks like a constant factor {value}{named}{advice}")
    }

    fn names(&self, [factor, error]: [f64; 2]) -> Vec<String> {
        names(&candidates(self.truth.entry(), None), factor, error)
    }

    /// The value of the first unit among some names, or what was measured.
    fn exact(&self, names: &[String], measured: f64) -> f64 {
        let list = candidates(self.truth.entry(), None);
        let unit = names.iter().find(|n| UNITS.contains(&n.as_str()));
        let named = unit.and_then(|n| list.iter().find(|c| c.name == *n));
        named.map_or(measured, |c| c.value)
    }

    fn zoomed(&self, zoom: f64) -> String {
        let degrees = self.truth.entry().camera.field_of_view_degrees;
        let seen = 2.0 * libm::atan(libm::tan(0.5 * degrees.to_radians()) / zoom).to_degrees();
        let near = |(z, _): &(f64, &str)| (zoom / z - 1.0).abs() < 0.01;
        let name = match conventions(self.truth).into_iter().find(near) {
            Some((_, name)) => format!(": {name}"),
            None => String::new(),
        };
        format!(
            "looks like another field of view, of about {seen:.1} degrees vertically in place of {degrees}{name}"
        )
    }
}

fn turned([across, down, diagonal]: [bool; 3]) -> &'static str {
    match (across, down, diagonal) {
        (true, false, false) => "mirrored left and right",
        (false, true, false) => "upside down: rows written from the bottom",
        (true, true, false) => "turned by 180 degrees",
        (false, false, _) => "with rows and columns exchanged",
        (true, true, _) => "with rows and columns exchanged, and turned by 180 degrees",
        _ => "turned by 90 degrees",
    }
}
