//! Expected class means of a whole image at finite bandwidth: what a regularized integrator is judged against.

use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Kernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter};
use rayon::prelude::*;

/// The image is integrated in this many strips of rows (fewer if it has fewer rows), whatever the number of threads.
const STRIPS: u32 = 16;

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
