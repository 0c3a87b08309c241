//! Truth of catalogue entries: the closed form of a kind, made ready for an entry's parameters.
//!
//! One file per kind. [`FloorTruth`] answers at floor points, per path class that is seen directly there: `LDE` and
//! `L S+ D E`. (The water of a `flat-interface` entry is entered before the floor is seen; its floor carries `LSDE`
//! alone.) For images, a form also tells the light of each class as bundles of rays; see [`crate::flux`].

mod axial;
mod closed_cup;
mod concave_sphere;
mod conic_mirrors;
mod conic_wall;
mod convex_sphere;
mod cylinder_cup;
mod cylinder_lamp;
mod diffuse;
mod flat_interface;
mod furnace;
mod glass_pillar;
mod glass_slab;
mod glass_sphere;
mod paraboloid;
mod pillar;
mod planar_chains;
mod planar_mirror;
mod stigmatic_refractors;
mod strength;
mod underwater;
mod water_waves;

pub use furnace::WallTruth;

use core::fmt::Debug;
use std::sync::Arc;

use crate::class::PathClass;
use crate::flux::Bundle;
use crate::kinds::Estimate;
use crate::kinds::singularity::{Singularity, SingularityKind};
use crate::scene::{Entry, Floor, Kind};

/// The light of one path class at a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointTruth {
    /// The class.
    pub class: PathClass,
    /// Irradiance of the floor, with error bound and number of roots [W/m²].
    pub irradiance: Estimate<f64>,
}

/// Whether a point's irradiance is a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is, with a bound.
    Regular,
    /// The point is on a caustic, to within rounding.
    Singular,
    /// The configuration is stigmatic, and the point is where all rays meet.
    Degenerate,
}

impl State {
    /// The word for it: `regular`, `singular`, `degenerate`.
    pub const fn name(self) -> &'static str {
        match self {
            State::Regular => "regular",
            State::Singular => "singular",
            State::Degenerate => "degenerate",
        }
    }
}

impl PointTruth {
    /// The light of a class.
    pub const fn new(class: PathClass, irradiance: Estimate<f64>) -> Self {
        PointTruth { class, irradiance }
    }

    /// Whether value and bound are numbers.
    pub const fn is_finite(&self) -> bool {
        self.irradiance.value.is_finite() && self.irradiance.error.is_finite()
    }
}

/// The closed form of an entry.
pub trait Form: Debug + Send + Sync {
    /// The light at the floor point (x, y, 0), per class that ends there, in the order of the entry's classes.
    fn at(&self, x: f64, y: f64) -> Vec<PointTruth>;

    /// The singularity nearest to (x, y, 0) of the class with position `index` in [`Self::at`]; `None` where there is none.
    /// Apart from the light, which costs a hundredth of it.
    fn singularity(&self, _x: f64, _y: f64, _index: usize) -> Option<Singularity<f64>> {
        None
    }

    /// The light of each of the entry's classes as bundles of rays that land on the floor and are seen from there
    /// directly, in the order of the classes. `None` where the pixels have a form of their own.
    fn bundles(&self) -> Option<Vec<Vec<Arc<dyn Bundle>>>> {
        None
    }
}

/// The form of a kind that has passed [`Entry::validate`].
pub fn form(kind: &Kind) -> Arc<dyn Form> {
    match kind {
        Kind::Diffuse(s) => Arc::new(diffuse::form(s)),
        Kind::PlanarMirror(s) => Arc::new(planar_mirror::form(s)),
        Kind::CylinderCup(s) => Arc::new(cylinder_cup::form(s)),
        Kind::FlatInterface(s) => Arc::new(flat_interface::form(s)),
        Kind::GlassSlab(s) => Arc::new(glass_slab::form(s)),
        Kind::Pillar(s) => Arc::new(pillar::form(s)),
        Kind::ConicWall(s) => Arc::new(conic_wall::form(s)),
        Kind::GlassPillar(s) => Arc::new(glass_pillar::form(s)),
        Kind::PlanarChains(s) => Arc::new(planar_chains::form(s)),
        Kind::ConcaveSphere(s) => Arc::new(concave_sphere::form(s)),
        Kind::ConvexSphere(s) => Arc::new(convex_sphere::form(s)),
        Kind::Paraboloid(s) => Arc::new(paraboloid::form(s)),
        Kind::ConicMirrors(s) => Arc::new(conic_mirrors::form(s)),
        Kind::Furnace(s) => Arc::new(furnace::form(s)),
        Kind::Underwater(s) => Arc::new(underwater::form(s)),
        Kind::GlassSphere(s) => Arc::new(glass_sphere::form(s)),
        Kind::WaterWaves(s) => Arc::new(water_waves::form(s)),
        Kind::StigmaticRefractors(s) => Arc::new(stigmatic_refractors::form(s)),
        Kind::CylinderLamp(s) => Arc::new(cylinder_lamp::form(s)),
        Kind::ClosedCup(s) => Arc::new(closed_cup::form(s)),
    }
}

/// The closed form of an entry's floor, made ready for many points.
#[derive(Clone, Debug)]
pub struct FloorTruth {
    form: Arc<dyn Form>,
    floor: Floor,
}

impl FloorTruth {
    /// The closed form of an entry that has passed [`Entry::validate`]; `None` for a scene without a floor.
    pub fn new(entry: &Entry) -> Option<Self> {
        Some(FloorTruth {
            form: form(&entry.kind),
            floor: entry.kind.floor()?.clone(),
        })
    }

    /// Albedo ρ of the floor: radiance is ρ E/π.
    pub fn albedo(&self) -> f64 {
        self.floor.albedo
    }

    /// Range of coordinate `axis` (0: x, 1: y) on the floor [m].
    pub fn range(&self, axis: usize) -> [f64; 2] {
        let (c, w) = (self.floor.center[axis], self.floor.half_width[axis]);
        [c - w, c + w]
    }

    /// Whether (x, y) is on the clipped floor.
    pub fn is_on_floor(&self, x: f64, y: f64) -> bool {
        let [cx, cy] = self.floor.center;
        let [wx, wy] = self.floor.half_width;
        f64::abs(x - cx) <= wx && f64::abs(y - cy) <= wy
    }

    /// The light at the floor point (x, y, 0), per class.
    pub fn at(&self, x: f64, y: f64) -> Vec<PointTruth> {
        self.form.at(x, y)
    }

    /// The singularity nearest to the floor point (x, y, 0) of the class with position `index` in [`Self::at`]; `None` where
    /// there is none.
    pub fn singularity(&self, x: f64, y: f64, index: usize) -> Option<Singularity<f64>> {
        self.form.singularity(x, y, index)
    }

    /// Whether the irradiance of a class is a number at (x, y), where `light` is what [`Self::at`] tells at `index`.
    pub fn state(&self, x: f64, y: f64, index: usize, light: &PointTruth) -> State {
        if light.is_finite() {
            return State::Regular;
        }
        match self.singularity(x, y, index) {
            Some(s) if s.kind == SingularityKind::PointFocus => State::Degenerate,
            _ => State::Singular,
        }
    }
}
