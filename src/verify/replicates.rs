//! Independent repetitions: how their seeds are made, and how they are run in parallel with the same bits every time.
//!
//! The seed of a replicate is 64 bits of Philox 4x32-10 under the user's seed as key, at the counter (identity, phase,
//! replicate): identity is the 64-bit FNV-1a hash of `scene/integrator`, phase 0 is the final test and 1, 2, … are the pilots.
//! So what else runs, on how many threads and in which order changes no replicate.

use nephroid_analytic::class::PathClass;
use rayon::prelude::*;

use crate::film::{Film, Layers};
use crate::integrators::{Prepared, Run};
use crate::judge::evidence::Replicate;
use crate::regions::Regions;
use crate::stream::philox;

/// The phase of the final test.
pub const FINAL: u32 = 0;

/// Where the replicates of one pair of scene and integrator take their seeds from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seeds {
    seed: u64,
    identity: u64,
}

impl Seeds {
    /// The seeds of a pair under a user's seed.
    pub fn new(seed: u64, scene: &str, integrator: &str) -> Self {
        const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let bytes = scene.bytes().chain([b'/']).chain(integrator.bytes());
        let identity = bytes.fold(OFFSET, |h, b| (h ^ u64::from(b)).wrapping_mul(PRIME));
        Seeds { seed, identity }
    }

    /// The seed of one replicate.
    pub fn replicate(&self, phase: u32, replicate: u32) -> u64 {
        let low_high = |v: u64| [v as u32, (v >> 32) as u32];
        let [a, b] = low_high(self.identity);
        let [low, high, ..] = philox([a, b, phase, replicate], low_high(self.seed));
        u64::from(low) | u64::from(high) << 32
    }
}

/// What a replicate consists of.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Bandwidth of each iteration; one iteration for methods without a photon map.
    pub bandwidths: Vec<f64>,
    /// Paths in each iteration.
    pub paths_per_iteration: u64,
}

impl Shape {
    /// Paths in a replicate.
    pub fn paths(&self) -> u64 {
        self.paths_per_iteration * self.bandwidths.len() as u64
    }
}

/// The film on which replicates are made.
#[derive(Clone, Copy, Debug)]
pub struct Canvas {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The classes of the layers.
    pub classes: &'static [PathClass],
}

/// Runs some replicates of a phase. What a replicate is does not depend on which others are run.
pub fn run(
    prepared: &dyn Prepared,
    canvas: Canvas,
    regions: &Regions,
    shape: &Shape,
    seeds: Seeds,
    phase: u32,
    replicates: core::ops::Range<u32>,
) -> Vec<Replicate> {
    let unread = Layers::default();
    run_without(
        unread, prepared, canvas, regions, shape, seeds, phase, replicates,
    )
}

/// The same, of which some layers will not be read: the others have the same bits.
pub fn run_without(
    unread: Layers,
    prepared: &dyn Prepared,
    canvas: Canvas,
    regions: &Regions,
    shape: &Shape,
    seeds: Seeds,
    phase: u32,
    replicates: core::ops::Range<u32>,
) -> Vec<Replicate> {
    let film = || Film::new(canvas.width, canvas.height, canvas.classes).without(unread);
    replicates
        .into_par_iter()
        .map_init(film, |film, k| {
            film.clear();
            let seed = seeds.replicate(phase, k);
            let mut run = Run::of(prepared);
            for (i, &bandwidth) in (0..).zip(&shape.bandwidths) {
                run.iterate(seed, i, shape.paths_per_iteration, bandwidth, film);
            }
            Replicate::of_film(film, regions)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn seeds_do_not_repeat() {
        let mut seen = HashSet::new();
        for seed in [0, 1, u64::MAX] {
            for (scene, integrator) in [("floor", "pt"), ("floor", "lt"), ("pool", "pt")] {
                let seeds = Seeds::new(seed, scene, integrator);
                for phase in 0..4 {
                    assert!((0..1000).all(|k| seen.insert(seeds.replicate(phase, k))));
                }
            }
        }
    }
}
