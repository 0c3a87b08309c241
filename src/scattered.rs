//! Expected means over the areas of an image, all at once: see [`nephroid_analytic::bandwidth::scatter`].

use nephroid_analytic::bandwidth::frame::FrameExpectation;
use nephroid_analytic::bandwidth::scatter::SETS;
use nephroid_analytic::bandwidth::{Bounded, Moments};
use rayon::prelude::*;

/// Points of each set in the first round, and in all; every round has as many as all before it.
const FIRST: u32 = 1 << 14;
const MOST: u32 = 1 << 19;
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
        let of = |area: &Vec<bool>| moments(&sums, area, f64::from(done));
        let first = areas.first().map_or_else(Moments::default, of);
        let known = |b: Bounded, tolerance: f64| {
            tolerance.is_infinite() || b.error <= tolerance * b.value.abs()
        };
        let enough = known(first.mean, tolerance[0]) && known(first.second_moment, tolerance[1]);
        if enough || done >= MOST {
            return areas.iter().map(of).collect();
        }
        until = 2 * done;
    }
}

fn moments(sums: &[Image], area: &[bool], points: f64) -> Moments {
    let pixels = area.iter().filter(|a| **a).count() as f64;
    let mean = |k: usize, image: &Image| {
        let inside = image.iter().zip(area).filter(|(_, a)| **a);
        inside.map(|(v, _)| v[k]).sum::<f64>() / (pixels * points)
    };
    let bounded = |k: usize| {
        let means: Vec<f64> = sums.iter().map(|image| mean(k, image)).collect();
        let count = means.len() as f64;
        let value = means.iter().sum::<f64>() / count;
        let squares: f64 = means.iter().map(|m| (m - value) * (m - value)).sum();
        Bounded {
            value,
            error: DEVIATIONS * f64::sqrt(squares / (count * (count - 1.0))),
        }
    };
    Moments {
        mean: bounded(0),
        second_moment: bounded(1),
    }
}
