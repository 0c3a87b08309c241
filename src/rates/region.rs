//! Where a rate is measured: pixels of the picture, or a close-up of an interior part of it.
//!
//! Near an edge of what a mirror lights, or of the mirror itself, the kernel loses what it would gather beyond, and the bias is of
//! lower order there. So the order of the bias is measured where the kernel is whole at every bandwidth, and where the
//! bias keeps its sign over the region and over the bandwidths: where it changes sign its leading coefficient is zero (for merging
//! by a plane mirror, on a circle about the foot of the light's image), and no single power describes it.
//!
//! Such a region is a small part of the picture. A close-up is the same pinhole, turned towards it, with a frame inside its
//! pixels: every path then counts.

use core::ops::Range;

use nephroid_analytic::bandwidth::film::{FilmExpectation, FilmPoint};
use nephroid_analytic::bandwidth::{Kernel, Technique};
use nephroid_analytic::camera::Film;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Camera, Entry, InvalidParameter};
use rayon::prelude::*;

/// What is measured.
#[derive(Clone, Debug)]
pub struct View {
    /// The scene, perhaps with the camera of a close-up.
    pub entry: Entry,
    /// Columns of its film.
    pub columns: Range<u32>,
    /// Rows.
    pub rows: Range<u32>,
    /// What it is, in a few words.
    pub name: String,
    /// Why it was taken.
    pub reason: String,
    /// Whether the film was made for this region: all of it counts, nothing in it is near an edge.
    pub is_close_up: bool,
}

impl View {
    /// The whole picture.
    pub fn whole(entry: &Entry, reason: &str) -> Self {
        let camera = &entry.camera;
        View {
            columns: 0..camera.width,
            rows: 0..camera.height,
            name: "image".to_owned(),
            reason: reason.to_owned(),
            is_close_up: false,
            entry: entry.clone(),
        }
    }

    /// Pixels x0 ≤ column < x1, y0 ≤ row < y1.
    ///
    /// # Errors
    /// What is allowed, if the rectangle is empty or not in the picture.
    pub fn pixels(entry: &Entry, [x0, y0, x1, y1]: [u32; 4]) -> Result<Self, String> {
        let camera = &entry.camera;
        let is_inside = x0 < x1 && x1 <= camera.width && y0 < y1 && y1 <= camera.height;
        if !is_inside {
            return Err(format!(
                "x0,y0,x1,y1 with 0 <= x0 < x1 <= {} and 0 <= y0 < y1 <= {} (pixels)",
                camera.width, camera.height
            ));
        }
        Ok(View {
            columns: x0..x1,
            rows: y0..y1,
            name: format!("pixels {x0},{y0},{x1},{y1}"),
            reason: "asked for".to_owned(),
            is_close_up: false,
            entry: entry.clone(),
        })
    }

    /// Pixels of the film per pixel of the region: a path's contribution to the region's mean is this times what it adds to a pixel's
    /// radiance, with the inverse probability.
    pub fn dilution(&self) -> f64 {
        let pixels = f64::from(self.entry.camera.width) * f64::from(self.entry.camera.height);
        pixels / self.area()
    }

    /// Pixels of the region.
    pub fn area(&self) -> f64 {
        self.columns.len() as f64 * self.rows.len() as f64
    }
}

/// Pixels of a close-up's film, across.
const CLOSE_UP_PIXELS: u32 = 8;
/// Steps of the grid of candidates and the sides of squares that are tried on it [pixels of the picture], the largest first.
const GRIDS: [(f64, &[f64]); 3] = [(2.0, &[8.0, 4.0]), (1.0, &[2.0, 1.0]), (0.5, &[0.5, 0.25])];
/// For merging a region must be small against the radius, for then a photon's second moment is that of a point.
const POINTS: [(f64, &[f64]); 2] = [(2.0, &[0.25]), (0.5, &[0.25])];
/// Tolerance of what is looked at to choose.
const TOLERANCE: f64 = 1e-6;
/// Places of a square that are looked at: corners, middles of edges, the centre.
const PLACES: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [-1.0, -1.0],
    [1.0, -1.0],
    [-1.0, 1.0],
    [1.0, 1.0],
    [0.0, -1.0],
    [0.0, 1.0],
    [-1.0, 0.0],
    [1.0, 0.0],
];

/// A square of the picture and how well the bias shows there: bias over standard deviation of one sample, at the largest bandwidth.
struct Candidate {
    center: [f64; 2],
    side: f64,
    signal: f64,
}

/// The square of the picture in which the class's bias shows best among those that are interior at all bandwidths, and over
/// which the bias keeps its sign. `None` if there is none.
///
/// # Errors
/// What [`FilmExpectation::new`] finds.
pub fn interior(
    entry: &Entry,
    class: PathClass,
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> Result<Option<View>, InvalidParameter> {
    let films = bandwidths
        .iter()
        .map(|&b| FilmExpectation::new(entry, technique, kernel, &[b]))
        .collect::<Result<Vec<_>, _>>()?;
    let largest = bandwidths.iter().copied().fold(0.0, f64::max);
    let Some(widest) = bandwidths.iter().position(|&b| b == largest) else {
        return Ok(None);
    };
    let (width, height) = films[widest].size();
    let grids: &[(f64, &[f64])] = if technique == Technique::Merge {
        &POINTS
    } else {
        &GRIDS
    };
    let inner = |film: &FilmExpectation, u: f64, v: f64| -> Option<FilmPoint> {
        film.at(class, u, v, TOLERANCE)
            .filter(|p| p.is_interior && p.sharp > 0.0)
    };
    for &(step, sides) in grids {
        let places = |pixels: u32| libm::ceil(f64::from(pixels) / step) as u32;
        // Centres at which the widest kernel is whole.
        let centers: Vec<[f64; 2]> = (0..places(height))
            .into_par_iter()
            .flat_map_iter(|j| {
                let film = &films[widest];
                (0..places(width)).filter_map(move |i| {
                    let [u, v] = [i, j].map(|k| (f64::from(k) + 0.5) * step);
                    inner(film, u, v).map(|_| [u, v])
                })
            })
            .collect();
        for &side in sides {
            let best = best_square(&films, widest, &centers, side, &inner);
            if let Some(best) = best {
                let view = close_up(entry, &best);
                return Ok(Some(if technique == Technique::Merge {
                    point_view(view, class, technique, kernel)
                } else {
                    view
                }));
            }
        }
    }
    Ok(None)
}

/// The square in which the bias shows best, among those about the centres.
fn best_square(
    films: &[FilmExpectation],
    widest: usize,
    centers: &[[f64; 2]],
    side: f64,
    inner: &(impl Fn(&FilmExpectation, f64, f64) -> Option<FilmPoint> + Sync),
) -> Option<Candidate> {
    let candidates: Vec<Candidate> = centers
        .par_iter()
        .filter_map(|&center| {
            let places = PLACES.map(|p| {
                let [u, v] = [0, 1].map(|k| center[k] + 0.5 * side * p[k]);
                [u, v]
            });
            let mut sign = 0.0;
            let mut signal = 0.0;
            // The widest first: it excludes most.
            let order = core::iter::once(widest).chain((0..films.len()).filter(|&k| k != widest));
            for k in order {
                for [u, v] in places {
                    let point = inner(&films[k], u, v)?;
                    let bias = point.moments.mean.value - point.sharp;
                    let deviation = f64::sqrt(point.moments.second_moment.value);
                    if sign == 0.0 {
                        sign = bias.signum();
                        signal = bias.abs() / deviation;
                    }
                    if bias * sign <= 0.0 {
                        return None;
                    }
                }
            }
            Some(Candidate {
                center,
                side,
                signal,
            })
        })
        .collect();
    candidates
        .into_iter()
        .reduce(|a, b| if b.signal > a.signal { b } else { a })
}

/// The close-up of a square.
fn close_up(entry: &Entry, square: &Candidate) -> View {
    let film = Film::new(&entry.camera);
    let [u, v] = square.center;
    let half = 0.5 * square.side;
    let towards = film.direction(u, v);
    let camera_of = |tangent: f64| -> Camera {
        Camera {
            look_at: (film.position + towards).to_f64(),
            field_of_view_degrees: 2.0 * libm::atan(tangent).to_degrees(),
            width: CLOSE_UP_PIXELS,
            height: CLOSE_UP_PIXELS,
            ..entry.camera.clone()
        }
    };
    // The largest frame whose corners, and thus all of it, are inside the square.
    let fits = |tangent: f64| {
        let turned = Film::new(&camera_of(tangent));
        let n = f64::from(CLOSE_UP_PIXELS);
        [[0.0, 0.0], [n, 0.0], [0.0, n], [n, n]]
            .iter()
            .all(|[a, b]| {
                let point = film.position + turned.direction(*a, *b);
                film.project(point)
                    .is_some_and(|(x, y)| (x - u).abs() <= half && (y - v).abs() <= half)
            })
    };
    let (mut low, mut high) = (0.0, half * film.dv.length_squared().sqrt());
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let mut camera = camera_of(low);
    camera.field_of_view_degrees = camera.field_of_view_degrees.max(SMALLEST_FIELD);
    View {
        columns: 0..CLOSE_UP_PIXELS,
        rows: 0..CLOSE_UP_PIXELS,
        name: format!("close-up at pixel ({u:.1}, {v:.1})"),
        reason: format!(
            "the same pinhole turned to a square {} pixels wide: there the kernel is whole at every bandwidth and the bias keeps its \
             sign; of such places, where the bias shows best against the spread of one sample",
            square.side
        ),
        is_close_up: true,
        entry: Entry {
            camera,
            ..entry.clone()
        },
    }
}

/// The close-up with its pinhole moved along its ray to where the frame is a point of the floor on the scale of any radius: all
/// camera paths of a photon map then gather the same photons, and the map's variance is a photon's second moment over their number.
/// A diffuse floor has the same radiance all along the ray.
fn point_view(view: View, class: PathClass, technique: Technique, kernel: Kernel) -> View {
    let middle = 0.5 * f64::from(CLOSE_UP_PIXELS);
    let seen = |entry: &Entry| -> Option<[f64; 3]> {
        let film = FilmExpectation::new(entry, technique, kernel, &[1.0]).ok()?;
        film.at(class, middle, middle, 1e-1).map(|p| p.floor)
    };
    let film = Film::new(&view.entry.camera);
    let Some(target) = seen(&view.entry) else {
        return view;
    };
    let forward = film.forward;
    let moved = |by: f64| -> Entry {
        let position = film.position + forward * by;
        let mut entry = view.entry.clone();
        entry.camera.position = position.to_f64();
        entry.camera.look_at = (position + forward).to_f64();
        entry.camera.field_of_view_degrees = SMALLEST_FIELD;
        entry
    };
    let sees_it = |by: f64| {
        seen(&moved(by)).is_some_and(|floor| (0..3).all(|k| (floor[k] - target[k]).abs() < 1e-6))
    };
    // As far as the floor, or the mirror in which it is seen.
    let (mut low, mut high) = (0.0, 1.0);
    while sees_it(high) && high < 1e6 {
        high *= 2.0;
    }
    for _ in 0..50 {
        let by = 0.5 * (low + high);
        if sees_it(by) {
            low = by;
        } else {
            high = by;
        }
    }
    let by = (low - NEAREST).max(0.0);
    View {
        entry: moved(by),
        name: format!(
            "point of the floor ({:.4}, {:.4}) m at {}",
            target[0],
            target[1],
            view.name.replace("close-up at ", "")
        ),
        reason: format!(
            "{}; the pinhole is moved along its ray to {NEAREST} m before the first surface, so that the frame is a point on the scale of \
             the radius",
            view.reason
        ),
        ..view
    }
}

/// What a camera can be [degrees].
const SMALLEST_FIELD: f64 = 0.1;
/// How near a pinhole comes to a surface [m].
const NEAREST: f64 = 0.01;
