//! The light of an entry's floor, class by class, as what a technique can mollify or merge.

use core::f64::consts::PI;
use std::sync::Arc;

use super::Technique;
use super::chart::chains::{Chains, chains};
use super::chart::connection::{Caustic, Source};
use super::chart::link::Receiver;
use super::chart::scenes;
use crate::class::{Chain, PathClass};
use crate::entries;
use crate::flux::Bundle;
use crate::scene::{Entry, InvalidParameter, Kind};

/// Light of one class.
#[derive(Clone, Debug)]
pub(super) struct Class {
    pub class: PathClass,
    /// What is connected through a mollified vertex.
    pub caustics: Vec<Caustic>,
    /// What is connected through the last of several vertices.
    pub chains: Option<Chains>,
    /// What lands on the floor.
    pub bundles: Vec<Arc<dyn Bundle>>,
    /// Flux of all photons [W].
    pub photons: f64,
}

/// What is said of a kind that a technique does not know.
pub(super) fn unknown(kind: &Kind, technique: Technique) -> InvalidParameter {
    InvalidParameter {
        key: "kind".to_owned(),
        found: kind.name().to_owned(),
        allowed: format!(
            "a kind with an expectation at finite bandwidth for the technique {technique}"
        ),
    }
}

/// The floor of a validated entry and the classes that end on it, however they are seen.
///
/// # Errors
/// A kind without a floor, or with a class of which the technique knows nothing.
pub(super) fn of_entry(
    entry: &Entry,
    technique: Technique,
    beam_area: f64,
) -> Result<(Receiver, Vec<Class>), InvalidParameter> {
    let kind = &entry.kind;
    let unknown = || unknown(kind, technique);
    let floor = kind.floor().ok_or_else(unknown)?;
    let receiver = Receiver {
        center: floor.center,
        half_width: floor.half_width,
        z: 0.0,
        size: 1.0,
        escape: scenes::diagonal(kind),
    };
    let mut classes = Vec::new();
    let mut bundles = entries::form(kind).bundles().unwrap_or_default();
    let mut ends: Vec<PathClass> = Vec::new();
    for class in kind.classes() {
        let seen = PathClass {
            eye: Chain::EMPTY,
            ..*class
        };
        if !ends.contains(&seen) {
            ends.push(seen);
        }
    }
    for (position, &class) in ends.iter().enumerate() {
        if class.light.is_empty() {
            continue;
        }
        // Any number of interactions can be merged; what is connected is mollified at one vertex.
        let caustics = scenes::caustics(kind, class, beam_area);
        let (bundles, chains) = match (bundles.get_mut(position), &caustics) {
            (Some(b), None) if technique == Technique::Merge => (core::mem::take(b), None),
            (_, None) if technique != Technique::Merge => (Vec::new(), chains(kind, class)),
            _ => (Vec::new(), None),
        };
        let caustics = caustics.unwrap_or_default();
        if caustics.is_empty() && bundles.is_empty() && chains.is_none() {
            return Err(unknown());
        }
        classes.push(Class {
            class,
            caustics,
            chains,
            bundles,
            photons: scenes::photons(kind, beam_area).ok_or_else(unknown)?,
        });
    }
    Ok((receiver, classes))
}

/// An unbounded receiver at a height, and the one class of light on it.
pub(super) fn unbounded(caustics: Vec<Caustic>, z: f64) -> (Receiver, Class) {
    let receiver = Receiver {
        center: [0.0; 2],
        half_width: [f64::INFINITY; 2],
        z,
        size: 1.0,
        escape: None,
    };
    let class = Class {
        class: PathClass::LSDE,
        photons: caustics.first().map_or(0.0, |c| c.photons),
        caustics,
        chains: None,
        bundles: Vec::new(),
    };
    (receiver, class)
}

/// The flux of the photons of a source [W].
pub(super) fn photons(source: &Source, beam_area: f64) -> f64 {
    match source {
        Source::Point(_, intensity) => 4.0 * PI * intensity,
        Source::Beam(_, irradiance) => irradiance * beam_area,
    }
}
