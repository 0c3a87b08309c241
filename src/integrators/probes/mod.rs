//! Probes: estimators of the irradiance of every class L S+ D at one floor point, without camera and film.
//!
//! What a regularized renderer does at a point, sample by sample, with the densities of the tables of expectations, so that
//! means and second moments can be held to them. Directions and distances at the mollified vertex s, the light y, the floor
//! point x; g is the angle between the exact continuation of the path at s and the connection; n² is 1 where light and
//! floor are in one medium. Samples of a class, of which the mean is its irradiance [W/m²]:
//!
//! | technique | a path | sample |
//! |---|---|---|
//! | `Camera` | direction at x with density cos/π, traced back, s next to the light | π n² w φ(g) E_s |
//! | `Symmetric` | the same | times √(c₂/c₁) where s reflects |
//! | `Light` | photon, s next to the floor | Φ w φ(g) c_x/r₁² |
//! | `Merge` | photon that lands in X on the floor | Φ w k(abs(X - x)) |
//!
//! w is the product of the reflectances and transmittances at the angles of the traced ray, E_s = I/r₂² or E₀ the
//! irradiance at s normal to the light, c₁ and c₂ the cosines at s of the exact path and towards the light, c_x the cosine
//! at x. Photons are uniform over the whole sphere of a point light, Φ = 4π I, and over a cross-section A_b of a
//! directional beam, Φ = A_b E₀ ([`Estimator::flux`]). The mollified connection must leave s on its side of the surface, and
//! nothing may be in its way.
//!
//! With a [`Distance`] the bandwidth is a radius r on the surface, and the kernel at s has the angle atan(r/d).
//!
//! Source: [Kaplanyan & Dachsbacher 2013] for the mollified connection. Random numbers come from (seed, iteration,
//! path) alone: a run has the same bits on any thread.

pub(super) mod aim;
mod sample;
mod sums;

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::error::Error;
use crate::geometry::chains::Chains;
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::once::Once;
use crate::geometry::scene::{Overrides, Scene};
use crate::geometry::specular::Specular;
use crate::stream::Stream;

use super::kernel::Kernel;
use sample::Sampler;

pub use aim::Aim;
pub use sums::Sums;

/// How a probe builds its paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Technique {
    /// From the floor point, mollified next to the light.
    Camera,
    /// The same with the symmetric form of a mollified reflection. At an interface it is `Camera`.
    Symmetric,
    /// From the light, mollified next to the floor.
    Light,
    /// From the light to the floor, within a radius of the point.
    Merge,
}

impl Technique {
    /// All of them.
    pub const ALL: [Technique; 4] = [
        Technique::Camera,
        Technique::Symmetric,
        Technique::Light,
        Technique::Merge,
    ];

    /// The name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Technique::Camera => "camera",
            Technique::Symmetric => "symmetric",
            Technique::Light => "light",
            Technique::Merge => "merge",
        }
    }

    /// Whether paths start at the light.
    pub const fn starts_at_light(self) -> bool {
        matches!(self, Technique::Light | Technique::Merge)
    }
}

/// The distance d that makes an angle atan(r/d) of a radius r, from the mollified vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Distance {
    /// Along the exact continuation of the path, to what it meets first: the clipped floor, or a specular surface. Where
    /// it leaves the scene, the diagonal of the box of all clipped surfaces and point lights; in a scene with an
    /// unbounded surface such a path contributes nothing.
    Exact,
    /// To the floor point, straight.
    Receiver,
    /// To the point light, straight.
    Light,
}

/// An estimator of the irradiance at floor points.
pub struct Estimator {
    classes: Vec<PathClass>,
    linked: bool,
    technique: Technique,
    kernel: Kernel,
    probe: Box<dyn Probe>,
}

/// An estimator for a light and a surface that are known at compile time. Bandwidths have been checked.
trait Probe: Send + Sync {
    fn flux(&self, bandwidth: f64, point: [f64; 2]) -> Option<Vec<f64>>;

    fn run(
        &self,
        stream: &Stream,
        paths: u64,
        bandwidth: f64,
        point: [f64; 2],
        aim: Option<&Aim>,
    ) -> Option<Vec<Sums>>;

    fn aim(&self, bandwidth: f64, point: [f64; 2]) -> Option<Aim>;
}

impl Estimator {
    /// Prepares an estimator for an entry. With a `distance` the bandwidth is a radius, and the technique is not `Merge`.
    ///
    /// # Errors
    /// An entry that does not validate or has no specular surface; a kernel or a distance that does not fit the technique or
    /// the light.
    pub fn new(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        distance: Option<Distance>,
    ) -> Result<Self, Error> {
        Estimator::prepared(entry, technique, kernel, distance, None)
    }

    /// The same for one class alone, which saves the time of the others.
    ///
    /// # Errors
    /// As for [`Self::new`], and a class that is none of its [`Self::classes`].
    pub fn of_class(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        distance: Option<Distance>,
        class: PathClass,
    ) -> Result<Self, Error> {
        Estimator::prepared(entry, technique, kernel, distance, Some(class))
    }

    fn prepared(
        entry: &Entry,
        technique: Technique,
        kernel: Kernel,
        distance: Option<Distance>,
        only: Option<PathClass>,
    ) -> Result<Self, Error> {
        let refused = |key: &str, found: &str, allowed: &str| Error::Parameter {
            file: entry.name.clone(),
            key: key.to_owned(),
            found: found.to_owned(),
            allowed: allowed.to_owned(),
        };
        entry
            .validate()
            .map_err(|e| refused(&e.key, &e.found, &e.allowed))?;
        let fits = match technique {
            Technique::Merge => kernel.is_planar(),
            _ => kernel.is_angular(),
        };
        if !fits {
            let allowed = match technique {
                Technique::Merge => "disc, epanechnikov, biweight, cone",
                _ => "cone, epanechnikov, vmf",
            };
            return Err(refused("kernel", &kernel.to_string(), allowed));
        }
        if technique == Technique::Merge && distance.is_some() {
            let allowed = "none for merge, whose bandwidth is a radius on the floor";
            return Err(refused("distance", &format!("{distance:?}"), allowed));
        }
        let prepare = Prepare {
            technique,
            kernel,
            distance,
            only,
        };
        let (classes, probe) = visit(entry, Overrides::default(), prepare)
            .map_err(|e| refused(e.key, &e.found, &e.allowed))?;
        Ok(Estimator {
            classes,
            linked: distance.is_some(),
            technique,
            kernel,
            probe,
        })
    }

    /// The classes, in the order of all lists here. What the eye sees through a surface is no part of them: for a point of
    /// the floor LSDSE is LSDE.
    pub fn classes(&self) -> &[PathClass] {
        &self.classes
    }

    /// Adds up the samples of `paths` paths at the floor point (x, y, 0), per class. All classes share the random numbers
    /// of a path. A point beside the clipped floor gets no light. `bandwidth` is an angle [rad] at most π, or a radius [m]
    /// with a distance and for `Merge`.
    ///
    /// # Errors
    /// A bandwidth out of range, or one whose kernel reaches a point from an unbounded part of the surface under parallel
    /// light.
    pub fn run(
        &self,
        seed: u64,
        iteration: u32,
        paths: u64,
        bandwidth: f64,
        point: [f64; 2],
    ) -> Result<Vec<Sums>, Error> {
        self.check(bandwidth)?;
        let stream = Stream::new(seed, iteration);
        self.probe
            .run(&stream, paths, bandwidth, point, None)
            .ok_or_else(|| self.unbounded(bandwidth))
    }

    /// The same with the random numbers limited to an aim. Each class's samples are multiplied by its share of the unit square
    /// of random numbers (of the solid angle, or of the cross-section of the beam): means stay, second moments
    /// are multiplied by the share. The aim must have been taken at the same point and a bandwidth that is not smaller.
    ///
    /// # Errors
    /// As for [`Self::run`].
    pub fn run_aimed(
        &self,
        seed: u64,
        iteration: u32,
        paths: u64,
        bandwidth: f64,
        point: [f64; 2],
        aim: &Aim,
    ) -> Result<Vec<Sums>, Error> {
        self.check(bandwidth)?;
        let stream = Stream::new(seed, iteration);
        self.probe
            .run(&stream, paths, bandwidth, point, Some(aim))
            .ok_or_else(|| self.unbounded(bandwidth))
    }

    /// Searches for the random numbers that can contribute at a floor point, per class. See [`Aim`].
    ///
    /// # Errors
    /// As for [`Self::run`], and a kernel without an end.
    pub fn aim(&self, bandwidth: f64, point: [f64; 2]) -> Result<Aim, Error> {
        self.check(bandwidth)?;
        if self.kernel == Kernel::VonMisesFisher {
            return Err(Error::Parameter {
                file: "probe".to_owned(),
                key: "kernel".to_owned(),
                found: self.kernel.to_string(),
                allowed: "cone, epanechnikov: a kernel that ends somewhere".to_owned(),
            });
        }
        self.probe
            .aim(bandwidth, point)
            .ok_or_else(|| self.unbounded(bandwidth))
    }

    /// Flux Φ of the light that photons are drawn from, per class [W]: 4π I, or A_b E₀. `None` for techniques that
    /// start at the floor.
    ///
    /// # Errors
    /// As for [`Self::run`].
    pub fn flux(&self, bandwidth: f64, point: [f64; 2]) -> Result<Option<Vec<f64>>, Error> {
        self.check(bandwidth)?;
        if !self.technique.starts_at_light() {
            return Ok(None);
        }
        let flux = self.probe.flux(bandwidth, point);
        flux.map(Some).ok_or_else(|| self.unbounded(bandwidth))
    }

    fn check(&self, bandwidth: f64) -> Result<(), Error> {
        let is_angle = self.technique != Technique::Merge && !self.linked;
        let (most, allowed) = if is_angle {
            (
                core::f64::consts::PI,
                "an angle greater than 0, at most π [rad]",
            )
        } else {
            (1e9, "a radius greater than 0, at most 1e9 [m]")
        };
        if bandwidth > 0.0 && bandwidth <= most {
            return Ok(());
        }
        Err(Error::Parameter {
            file: "probe".to_owned(),
            key: "bandwidth".to_owned(),
            found: bandwidth.to_string(),
            allowed: allowed.to_owned(),
        })
    }

    fn unbounded(&self, bandwidth: f64) -> Error {
        Error::Parameter {
            file: "probe".to_owned(),
            key: "bandwidth".to_owned(),
            found: format!("{bandwidth} with a {} kernel", self.kernel),
            allowed: "a kernel that reaches the point from a bounded part of the unbounded surface"
                .to_owned(),
        }
    }
}

/// What does not fit a scene.
struct Misfit {
    key: &'static str,
    found: String,
    allowed: String,
}

/// What is prepared once the kind of the scene is known.
struct Prepare {
    technique: Technique,
    kernel: Kernel,
    distance: Option<Distance>,
    only: Option<PathClass>,
}

impl Visitor for Prepare {
    type Output = Result<(Vec<PathClass>, Box<dyn Probe>), Misfit>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Self::Output {
        self.chains(Scene {
            light: scene.light,
            surface: Once(scene.surface),
            floor: scene.floor,
            camera: scene.camera,
        })
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output {
        let mut sampler = Sampler::new(scene, self.technique, self.kernel, self.distance);
        if sampler.classes().is_empty() {
            return Err(Misfit {
                key: "kind",
                found: "a scene without a specular surface".to_owned(),
                allowed: "a scene with one".to_owned(),
            });
        }
        if let Some(class) = self.only {
            let all: Vec<_> = sampler.classes().iter().map(PathClass::to_string).collect();
            sampler.keep(class);
            if sampler.classes().is_empty() {
                return Err(Misfit {
                    key: "class",
                    found: class.to_string(),
                    allowed: all.join(", "),
                });
            }
        }
        if self.distance == Some(Distance::Light) && L::IS_DISTANT {
            return Err(Misfit {
                key: "distance",
                found: "the distance of a directional light".to_owned(),
                allowed: "Exact, Receiver".to_owned(),
            });
        }
        Ok((sampler.classes(), Box::new(sampler)))
    }

    fn furnace(self, _: Furnace) -> Self::Output {
        Err(Misfit {
            key: "kind",
            found: "a scene without a floor".to_owned(),
            allowed: "a scene with a floor and a specular surface".to_owned(),
        })
    }
}
