//! `nephroid bench`: run time against error.

use std::path::PathBuf;

use serde_json::{Value, json};

use crate::bench::{
    self, BANDWIDTHS, ClassResult, Curve, ITERATIONS, PairResult, REPLICATES, Reached, TARGET,
};
use crate::error::Error;
use crate::integrators::{Integrator, NAMES, Settings, by_name};
use crate::output::write_text;
use crate::{entry, exit};

/// The scenes of a comparison.
const SCENES: [&str; 2] = ["cup", "mirror-wall"];

/// Compare integrators by run time and error.
///
/// For each path class: the CPU seconds until the root mean square error of its pixels is 1 % of its mean, from independent
/// replicates held to the exact image, extrapolated by the law of the error: 1/n, a power of n for shrinking bandwidths, bias and
/// variance as powers of a fixed bandwidth. A regularizing method has the time of its best bandwidth. Pixels that folds cross are left out for all methods. All numbers
/// but the times are the same on any machine.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file. May be repeated. Default: cup and mirror-wall.
    #[arg(long = "scene", value_name = "SCENE")]
    scenes: Vec<String>,
    /// The short name of an integrator. May be repeated. Default: all.
    #[arg(long = "integrator", value_name = "NAME")]
    integrators: Vec<String>,
    /// Seed of the random numbers.
    #[arg(long, value_name = "K", default_value_t = 1)]
    seed: u64,
    /// Also write a plot of error against CPU time.
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let scenes: Vec<&str> = if args.scenes.is_empty() {
        SCENES.to_vec()
    } else {
        args.scenes.iter().map(String::as_str).collect()
    };
    let names: Vec<&str> = if args.integrators.is_empty() {
        NAMES.to_vec()
    } else {
        args.integrators.iter().map(String::as_str).collect()
    };
    let integrators: Vec<Box<dyn Integrator>> = names
        .iter()
        .map(|name| by_name(name, &Settings::default()))
        .collect::<Result<_, _>>()?;
    let entries = scenes
        .iter()
        .map(|scene| entry::load(scene))
        .collect::<Result<Vec<_>, _>>()?;
    let (mut results, mut not_run) = (Vec::new(), Vec::new());
    for entry in entries {
        let subject = bench::Subject::new(entry);
        for integrator in &integrators {
            let reason = match integrator.supports(subject.entry()) {
                Err(reason) => reason,
                Ok(()) => match bench::run(&subject, integrator.as_ref(), args.seed) {
                    Some(result) => {
                        results.push(result);
                        continue;
                    }
                    None => "it samples no path class of this scene".to_owned(),
                },
            };
            not_run.push((subject.entry().name.clone(), integrator.name(), reason));
        }
    }
    if let Some(path) = &args.plot {
        write_text(path, &bench::plot::svg(&results))?;
    }
    if args.json {
        let not_run: Vec<Value> = not_run
            .iter()
            .map(|(scene, integrator, reason)| {
                json!({ "scene": scene, "integrator": integrator, "reason": reason })
            })
            .collect();
        let answer = json!({
            "schema": "nephroid-bench/1", "seed": args.seed, "target": TARGET, "replicates": REPLICATES,
            "iterations": ITERATIONS, "bandwidths": BANDWIDTHS,
            "results": results.iter().map(as_json).collect::<Vec<_>>(), "not_run": not_run,
        });
        super::print(&answer.to_string());
    } else {
        print_table(&results);
        for (scene, integrator, reason) in &not_run {
            super::print(&format!("not run: {scene} with {integrator}: {reason}"));
        }
    }
    Ok(if results.is_empty() {
        exit::NOTHING_RAN
    } else {
        exit::PASS
    })
}

fn print_table(results: &[PairResult]) {
    super::print(&format!(
        "{:<12} {:<10} {:<6} {:>9} {:>10} {:>12} {:>12} {:>22}",
        "scene",
        "integrator",
        "class",
        "bandwidth",
        "Mpaths/s",
        "RMS error",
        "MSE × time",
        "s to 1 %"
    ));
    for result in results {
        for class in &result.classes {
            if let Some(curve) = class.shown() {
                print_row(result, class, curve);
            }
        }
    }
    let crossed: Vec<String> = results
        .iter()
        .filter(|r| r.crossed > 0)
        .map(|r| format!("{} {}", r.scene, r.crossed))
        .fold(Vec::new(), |mut all, text| {
            if !all.contains(&text) {
                all.push(text);
            }
            all
        });
    super::print(&format!(
        "RMS error: over the pixels, relative to the class's mean, after {ITERATIONS} paths per pixel; {REPLICATES} replicates. \
         Times: CPU seconds."
    ));
    if !crossed.is_empty() {
        super::print(&format!(
            "Pixels that folds cross, left out: {}.",
            crossed.join(", ")
        ));
    }
}

fn print_row(result: &PairResult, class: &ClassResult, curve: &Curve) {
    let last = curve.checkpoints.last();
    let error = last.map_or(f64::NAN, |c| c.error);
    let time = f64::from(ITERATIONS) * curve.seconds;
    let reached = match class.reached {
        Reached::After(seconds, None) => format!("{seconds:.3e}"),
        Reached::After(seconds, Some(bandwidth)) => format!("{seconds:.3e} at {bandwidth:.4}"),
        Reached::Unknown => "unknown".to_owned(),
    };
    super::print(&format!(
        "{:<12} {:<10} {:<6} {:>9} {:>10.2} {:>10.2} % {:>12.2e} {:>22}",
        result.scene,
        result.integrator,
        class.class.to_string(),
        curve.bandwidth.map_or("-".to_owned(), |b| b.to_string()),
        result.mpaths_per_cpu_s,
        100.0 * error.sqrt(),
        error * time,
        reached
    ));
}

fn as_json(result: &PairResult) -> Value {
    let curve = |curve: &Curve| {
        let checkpoints: Vec<Value> = curve
            .checkpoints
            .iter()
            .map(|c| {
                json!({
                    "iterations": c.iterations, "relative_mse": c.error, "relative_variance": c.variance,
                    "relative_squared_bias": c.squared_bias, "relative_squared_bias_error": c.bias_error,
                    "cpu_seconds": f64::from(c.iterations) * curve.seconds,
                })
            })
            .collect();
        json!({
            "bandwidth": curve.bandwidth, "checkpoints": checkpoints,
        })
    };
    let classes: Vec<Value> = result
        .classes
        .iter()
        .map(|class| {
            json!({
                "class": class.class.to_string(),
                "time_to_1pct": class.reached.seconds(),
                "bandwidth": class.reached.bandwidth(),
                "curves": class.curves.iter().map(curve).collect::<Vec<_>>(),
            })
        })
        .collect();
    json!({
        "scene": result.scene, "integrator": result.integrator, "mpaths_per_cpu_s": result.mpaths_per_cpu_s,
        "paths_per_iteration": result.paths, "excluded_pixels": result.crossed, "classes": classes,
    })
}
