//! The chains of every kind that has more than one specular interaction, or whose one interaction is not in `scenes`.

mod ball;
mod cup;
mod glass_pillar;
mod slab;
mod wedge;

use std::sync::Arc;

use super::chain::Chain;
use super::connection::Source;
use super::scenes;
use crate::class::PathClass;
use crate::scene::Kind;
use crate::vector::{Vec3, vec3};

/// Light that reaches the floor along chains.
#[derive(Clone, Debug)]
pub(in crate::bandwidth) struct Chains {
    pub source: Source,
    /// Disjoint families of paths.
    pub families: Vec<Arc<dyn Chain>>,
}

/// The light of a class `L S+ D` by its chains; `None` where there is no such form.
pub(in crate::bandwidth) fn chains(kind: &Kind, class: PathClass) -> Option<Chains> {
    let source = scenes::source(kind)?;
    let interactions = class.light.len() as u32;
    if interactions == 0 {
        return None;
    }
    let families: Vec<Arc<dyn Chain>> = match (kind, source) {
        (Kind::PlanarChains(s), Source::Point(y, intensity)) => [0, 1]
            .into_iter()
            .filter_map(|last| wedge::Wedge::new(&s.wedge, (y, intensity), interactions, last))
            .map(|c| Arc::new(c) as Arc<dyn Chain>)
            .collect(),
        (Kind::GlassSlab(s), Source::Point(y, intensity)) => {
            vec![Arc::new(slab::Slab::new(
                &s.slab,
                (y, intensity),
                interactions,
            ))]
        }
        (Kind::GlassSphere(s), Source::Beam(d, irradiance)) => {
            vec![Arc::new(ball::Ball::new(
                &s.glass,
                (d, irradiance),
                interactions,
            ))]
        }
        (Kind::GlassPillar(s), Source::Beam(d, irradiance)) => {
            vec![Arc::new(glass_pillar::Pillar::new(
                &s.pillar,
                (d, irradiance),
                interactions,
            ))]
        }
        (Kind::ClosedCup(s), Source::Beam(d, irradiance)) => {
            vec![Arc::new(cup::Cup::new(
                &s.wall,
                (d, irradiance),
                interactions,
            ))]
        }
        _ => return None,
    };
    Some(Chains { source, families })
}

/// A unit vector about a frame of three by stereographic projection of the half-space of the last one, |u| ≤ 1; solid angle per
/// parameter area; and what is left to the border.
fn direction(frame: &[Vec3<f64>; 3], u: [f64; 2]) -> (Vec3<f64>, f64, f64) {
    let square = u[0] * u[0] + u[1] * u[1];
    let k = 1.0 / (1.0 + square);
    let [a, b, c] = *frame;
    let d = a * (2.0 * u[0] * k) + b * (2.0 * u[1] * k) + c * ((1.0 - square) * k);
    (d, 4.0 * k * k, 1.0 - square)
}

/// The vertical unit vector.
const UP: Vec3<f64> = vec3(0.0, 0.0, 1.0);
