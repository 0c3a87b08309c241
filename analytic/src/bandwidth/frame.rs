//! Films at finite bandwidth, of any kind with an expectation at points: pixels, regions and whole images.
//!
//! Through a film point the eye sees a floor point x, directly or by a specular surface (weight W), and
//!
//! ```text
//! mean of a region    = ∫ W ρ/π E_α(x(u, v)) du dv                over what sees the floor, per area of the region
//! second moment       = ∫ (W ρ/π)² m₂(x(u, v)) du dv              one camera sample uniform in it, one estimator sample
//! ```
//!
//! The mollified E is continuous; its kinks are where an edge of the kernel touches one of the surface. Regions are cut at the
//! floor's border and halved where the interpolants are worst; an image is covered with tiles of which each is one interpolant.

use core::f64::consts::PI;
use core::ops::Range;

use super::chart::{Integrand, MARGINS, Node, integrate_over};
use super::entry::{EntryExpectation, Estimator};
use super::{Bounded, Moments};
use crate::camera::Film;
use crate::class::PathClass;
use crate::flux::poly::{Chebyshev, N, nodes, value};
use crate::optics::fresnel_transmittance;
use crate::pixel::rule::Rule;
use crate::scene::{Entry, InvalidParameter, Kind};
use crate::vector::vec3;

/// How the eye sees the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Eye {
    /// Straight.
    Direct,
    /// Through a flat surface at a height, into this index.
    Water { height: f64, index: f64 },
}

/// One class as it is seen.
#[derive(Clone, Copy, Debug)]
struct Layer {
    class: PathClass,
    /// Position of the class as it ends on the floor.
    position: usize,
    eye: Eye,
}

/// The expectation of the image of an entry by a regularized estimator.
#[derive(Clone, Debug)]
pub struct FrameExpectation {
    expectation: EntryExpectation,
    film: Film,
    /// ρ/π.
    brightness: f64,
    center: [f64; 2],
    half_width: [f64; 2],
    layers: Vec<Layer>,
}

impl FrameExpectation {
    /// Prepares an estimator for an entry; see [`EntryExpectation::new`].
    ///
    /// # Errors
    /// What [`EntryExpectation::new`] finds; a kind of which the eye sees the floor in a way that is not known here.
    pub fn new(
        entry: &Entry,
        estimator: Estimator<'_>,
        beam_area: f64,
    ) -> Result<Self, InvalidParameter> {
        let expectation = EntryExpectation::new(entry, estimator, beam_area)?;
        let unknown = || {
            InvalidParameter {
            key: "kind".to_owned(),
            found: entry.kind.name().to_owned(),
            allowed: "a kind whose floor is seen directly or through flat water, with nothing in front of it"
                .to_owned(),
        }
        };
        let floor = entry.kind.floor().ok_or_else(unknown)?;
        let ends = expectation.classes();
        let mut layers = Vec::new();
        for &class in entry.kind.classes() {
            let same = |c: &PathClass| c.light == class.light && c.diffuse == class.diffuse;
            let Some(position) = ends.iter().position(same) else {
                continue;
            };
            layers.push(Layer {
                class,
                position,
                eye: eye(&entry.kind, class).ok_or_else(unknown)?,
            });
        }
        Ok(FrameExpectation {
            expectation,
            film: Film::new(&entry.camera),
            brightness: floor.albedo / PI,
            center: floor.center,
            half_width: floor.half_width,
            layers,
        })
    }

    /// The regularized classes, in the order of the entry's.
    pub fn classes(&self) -> Vec<PathClass> {
        self.layers.iter().map(|l| l.class).collect()
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.film.width, self.film.height)
    }

    /// Moments of the radiance [W m⁻² sr⁻¹] of a class summed over the pixels of a rectangle, to `tolerance × max(|value|, floor)` where
    /// `floor` are such sums, or nothing; second moments to ten times that.
    ///
    /// **Accuracy**: as stated in the error bounds, which are estimates.
    pub fn region(
        &self,
        class: usize,
        columns: Range<u32>,
        rows: Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
    ) -> Moments {
        let domain = [
            [f64::from(columns.start), f64::from(columns.end)],
            [f64::from(rows.start), f64::from(rows.end)],
        ];
        let area = (domain[0][1] - domain[0][0]) * (domain[1][1] - domain[1][0]);
        let seen = Seen {
            frame: self,
            layer: &self.layers[class],
            domain,
            tolerance: 0.1 * tolerance,
            // A point may be as wrong as all of them on average.
            floor: floor.map(|f| f / area),
            cells: if area > 1.0 { [2; 2] } else { [1; 2] },
        };
        let sum = integrate_over(&seen, &[domain], tolerance, [0.0; 2], floor);
        let bounded = |k: usize| Bounded {
            value: sum.value[k],
            error: sum.error[k] + tolerance * 0.1 * f64::abs(sum.value[k]),
        };
        Moments {
            mean: bounded(0),
            second_moment: bounded(1),
        }
    }

    /// Moments of the radiance [W m⁻² sr⁻¹] of a class for each pixel of a rectangle, row by row, to `tolerance × max(|value|, floor)` where
    /// `floor` is a typical pixel.
    ///
    /// The rectangle is covered with tiles of which each is one interpolant of degree 8, halved until that is good enough or a
    /// pixel is left, which is then integrated by itself. **Accuracy**: as stated in the error bounds, which are estimates.
    pub fn pixels(
        &self,
        class: usize,
        columns: Range<u32>,
        rows: Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
    ) -> Vec<Moments> {
        let width = columns.len();
        let mut out = vec![Moments::default(); width * rows.len()];
        let (left, top) = (columns.start, rows.start);
        let mut tiles = vec![(columns, rows)];
        let seen = Seen {
            frame: self,
            layer: &self.layers[class],
            domain: [[0.0; 2]; 2],
            tolerance: 0.1 * tolerance,
            floor,
            cells: [1; 2],
        };
        while let Some((columns, rows)) = tiles.pop() {
            if columns.is_empty() || rows.is_empty() {
                continue;
            }
            let done = match is_seen(&seen, &columns, &rows) {
                Some(false) => true,
                Some(true) => seen.tile(&columns, &rows, tolerance, floor, &mut |i, j, m| {
                    out[(j - top) as usize * width + (i - left) as usize] = m;
                }),
                None => false,
            };
            if done {
                continue;
            }
            if columns.len() == 1 && rows.len() == 1 {
                let at = (rows.start - top) as usize * width + (columns.start - left) as usize;
                out[at] = self.region(class, columns, rows, tolerance, floor);
            } else {
                let (i, j) = (
                    columns.start + columns.len() as u32 / 2,
                    rows.start + rows.len() as u32 / 2,
                );
                for c in [columns.start..i, i..columns.end] {
                    for r in [rows.start..j, j..rows.end] {
                        tiles.push((c.clone(), r));
                    }
                }
            }
        }
        out
    }

    /// What the eye sees through a film point: the floor point, the weight on the way, and margins of its existence.
    fn look(&self, eye: Eye, u: f64, v: f64) -> ([f64; 2], f64, [f64; 6]) {
        let film = &self.film;
        let (mut origin, mut d) = (film.position, film.direction(u, v));
        let (mut weight, mut margins) = (1.0, [1.0; 6]);
        match eye {
            Eye::Direct => {}
            Eye::Water { height, index } => {
                let t = (height - origin.z) / d.z;
                let at = origin + d * t;
                let unit = d.normalized();
                let c = -unit.z;
                let q = libm::sqrt(index * index - (1.0 - c) * (1.0 + c));
                margins[3] = c;
                weight = fresnel_transmittance(1.0, c, index, q) / (index * index);
                (origin, d) = (at, vec3(unit.x, unit.y, -q));
            }
        }
        margins[5] = -d.z;
        let t = origin.z / -d.z;
        let p = [origin.x + d.x * t, origin.y + d.y * t];
        for k in 0..2 {
            let s = (p[k] - self.center[k]) / self.half_width[k];
            // Negative on both sides, and smooth through infinity.
            margins[k] = if s.abs() > 1e8 {
                -1.0
            } else {
                (1.0 - s) * (1.0 + s) / (1.0 + s * s)
            };
        }
        (p, weight, margins)
    }
}

/// How a class is seen, where the image has no edges but the floor's.
fn eye(kind: &Kind, class: PathClass) -> Option<Eye> {
    match (kind, class.eye.len()) {
        (Kind::PlanarMirror(_) | Kind::CylinderCup(_), _) => None,
        (_, 0) => Some(Eye::Direct),
        (Kind::FlatInterface(s), 1) => Some(Eye::Water {
            height: s.water.surface_z,
            index: s.water.index,
        }),
        _ => None,
    }
}

fn padded(conditions: &[f64; 6]) -> [f64; MARGINS] {
    let mut margins = [1.0; MARGINS];
    margins[..conditions.len()].copy_from_slice(conditions);
    margins
}

/// The radiance over the film.
struct Seen<'a> {
    frame: &'a FrameExpectation,
    layer: &'a Layer,
    domain: [[f64; 2]; 2],
    tolerance: f64,
    floor: [f64; 2],
    cells: [u32; 2],
}

impl Integrand for Seen<'_> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    fn edges(&self) -> &[f64] {
        &[1.0]
    }

    fn spans(&self) -> &[f64] {
        &[1.0]
    }

    fn rounding(&self) -> f64 {
        self.tolerance
    }

    /// The light itself, which costs a thousand times as much as the margins, is left to [`Self::kernel`].
    fn node(&self, u: [f64; 2]) -> Node {
        Node {
            level: 0.0,
            least: f64::NAN,
            deflection: [u[0], u[1], 0.0],
            density: [1.0; 2],
            distance: 0.0,
            margins: self.margins(u),
        }
    }

    /// Second moments are wanted for the sizes of samples.
    fn slack(&self) -> [f64; 2] {
        [1.0, 10.0]
    }

    fn margins(&self, [u, v]: [f64; 2]) -> [f64; MARGINS] {
        padded(&self.frame.look(self.layer.eye, u, v).2)
    }

    fn kernel(&self, _: usize, node: &Node) -> [f64; 2] {
        self.radiance(node.deflection[0], node.deflection[1])
    }

    fn coarse(&self) -> [u32; 2] {
        self.cells
    }
}

impl Seen<'_> {
    /// Mean and second moment of the radiance at a film point.
    fn radiance(&self, u: f64, v: f64) -> [f64; 2] {
        let frame = self.frame;
        let (x, weight, _) = frame.look(self.layer.eye, u, v);
        let scale = weight * frame.brightness;
        let floor = [self.floor[0] / scale, self.floor[1] / (scale * scale)];
        let m = frame
            .expectation
            .of_class(self.layer.position, x, self.tolerance, floor);
        [scale * m.mean.value, scale * scale * m.second_moment.value]
    }

    /// All pixels of a tile by one interpolant, if that is good enough.
    fn tile(
        &self,
        columns: &Range<u32>,
        rows: &Range<u32>,
        tolerance: f64,
        floor: [f64; 2],
        put: &mut dyn FnMut(u32, u32, Moments),
    ) -> bool {
        let (low, size) = corner_and_size(columns, rows);
        let at = |k: usize, a: f64| low[k] + 0.5 * size[k] * (1.0 + a);
        let values: Vec<[f64; 2]> = nodes()
            .iter()
            .flat_map(|b| nodes().iter().map(|a| [at(0, *a), at(1, *b)]))
            .map(|u| self.radiance(u[0], u[1]))
            .collect();
        let fits = [0, 1].map(|k| {
            let grid = core::array::from_fn(|l| core::array::from_fn(|i| values[l * N + i][k]));
            Chebyshev::new(&grid)
        });
        // A pixel of its own is an integral, of several each is about a value.
        let single = columns.len() * rows.len() == 1;
        let errors = fits.map(|c| {
            if single {
                0.25 * c.integral_error()
            } else {
                0.3 * (c.tails()[0] + c.tails()[1])
            }
        });
        let good = (0..2).all(|k| {
            errors[k] <= self.slack()[k] * tolerance * f64::abs(fits[k].c[0][0]).max(floor[k])
        });
        if !good {
            return false;
        }
        let polynomials = fits.map(|c| c.polynomial());
        let rule = Rule::gauss(5);
        for j in rows.clone() {
            for i in columns.clone() {
                let mut moments = Moments::default();
                for (k, p) in polynomials.iter().enumerate() {
                    let mut sum = 0.0;
                    for (y, wy) in rule.iter() {
                        let b = 2.0 * (f64::from(j) + y - low[1]) / size[1] - 1.0;
                        let line = p.along_a(b);
                        for (x, wx) in rule.iter() {
                            let a = 2.0 * (f64::from(i) + x - low[0]) / size[0] - 1.0;
                            sum += wx * wy * value(&line, a);
                        }
                    }
                    let bounded = Bounded {
                        value: sum,
                        error: errors[k] + 0.1 * tolerance * f64::abs(sum).max(floor[k]),
                    };
                    if k == 0 {
                        moments.mean = bounded;
                    } else {
                        moments.second_moment = bounded;
                    }
                }
                put(i, j, moments);
            }
        }
        true
    }
}

fn corner_and_size(columns: &Range<u32>, rows: &Range<u32>) -> ([f64; 2], [f64; 2]) {
    (
        [f64::from(columns.start), f64::from(rows.start)],
        [columns.len() as f64, rows.len() as f64],
    )
}

/// Whether all of a tile is in a part of the film, or nothing of it; `None` if neither is certain.
fn is_seen(seen: &Seen<'_>, columns: &Range<u32>, rows: &Range<u32>) -> Option<bool> {
    let (low, size) = corner_and_size(columns, rows);
    let at = |k: usize, a: f64| low[k] + 0.5 * size[k] * (1.0 + a);
    let x = nodes();
    let margins: [[[f64; MARGINS]; N]; N] = core::array::from_fn(|l| {
        core::array::from_fn(|k| seen.margins([at(0, x[k]), at(1, x[l])]))
    });
    let mut all = Some(true);
    let grids = (0..MARGINS).map(|m| margins.map(|row| row.map(|node| node[m])));
    for grid in grids {
        if !grid.iter().flatten().all(|g| g.is_finite()) {
            all = None;
            continue;
        }
        let c = Chebyshev::new(&grid);
        let [p, q] = c.tails();
        let spread = c.spread() + 6.0 * (p + q);
        if c.c[0][0] < -spread {
            return Some(false);
        }
        if !(c.c[0][0] > spread) {
            all = None;
        }
    }
    all
}
