//! A scene as specular manifold sampling sees it, whatever its light and surface: an object-safe interface, one call for
//! a camera ray or a solution. The walks between them cost a hundred times as much.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use crate::geometry::chains::{Chains, Vertex};
use crate::geometry::compiled::{Visitor, visit};
use crate::geometry::furnace::Furnace;
use crate::geometry::light::Light;
use crate::geometry::once::Once;
use crate::geometry::pinhole::Pinhole;
use crate::geometry::scene::{Overrides, Scene};
use crate::geometry::specular::Specular;

use super::chains::{direct_radiance, seen_vertex};
use super::connection::{ToLight, to_light};
use super::defect::Defect;
use super::manifold_walk::Source;

/// A floor point that a camera ray ends in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    /// The point [m].
    pub vertex: DVec3,
    /// What radiance that leaves it is multiplied by on its way to the film.
    pub weight: f64,
    /// Whether it is seen through the specular surface.
    pub via: bool,
}

/// A scene.
pub(super) trait Stage: Send + Sync {
    /// The camera.
    fn camera(&self) -> &Pinhole;

    /// The floor's BSDF [1/sr].
    fn bsdf(&self) -> f64;

    /// The classes of light on the floor, one for each chain.
    fn classes(&self) -> &'static [PathClass];

    /// Where the light is.
    fn source(&self) -> Source;

    /// What radiance is multiplied by on its way from the light to the floor, apart from weights.
    fn gain(&self) -> f64;

    /// Where a camera ray ends.
    fn seen(&self, direction: DVec3) -> Option<Seen>;

    /// Radiance that direct light leaves a floor point with [W m⁻² sr⁻¹].
    fn direct(&self, defect: &Defect, vertex: DVec3) -> f64;

    /// What a ray from the floor meets first on a chain, and its connection to the light if nothing is in the way and the
    /// squared chord between it and the exact continuation is below a bound.
    fn connected(
        &self,
        chain: usize,
        x: DVec3,
        direction: DVec3,
        squared_chord: f64,
    ) -> Option<(Vertex, ToLight)>;
}

fn source<L: Light>(light: &L) -> Source {
    match light.position() {
        Some(position) => Source::Point(position),
        None => Source::Distant(light.towards(DVec3::ZERO).0),
    }
}

/// A floor that is seen directly.
pub(super) struct Open<L, S>(pub Scene<L, S>);

impl<L: Light, S: Chains> Stage for Open<L, S> {
    fn camera(&self) -> &Pinhole {
        &self.0.camera
    }

    fn bsdf(&self) -> f64 {
        self.0.floor.bsdf
    }

    fn classes(&self) -> &'static [PathClass] {
        self.0.surface.classes()
    }

    fn source(&self) -> Source {
        source(&self.0.light)
    }

    fn gain(&self) -> f64 {
        self.0.surface.radiance_gain()
    }

    fn seen(&self, direction: DVec3) -> Option<Seen> {
        let vertex = seen_vertex(&self.0, direction)?;
        Some(Seen {
            vertex,
            weight: 1.0,
            via: false,
        })
    }

    fn direct(&self, defect: &Defect, vertex: DVec3) -> f64 {
        direct_radiance(&self.0, defect, vertex)
    }

    fn connected(
        &self,
        chain: usize,
        x: DVec3,
        direction: DVec3,
        squared_chord: f64,
    ) -> Option<(Vertex, ToLight)> {
        let vertex = self.0.surface.trace_back(chain, x, direction)?;
        let light = to_light(&self.0, &vertex, squared_chord)?;
        Some((vertex, light))
    }
}

/// A floor that is seen through the surface as well.
pub(super) struct Mirrored<L, S> {
    scene: Scene<L, S>,
    floor: Open<L, Once<S>>,
}

impl<L: Light, S: Specular> Mirrored<L, S> {
    pub fn new(scene: Scene<L, S>) -> Self {
        let floor = Open(Scene {
            light: scene.light,
            surface: Once(scene.surface),
            floor: scene.floor,
            camera: scene.camera,
        });
        Mirrored { scene, floor }
    }
}

impl<L: Light, S: Specular> Stage for Mirrored<L, S> {
    fn camera(&self) -> &Pinhole {
        &self.scene.camera
    }

    fn bsdf(&self) -> f64 {
        self.scene.floor.bsdf
    }

    fn classes(&self) -> &'static [PathClass] {
        self.floor.classes()
    }

    fn source(&self) -> Source {
        self.floor.source()
    }

    fn gain(&self) -> f64 {
        self.floor.gain()
    }

    fn seen(&self, direction: DVec3) -> Option<Seen> {
        let landing = self.scene.landing(self.scene.camera.position, direction);
        let through = self.scene.surface.radiance_scale();
        (landing.weight > 0.0).then(|| Seen {
            vertex: DVec3::new(landing.x, landing.y, 0.0),
            weight: landing.weight * if landing.via { through } else { 1.0 },
            via: landing.via,
        })
    }

    fn direct(&self, defect: &Defect, vertex: DVec3) -> f64 {
        self.floor.direct(defect, vertex)
    }

    fn connected(
        &self,
        chain: usize,
        x: DVec3,
        direction: DVec3,
        squared_chord: f64,
    ) -> Option<(Vertex, ToLight)> {
        self.floor.connected(chain, x, direction, squared_chord)
    }
}

/// Where camera rays end on the floor, for what judges images.
pub struct Sight(Box<dyn Stage>);

impl Sight {
    /// The sight of a validated entry; `None` without a floor.
    pub fn new(entry: &Entry) -> Option<Self> {
        visit(entry, Overrides::default(), Look).map(Sight)
    }

    /// The floor point (x, y) [m] that is seen at a film position (columns from the left, rows from the top), and whether
    /// it is seen through the specular surface.
    pub fn floor_point(&self, column: f64, row: f64) -> Option<([f64; 2], bool)> {
        let seen = self.0.seen(self.0.camera().direction(column, row))?;
        Some(([seen.vertex.x, seen.vertex.y], seen.via))
    }
}

struct Look;

impl Visitor for Look {
    type Output = Option<Box<dyn Stage>>;

    fn scene<L: Light, S: Specular>(self, scene: Scene<L, S>) -> Self::Output {
        Some(Box::new(Mirrored::new(scene)))
    }

    fn chains<L: Light, S: Chains>(self, scene: Scene<L, S>) -> Self::Output {
        Some(Box::new(Open(scene)))
    }

    fn furnace(self, _: Furnace) -> Self::Output {
        None
    }
}
