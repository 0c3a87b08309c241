//! `sms`: specular manifold sampling, the unbiased competitor [Zeltner, Georgiev & Jakob 2020, "Specular manifold sampling
//! for rendering high-frequency caustics and glints"].
//!
//! At the floor point a walk starts from a random point of the specular surface and ends, if it does, in one of the
//! solutions k of the specular constraint, with a probability p_k that nobody knows. Its irradiance
//!
//! E_k = w n² E_s c_x c₁ c₂/(r₁² |det H|)
//!
//! (see [`super::manifold_walk`]; w reflectance or transmittance, E_s the irradiance at s normal to the light, c_x the cosine
//! at the floor) is divided by p_k through N, the number of further walks until one ends in k again: E N = 1/p_k. The mean
//! is Σ_k p_k E_k/p_k. A path takes as many further walks, on average, as there are solutions that light comes from: the sum
//! of p_k/p_k. There is no bound on N, and no clamp on E_k, which grows without bound towards a fold: within pixels that
//! folds cross the variance is infinite.

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Entry, Kind};

use crate::film::Film;
use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::manifold::{Surface, surface};
use crate::geometry::scene::{Scene, unit};
use crate::geometry::specular::Specular;
use crate::stream::{BLOCK, Dimension, Lanes, Stream, zeros};
use glam::DVec3;

use super::camera_paths::add;
use super::defect::Defect;
use super::deviation::Deviation;
use super::furnace::CameraWalks;
use super::manifold_defect::ManifoldDefect;
use super::manifold_walk::{Ends, Solution, walk};
use super::plan::{next_event_plan, not_sampled, plan_of, walk_plan};
use super::settings::Settings;
use super::stage::{Mirrored, Open, Seen, Stage};
use super::{ClassPlan, Integrator, Plan, Prepared, Technique, Treatment};

/// Specular manifold sampling.
pub struct Sms {
    settings: Settings,
}

impl Sms {
    /// The method; the kernel is ignored.
    pub fn new(settings: Settings) -> Self {
        Sms { settings }
    }
}

impl Integrator for Sms {
    fn name(&self) -> &'static str {
        "sms"
    }

    fn title(&self) -> &'static str {
        "specular manifold sampling: Newton's method from random starts, unbiased reciprocal probabilities"
    }

    fn plan(&self, entry: &Entry) -> Plan {
        let walks = surface(entry).is_some();
        plan_of(entry, |class| {
            if class.diffuse > 1 {
                return walk_plan(class, Technique::NextEvent);
            }
            if let Some(plan) = next_event_plan(class) {
                return plan;
            }
            if !walks || class.light.len() > 1 {
                return not_sampled(
                    class,
                    "a walk over several specular vertices at once; only single interactions next to the light are \
                     walked on",
                );
            }
            ClassPlan {
                class,
                treatment: Treatment::Exact(Technique::ManifoldSampling),
                reason: "Newton's method on the specular constraint, from points drawn on the specular surface; the \
                         reciprocal of a solution's probability is the number of further walks until one finds it again"
                    .to_owned(),
            }
        })
    }

    fn is_dear(&self, entry: &Entry) -> bool {
        !matches!(
            entry.kind,
            Kind::Diffuse(_) | Kind::PlanarMirror(_) | Kind::FlatInterface(_)
        )
    }

    fn has_infinite_variance_at_folds(&self) -> bool {
        true
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        let defect = Defect::new(self.settings.fault);
        let overrides = defect.overrides();
        let prepare = Prepare {
            surface: surface(entry),
            settings: self.settings,
        };
        visit(entry, overrides, prepare)
    }
}

/// What is prepared once the kind of the scene is known.
struct Prepare {
    surface: Option<Surface>,
    settings: Settings,
}

impl Prepare {
    fn on(self, stage: Box<dyn Stage>) -> Box<dyn Prepared> {
        let single = |(chain, class): (usize, &PathClass)| {
            (class.is_caustic() && class.light.len() == 1).then_some(chain)
        };
        let chain = stage.classes().iter().enumerate().find_map(single);
        let fault = self.settings.fault;
        Box::new(PreparedSms {
            caustic: chain.zip(self.surface),
            stage,
            defect: Defect::new(fault),
            deviation: ManifoldDefect::new(fault),
        })
    }
}

impl Visitor for Prepare {
    type Output = Box<dyn Prepared>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        self.on(Box::new(Mirrored::new(scene)))
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Box<dyn Prepared> {
        self.on(Box::new(Open(scene)))
    }

    fn furnace(self, scene: Furnace) -> Box<dyn Prepared> {
        Box::new(CameraWalks::new(scene, Defect::new(self.settings.fault)))
    }
}

struct PreparedSms {
    stage: Box<dyn Stage>,
    /// The chain with one interaction, and the surface that it is on.
    caustic: Option<(usize, Surface)>,
    defect: Defect,
    deviation: ManifoldDefect,
}

/// Directions to a solution and from it to the light agree to this, squared: rounding of a walk's end, magnified.
const AGREES: f64 = 1e-12;

impl PreparedSms {
    /// The film layers of light that comes directly and by the chain, seen directly and through the surface.
    fn layers(&self, film: &Film) -> [[Option<usize>; 2]; 2] {
        let seen = |class: PathClass| {
            let through = PathClass {
                eye: PathClass::LDSE.eye,
                ..class
            };
            [film.layer_of(class), film.layer_of(through)]
        };
        let caustic = self
            .caustic
            .as_ref()
            .map_or([None; 2], |&(chain, _)| seen(self.stage.classes()[chain]));
        [seen(PathClass::LDE), caustic]
    }

    /// Irradiance of a solution [W/m²]; 0 if no light takes that way.
    fn irradiance(&self, chain: usize, ends: &Ends, solution: &Solution) -> f64 {
        let direction = unit(solution.point - ends.x);
        let agrees = self.deviation.agrees(AGREES);
        let connected = self.stage.connected(chain, ends.x, direction, agrees);
        let Some((vertex, light)) = connected else {
            return 0.0;
        };
        let apart = vertex.point - solution.point;
        if apart.dot(apart) > agrees * solution.distance * solution.distance {
            return 0.0;
        }
        let squared = solution.distance * solution.distance;
        let first = f64::abs(vertex.normal.dot(direction));
        let jacobian = self.deviation.jacobian(
            first / squared,
            light.cosine / f64::abs(solution.determinant),
            light.distance,
        );
        vertex.weight * light.irradiance * self.stage.gain() * direction.z * jacobian
    }

    /// An estimate of the irradiance of the chain at a floor point.
    fn sample(&self, chain: usize, surface: &Surface, x: DVec3, stream: &Stream, path: u64) -> f64 {
        let ends = Ends {
            x,
            source: self.stage.source(),
            index: surface.index,
        };
        let precision = self.deviation.precision();
        let find = |trial: u64| {
            let (u, v) = stream.trial(path, trial);
            // One number picks the part, and the point with its later digits.
            let parts = surface.parts.len();
            let u = u * parts as f64;
            let part = (u as usize).min(parts - 1);
            let manifold = surface.parts[part].as_ref();
            let start = manifold.start(x, u - part as f64, v);
            walk(manifold, &ends, start, precision)
        };
        if let Some(walks) = self.deviation.fixed_walks() {
            return self.distinct(chain, &ends, (0..walks).filter_map(find));
        }
        let Some(solution) = find(0) else {
            return 0.0;
        };
        let irradiance = self.irradiance(chain, &ends, &solution);
        if irradiance == 0.0 {
            return 0.0;
        }
        // Until the same solution is found again.
        let mut walks = 1;
        while !find(walks).is_some_and(|other| self.deviation.same(x, &solution, &other, precision))
        {
            if self.deviation.gives_up(walks) {
                return 0.0;
            }
            walks += 1;
        }
        irradiance * self.deviation.reciprocal(walks)
    }

    /// The biased variant: what different solutions of a fixed number of walks bring.
    fn distinct(&self, chain: usize, ends: &Ends, found: impl Iterator<Item = Solution>) -> f64 {
        let precision = self.deviation.precision();
        let mut solutions: Vec<Solution> = Vec::new();
        for new in found {
            if !solutions.iter().any(|old| old.is(&new, precision)) {
                solutions.push(new);
            }
        }
        solutions
            .iter()
            .map(|s| self.irradiance(chain, ends, s))
            .sum()
    }
}

impl Prepared for PreparedSms {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, _bandwidth: f64, film: &mut Film) {
        film.paths += paths;
        let stage = self.stage.as_ref();
        let [direct, caustic] = self.layers(film);
        let camera = stage.camera();
        let (columns, rows) = camera.size();
        let pixels = camera.pixels();
        let (seed, iteration) = self.defect.address(seed, iteration);
        let stream = Stream::new(seed, iteration);
        let (mut u, mut v): (Lanes, Lanes) = (zeros(), zeros());
        for first in (0..paths).step_by(BLOCK) {
            let live = (paths - first).min(BLOCK as u64) as usize;
            stream.pairs(first, Dimension::Film, &mut u, &mut v);
            for (path, (&u, &v)) in (first..).zip(u.iter().zip(&v)).take(live) {
                let (column, row) = (u * columns, v * rows);
                let seen = stage.seen(camera.direction(column, row));
                let Some(Seen {
                    vertex,
                    weight,
                    via,
                }) = seen
                else {
                    continue;
                };
                let mut splat = |layer: Option<usize>, radiance: f64| {
                    if let (Some(layer), true) = (layer, radiance > 0.0) {
                        add(film, layer, column, row, pixels * weight * radiance);
                        film.nonzero[layer] += 1;
                    }
                };
                let side = usize::from(via);
                if direct[side].is_some() {
                    splat(direct[side], stage.direct(&self.defect, vertex));
                }
                if let (Some((chain, surface)), Some(layer)) = (&self.caustic, caustic[side]) {
                    let irradiance = self.sample(*chain, surface, vertex, &stream, path);
                    splat(Some(layer), stage.bsdf() * irradiance);
                }
            }
        }
    }
}
