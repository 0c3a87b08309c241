//! The connection of a camera path's specular vertex to the light: what technique `camera` mollifies.

use crate::geometry::chains::{Chains, Vertex};
use crate::geometry::light::Light;
use crate::geometry::scene::{Scene, unit};

/// A connection that nothing is in the way of.
#[derive(Clone, Copy, Debug)]
pub(super) struct ToLight {
    /// Squared chord between the exact direction and the one to the light.
    pub(super) squared_chord: f64,
    /// Irradiance normal to that direction [W/m²].
    pub(super) irradiance: f64,
    /// Distance of the light [m]; infinite for parallel light.
    pub(super) distance: f64,
    /// Cosine at the vertex towards the light.
    pub(super) cosine: f64,
}

/// Connects a vertex that a path was traced back to with the light. `None` beyond a squared chord, where the light is
/// on the wrong side, and where a surface is in the way.
#[inline(always)]
pub(super) fn to_light<L: Light, S: Chains>(
    scene: &Scene<L, S>,
    vertex: &Vertex,
    support: f64,
) -> Option<ToLight> {
    let (towards, t_end) = scene.light.towards(vertex.point);
    let direction = unit(towards);
    let difference = vertex.direction - direction;
    let squared_chord = difference.dot(difference);
    let cosine = vertex.normal.dot(direction);
    if !(squared_chord < support && cosine > 0.0) {
        return None;
    }
    if scene.surface.again(vertex, towards) < t_end {
        return None;
    }
    Some(ToLight {
        squared_chord,
        irradiance: scene.light.normal_irradiance(towards),
        distance: t_end * f64::sqrt(towards.dot(towards)),
        cosine,
    })
}
