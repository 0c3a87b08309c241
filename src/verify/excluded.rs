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

/// The part of an image in which a verdict is found, and the pixels that are left out of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// What is left.
    pub regions: Regions,
    /// All that was asked for: an image, or a mask of it.
    pub all: Regions,
    /// Number of pixels that are left out.
    pub pixels: u64,
}

impl Kept {
    /// What folds leave of an image, or of its pixels that are `selected`; `None` if they leave nothing.
    pub fn of(entry: &Entry, selected: Option<&[bool]>) -> Option<Self> {
        let (width, height) = (entry.camera.width, entry.camera.height);
        let crossed = crossed_by_folds(entry);
        let is_asked = |k: usize| selected.is_none_or(|s| s[k]);
        let asked: Vec<bool> = (0..crossed.len()).map(is_asked).collect();
        let kept: Vec<bool> = asked.iter().zip(&crossed).map(|(a, c)| a & !c).collect();
        let count = |which: &[bool]| which.iter().filter(|w| **w).count() as u64;
        let pixels = count(&asked) - count(&kept);
        let all = match selected {
            Some(_) => Regions::mask(width, height, &asked)?,
            None => Regions::image(width, height),
        };
        Some(Kept {
            regions: Regions::mask(width, height, &kept)?,
            all,
            pixels,
        })
    }

    /// How much is left out, of classes that should be so bright in what is left and in all of it.
    pub fn excluded(&self, kept: &[Option<Expected>], all: &[Option<Expected>]) -> Excluded {
        let energy = |classes: &[Option<Expected>], regions: &Regions| -> f64 {
            let means = classes.iter().flatten().map(|e| e.first().value);
            means.sum::<f64>() * regions.pixels()[0] as f64
        };
        let (inside, total) = (energy(kept, &self.regions), energy(all, &self.all));
        let energy = if total > 0.0 {
            1.0 - inside / total
        } else {
            0.0
        };
        Excluded {
            pixels: self.pixels,
            energy,
        }
    }
}
