//! Expected means over the areas of an image, all at once: see [`nephroid_analytic::bandwidth::scatter`].

use nephroid_analytic::bandwidth::frame::FrameExpectation;
use nephroid_analytic::bandwidth::scatter::SETS;
use nephroid_analytic::bandwidth::{Bounded, Moments};
use rayon::prelude::*;

/// Points of each set in the first round, and in all where areas are asked for; every round has as many as all before it.
const FIRST: u32 = 1 << 14;
const MOST: u32 = 1 << 19;
/// Points of each set, in all, where every pixel is asked for.
const MOST_FOR_PIXELS: u32 = 1 << 20;
/// Parts of a round, so that threads have something to share.
const PARTS: u32 = 4;
/// Standard errors of a mean over the sets (seven degrees of freedom) that an error bound allows: beyond are 0.2 %.
const DEVIATIONS: f64 = 4.5;

/// Mean and second moment of each pixel, summed over the points.
type Image = Vec<[f64; 2]>;

/// The mean of a class over each area, of which the first is to be known to a tolerance of first and second moments, relative.
///
/// **Accuracy**: as stated in the error bounds, which are estimates.
pub fn areas(
    frame: &FrameExpectation,
    class: usize,
    areas: &[Vec<bool>],
    tolerance: [f64; 2],
) -> Vec<Moments> {
    let (sums, points) = sums(frame, class, MOST, |sums, points| {
        let first = areas
            .first()
            .map_or_else(Moments::default, |a| moments(sums, a, points));
        let known = |b: Bounded, tolerance: f64| {
            tolerance.is_infinite() || b.error <= tolerance * b.value.abs()
        };
        known(first.mean, tolerance[0]) && known(first.second_moment, tolerance[1])
    });
    areas
        .iter()
        .map(|area| moments(&sums, area, points))
        .collect()
}

/// The mean of a class over each pixel, row by row, to a tolerance of the mean of all.
///
/// **Accuracy**: as stated in the error bounds, which are estimates.
pub fn pixels(frame: &FrameExpectation, class: usize, tolerance: f64) -> Vec<Bounded> {
    let all = |sums: &[Image], points: f64| -> Vec<Bounded> {
        let count = sums.first().map_or(0, Vec::len);
        (0..count)
            .map(|p| spread(sums.iter().map(|image| image[p][0] / points)))
            .collect()
    };
    let (sums, points) = sums(frame, class, MOST_FOR_PIXELS, |sums, points| {
        let total = |part: fn(&Bounded) -> f64| all(sums, points).iter().map(part).sum::<f64>();
        total(|b| b.error) <= tolerance * total(|b| b.value)
    });
    all(&sums, points)
}

/// Sums of all sets, and the points of each: rounds until it is enough, or there are `most`.
fn sums(
    frame: &FrameExpectation,
    class: usize,
    most: u32,
    enough: impl Fn(&[Image], f64) -> bool,
) -> (Vec<Image>, f64) {
    let pixels = frame.size().0 as usize * frame.size().1 as usize;
    let aim = frame.aim(class);
    let mut sums: Vec<Image> = vec![vec![[0.0; 2]; pixels]; SETS as usize];
    let (mut done, mut until) = (0, FIRST);
    loop {
        let size = (until - done) / PARTS;
        let parts: Vec<Image> = (0..SETS * PARTS)
            .into_par_iter()
            .map(|k| {
                let (set, start) = (k / PARTS, done + k % PARTS * size);
                let mut image = vec![[0.0; 2]; pixels];
                frame.scatter(class, &aim, set, start..start + size, &mut image);
                image
            })
            .collect();
        for (k, part) in parts.iter().enumerate() {
            for (sum, value) in sums[k / PARTS as usize].iter_mut().zip(part) {
                *sum = [sum[0] + value[0], sum[1] + value[1]];
            }
        }
        done = until;
        if done >= most || enough(&sums, f64::from(done)) {
            return (sums, f64::from(done));
        }
        until = 2 * done;
    }
}

/// The mean of the sets' values, and how far it may be off.
fn spread(values: impl Iterator<Item = f64>) -> Bounded {
    let values: Vec<f64> = values.collect();
    let count = values.len() as f64;
    let value = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|m| (m - value) * (m - value)).sum();
    Bounded {
        value,
        error: DEVIATIONS * f64::sqrt(squares / (count * (count - 1.0))),
    }
}

fn moments(sums: &[Image], area: &[bool], points: f64) -> Moments {
    let pixels = area.iter().filter(|a| **a).count() as f64;
    let mean = |k: usize, image: &Image| {
        let inside = image.iter().zip(area).filter(|(_, a)| **a);
        inside.map(|(v, _)| v[k]).sum::<f64>() / (pixels * points)
    };
    let of = |k: usize| spread(sums.iter().map(|image| mean(k, image)));
    Moments {
        mean: of(0),
        second_moment: of(1),
    }
}
