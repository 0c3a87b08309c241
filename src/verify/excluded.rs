//! Pixels that a fold crosses, left out for estimators whose variance is infinite there.
//!
//! An unbiased estimator that reaches a fold's light point by point has contributions like δ^(-1/2) at distance δ from the
//! fold: tail index 2, no variance, no valid t test in a pixel that the fold crosses. Which pixels these are is known
//! exactly: those of which a point that is seen on the floor, directly or in a mirror, is as near to a fold as the pixel is wide. They are no part
//! of the verdict, and how many they are and how much of the light they hold is printed with it.

use nephroid_analytic::camera::Film;
use nephroid_analytic::entries::FloorTruth;
use nephroid_analytic::scene::Entry;
use rayon::prelude::*;

use super::expected::Expected;
use crate::integrators::Sight;
use crate::regions::Regions;

/// What was left out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excluded {
    /// Number of pixels.
    pub pixels: u64,
    /// Their part of the light of the judged classes.
    pub energy: f64,
}

/// Per pixel, row by row from the top, whether a fold (or cusp, or focus) of any class that ends on the floor crosses what the
/// pixel sees of the floor, directly or through the specular surface: whether it is nearer to the point seen at the centre
/// than the point seen at the farthest corner is. A pixel that sees no floor is not crossed. One that sees the floor in
/// both ways, or in part, is crossed if the fold is as near to any of its points as another one is.
pub fn crossed_by_folds(entry: &Entry) -> Vec<bool> {
    let (width, height) = (entry.camera.width, entry.camera.height);
    let (Some(truth), Some(sight)) = (FloorTruth::new(entry), Sight::new(entry)) else {
        return vec![false; width as usize * height as usize];
    };
    let is_near = |[x, y]: [f64; 2], reach: f64| {
        (0..truth.at(x, y).len())
            .filter_map(|class| truth.singularity(x, y, class))
            .any(|s| s.distance <= reach)
    };
    let is_crossed = |k: u32| {
        let (i, j) = (f64::from(k % width), f64::from(k / width));
        let seen = PLACES.map(|(a, b)| sight.floor_point(i + a, j + b));
        let farthest = |[x, y]: [f64; 2]| {
            let others = seen.iter().flatten();
            others.fold(0.0, |far, ([p, q], _)| {
                f64::max(far, libm::hypot(p - x, q - y))
            })
        };
        let is_whole =
            |(_, via): ([f64; 2], bool)| seen.iter().all(|s| s.is_some_and(|s| s.1 == via));
        match seen[0] {
            Some(centre) if is_whole(centre) => is_near(centre.0, farthest(centre.0)),
            _ => {
                // Where the floor ends, or a surface begins, what is missing is about as far as the rest, or unknown.
                let points: Vec<_> = seen.iter().flatten().map(|s| s.0).collect();
                let reach = points.iter().map(|&p| farthest(p)).fold(0.0, f64::max);
                let pixel = sight_of_pixel(entry, i, j);
                points.iter().any(|&p| is_near(p, reach.max(pixel)))
            }
        }
    };
    (0..width * height)
        .into_par_iter()
        .map(is_crossed)
        .collect()
}

/// The centre of a pixel and its corners.
const PLACES: [(f64, f64); 5] = [(0.5, 0.5), (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];

/// How far the corners of a pixel are from its centre on the plane of the floor, whatever is in the way; infinite above the
/// horizon.
fn sight_of_pixel(entry: &Entry, i: f64, j: f64) -> f64 {
    let film = Film::new(&entry.camera);
    let floor = |(a, b): (f64, f64)| {
        let d = film.direction(i + a, j + b);
        let t = -film.position.z / d.z;
        let point = (film.position.x + d.x * t, film.position.y + d.y * t);
        (t > 0.0 && t.is_finite()).then_some(point)
    };
    let points = PLACES.map(floor);
    let Some((x, y)) = points[0] else {
        return f64::INFINITY;
    };
    points.into_iter().fold(0.0, |far, p| {
        f64::max(
            far,
            p.map_or(f64::INFINITY, |(p, q)| libm::hypot(p - x, q - y)),
        )
    })
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
        // Without a fold in it, the image is what is left: there contributions are counted.
        let regions = if pixels == 0 {
            all.clone()
        } else {
            Regions::mask(width, height, &kept)?
        };
        Some(Kept {
            regions,
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
