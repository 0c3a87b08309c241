//! Expected class means of an image and of its areas at finite bandwidth: what a regularized integrator is judged against.
//!
//! A mean over an area is a smooth function of the bandwidth b, and so is b² times a second moment (it grows like
//! b⁻²). So the average over a long schedule needs a few bandwidths only: the function is interpolated in b² at Chebyshev
//! nodes between the smallest and the largest, and the interpolant is averaged over the schedule itself. The last
//! Chebyshev coefficient bounds what the interpolation leaves out.

use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Bounded, Kernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, InvalidParameter, Kind};
use rayon::prelude::*;

use crate::frames;
use crate::mosaic::{Mosaic, Rectangle};
use crate::regions::Regions;
use crate::truth::TruthImage;

/// The error of one rectangle is an estimate, which has been seen to be three times too small (`tests/expectations/films.rs`). Those of
/// several are added up, not in quadrature, which makes up for it as their number grows: the factor on the estimate for so many.
fn allowance(rectangles: usize) -> f64 {
    (4.0 / libm::sqrt(rectangles as f64)).max(1.0)
}

/// Why there are no expectations of a technique on an entry, if there are none. What regularizes is not judged there.
pub fn unknown(entry: &Entry, technique: Technique) -> Option<String> {
    if is_planar(&entry.kind) {
        return None;
    }
    let kernel = technique.default_kernel();
    let error = frames::prepared(entry, technique, kernel, &[0.1]).err()?;
    Some(format!(
        "no exact expectation at finite bandwidth for the kind {}: {} is {}, allowed: {}",
        entry.kind.name(),
        error.key,
        error.found,
        error.allowed
    ))
}

/// Whether every edge in the picture is a straight line, along which it can be cut.
pub fn is_planar(kind: &Kind) -> bool {
    matches!(kind, Kind::Diffuse(_) | Kind::PlanarMirror(_))
}

/// The exact image at finite bandwidth: regular classes as they are, the others as the estimator has them on average; an angle [rad], or
/// a radius [m] for `Merge` and `Linked`. Errors of the latter are estimates, of about a percent of a pixel.
///
/// # Errors
/// As [`class_means`].
pub fn image(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidth: f64,
    tolerance: f64,
) -> Result<TruthImage, InvalidParameter> {
    frames::image(entry, technique, kernel, bandwidth, tolerance)
}

/// Mean over the whole image of the radiance [W m⁻² sr⁻¹] of each regularized class, and the second moment of one sample
/// of it (one camera sample uniform on the film, one sample of the estimator), averaged over the bandwidths: angles [rad],
/// or radii [m] for `Merge` and `Linked`.
///
/// `tolerance` is relative to the class's mean; what was reached is in the bounds. The same bits for any number of
/// threads. `diffuse` has no regularized class: an empty list.
///
/// # Errors
/// A kind without a floor, or of which the technique knows nothing; an entry that does not validate, a kernel that does not
/// fit the technique, a bandwidth out of range.
pub fn class_means(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: f64,
) -> Result<Vec<(PathClass, Moments)>, InvalidParameter> {
    let image = Regions::image(entry.camera.width, entry.camera.height);
    let all = [tolerance; 2];
    let classes = area_moments(entry, technique, kernel, bandwidths, all, &image)?;
    Ok(classes
        .into_iter()
        .map(|(c, areas)| (c, areas[0]))
        .collect())
}

/// The same for each area of the regions, which are those of the entry's image. `tolerance` is that of the first moments and that of
/// the second ones (infinite if they are not asked for), relative to the sum over all areas: those of faint ones are known
/// as well as light of that amount needs.
///
/// # Errors
/// As [`class_means`].
pub fn area_moments(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: [f64; 2],
    regions: &Regions,
) -> Result<Vec<(PathClass, Vec<Moments>)>, InvalidParameter> {
    nephroid_analytic::bandwidth::check(technique, kernel, bandwidths)?;
    let mosaic = regions.mosaic();
    let is_planar = is_planar(&entry.kind);
    let averaged = |b: &[f64]| {
        if is_planar {
            averaged_kernel(entry, technique, kernel, b, tolerance, &mosaic)
        } else {
            frames::area_moments(entry, technique, kernel, b, tolerance, regions)
        }
    };
    let fold = |f: fn(f64, f64) -> f64| bandwidths.iter().copied().reduce(f);
    let (low, high) = (
        fold(f64::min).unwrap_or_default(),
        fold(f64::max).unwrap_or_default(),
    );
    // More nodes for a wider range; below this length the averaged kernel itself is cheaper.
    let nodes = match (high > 4.0 * low, is_planar) {
        (true, _) => 9,
        (false, true) => 5,
        // A picture with curved edges costs ten times as much.
        (false, false) => 4,
    };
    if bandwidths.len() <= nodes || !(high > low * (1.0 + 1e-9)) {
        return averaged(bandwidths);
    }
    let rule = Interpolation::new(nodes, low, high);
    let runs = rule
        .bandwidths
        .iter()
        .map(|&b| averaged(&[b]))
        .collect::<Result<Vec<_>, _>>()?;
    let interpolated = |class: usize, area: usize| {
        let at = || runs.iter().map(|r| r[class].1[area]);
        let means: Vec<Bounded> = at().map(|m| m.mean).collect();
        let seconds: Vec<Bounded> = at()
            .zip(&rule.bandwidths)
            .map(|(m, b)| Bounded {
                value: b * b * m.second_moment.value,
                error: b * b * m.second_moment.error,
            })
            .collect();
        Moments {
            mean: rule.average(&means, |_| 1.0, bandwidths),
            second_moment: rule.average(&seconds, |b| 1.0 / (b * b), bandwidths),
        }
    };
    let classes = runs.first().map_or(&[][..], |r| r.as_slice());
    Ok(classes
        .iter()
        .enumerate()
        .map(|(c, (class, areas))| {
            let of_area = |a: usize| interpolated(c, a);
            (*class, (0..areas.len()).map(of_area).collect())
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

/// One run with the averaged kernel: the mean over each area.
fn averaged_kernel(
    entry: &Entry,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
    tolerance: [f64; 2],
    mosaic: &Mosaic,
) -> Result<Vec<(PathClass, Vec<Moments>)>, InvalidParameter> {
    let film = FilmExpectation::new(entry, technique, kernel, bandwidths)?;
    let classes = film.classes();
    let region = |r: &Rectangle, targets: &[[f64; 2]], tolerance: f64| {
        film.region(r.x..r.x + r.width, r.y..r.y + r.height, targets, tolerance)
    };

    // A first estimate tells how bright the classes are and where the error is.
    let unlimited = vec![[f64::INFINITY; 2]; classes.len()];
    let first: Vec<Vec<Moments>> = mosaic
        .rectangles
        .par_iter()
        .map(|r| region(r, &unlimited, 1e-3))
        .collect();
    let of = |m: &Moments| [m.mean, m.second_moment];
    let total = |c: usize, k: usize| -> [f64; 2] {
        first.iter().fold([0.0; 2], |sum, part| {
            let b = of(&part[c])[k];
            [sum[0] + b.value.abs(), sum[1] + b.error]
        })
    };
    let totals: Vec<[[f64; 2]; 2]> = (0..classes.len())
        .map(|c| [total(c, 0), total(c, 1)])
        .collect();
    let pixels: u64 = mosaic.rectangles.iter().map(Rectangle::pixels).sum();

    // What is asked for holds for the first area.
    let wanted = tolerance.map(|t| t / allowance(mosaic.areas[0].len()));
    // Half of the allowed error is shared equally by pixels, half goes where it is hard to get.
    let target = |part: usize, c: usize, k: usize| {
        if wanted[k].is_infinite() {
            return f64::INFINITY;
        }
        let [value, error] = totals[c][k];
        let here = of(&first[part][c])[k].error;
        let hard = if error > 0.0 { here / error } else { 0.0 };
        let equal = mosaic.rectangles[part].pixels() as f64 / pixels as f64;
        wanted[k] * value * 0.5 * (equal + hard)
    };
    let parts: Vec<Vec<Moments>> = (0..mosaic.rectangles.len())
        .into_par_iter()
        .map(|part| {
            let targets: Vec<[f64; 2]> = (0..classes.len())
                .map(|c| core::array::from_fn(|k| target(part, c, k)))
                .collect();
            let finest = wanted[0].min(wanted[1]);
            region(&mosaic.rectangles[part], &targets, finest)
        })
        .collect();

    let mean = |c: usize, area: &Vec<usize>| {
        let pixels: u64 = area.iter().map(|&k| mosaic.rectangles[k].pixels()).sum();
        let pixels = pixels as f64;
        let sure = allowance(area.len());
        let mut sum = Moments::default();
        for m in area.iter().map(|&k| &parts[k][c]) {
            sum.mean.value += m.mean.value / pixels;
            sum.mean.error += sure * m.mean.error / pixels;
            sum.second_moment.value += m.second_moment.value / pixels;
            sum.second_moment.error += sure * m.second_moment.error / pixels;
        }
        sum
    };
    Ok(classes
        .iter()
        .enumerate()
        .map(|(c, &class)| (class, mosaic.areas.iter().map(|a| mean(c, a)).collect()))
        .collect())
}
