//! For programs: schemas `nephroid-verify/1` and `nephroid-gate/1`, the same but for the settings.

use serde_json::{Value, json};

use crate::verify::verdicts::{Outcome, Verdict};

/// The whole answer.
pub fn outcome(o: &Outcome) -> Value {
    let verdicts: Vec<_> = o.verdicts.iter().map(verdict).collect();
    let not_run: Vec<_> = o
        .not_run
        .iter()
        .map(|n| json!({ "scene": n.scene, "integrator": n.integrator, "reason": n.reason }))
        .collect();
    json!({
        "schema": format!("nephroid-{}/1", o.program.name()),
        "version": env!("CARGO_PKG_VERSION"),
        "effort": o.effort.map(|e| e.to_string()),
        "seed": o.seed,
        "bandwidth": o.bandwidth,
        "margin": o.margin,
        "level": o.level,
        "equivalence_level": o.equivalence_level,
        "checks": o.checks,
        "exit_code": o.exit_code(),
        "seconds": o.seconds,
        "verdicts": verdicts,
        "not_run": not_run,
        "notes": o.notes,
    })
}

/// One verdict. `level` is this check's share of the suite's.
fn verdict(v: &Verdict) -> Value {
    let f = &v.finding;
    json!({
        "scene": v.scene,
        "variation": v.variation,
        "integrator": v.integrator,
        "class": v.class,
        "region": v.region,
        "state": f.state,
        "effect": f.effect,
        "interval": f.interval,
        "margin": v.margin,
        "level": v.levels.different,
        "equivalence_level": v.levels.equivalent,
        "power": f.power,
        "minimum_detectable_bias": f.minimum_detectable_bias,
        "p_different": f.p_different,
        "p_equivalent": f.p_equivalent,
        "bias_established": f.bias_established,
        "mean": v.mean,
        "truth": v.truth.map(|t| t.value),
        "truth_error_bound": v.truth.map(|t| t.error),
        "bandwidth": v.bandwidth,
        "tiles": f.tiles,
        "excluded": v.excluded.map(|e| json!({ "pixels": e.pixels, "energy": e.energy })),
        "tail_index": v.tail.map(|t| json!({
            "index": t.index, "standard_error": t.error, "stable": t.is_stable,
        })),
        "replicates": v.replicates,
        "looks": v.looks,
        "paths": v.paths,
        "paths_needed": v.paths_needed,
        "seed": v.seed,
        "seconds": v.seconds,
        "reason": f.reason,
        "looks_like": v.looks_like,
        "command": v.command,
    })
}
