//! What a wrong factor may be proportional to, pixel by pixel: cosines and distances at both ends of the last vertex.
//!
//! Found with the integrators' geometry, by rays through pixel centres and by photons. Only used to describe a residual:
//! no verdict depends on it.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::emission::Emitter;
use crate::geometry::floor::Floor;
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::pinhole::Pinhole;
use crate::geometry::scene::{Overrides, Scene};
use crate::geometry::specular::Specular;
use crate::stream::{BLOCK, Dimension, Stream, zeros};

/// Photons that find the cosines of light that has met specular surfaces.
const PHOTONS: u64 = 1 << 19;

/// The name of the product of reflectances and transmittances between light and eye.
pub const WEIGHT: &str = "the reflectance or transmittance on the way";

/// One quantity over the image; NaN where it is not known.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariate {
    /// What it is, for a person.
    pub name: &'static str,
    /// By pixel.
    pub values: Vec<f64>,
}

/// How far a quantity is carried over the border of where it is known [pixels].
const CARRIED: u32 = 2;

impl Covariate {
    /// Whether it differs from pixel to pixel at all.
    pub fn varies(&self) -> bool {
        let known = || self.values.iter().copied().filter(|c| !c.is_nan());
        let [low, high] = [
            known().fold(f64::INFINITY, f64::min),
            known().fold(0.0, f64::max),
        ];
        high > low * (1.0 + 1e-6)
    }

    /// Pixels at the border of what is seen have light, though the ray through their centre may miss it: they get the mean of
    /// their neighbours.
    fn carried(mut self, width: usize) -> Self {
        for _ in 0..CARRIED {
            let known = self.values.clone();
            for (i, value) in self.values.iter_mut().enumerate() {
                if !value.is_nan() {
                    continue;
                }
                let (x, y) = (i % width, i / width);
                let near = |c: usize, end: usize| c.saturating_sub(1)..(c + 2).min(end);
                let around = near(y, known.len() / width)
                    .flat_map(|y| near(x, width).map(move |x| y * width + x))
                    .map(|j| known[j])
                    .filter(|c| !c.is_nan());
                let (sum, count) = around.fold((0.0, 0.0), |(s, n), c| (s + c, n + 1.0));
                *value = sum / count;
            }
        }
        self
    }

    /// Mean over the pixels where it is known, each with its part of the light.
    pub fn mean(&self, light: &[f64]) -> f64 {
        let known = || self.values.iter().zip(light).filter(|(c, _)| !c.is_nan());
        known().map(|(c, l)| c * l).sum::<f64>() / known().map(|(_, l)| l).sum::<f64>()
    }
}

/// The quantities that are known for a class.
pub fn of(entry: &Entry, class: PathClass) -> Vec<Covariate> {
    let width = entry.camera.width as usize;
    let found = visit(entry, Overrides::default(), Quantities { class });
    found.into_iter().map(|c| c.carried(width)).collect()
}

struct Quantities {
    class: PathClass,
}

/// Cosine and distance of the light at a floor point, cosine and distance of the eye, cosine at the sensor.
#[derive(Clone, Copy)]
struct Point {
    light: Option<[f64; 2]>,
    eye: Option<[f64; 2]>,
    sensor: f64,
    /// Reflectance or transmittance on the way from the light, and to the eye.
    weight: f64,
}

fn grid(camera: &Pinhole, of: impl Fn(DVec3) -> Option<Point>) -> Vec<Option<Point>> {
    let (columns, rows) = camera.size();
    let (columns, rows) = (columns as u32, rows as u32);
    (0..rows)
        .flat_map(|row| (0..columns).map(move |column| (column, row)))
        .map(|(column, row)| of(camera.direction(f64::from(column) + 0.5, f64::from(row) + 0.5)))
        .collect()
}

fn collected(points: &[Option<Point>]) -> Vec<Covariate> {
    let values = |of: &dyn Fn(&Point) -> Option<f64>| -> Vec<f64> {
        let value = |p: &Option<Point>| p.as_ref().and_then(of).unwrap_or(f64::NAN);
        points.iter().map(value).collect()
    };
    let all = [
        (
            "the cosine at the receiver",
            values(&|p| p.light.map(|l| l[0])),
        ),
        (
            "the distance to the light",
            values(&|p| p.light.map(|l| l[1])),
        ),
        (
            "the cosine at the receiver towards the eye",
            values(&|p| p.eye.map(|e| e[0])),
        ),
        ("the distance to the eye", values(&|p| p.eye.map(|e| e[1]))),
        ("the cosine at the sensor", values(&|p| Some(p.sensor))),
        (WEIGHT, values(&|p| Some(p.weight))),
    ];
    all.into_iter()
        .map(|(name, values)| Covariate { name, values })
        .filter(|c| c.values.iter().any(|v| !v.is_nan()))
        .collect()
}

fn sensor(direction: DVec3) -> f64 {
    1.0 / f64::sqrt(direction.dot(direction))
}

/// Cosine and distance from a floor point of what is at `direction` from it.
fn seen_at(direction: DVec3) -> [f64; 2] {
    let distance = f64::sqrt(direction.dot(direction));
    [direction.z / distance, distance]
}

fn towards_light<L: Light>(light: &L, vertex: DVec3) -> [f64; 2] {
    let (towards, end) = light.towards(vertex);
    let [cosine, distance] = seen_at(towards);
    // A directional light has no distance.
    [
        cosine,
        if end < f64::INFINITY {
            distance
        } else {
            f64::NAN
        },
    ]
}

/// Mean cosine of arrival and mean weight by pixel, from photons that `land` where the pinhole can see them.
fn arrivals(
    camera: &Pinhole,
    emitter: &impl Emitter,
    land: impl Fn(DVec3, DVec3) -> Option<(DVec3, f64, f64)>,
) -> Vec<[f64; 2]> {
    let (columns, rows) = camera.size();
    let mut sums = vec![[0.0; 3]; (columns * rows) as usize];
    let stream = Stream::new(0x6469_6167, 0);
    let (mut u, mut v) = (zeros(), zeros());
    for first in (0..PHOTONS).step_by(BLOCK) {
        stream.pairs(first, Dimension::Emission, &mut u, &mut v);
        for (&u, &v) in u.iter().zip(&v) {
            let (origin, direction) = emitter.ray(u, v);
            let Some((vertex, cosine, weight)) = land(origin, direction) else {
                continue;
            };
            let (column, row, density) = camera.project_floor(vertex);
            if density > 0.0 {
                let pixel = row as usize * columns as usize + column as usize;
                if let Some([sum, weights, count]) = sums.get_mut(pixel) {
                    *sum += cosine;
                    *weights += weight;
                    *count += 1.0;
                }
            }
        }
    }
    sums.into_iter()
        .map(|[sum, weights, count]| [sum / count, weights / count])
        .collect()
}

fn with_arrivals(points: &mut [Option<Point>], arrivals: Vec<[f64; 2]>) {
    for (point, [cosine, weight]) in points.iter_mut().zip(arrivals) {
        if let Some(point) = point {
            point.light = Some([cosine, f64::NAN]);
            point.weight *= weight;
        }
    }
}

impl Visitor for Quantities {
    type Output = Vec<Covariate>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Vec<Covariate> {
        let camera = &scene.camera;
        let via_eye = !self.class.eye.is_empty();
        let via_light = !self.class.light.is_empty();
        let mut points = grid(camera, |direction| {
            let landing = scene.landing(camera.position, direction);
            if !(landing.weight > 0.0) || landing.via != via_eye {
                return None;
            }
            let vertex = DVec3::new(landing.x, landing.y, 0.0);
            let eye = (!via_eye).then(|| seen_at(camera.position - vertex));
            let light = (!via_light).then(|| towards_light(&scene.light, vertex));
            Some(Point {
                light,
                eye,
                sensor: sensor(direction),
                weight: landing.weight,
            })
        });
        if via_light && !via_eye {
            let mut targets = scene.floor.hull();
            targets.extend(scene.surface.hull());
            let emitter = scene.light.aimed(&targets);
            let cosines = arrivals(camera, &emitter, |origin, direction| {
                let landing = scene.landing(origin, direction);
                let lands = landing.via & (landing.weight > 0.0);
                let vertex = DVec3::new(landing.x, landing.y, 0.0);
                lands.then_some((vertex, landing.cosine, landing.weight))
            });
            with_arrivals(&mut points, cosines);
        }
        collected(&points)
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Vec<Covariate> {
        let camera = &scene.camera;
        let direct = self.class.light.is_empty();
        let mut points = grid(camera, |direction| {
            let t = Floor::meet(camera.position, direction);
            let vertex = camera.position + direction * t;
            if !(t < f64::INFINITY) || !scene.floor.contains(vertex.x, vertex.y) {
                return None;
            }
            Some(Point {
                light: direct.then(|| towards_light(&scene.light, vertex)),
                eye: Some(seen_at(camera.position - vertex)),
                sensor: sensor(direction),
                weight: 1.0,
            })
        });
        let chain = scene
            .surface
            .classes()
            .iter()
            .position(|&c| c == self.class);
        if let (false, Some(chain)) = (direct, chain) {
            let targets = scene.surface.targets(chain, &scene.floor.hull());
            let highest = targets.iter().map(|p| p.z).fold(0.0, f64::max);
            let emitter = scene.light.narrow(&targets, highest);
            let cosines = arrivals(camera, &emitter, |origin, direction| {
                let leg = scene.surface.follow(chain, origin, direction);
                let t = Floor::meet(leg.origin, leg.direction);
                let d = leg.direction;
                let lands = (leg.weight > 0.0) & (t < f64::INFINITY);
                lands.then(|| (leg.origin + d * t, -d.z / f64::sqrt(d.dot(d)), leg.weight))
            });
            with_arrivals(&mut points, cosines);
        }
        collected(&points)
    }

    fn furnace(self, scene: Furnace) -> Vec<Covariate> {
        let camera = &scene.camera;
        let points = grid(camera, |direction| {
            let vertex = scene.hit(camera.position, direction);
            let normal = scene.normal(vertex);
            let at = |d: DVec3| {
                let distance = f64::sqrt(d.dot(d));
                [d.dot(normal) / distance, distance]
            };
            let light = (self.class == PathClass::LDE).then(|| at(scene.light.towards(vertex).0));
            Some(Point {
                light,
                eye: Some(at(camera.position - vertex)),
                sensor: sensor(direction),
                weight: 1.0,
            })
        });
        collected(&points)
    }
}
