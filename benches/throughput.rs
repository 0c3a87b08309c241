//! Paths per CPU-second of every integrator on `mirror-wall` (or the scene in `BENCH_SCENE`), one thread:
//! `cargo bench --bench throughput -- [INTEGRATOR]...`.
//!
//! One path of `ppm` is one photon and one camera path. Per integrator: a warm-up, then the median of seven runs, in
//! seconds of CPU time of this thread where the system tells it, of wall time otherwise.

use std::time::Instant;

use nephroid::entry;
use nephroid::film::Film;
use nephroid::integrators::{self, Treatment};

/// Bandwidth: angle [rad] or radius [m].
const BANDWIDTH: f64 = 0.2;
const PATHS: u64 = 1 << 21;
const RUNS: u32 = 7;

/// CPU time of this thread [s], on Linux.
fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

fn main() {
    let scene = std::env::var("BENCH_SCENE").unwrap_or_else(|_| "mirror-wall".to_owned());
    let entry = match entry::load(&scene) {
        Ok(entry) => entry,
        Err(error) => {
            eprintln!("{error}");
            return;
        }
    };
    println!(
        "{scene}: {PATHS} paths a run, bandwidth {BANDWIDTH}, median of {RUNS} runs, one thread"
    );
    let only: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    for integrator in integrators::all() {
        if !only.is_empty() && !only.iter().any(|name| name == integrator.name()) {
            continue;
        }
        let plan = integrator.plan(&entry);
        if plan.iter().all(|c| c.treatment == Treatment::NotSampled) {
            println!(
                "{:<8} samples no path class of this scene",
                integrator.name()
            );
            continue;
        }
        let prepared = integrator.prepare(&entry);
        let mut film = Film::new(
            entry.camera.width,
            entry.camera.height,
            entry.kind.classes(),
        );
        prepared.iterate(1, 0, PATHS, BANDWIDTH, &mut film);
        let mut rates: Vec<f64> = (1..=RUNS)
            .map(|iteration| {
                let (wall, cpu) = (Instant::now(), cpu_seconds());
                prepared.iterate(1, iteration, PATHS, BANDWIDTH, &mut film);
                let cpu = cpu.and_then(|before| Some(cpu_seconds()? - before));
                let seconds = cpu
                    .filter(|&s| s > 0.0)
                    .unwrap_or(wall.elapsed().as_secs_f64());
                PATHS as f64 / seconds * 1e-6
            })
            .collect();
        rates.sort_by(f64::total_cmp);
        println!(
            "{:<8} {:7.1} million paths per CPU-second (slowest {:.1}, fastest {:.1})",
            integrator.name(),
            rates[rates.len() / 2],
            rates[0],
            rates[rates.len() - 1]
        );
    }
}
