//! Pixels and film regions at finite bandwidth: the mean radiance of the regularized classes.
//!
//! The eye's side of a path is not touched by a mollified vertex on the light's side: through a film point the eye sees a
//! floor point x, directly or in the mirror (weight W = 1 or R), and
//!
//! ```text
//! mean of the pixel     = ∫ W ρ/π E_α(x(u, v)) du dv             over the part of the pixel where such an x exists
//! second moment         = ∫ (W ρ/π)² m₂(x(u, v)) du dv           one camera sample uniform in the pixel, one estimator sample
//! ```
//!
//! The mollified E is continuous but changes within about a kernel's width along the border of the lit region, so the film is
//! cut along that border, and pieces there count as unknown until they are small enough to have seen the change.

use super::cubature::{Integrand, Value};
use super::probe::Expectation;
use super::quadrature::Pair;
use super::setting::PlanarSetting;
use super::{Bounded, Kernel, Moments, Technique, check};
use crate::camera::Film;
use crate::class::PathClass;
use crate::pixel::planar::{Eye, Light, PlanarView};
use crate::pixel::polygon::{ConvexSet, HalfPlane, Polygon};
use crate::scene::{Entry, InvalidParameter, Kind, PlanarMirrorScene};
use crate::vector::Vec3;

/// Rounds of splits at most, per pixel or strip.
const ROUNDS: usize = 60;

/// Pixels fainter than this part of the unclipped radiance are computed to an absolute tolerance only.
const FAINT: f64 = 1e-6;

/// One regularized class: how the eye sees the floor and what weight it carries.
#[derive(Clone, Debug)]
struct Layer {
    class: PathClass,
    eye: Eye,
    /// W ρ/π.
    factor: f64,
    /// The film region.
    seen: Vec<ConvexSet>,
    hidden: Vec<ConvexSet>,
    /// Of it, what is lit at bandwidth zero.
    lit: ConvexSet,
}

/// The expectation of the image of an entry by a regularized estimator.
#[derive(Clone, Debug)]
pub struct FilmExpectation {
    expectation: Option<Expectation>,
    view: PlanarView,
    layers: Vec<Layer>,
    classes: Vec<PathClass>,
    width: u32,
    height: u32,
}

/// What one point of the film sees of a regularized class.
#[derive(Clone, Copy, Debug)]
pub struct FilmPoint {
    /// The floor point [m].
    pub floor: [f64; 3],
    /// Of the radiance [W m⁻² sr⁻¹].
    pub moments: Moments,
    /// The radiance at bandwidth zero.
    pub sharp: f64,
    /// Of a sample that is not zero, where [`Expectation::hit_probability`] knows it.
    pub hit_probability: Option<Bounded>,
    /// Whether the floor point is farther from every border of what the mirror lights than the kernel reaches.
    pub is_interior: bool,
}

impl FilmExpectation {
    /// Prepares an entry of kind `diffuse` (which has no regularized class) or `planar-mirror`.
    ///
    /// # Errors
    /// What [`Entry::validate`] and [`check`] find; another kind.
    pub fn new(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        bandwidths: &[f64],
    ) -> Result<Self, InvalidParameter> {
        check(technique, kernel, bandwidths)?;
        let setting = PlanarSetting::of_entry(entry)?;
        let Some(view) = PlanarView::new(entry) else {
            return Err(InvalidParameter {
                key: "kind".to_owned(),
                found: entry.kind.name().to_owned(),
                allowed: "diffuse or planar-mirror: the kinds with a finite-bandwidth expectation"
                    .to_owned(),
            });
        };
        let mut layers = Vec::new();
        if let (Some(setting), Kind::PlanarMirror(PlanarMirrorScene { floor, mirror, .. })) =
            (&setting, &entry.kind)
        {
            let brightness = floor.albedo / core::f64::consts::PI;
            let eyes = [
                (PathClass::LSDE, Eye::Direct, 1.0),
                (PathClass::LSDSE, Eye::Mirror, mirror.reflectance),
            ];
            for (class, eye, weight) in eyes {
                layers.extend(layer(
                    &view,
                    setting,
                    entry,
                    technique,
                    class,
                    eye,
                    weight * brightness,
                ));
            }
        }
        let expectation = match setting {
            Some(s) => Some(Expectation::new(s, technique, kernel, bandwidths)?),
            None => None,
        };
        Ok(FilmExpectation {
            expectation,
            view,
            classes: layers.iter().map(|l| l.class).collect(),
            layers,
            width: entry.camera.width,
            height: entry.camera.height,
        })
    }

    /// The regularized classes, in the order in which everything here lists them: LSDE, LSDSE, or none.
    pub fn classes(&self) -> &[PathClass] {
        &self.classes
    }

    /// Columns and rows.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Moments of the radiance [W m⁻² sr⁻¹] of the pixels of row j, as [class][column], to a relative tolerance.
    pub fn row(&self, j: u32, tolerance: f64) -> Vec<Vec<Moments>> {
        let v = [f64::from(j), f64::from(j) + 1.0];
        self.layers
            .iter()
            .map(|layer| {
                (0..self.width)
                    .map(|i| {
                        let u = [f64::from(i), f64::from(i) + 1.0];
                        let pieces = layer.pieces(&Polygon::rectangle(u, v));
                        if pieces.is_empty() {
                            return Moments::default();
                        }
                        let peak = self.peak(layer, u[0] + 0.5, v[0] + 0.5);
                        let sum = self.integrate(layer, &pieces, tolerance, |s| {
                            core::array::from_fn(|k| {
                                tolerance * s.value[k].abs().max(FAINT * peak[k])
                            })
                        });
                        moments(&sum)
                    })
                    .collect()
            })
            .collect()
    }

    /// Moments summed over the pixels of rows `rows`, per class, each to an absolute error below `target`
    /// ([mean, second moment], in units of a pixel's radiance). An infinite target gives a first estimate. `tolerance` is that of the
    /// irradiance at a point.
    pub fn strip(
        &self,
        rows: core::ops::Range<u32>,
        targets: &[[f64; 2]],
        tolerance: f64,
    ) -> Vec<Moments> {
        self.region(0..self.width, rows, targets, tolerance)
    }

    /// The same for a rectangle of pixels.
    pub fn region(
        &self,
        columns: core::ops::Range<u32>,
        rows: core::ops::Range<u32>,
        targets: &[[f64; 2]],
        tolerance: f64,
    ) -> Vec<Moments> {
        let v = [f64::from(rows.start), f64::from(rows.end)];
        let u = [f64::from(columns.start), f64::from(columns.end)];
        let tiles = libm::ceil((u[1] - u[0]) / (v[1] - v[0]).max(1.0)).max(1.0);
        self.layers
            .iter()
            .zip(targets)
            .map(|(layer, target)| {
                let pieces: Vec<Polygon> = (0..tiles as u32)
                    .flat_map(|t| {
                        let at = |t: u32| u[0] + (u[1] - u[0]) * f64::from(t) / tiles;
                        layer.pieces(&Polygon::rectangle([at(t), at(t + 1)], v))
                    })
                    .collect();
                moments(&self.integrate(layer, &pieces, tolerance, |_| *target))
            })
            .collect()
    }

    /// What the film point (u, v) sees of a class, to a relative tolerance; `None` where it sees no floor of it.
    pub fn at(&self, class: PathClass, u: f64, v: f64, tolerance: f64) -> Option<FilmPoint> {
        let layer = self.layers.iter().find(|l| l.class == class)?;
        let seen = layer.seen.iter().all(|s| s.contains(u, v));
        if !seen || layer.hidden.iter().any(|h| h.contains(u, v)) {
            return None;
        }
        let (expectation, rays) = (self.expectation.as_ref()?, self.view.rays(layer.eye)?);
        let x = rays.floor_point(u, v).to_f64();
        let (m, plain) = expectation.examine(x, tolerance);
        let scaled = |b: Bounded, factor: f64| Bounded {
            value: factor * b.value,
            error: factor * b.error,
        };
        Some(FilmPoint {
            floor: x,
            moments: Moments {
                mean: scaled(m.mean, layer.factor),
                second_moment: scaled(m.second_moment, layer.factor * layer.factor),
            },
            sharp: layer.factor * expectation.sharp(x),
            hit_probability: expectation.hit_probability(x, tolerance),
            is_interior: plain && m.mean.value > 0.0,
        })
    }

    fn integrate(
        &self,
        layer: &Layer,
        pieces: &[Polygon],
        tolerance: f64,
        target: impl Fn(&Pair) -> [f64; 2],
    ) -> Pair {
        let (Some(expectation), Some(rays)) = (&self.expectation, self.view.rays(layer.eye)) else {
            return Pair::default();
        };
        let factors = [layer.factor, layer.factor * layer.factor];
        let integrand = Integrand {
            at: |u: f64, v: f64| {
                let x = rays.floor_point(u, v).to_f64();
                let (m, plain) = expectation.examine(x, 0.1 * tolerance);
                let bounded = [m.mean, m.second_moment];
                Value {
                    pair: Pair {
                        value: core::array::from_fn(|k| factors[k] * bounded[k].value),
                        error: core::array::from_fn(|k| factors[k] * bounded[k].error),
                    },
                    plain,
                }
            },
            peak: |u: f64, v: f64| self.peak(layer, u, v),
            on_border: |u: f64, v: f64| expectation.is_on_lit_border(rays.floor_point(u, v)),
        };
        integrand.integrate(pieces, ROUNDS, target)
    }

    /// Moments of the radiance at a film point if the mirror were unbounded, roughly.
    fn peak(&self, layer: &Layer, u: f64, v: f64) -> [f64; 2] {
        let (Some(expectation), Some(rays)) = (&self.expectation, self.view.rays(layer.eye)) else {
            return [0.0; 2];
        };
        let [mean, second] = expectation.unclipped(rays.floor_point(u, v));
        [layer.factor * mean, layer.factor * layer.factor * second]
    }
}

fn moments(p: &Pair) -> Moments {
    let bounded = |k: usize| Bounded {
        value: p.value[k],
        error: p.error[k],
    };
    Moments {
        mean: bounded(0),
        second_moment: bounded(1),
    }
}

fn layer(
    view: &PlanarView,
    setting: &PlanarSetting,
    entry: &Entry,
    technique: Technique,
    class: PathClass,
    eye: Eye,
    factor: f64,
) -> Option<Layer> {
    let any = view.region(eye, Light::Any)?;
    let lit = view.region(eye, Light::Mirror)?;
    let mut seen = any.inside.clone();
    if eye == Eye::Direct && technique != Technique::Merge {
        // Only merging lets light reach a floor point behind the mirror's plane.
        seen.half_planes.push(in_front(setting, entry));
    }
    // The lit region carries the conditions of the seen one and those of the light.
    let extra: Vec<HalfPlane> = lit
        .inside
        .half_planes
        .iter()
        .filter(|h| !any.inside.half_planes.contains(h))
        .copied()
        .collect();
    Some(Layer {
        class,
        eye,
        factor,
        seen: vec![seen],
        hidden: any.outside.clone(),
        lit: ConvexSet { half_planes: extra },
    })
}

/// The film points of which the direct ray meets the floor in front of the mirror's plane (rays that go down):
/// x = q − d q_z/d_z, so (x − m)·n ≥ 0 ⇔ (q − m)·n (−d_z) + q_z d·n ≥ 0, linear in (u, v).
fn in_front(setting: &PlanarSetting, entry: &Entry) -> HalfPlane {
    let film = Film::new(&entry.camera);
    let height = setting.mirror_height(film.position);
    let n = setting.mirror_normal;
    let along = |d: Vec3<f64>| film.position.z * d.dot(n) - height * d.z;
    HalfPlane {
        a: along(film.du),
        b: along(film.dv),
        c: along(film.corner),
    }
}

impl Layer {
    /// The part of a rectangle that is seen, cut along the border of the lit region.
    fn pieces(&self, rectangle: &Polygon) -> Vec<Polygon> {
        let mut pieces = vec![rectangle.clone()];
        for set in &self.seen {
            pieces = pieces.iter().map(|p| p.intersection(set)).collect();
        }
        for set in &self.hidden {
            let whole = core::mem::take(&mut pieces);
            whole.iter().for_each(|p| p.difference(set, &mut pieces));
        }
        let mut cut = Vec::new();
        for p in pieces.iter().filter(|p| !p.is_empty()) {
            cut.push(p.intersection(&self.lit));
            p.difference(&self.lit, &mut cut);
        }
        cut.retain(|p| !p.is_empty() && p.area() > 0.0);
        cut
    }
}
