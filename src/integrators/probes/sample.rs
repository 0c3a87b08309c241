//! The samples of a probe, one chain and one pair of random numbers at a time.

use core::f64::consts::PI;

use glam::DVec3;
use multiversion::multiversion;
use nephroid_analytic::class::{PathClass, Specular};

use crate::geometry::chains::{Chains, Vertex, bounding_box};
use crate::geometry::emission::Emitter;
use crate::geometry::floor::Floor;
use crate::geometry::light::Light;
use crate::geometry::scene::Scene;
use crate::geometry::turn::sin_cos_of_turns;
use crate::integrators::connection::to_light;
use crate::integrators::kernel::{AngleKernel, Kernel, RadiusKernel};
use crate::integrators::merged_chains::{emitter, landing};
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};

use super::aim::{self, Aim, Chart, Part};
use super::{Distance, Probe, Sums, Technique};

/// An estimator whose light and surface are known at compile time.
pub(super) struct Sampler<L: Light, S> {
    scene: Scene<L, S>,
    technique: Technique,
    kernel: Kernel,
    distance: Option<Distance>,
    /// Positions of the chains of the classes.
    chains: Vec<usize>,
    /// Diagonal of the box of all clipped surfaces and point lights [m]; `None` with an unbounded surface.
    diagonal: Option<f64>,
}

/// A technique at a bandwidth and a floor point.
enum State<L: Light> {
    /// From the floor point.
    Camera(Width),
    /// From the light, with an emitter for each class.
    Light(Width, Vec<L::Emitter>),
    /// Photons that land on the floor.
    Merge(RadiusKernel, Vec<L::Emitter>),
}

/// The kernel on the angle.
enum Width {
    /// The same at every vertex.
    Angle(AngleKernel),
    /// Of an angle that a radius [m] makes.
    Radius(Distance, f64),
}

impl<L: Light, S: Chains> Sampler<L, S> {
    pub(super) fn new(
        scene: Scene<L, S>,
        technique: Technique,
        kernel: Kernel,
        distance: Option<Distance>,
    ) -> Self {
        let classes = scene.surface.classes().iter().enumerate();
        let caustic = |(chain, class): (usize, &PathClass)| class.is_caustic().then_some(chain);
        let diagonal = scene.surface.bounds().and_then(|surface| {
            let mut points = scene.floor.hull();
            points.extend(surface);
            points.extend(scene.light.position());
            bounding_box(&points).map(|[low, high]| (high - low).length())
        });
        Sampler {
            chains: classes.filter_map(caustic).collect(),
            scene,
            technique,
            kernel,
            distance,
            diagonal,
        }
    }

    pub(super) fn classes(&self) -> Vec<PathClass> {
        let all = self.scene.surface.classes();
        self.chains.iter().map(|&chain| all[chain]).collect()
    }

    fn width(&self, bandwidth: f64) -> Width {
        match self.distance {
            None => Width::Angle(AngleKernel::new(self.kernel, bandwidth.min(PI), None)),
            Some(distance) => Width::Radius(distance, bandwidth),
        }
    }

    /// Keeps one class alone.
    pub(super) fn keep(&mut self, class: PathClass) {
        let all = self.scene.surface.classes();
        self.chains.retain(|&chain| all[chain] == class);
    }

    /// `None` where parallel light reaches the point from an unbounded part of the surface.
    fn state(&self, bandwidth: f64, x: DVec3) -> Option<State<L>> {
        let width = self.width(bandwidth);
        Some(match self.technique {
            Technique::Camera | Technique::Symmetric => State::Camera(width),
            Technique::Light => State::Light(width, self.emitters(bandwidth, x)?),
            Technique::Merge => State::Merge(
                RadiusKernel::new(self.kernel, bandwidth, None),
                self.chains
                    .iter()
                    .map(|&chain| emitter(&self.scene, chain))
                    .collect(),
            ),
        })
    }

    /// Photons over everything that a mollified path can begin with.
    fn emitters(&self, bandwidth: f64, x: DVec3) -> Option<Vec<L::Emitter>> {
        if !L::IS_DISTANT {
            let sphere = self.scene.light.spread(&[], 0.0);
            return Some(self.chains.iter().map(|_| sphere).collect());
        }
        let widest = match (self.kernel, self.distance) {
            // A kernel without an end.
            (Kernel::VonMisesFisher, _) => PI,
            (_, None) => bandwidth,
            // Every angle of a link is less than a right one.
            (_, Some(_)) => 0.5 * PI,
        };
        let targets = self.scene.surface.exposed(x, widest)?;
        let highest = targets.iter().map(|p| p.z).fold(0.0, f64::max);
        let beam = self.scene.light.spread(&targets, highest);
        Some(self.chains.iter().map(|_| beam).collect())
    }

    /// The sample of the class with this position.
    #[inline(always)]
    fn sample(&self, state: &State<L>, class: usize, x: DVec3, u: f64, v: f64) -> f64 {
        let chain = self.chains[class];
        let sample = match state {
            State::Camera(width) => self.camera(width, chain, x, u, v),
            State::Light(width, emitters) => self.light(width, chain, &emitters[class], x, u, v),
            State::Merge(kernel, emitters) => {
                let emitter = &emitters[class];
                let (origin, direction) = emitter.ray(u, v);
                landing(&self.scene, chain, origin, direction).map(|(px, py, _, weight)| {
                    let (dx, dy) = (px - x.x, py - x.y);
                    let d2 = dx * dx + dy * dy;
                    let inside = d2 < kernel.radius * kernel.radius;
                    let value = kernel.density(d2);
                    if inside {
                        emitter.flux() * weight * value
                    } else {
                        0.0
                    }
                })
            }
        };
        sample.unwrap_or(0.0)
    }

    #[inline(always)]
    fn camera(&self, width: &Width, chain: usize, x: DVec3, u: f64, v: f64) -> Option<f64> {
        let Scene { surface, .. } = &self.scene;
        // The density cos/π over the hemisphere.
        let (sine, cosine) = sin_cos_of_turns(u);
        let r = f64::sqrt(v);
        let direction = DVec3::new(r * cosine, r * sine, f64::sqrt(1.0 - v));
        let vertex = surface.trace_back(chain, x, direction)?;
        let light = to_light(&self.scene, &vertex, width.support())?;
        let density = self.density(width, &vertex, x, light.distance, light.squared_chord)?;
        let symmetric = if self.technique == Technique::Symmetric && self.reflects(chain) {
            let c1 = vertex.normal.dot(vertex.direction);
            f64::sqrt(light.cosine / c1)
        } else {
            1.0
        };
        let gain = PI * surface.radiance_gain();
        Some(gain * vertex.weight * light.irradiance * density * symmetric)
    }

    /// Whether the vertex next to the light reflects.
    fn reflects(&self, chain: usize) -> bool {
        let class = self.scene.surface.classes()[chain];
        match class.light.iter().next() {
            Some(Specular::Reflection) => true,
            Some(Specular::Any) => !S::REFRACTS,
            _ => false,
        }
    }

    #[inline(always)]
    fn light(
        &self,
        width: &Width,
        chain: usize,
        emitter: &L::Emitter,
        x: DVec3,
        u: f64,
        v: f64,
    ) -> Option<f64> {
        let Scene { surface, light, .. } = &self.scene;
        let (origin, direction) = emitter.ray(u, v);
        let vertex = surface.strike(chain, origin, direction)?;
        let towards = x - vertex.point;
        let square = towards.dot(towards);
        let difference = vertex.direction - towards / f64::sqrt(square);
        let squared_chord = difference.dot(difference);
        let right_side = vertex.normal.dot(towards) > 0.0 && towards.z < 0.0;
        if !(squared_chord < width.support() && right_side) {
            return None;
        }
        let to_light = light
            .position()
            .map_or(f64::INFINITY, |y| (y - vertex.point).length());
        let density = self.density(width, &vertex, x, to_light, squared_chord)?;
        if surface.again(&vertex, towards) < 1.0 {
            return None;
        }
        let cosine = -towards.z / f64::sqrt(square);
        Some(emitter.flux() * vertex.weight * density * cosine / square)
    }

    /// The kernel; `None` where it is zero.
    #[inline(always)]
    fn density(
        &self,
        width: &Width,
        vertex: &Vertex,
        x: DVec3,
        to_light: f64,
        squared_chord: f64,
    ) -> Option<f64> {
        match *width {
            // The chord has been compared with the support.
            Width::Angle(ref kernel) => Some(kernel.density(squared_chord)),
            Width::Radius(distance, radius) => {
                let d = match distance {
                    Distance::Exact => self.exact_distance(vertex)?,
                    Distance::Receiver => (x - vertex.point).length(),
                    Distance::Light => to_light,
                };
                let kernel = AngleKernel::new(self.kernel, libm::atan2(radius, d), None);
                (squared_chord < kernel.support).then(|| kernel.density(squared_chord))
            }
        }
    }

    /// From the vertex along the exact continuation to what it meets first [m].
    fn exact_distance(&self, vertex: &Vertex) -> Option<f64> {
        let (o, d) = (vertex.point, vertex.direction);
        let t = Floor::meet(o, d);
        let landed = self.scene.floor.contains(o.x + d.x * t, o.y + d.y * t);
        let floor = if landed { t } else { f64::INFINITY };
        let surface = self.scene.surface.again(vertex, d);
        let first = if surface < floor { surface } else { floor };
        if first < f64::INFINITY {
            Some(first)
        } else {
            self.diagonal
        }
    }

    /// Sums over a block of paths.
    fn block(
        &self,
        state: &State<L>,
        class: usize,
        x: DVec3,
        part: Option<&Part>,
        u: &[f64],
        v: &[f64],
    ) -> Sums {
        let mut sums = Sums::default();
        let mut add = |sample: f64| {
            sums.sum += sample;
            sums.sum_of_squares += sample * sample;
            sums.nonzero += u64::from(sample > 0.0);
        };
        match part {
            None => {
                for (&u, &v) in u.iter().zip(v) {
                    add(self.sample(state, class, x, u, v));
                }
            }
            // Nothing was found to contribute.
            Some(part) if part.is_empty() => {}
            Some(part) => {
                let share = part.share();
                for (&u, &v) in u.iter().zip(v) {
                    let (u, v) = part.place(u, v);
                    add(share * self.sample(state, class, x, u, v));
                }
            }
        }
        sums
    }

    /// The same photons with another width of the kernel.
    fn widened(&self, state: &State<L>, width: f64) -> State<L> {
        match state {
            State::Camera(_) => State::Camera(self.width(width)),
            State::Light(_, emitters) => State::Light(self.width(width), emitters.clone()),
            State::Merge(_, emitters) => State::Merge(
                RadiusKernel::new(self.kernel, width, None),
                emitters.clone(),
            ),
        }
    }

    fn on_floor(&self, [x, y]: [f64; 2]) -> Option<DVec3> {
        self.scene
            .floor
            .contains(x, y)
            .then(|| DVec3::new(x, y, 0.0))
    }

    fn dimension(&self) -> Dimension {
        if self.technique.starts_at_light() {
            Dimension::Emission
        } else {
            Dimension::Direction
        }
    }

    fn chart(&self) -> Chart {
        match (self.technique.starts_at_light(), L::IS_DISTANT) {
            (false, _) => Chart::Disc,
            (true, false) => Chart::Sphere,
            (true, true) => Chart::Plane,
        }
    }

    /// Lengths of the scene: where the search for the support of a radius begins [m].
    fn widest(&self) -> f64 {
        if self.distance.is_none() && self.technique != Technique::Merge {
            return 1.0;
        }
        let hull = self.scene.floor.hull();
        bounding_box(&hull).map_or(1.0, |[low, high]| 0.5 * (high - low).length())
    }
}

impl Width {
    /// Beyond this squared chord the kernel is zero at every vertex.
    #[inline(always)]
    fn support(&self) -> f64 {
        match self {
            Width::Angle(kernel) => kernel.support,
            Width::Radius(..) => f64::INFINITY,
        }
    }
}

impl<L: Light, S: Chains> Probe for Sampler<L, S> {
    fn flux(&self, bandwidth: f64, [x, y]: [f64; 2]) -> Option<Vec<f64>> {
        match self.state(bandwidth, DVec3::new(x, y, 0.0))? {
            State::Camera(_) => Some(Vec::new()),
            State::Light(_, emitters) | State::Merge(_, emitters) => {
                Some(emitters.iter().map(Emitter::flux).collect())
            }
        }
    }

    fn run(
        &self,
        stream: &Stream,
        paths: u64,
        bandwidth: f64,
        point: [f64; 2],
        aim: Option<&Aim>,
    ) -> Option<Vec<Sums>> {
        let empty = Sums {
            paths,
            ..Sums::default()
        };
        let mut sums = vec![empty; self.chains.len()];
        let Some(x) = self.on_floor(point) else {
            return Some(sums);
        };
        let state = self.state(bandwidth, x)?;
        let (mut u, mut v): (Lanes, Lanes) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            draw(stream, first, self.dimension(), &mut u, &mut v);
            for (class, sums) in sums.iter_mut().enumerate() {
                let part = aim.and_then(|aim| aim.parts.get(class));
                let block = self.block(&state, class, x, part, &u[..live], &v[..live]);
                sums.add(&block);
            }
        }
        Some(sums)
    }

    fn aim(&self, bandwidth: f64, point: [f64; 2]) -> Option<Aim> {
        let Some(x) = self.on_floor(point) else {
            let parts = vec![Part::default(); self.chains.len()];
            return Some(Aim { parts });
        };
        let state = self.state(bandwidth, x)?;
        let part = |class: usize| {
            aim::search(self.chart(), bandwidth, self.widest(), |width| {
                let wide = self.widened(&state, width);
                Box::new(move |u, v| self.sample(&wide, class, x, u, v) > 0.0)
            })
        };
        Some(Aim {
            parts: (0..self.chains.len()).map(part).collect(),
        })
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn draw(stream: &Stream, first: u64, dimension: Dimension, u: &mut Lanes, v: &mut Lanes) {
    stream.pairs(first, dimension, u, v);
}
