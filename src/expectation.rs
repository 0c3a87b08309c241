//! Expected class means of a whole image at finite bandwidth: what a regularized integrator is judged against.
//!
//! A mean over a whole image is a smooth function of the bandwidth b, and so is b² times a second moment (it grows like
//! b⁻²). So the average over a long schedule needs a few bandwidths only: the function is interpolated in b² at Chebyshev
//! nodes between the smallest and the largest, and the interpolant is averaged over the schedule itself. The last
//! Chebyshev coefficient bounds what the interpolation leaves out.

use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Bounded, Kernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter, Kind};
use rayon::prelude::*;

/// The image is integrated in this many strips of rows (fewer if it has fewer rows), whatever the number of threads.
const STRIPS: u32 = 16;

/// Whether there are expectations at finite bandwidth for a kind. What regularizes is not judged on the others.
pub fn is_known(kind: &Kind) -> bool {
    matches!(kind, Kind::Diffuse(_) | Kind::PlanarMirror(_))
}

/// Mean over the whole image of the radiance [W m⁻² sr⁻¹] of each regularized class, and the second moment of one sample
/// of it (one camera sample uniform on the film, one sample of the estimator), averaged over the bandwidths: angles [rad],
/// or radii [m] for `Merge` and `Linked`.
///
/// `tolerance` is relative to the class's mean; what was reached is in the bounds. The same bits for any number of
/// threads. `diffuse` has no regularized class: an empty list.
///
/// # Errors
/// A kind other than `diffuse` and `planar-mirror`, an entry that does not validate, a kernel that does not fit the
/// technique, a bandwidth out of range.
pub fn class_means(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: f64,
) -> Result<Vec<(PathClass, Moments)>, InvalidParameter> {
    nephroid_analytic::bandwidth::check(technique, kernel, bandwidths)?;
    let fold = |f: fn(f64, f64) -> f64| bandwidths.iter().copied().reduce(f);
    let (low, high) = (
        fold(f64::min).unwrap_or_default(),
        fold(f64::max).unwrap_or_default(),
    );
    // More nodes for a wider range; below this length the averaged kernel itself is cheaper.
    let nodes = if high > 4.0 * low { 9 } else { 5 };
    if bandwidths.len() <= nodes || !(high > low * (1.0 + 1e-9)) {
        return averaged_kernel(entry, technique, kernel, bandwidths, tolerance);
    }
    let rule = Interpolation::new(nodes, low, high);
    let runs = rule
        .bandwidths
        .iter()
        .map(|&b| averaged_kernel(entry, technique, kernel, &[b], tolerance))
        .collect::<Result<Vec<_>, _>>()?;
    let class_count = runs.first().map_or(0, Vec::len);
    Ok((0..class_count)
        .map(|c| {
            let means: Vec<Bounded> = runs.iter().map(|r| r[c].1.mean).collect();
            let seconds: Vec<Bounded> = runs
                .iter()
                .zip(&rule.bandwidths)
                .map(|(r, b)| Bounded {
                    value: b * b * r[c].1.second_moment.value,
                    error: b * b * r[c].1.second_moment.error,
                })
                .collect();
            let moments = Moments {
                mean: rule.average(&means, |_| 1.0, bandwidths),
                second_moment: rule.average(&seconds, |b| 1.0 / (b * b), bandwidths),
            };
            (runs[0][c].0, moments)
        })
        .collect())
}

/// Polynomial interpolation in b² at Chebyshev nodes.
pub(crate) struct Interpolation {
    /// The nodes.
    pub(crate) bandwidths: Vec<f64>,
    low: f64,
    high: f64,
}

impl Interpolation {
    pub(crate) fn new(count: usize, low: f64, high: f64) -> Self {
        let (low, high) = (low * low, high * high);
        let bandwidths = (0..count)
            .map(|k| {
                let x = libm::cos(core::f64::consts::PI * (k as f64 + 0.5) / count as f64);
                (0.5 * (low + high) + 0.5 * (high - low) * x).sqrt()
            })
            .collect();
        Interpolation {
            bandwidths,
            low,
            high,
        }
    }

    /// Average of `scale(b)` times the interpolant over a schedule.
    pub(crate) fn average(
        &self,
        values: &[Bounded],
        scale: impl Fn(f64) -> f64,
        schedule: &[f64],
    ) -> Bounded {
        let m = values.len();
        let angle = |k: usize| core::f64::consts::PI * (k as f64 + 0.5) / m as f64;
        // Averages of scale(b) T_j over the schedule, and of scale(b).
        let mut averages = vec![0.0; m];
        for &b in schedule {
            let x = (2.0 * b * b - self.low - self.high) / (self.high - self.low);
            let theta = libm::acos(x.clamp(-1.0, 1.0));
            for (j, a) in averages.iter_mut().enumerate() {
                *a += scale(b) * libm::cos(j as f64 * theta) / schedule.len() as f64;
            }
        }
        let weight = |k: usize| -> f64 {
            let term = |j: usize| {
                let half = if j == 0 { 0.5 } else { 1.0 };
                half * averages[j] * libm::cos(j as f64 * angle(k))
            };
            (0..m).map(term).sum::<f64>() * 2.0 / m as f64
        };
        let mut result = Bounded::default();
        let mut last = 0.0;
        for (k, v) in values.iter().enumerate() {
            let w = weight(k);
            result.value += w * v.value;
            result.error += w.abs() * v.error;
            last += 2.0 / m as f64 * v.value * libm::cos((m - 1) as f64 * angle(k));
        }
        result.error += f64::abs(last) * averages[0];
        result
    }
}

/// One run with the averaged kernel.
fn averaged_kernel(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: f64,
) -> Result<Vec<(PathClass, Moments)>, InvalidParameter> {
    let film = FilmExpectation::new(entry, technique, kernel, bandwidths)?;
    let classes = film.classes();
    let (width, height) = film.size();
    let count = STRIPS.min(height);
    let rows = |k: u32| height * k / count..height * (k + 1) / count;

    // A first estimate tells how bright the classes are and where the error is.
    let unlimited = vec![[f64::INFINITY; 2]; classes.len()];
    let first: Vec<Vec<Moments>> = (0..count)
        .into_par_iter()
        .map(|k| film.strip(rows(k), &unlimited, 1e-3))
        .collect();
    let of = |m: &Moments| [m.mean, m.second_moment];
    let total = |c: usize, k: usize| -> [f64; 2] {
        first.iter().fold([0.0; 2], |sum, strip| {
            let b = of(&strip[c])[k];
            [sum[0] + b.value.abs(), sum[1] + b.error]
        })
    };
    let totals: Vec<[[f64; 2]; 2]> = (0..classes.len())
        .map(|c| [total(c, 0), total(c, 1)])
        .collect();

    // Half of the allowed error is shared equally, half goes where it is hard to get.
    let strips: Vec<Vec<Moments>> = (0..count)
        .into_par_iter()
        .map(|k| {
            let targets: Vec<[f64; 2]> = (0..classes.len())
                .map(|c| {
                    core::array::from_fn(|m| {
                        let [value, error] = totals[c][m];
                        let here = of(&first[k as usize][c])[m].error;
                        let share = if error > 0.0 { here / error } else { 0.0 };
                        tolerance * value * 0.5 * (1.0 / f64::from(count) + share)
                    })
                })
                .collect();
            film.strip(rows(k), &targets, tolerance)
        })
        .collect();

    let pixels = f64::from(width) * f64::from(height);
    Ok(classes
        .iter()
        .enumerate()
        .map(|(c, &class)| {
            let mut sum = Moments::default();
            for strip in &strips {
                sum.mean.value += strip[c].mean.value / pixels;
                sum.mean.error += strip[c].mean.error / pixels;
                sum.second_moment.value += strip[c].second_moment.value / pixels;
                sum.second_moment.error += strip[c].second_moment.error / pixels;
            }
            (class, sum)
        })
        .collect())
}
