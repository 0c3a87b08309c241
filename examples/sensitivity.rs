//! How fast a small bias is established, and how fast its absence: light tracing made brighter by a known factor.
//!
//! ```text
//! cargo run --release --example sensitivity
//! ```
//!
//! A method of one's own is a type with the two traits [`Integrator`] and [`Prepared`]: here one that wraps another.

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{Integrator, Plan, Prepared, Schedule, Settings, by_name};
use nephroid::judge::hypotheses::LEVEL;
use nephroid::verify::effort::Effort;
use nephroid::verify::expected::Truths;
use nephroid::verify::run::{Request, run};
use nephroid::verify::suite::{Coverage, Subject};
use nephroid_analytic::scene::Entry;

/// A method whose light is too bright by a factor.
struct Brighter(Box<dyn Integrator>, f64);

struct BrighterPrepared(Box<dyn Prepared>, f64);

impl Integrator for Brighter {
    fn name(&self) -> &'static str {
        self.0.name()
    }

    fn title(&self) -> &'static str {
        self.0.title()
    }

    fn plan(&self, entry: &Entry) -> Plan {
        self.0.plan(entry)
    }

    fn schedule(&self, bandwidth: f64) -> Schedule {
        self.0.schedule(bandwidth)
    }

    fn supports(&self, entry: &Entry) -> Result<(), String> {
        self.0.supports(entry)
    }

    fn prepare(&self, entry: &Entry) -> Box<dyn Prepared> {
        Box::new(BrighterPrepared(self.0.prepare(entry), self.1))
    }
}

impl Prepared for BrighterPrepared {
    fn iterate(&self, seed: u64, iteration: u32, paths: u64, bandwidth: f64, film: &mut Film) {
        self.0.iterate(seed, iteration, paths, bandwidth, film);
        for layer in &mut film.layers {
            layer.iter_mut().for_each(|v| *v *= self.1);
        }
    }
}

fn main() -> Result<(), nephroid::error::Error> {
    println!(
        "scene        lt too bright by  margin  class  state        bias      paths    seconds"
    );
    for scene in ["mirror-wall", "cup"] {
        for (bias, margin) in [(0.01, 0.005), (0.002, 0.001), (0.0, 0.005)] {
            let mut truths = Truths::for_margin(margin);
            let request = Request {
                scenes: vec![Subject {
                    argument: scene.to_owned(),
                    entry: entry::load(scene)?,
                }],
                integrators: vec![Box::new(Brighter(
                    by_name("lt", &Settings::default())?,
                    1.0 + bias,
                ))],
                left_out: Vec::new(),
                effort: Effort::Standard,
                coverage: Coverage::Everything,
                margin,
                level: LEVEL,
                checks: None,
                most_paths: Effort::Standard.most_paths(),
                variations: false,
                seed: 1,
                bandwidth: 0.2,
                kernel: None,
                mask: None,
            };
            let outcome = run(&request, &mut truths, &|_, _, _, _| {})?;
            for v in outcome
                .verdicts
                .iter()
                .filter(|v| v.finding.effect.is_some())
            {
                println!(
                    "{scene:<12} {:>14.1} % {:>6.1} %  {:<6} {:<12} {:>+6.2} % {:>9.1e} {:>9.2}",
                    100.0 * bias,
                    100.0 * margin,
                    v.class,
                    v.finding.state.word(),
                    100.0 * v.finding.effect.unwrap_or(f64::NAN),
                    v.paths as f64,
                    v.seconds,
                );
            }
        }
    }
    Ok(())
}
