//! Rates: fits on synthetic data of known law, and integrators whose rates are right or wrong on purpose.
//!
//! Every study here shares a level of 1e-6 among its tests, so a false "different" anywhere in this file has a probability below
//! 2e-5 in all; seeds are fixed.

mod bias;
mod commands;
mod converge;
mod fits;
mod regions;
mod schedules;

use libm::sqrt;
use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Integrator, Plan, Prepared, Settings, by_name};
use nephroid_analytic::scene::Entry;

const LEVEL: f64 = 1e-6;

const BANDWIDTHS: [f64; 4] = [0.4, 0.28, 0.2, 0.1];

fn mirror_wall() -> Entry {
    entry::load("mirror-wall").unwrap()
}

fn integrator(name: &str) -> Box<dyn Integrator> {
    by_name(name, &Settings::default()).unwrap()
}

/// A change of what an iteration is asked for.
#[derive(Clone, Copy)]
enum Change {
    /// The bandwidth never falls below this.
    NeverBelow(f64),
    /// The bandwidth of iteration i (from 1) is as for √i.
    HalfTheExponent(f64),
    /// Every iteration draws the random numbers of the first.
    SameNumbers,
    /// Half of the paths, each counted twice.
    HalfThePaths,
}

/// An integrator with a defect of its rate.
struct Changed(Box<dyn Integrator>, Change);

struct PreparedChanged(Box<dyn Prepared>, Change);

impl Integrator for Changed {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn title(&self) -> &'static str {
        self.0.title()
    }

    fn plan(&self, entry: &Entry) -> Plan {
        self.0.plan(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        Box::new(PreparedChanged(self.0.prepare(entry), self.1))
    }
}

impl Prepared for PreparedChanged {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        let (mut iteration, mut drawn, mut bandwidth) = (iteration, paths, bandwidth);
        match self.1 {
            Change::NeverBelow(least) => bandwidth = bandwidth.max(least),
            Change::HalfTheExponent(first) => bandwidth = sqrt(first * bandwidth),
            Change::SameNumbers => iteration = 0,
            Change::HalfThePaths => drawn = paths / 2,
        }
        let scale = paths as f64 / drawn as f64;
        let mut one = Film::new(film.width, film.height, film.classes);
        self.0.iterate(seed, iteration, drawn, bandwidth, &mut one);
        one.layers.iter_mut().flatten().for_each(|v| *v *= scale);
        film.add(&one);
        film.paths += paths - drawn;
    }
}
