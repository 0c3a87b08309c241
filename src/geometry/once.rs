//! A surface that a ray meets once at most, as chains: direct light where it reaches the floor, and one interaction.

use glam::DVec3;
use nephroid_analytic::class::PathClass;

use super::chains::{Chains, Leg, Vertex, bounding_box};
use super::floor::Floor;
use super::specular::Specular;

/// The surface; what the eye sees through it is no part of this.
#[derive(Clone, Copy, Debug)]
pub struct Once<S>(pub S);

impl<S: Specular> Chains for Once<S> {
    const REFRACTS: bool = S::SEPARATES;
    const MEETS_ITSELF: bool = S::MEETS_ITSELF;

    fn classes(&self) -> &'static [PathClass] {
        match (S::EXISTS, S::SEPARATES) {
            (false, _) => &[PathClass::LDE],
            (true, false) => &[PathClass::LDE, PathClass::LSDE],
            (true, true) => &[PathClass::LSDE],
        }
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let meeting = self.0.meet(origin, direction);
        let met = meeting.t < Floor::meet(origin, direction);
        let direct = self.classes()[chain].light.is_empty();
        match (direct, met) {
            (true, false) => Leg {
                origin,
                direction,
                weight: 1.0,
            },
            (false, true) => Leg {
                origin: meeting.point,
                direction: meeting.direction,
                weight: meeting.weight,
            },
            _ => Leg::DARK,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.0.blocks(origin, direction, t_end)
    }

    /// The floor, or the surface; parallel light through an unbounded one is no catalogue kind.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        let surface = self.0.hull();
        if self.classes()[chain].light.is_empty() || surface.is_empty() {
            floor.to_vec()
        } else {
            surface
        }
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let meeting = self.0.meet(origin, direction);
        let taken = meeting.t < Floor::meet(origin, direction) && meeting.weight > 0.0;
        taken.then(|| Vertex {
            point: meeting.point,
            direction: meeting.direction,
            normal: self.0.normal_after(&meeting),
            weight: meeting.weight,
        })
    }

    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        self.0.again(vertex.point, direction)
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        bounding_box(&self.0.hull())
    }

    fn radiance_gain(&self) -> f64 {
        1.0 / self.0.radiance_scale()
    }
}
