//! A flat, unbounded water surface with the floor and the camera below it: one refraction on the light's side, none on
//! the eye's.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, UnderwaterScene};

use super::chains::{Chains, Leg, Vertex};
use super::specular::Specular;
use super::water::Water;

/// The surface, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Underwater {
    surface: Water,
    surface_z: f64,
    classes: &'static [PathClass],
}

impl Underwater {
    /// Prepares a validated scene's surface.
    pub fn new(scene: &UnderwaterScene, surface: Water) -> Self {
        Underwater {
            surface,
            surface_z: scene.water.surface_z,
            classes: scene.classes(),
        }
    }
}

impl Chains for Underwater {
    const REFRACTS: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, _: usize, origin: DVec3, direction: DVec3) -> Leg {
        let meeting = self.surface.meet(origin, direction);
        if !(direction.z < 0.0 && meeting.weight > 0.0) {
            return Leg::DARK;
        }
        Leg {
            origin: meeting.point,
            direction: meeting.direction,
            weight: meeting.weight,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let t = (self.surface_z - origin.z) / direction.z;
        (t > 0.0) & (t < t_end)
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let meeting = self.surface.meet(origin, direction);
        (meeting.weight > 0.0).then(|| Vertex {
            point: meeting.point,
            direction: meeting.direction,
            normal: self.surface.normal_after(&meeting),
            weight: meeting.weight,
        })
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn radiance_gain(&self) -> f64 {
        1.0 / self.surface.radiance_scale()
    }

    /// In the air a ray is flatter than the straight line to where it lands, and steeper than the line to the point of the
    /// surface above that.
    fn targets(&self, _: usize, floor: &[DVec3]) -> Vec<DVec3> {
        let raised = floor
            .iter()
            .map(|&corner| DVec3::new(corner.x, corner.y, self.surface_z));
        floor.iter().copied().chain(raised).collect()
    }
}
