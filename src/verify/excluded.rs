//! Pixels that a fold crosses, left out for estimators whose variance is infinite there.
//!
//! An unbiased estimator that reaches a fold's light point by point has contributions like δ^(-1/2) at distance δ from the
//! fold: tail index 2, no variance, no valid t test in a pixel that the fold crosses. Which pixels these are is known
//! exactly: those of which a point that is seen on the floor is as near to a fold as the pixel is wide. They are no part
//! of the verdict, and how many they are and how much of the light they hold is printed with it.

use nephroid_analytic::camera::Film;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;
use rayon::prelude::*;

use super::expected::Expected;
use crate::regions::Regions;

/// What was left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excluded {
    /// Number of pixels.
    pub pixels: u64,
    /// Their part of the light of the judged classes.
    pub energy: f64,
}

/// Per pixel, row by row from the top, whether the nearest fold (or cusp, or focus) of any class that ends on the floor is
/// nearer to its centre than its farthest corner is, on the floor. A pixel that sees no floor is not crossed.
pub fn crossed_by_folds(entry: &Entry) -> Vec<bool> {
    let (width, height) = (entry.camera.width, entry.camera.height);
    let Some(truth) = FloorTruth::new(entry) else {
        return vec![false; width as usize * height as usize];
    };
    let film = Film::new(&entry.camera);
    let floor = |u: f64, v: f64| {
        let d = film.direction(u, v);
        let t = -film.position.z / d.z;
        let point = (film.position.x + d.x * t, film.position.y + d.y * t);
        (t > 0.0 && t.is_finite()).then_some(point)
    };
    let is_crossed = |k: u32| {
        let (i, j) = (f64::from(k % width), f64::from(k / width));
        let Some((x, y)) = floor(i + 0.5, j + 0.5) else {
            return false;
        };
        if !truth.is_on_floor(x, y) {
            return false;
        }
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let reach = corners
            .into_iter()
            // A corner above the horizon is infinitely far.
            .map(|(a, b)| {
                floor(i + a, j + b).map_or(f64::INFINITY, |(p, q)| libm::hypot(p - x, q - y))
            })
            .fold(0.0, f64::max);
        (0..truth.at(x, y).len())
            .filter_map(|class| truth.singularity(x, y, class))
            .any(|s| s.distance <= reach)
    };
    (0..width * height)
        .into_par_iter()
        .map(is_crossed)
        .collect()
}

/// The regions that are left, and what is not among them; `None` if all of the image is crossed.
pub fn regions(entry: &Entry) -> Option<(Regions, u64)> {
    let crossed = crossed_by_folds(entry);
    let kept: Vec<bool> = crossed.iter().map(|c| !c).collect();
    let pixels = crossed.iter().filter(|c| **c).count() as u64;
    let regions = Regions::mask(entry.camera.width, entry.camera.height, &kept)?;
    Some((regions, pixels))
}

/// Narrows what is expected to the first area of the regions, and tells how much is left out. Classes known over the whole
/// image only can no longer be judged.
pub fn narrow(
    expected: Vec<Option<Expected>>,
    regions: &Regions,
    pixels: u64,
) -> (Vec<Option<Expected>>, Excluded) {
    let kept = regions.pixels()[0];
    let all = kept + pixels;
    let (mut inside, mut total) = (0.0, 0.0);
    let narrowed = expected
        .into_iter()
        .map(|e| {
            let e = e?;
            let area = *e.areas.first()?;
            inside += area.value * kept as f64;
            total += e.image.value * all as f64;
            Some(Expected::of_image(area))
        })
        .collect();
    let energy = if total > 0.0 {
        1.0 - inside / total
    } else {
        0.0
    };
    (narrowed, Excluded { pixels, energy })
}
