//! What a region should be: at bandwidth zero, and mean and second moment of one path's contribution at each bandwidth.

use nephroid_analytic::bandwidth::film::FilmExpectation;
use nephroid_analytic::bandwidth::{Bounded, Kernel, Moments, Technique};
use nephroid_analytic::class::PathClass;
use nephroid_analytic::pixel::PixelTruth;
use nephroid_analytic::scene::InvalidParameter;
use rayon::prelude::*;

use super::region::View;
use crate::expectation::{Interpolation, is_planar};
use crate::frames;
use crate::integrators::Prepared;

/// Relative tolerance of means: a hundredth of a bias of 1e-4.
const TOLERANCE: f64 = 1e-6;
/// Tolerance that a region with edges reaches in seconds.
const TOLERANCE_WITH_EDGES: f64 = 2e-5;
/// Tolerances of mean and second moment where edges are curved, or the light is.
const TOLERANCE_CURVED: [f64; 2] = [1e-4, 1e-2];
/// Longer schedules are interpolated between so many bandwidths.
const NODES: usize = 12;

/// What one path contributes to a region at one bandwidth.
#[derive(Clone, Copy, Debug, Default)]
pub struct Expected {
    /// Mean of the region's radiance [W m⁻² sr⁻¹].
    pub mean: Bounded,
    /// Second moment of one path's contribution to it.
    pub second_moment: Bounded,
    /// Probability of a contribution that is not zero, where it is known.
    pub hit: Option<f64>,
    /// By how much, relative to it, the probability that a photon is seen from anywhere in the region may exceed it.
    pub excess: f64,
}

impl Expected {
    /// Variance of one path's contribution.
    pub fn variance(&self) -> f64 {
        self.second_moment.value - self.mean.value * self.mean.value
    }

    /// Contributions that are not zero out of one path, or fewer: exact for samples that are all alike.
    pub fn effective_hit(&self) -> f64 {
        self.mean.value * self.mean.value / self.second_moment.value
    }
}

/// The region's radiance at bandwidth zero.
///
/// # Errors
/// What [`PixelTruth::new`] finds.
pub fn sharp(view: &View, class: PathClass) -> Result<Option<Bounded>, InvalidParameter> {
    let truth = PixelTruth::new(&view.entry)?;
    let Some(layer) = truth.classes().iter().position(|&c| c == class) else {
        return Ok(None);
    };
    let rows: Vec<Vec<Bounded>> = view
        .rows
        .clone()
        .into_par_iter()
        .map(|j| truth.row(j, 1e-9).swap_remove(layer))
        .collect();
    let columns = view.columns.start as usize..view.columns.end as usize;
    let mut sum = Bounded::default();
    for b in rows.iter().flat_map(|r| &r[columns.clone()]) {
        sum.value += b.value / view.area();
        sum.error += b.error / view.area();
    }
    Ok(Some(sum))
}

/// What is expected at each bandwidth.
///
/// # Errors
/// What [`FilmExpectation::new`] finds.
pub fn expected(
    view: &View,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> Result<Vec<Expected>, InvalidParameter> {
    let mut all = at_points(view, class, technique, kernel, bandwidths)?;
    if technique != Technique::Merge || !view.is_close_up {
        return Ok(all);
    }
    let film = FilmExpectation::new(&view.entry, technique, kernel, &bandwidths[..1])?;
    let points = floor_points(&film, class, view);
    for (e, &r) in all.iter_mut().zip(bandwidths) {
        // A photon within r of some point of the region is within r + half its diameter of the middle.
        let grown = 1.0 + 0.5 * diameter(&points) / r;
        e.excess = grown * grown - 1.0;
        let shared = overlap(&points, kernel, r);
        e.second_moment.value *= shared;
        e.second_moment.error *= shared;
    }
    Ok(all)
}

/// The same for photons that are drawn from a part of the emission only.
pub fn aimed(mut all: Vec<Expected>, prepared: &dyn Prepared, bandwidths: &[f64]) -> Vec<Expected> {
    for (e, &b) in all.iter_mut().zip(bandwidths) {
        let share = prepared.share_of_emission(b);
        if share > 0.0 {
            e.second_moment.value *= share;
            e.second_moment.error *= share;
            e.hit = e.hit.map(|p| p / share);
        }
    }
    all
}

/// The same as if each camera path had photons of its own.
fn at_points(
    view: &View,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> Result<Vec<Expected>, InvalidParameter> {
    let mut distinct = bandwidths.to_vec();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    let one = |&b: &f64| at(view, class, technique, kernel, b);
    let (Some(&low), Some(&high)) = (distinct.first(), distinct.last()) else {
        return Ok(Vec::new());
    };
    if distinct.len() <= NODES {
        let of = distinct
            .par_iter()
            .map(one)
            .collect::<Result<Vec<_>, _>>()?;
        let position = |b: &f64| distinct.iter().position(|d| d == b).unwrap_or(0);
        return Ok(bandwidths.iter().map(|b| of[position(b)]).collect());
    }
    // The mean, and what the second moment and the hits are relative to b⁻² and b², are smooth functions of b².
    nephroid_analytic::bandwidth::check(technique, kernel, &distinct)?;
    let rule = Interpolation::new(NODES, low, high);
    let nodes = rule
        .bandwidths
        .par_iter()
        .map(one)
        .collect::<Result<Vec<_>, _>>()?;
    let scaled = |v: Bounded, by: f64| Bounded {
        value: v.value * by,
        error: v.error * by,
    };
    let nodes = || nodes.iter().zip(&rule.bandwidths);
    let means: Vec<Bounded> = nodes().map(|(e, _)| e.mean).collect();
    let seconds: Vec<Bounded> = nodes()
        .map(|(e, b)| scaled(e.second_moment, b * b))
        .collect();
    let hits: Option<Vec<Bounded>> = nodes()
        .map(|(e, b)| {
            e.hit.map(|p| Bounded {
                value: p / (b * b),
                error: 0.0,
            })
        })
        .collect();
    let interpolated = |&b: &f64| Expected {
        mean: rule.average(&means, |_| 1.0, &[b]),
        second_moment: rule.average(&seconds, |b| 1.0 / (b * b), &[b]),
        hit: hits
            .as_ref()
            .map(|h| rule.average(h, |b| b * b, &[b]).value),
        excess: 0.0,
    };
    Ok(bandwidths.iter().map(interpolated).collect())
}

fn at(
    view: &View,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    bandwidth: f64,
) -> Result<Expected, InvalidParameter> {
    if !is_planar(&view.entry.kind) {
        return on_tiles(view, class, technique, kernel, bandwidth);
    }
    let film = FilmExpectation::new(&view.entry, technique, kernel, &[bandwidth])?;
    let Some(layer) = film.classes().iter().position(|&c| c == class) else {
        return Ok(Expected::default());
    };
    let tolerance = if view.is_close_up {
        TOLERANCE
    } else {
        TOLERANCE_WITH_EDGES
    };
    let moments = region(&film, view, layer, tolerance);
    let per = |b: Bounded, by: f64| Bounded {
        value: by * b.value,
        error: by * b.error,
    };
    Ok(Expected {
        mean: per(moments.mean, 1.0 / view.area()),
        second_moment: per(moments.second_moment, view.dilution() / view.area()),
        hit: hit(&film, class, view),
        excess: 0.0,
    })
}

/// The same where edges in the picture are curved.
fn on_tiles(
    view: &View,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    bandwidth: f64,
) -> Result<Expected, InvalidParameter> {
    let frame = frames::prepared(&view.entry, technique, kernel, &[bandwidth])?;
    let Some(layer) = frame.classes().iter().position(|&c| c == class) else {
        return Ok(Expected::default());
    };
    let (columns, rows) = (view.columns.clone(), view.rows.clone());
    let moments = frames::region(&frame, layer, columns, rows, TOLERANCE_CURVED);
    let per = |b: Bounded, by: f64| Bounded {
        value: by * b.value,
        error: by * b.error,
    };
    Ok(Expected {
        mean: per(moments.mean, 1.0 / view.area()),
        second_moment: per(moments.second_moment, view.dilution() / view.area()),
        hit: None,
        excess: 0.0,
    })
}

/// Moments summed over the region's pixels, to a relative tolerance.
fn region(film: &FilmExpectation, view: &View, layer: usize, tolerance: f64) -> Moments {
    // Strips are integrated in parallel; a close-up is one piece.
    let strips = if view.is_close_up {
        1
    } else {
        16.min(view.rows.len() as u32)
    };
    let rows = |k: u32| {
        let (start, count) = (view.rows.start, view.rows.len() as u32);
        start + count * k / strips..start + count * (k + 1) / strips
    };
    let integrate = |targets: &[f64; 2], tolerance: f64| -> Vec<Moments> {
        let all = vec![*targets; film.classes().len()];
        let strip = |k: u32| film.region(view.columns.clone(), rows(k), &all, tolerance)[layer];
        (0..strips).into_par_iter().map(strip).collect()
    };
    let total = |parts: &[Moments]| {
        let mut sum = Moments::default();
        for m in parts {
            sum.mean.value += m.mean.value;
            sum.mean.error += m.mean.error;
            sum.second_moment.value += m.second_moment.value;
            sum.second_moment.error += m.second_moment.error;
        }
        sum
    };
    let first = total(&integrate(&[f64::INFINITY; 2], 1e-3));
    let share = 1.0 / f64::from(strips);
    let targets = [
        tolerance * first.mean.value.abs() * share,
        // A variance to 1e-4 is plenty.
        tolerance.max(1e-4) * first.second_moment.value.abs() * share,
    ];
    total(&integrate(&targets, tolerance))
}

/// Gauss points and weights on [0, 1].
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// The mean over a close-up of the probability of a hit.
fn hit(film: &FilmExpectation, class: PathClass, view: &View) -> Option<f64> {
    if !view.is_close_up {
        return None;
    }
    let (width, height) = (view.columns.end, view.rows.end);
    let mut sum = 0.0;
    for (s, ws) in GAUSS {
        for (t, wt) in GAUSS {
            let point = film.at(class, s * f64::from(width), t * f64::from(height), 1e-6)?;
            sum += ws * wt * point.hit_probability?.value;
        }
    }
    Some(sum)
}

/// Floor points that a close-up sees, spread over its film, corners included.
fn floor_points(film: &FilmExpectation, class: PathClass, view: &View) -> Vec<[f64; 3]> {
    const SIDE: u32 = 4;
    let at = |k: u32, n: u32| f64::from(k) / f64::from(SIDE) * f64::from(n);
    (0..=SIDE)
        .flat_map(|j| (0..=SIDE).map(move |i| [i, j]))
        .filter_map(|[i, j]| {
            let point = film.at(class, at(i, view.columns.end), at(j, view.rows.end), 1e-1);
            point.map(|p| p.floor)
        })
        .collect()
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let d = |k: usize| (a[k] - b[k]) * (a[k] - b[k]);
    (d(0) + d(1) + d(2)).sqrt()
}

fn diameter(points: &[[f64; 3]]) -> f64 {
    let all = points
        .iter()
        .flat_map(|a| points.iter().map(move |b| distance(a, b)));
    all.fold(0.0, f64::max)
}

/// All camera paths of a photon map share its photons: the variance of the map's mean is that of the mean of k over the region's
/// floor points, and ∫ k(X − x) k(X − x') dX over pairs of these is this part of ∫ k². For a disc and two points at distance d it
/// is (2/π)(acos t − t √(1 − t²)), t = d/2r; for a kernel that is continuous it is 1 but for (d/r)², which is nothing here.
fn overlap(points: &[[f64; 3]], kernel: Kernel, r: f64) -> f64 {
    if kernel != Kernel::Disc {
        return 1.0;
    }
    let (mut sum, mut pairs) = (0.0, 0.0);
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            let t = (0.5 * distance(a, b) / r).min(1.0);
            sum += core::f64::consts::FRAC_2_PI * (libm::acos(t) - t * (1.0 - t * t).sqrt());
            pairs += 1.0;
        }
    }
    if pairs > 0.0 { sum / pairs } else { 1.0 }
}
