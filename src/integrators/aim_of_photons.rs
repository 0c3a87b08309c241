//! Photons limited to those that can land where the camera looks, within the radius of merging.
//!
//! Photons are equally likely over everything that reaches the mirror; of a close-up of the floor only those few contribute
//! that land next to it. Limiting the pairs of random numbers of the emission to a part of the unit square that contains all of
//! these multiplies every photon's flux by the part's area: means stay, second moments are multiplied by the area.

use core::f64::consts::SQRT_2;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::probes::aim::{Chart, Part, search};
use crate::geometry::emission::Emitter;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::geometry::specular::Specular;

/// The search begins with a kernel this much wider than what is asked for.
const WIDEST: f64 = 16.0;
/// Film points that are looked through along each side.
const SIDE: u32 = 32;

/// A part of the emission, and how dense its photons lie.
pub(super) struct Aimed {
    /// Where the pairs of random numbers are.
    pub(super) part: Part,
    /// Photons that reach the floor per photon traced and square metre of their bounding box.
    pub(super) density: f64,
}

/// The parts for all radii that have been asked for. A part is made for the next power of √2, so that a schedule needs few.
#[derive(Default)]
pub(super) struct Aims {
    by_step: Mutex<BTreeMap<i32, Arc<Aimed>>>,
}

impl Aims {
    /// The part for a radius > 0 m; `make` makes it for a radius that is up to √2 times as large.
    pub(super) fn of(&self, radius: f64, make: impl FnOnce(f64) -> Aimed) -> Arc<Aimed> {
        let step = libm::ceil(2.0 * libm::log2(radius));
        let mut aims = self.by_step.lock().unwrap_or_else(PoisonError::into_inner);
        let made = aims.entry(step as i32).or_insert_with(|| {
            let rounded = libm::exp2(0.5 * step);
            // A step that rounding has made too short.
            let radius = if rounded >= radius {
                rounded
            } else {
                radius * SQRT_2
            };
            Arc::new(make(radius))
        });
        Arc::clone(made)
    }
}

/// The emission's part from which photons can land, through the specular surface, within `radius` of a floor point that the
/// camera sees.
pub(super) fn part_of<L: Light, S: Specular>(
    scene: &Scene<L, S>,
    emitter: &L::Emitter,
    radius: f64,
) -> Part {
    let Some([low, high]) = seen(scene) else {
        return Part::default();
    };
    let hits = |width: f64| -> Box<dyn Fn(f64, f64) -> bool + '_> {
        Box::new(move |u, v| {
            let (origin, direction) = emitter.ray(u, v);
            let landing = scene.landing(origin, direction);
            // The distance to the box of what is seen.
            let beyond = |x: f64, low: f64, high: f64| f64::max(f64::max(low - x, x - high), 0.0);
            let (dx, dy) = (
                beyond(landing.x, low[0], high[0]),
                beyond(landing.y, low[1], high[1]),
            );
            landing.via && landing.weight > 0.0 && dx * dx + dy * dy < width * width
        })
    };
    let chart = if L::IS_DISTANT {
        Chart::Plane
    } else {
        Chart::Sphere
    };
    search(chart, radius, WIDEST * radius, hits)
}

/// The box of the floor points that the camera sees, directly or by the specular surface; `None` if there are none.
fn seen<L: Light, S: Specular>(scene: &Scene<L, S>) -> Option<[[f64; 2]; 2]> {
    let (columns, rows) = scene.camera.size();
    let at = |k: u32, size: f64| f64::from(k) / f64::from(SIDE) * size;
    let look = |i: u32, j: u32| {
        let direction: DVec3 = scene.camera.direction(at(i, columns), at(j, rows));
        let landing = scene.landing(scene.camera.position, direction);
        (landing.weight > 0.0).then_some([landing.x, landing.y])
    };
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    // Between neighbours the floor is seen as far beyond the outermost as they are apart.
    let mut step = [0.0_f64; 2];
    for j in 0..=SIDE {
        for i in 0..=SIDE {
            let Some(p) = look(i, j) else { continue };
            for k in 0..2 {
                low[k] = f64::min(low[k], p[k]);
                high[k] = f64::max(high[k], p[k]);
            }
            let neighbours = [(i + 1, j), (i, j + 1)].map(|(a, b)| look(a.min(SIDE), b.min(SIDE)));
            for q in neighbours.into_iter().flatten() {
                for k in 0..2 {
                    step[k] = f64::max(step[k], f64::abs(p[k] - q[k]));
                }
            }
        }
    }
    let grown = |k: usize| [low[k] - step[k], high[k] + step[k]];
    let ([x0, x1], [y0, y1]) = (grown(0), grown(1));
    (low[0] <= high[0]).then_some([[x0, y0], [x1, y1]])
}
