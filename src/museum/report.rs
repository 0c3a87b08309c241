//! The kill matrix for a terminal, for programs (schema `nephroid-faults/1`) and as a page of the documentation.

use core::fmt::Write as _;

use serde_json::{Value, json};

use super::exhibits::Exhibit;
use super::matrix::{Matrix, Row};

/// Why a row is as it is, where that needs saying.
fn reason(row: &Row) -> String {
    let unkillable = row.exhibit.and_then(|e| e.unkillable);
    match (row.exhibit, unkillable, row.is_as_expected()) {
        (_, Some(reason), true) => reason.to_owned(),
        (Some(_), None, false) => {
            format!(
                "not noticed in {} of {} seeds",
                row.trials.len() - row.noticed(),
                row.trials.len()
            )
        }
        (Some(_), None, true) => String::new(),
        (None, _, true) => String::new(),
        (_, _, false) => "a false alarm".to_owned(),
    }
}

/// For a terminal, without a final newline.
pub fn text(matrix: &Matrix) -> String {
    let mut text = format!(
        "{:<28} {:<22} {:>7} {:>8} {:>8}  noticed as\n",
        "exhibit", "stand", "killed", "paths", "seconds"
    );
    for row in matrix.controls.iter().chain(&matrix.rows) {
        let id = row.exhibit.map_or("(no fault)", |e| e.id);
        let killed = format!("{}/{}", row.noticed(), row.trials.len());
        let by = row
            .trials
            .iter()
            .find(|t| t.noticed)
            .map_or("", |t| t.by.as_str());
        let _ = writeln!(
            text,
            "{id:<28} {:<22} {killed:>7} {:>8.1e} {:>8.1}  {by}",
            row.stand.title(),
            row.worst(|t| t.paths as f64),
            row.worst(|t| t.seconds),
        );
        for line in [row.looks_like().unwrap_or_default(), &reason(row)] {
            if !line.is_empty() {
                let _ = writeln!(text, "    {line}");
            }
        }
    }
    let _ = write!(text, "\n{}", summary(matrix));
    text
}

/// Numbers of exhibits: all, killed; and those that nothing can kill.
fn counts(matrix: &Matrix) -> [usize; 3] {
    let mut ids: Vec<&Exhibit> = Vec::new();
    for exhibit in matrix.rows.iter().filter_map(|r| r.exhibit) {
        if !ids.iter().any(|e| e.id == exhibit.id) {
            ids.push(exhibit);
        }
    }
    let is_killed = |e: &&&Exhibit| {
        let mut of = matrix
            .rows
            .iter()
            .filter(|r| r.exhibit.is_some_and(|x| x.id == e.id));
        e.unkillable.is_none() && of.all(Row::killed)
    };
    let unkillable = ids.iter().filter(|e| e.unkillable.is_some()).count();
    [
        ids.len() - unkillable,
        ids.iter().filter(is_killed).count(),
        unkillable,
    ]
}

fn summary(matrix: &Matrix) -> String {
    let [killable, killed, unkillable] = counts(matrix);
    let alarms = matrix.controls.iter().filter(|r| r.noticed() > 0).count();
    format!(
        "{killed} of {killable} faults noticed at every stand in every one of {} seeds; {unkillable} that no test of means can \
         notice; {} stands without a fault, {alarms} false alarms.\n\
         Margin 1 %, level 1e-6 for a suite of {} checks. Paths and seconds are the most over the seeds, without truths.",
        matrix.seeds,
        matrix.controls.len(),
        matrix.checks,
    )
}

/// For programs.
pub fn json(matrix: &Matrix) -> Value {
    let row = |row: &Row| {
        let worst = row.worst(|t| t.paths as f64);
        let mut value = json!({
            "id": row.exhibit.map(|e| e.id),
            "description": row.exhibit.map(|e| e.description),
            "source": row.exhibit.map(|e| e.source),
            "injection": row.exhibit.map(|e| e.injection),
            "killable": row.exhibit.map(|e| e.unkillable.is_none()),
            "killed": row.killed(),
            "reason": reason(row),
            "looks_like": row.looks_like(),
            "integrator": row.stand.integrator,
            "scene": row.stand.scene,
            "bandwidth": row.stand.bandwidth,
            "check": row.stand.check.word(),
            "noticed_as": row.trials.iter().find(|t| t.noticed).map(|t| &t.by),
            "seeds": row.trials.len(),
            "noticed": row.noticed(),
            "paths": worst as u64,
            "seconds": row.worst(|t| t.seconds),
        });
        if let (Some(accepted), Some(map)) = (row.accepted, value.as_object_mut()) {
            map.insert(
                "accepted_by".to_owned(),
                json!({
                    "pbrt": accepted.pbrt, "mitsuba": accepted.mitsuba, "blender": accepted.blender,
                }),
            );
        }
        value
    };
    json!({
        "schema": "nephroid-faults/1",
        "version": env!("CARGO_PKG_VERSION"),
        "exit_code": matrix.exit_code(),
        "checks": matrix.checks,
        "seeds": matrix.seeds,
        "controls": matrix.controls.iter().map(row).collect::<Vec<_>>(),
        "faults": matrix.rows.iter().map(row).collect::<Vec<_>>(),
    })
}

/// A page of the documentation.
pub fn markdown(matrix: &Matrix, command: &str) -> String {
    let mut page = String::from(HEAD);
    let _ = writeln!(page, "Written by `{command}`.\n\n{}\n", summary(matrix));
    page.push_str(MATRIX);
    for row in &matrix.rows {
        let by = row
            .trials
            .iter()
            .find(|t| t.noticed)
            .map_or("", |t| t.by.as_str());
        let _ = writeln!(
            page,
            "| {} | {} | {}/{} | {:.1e} | {:.1} | {by} | {} |",
            row.exhibit.map_or("", |e| e.id),
            stand(row),
            row.noticed(),
            row.trials.len(),
            row.worst(|t| t.paths as f64),
            row.worst(|t| t.seconds),
            row.looks_like()
                .unwrap_or_default()
                .trim_start_matches("looks like "),
        );
    }
    page.push_str(CONTROLS);
    for row in &matrix.controls {
        let _ = writeln!(
            page,
            "| {} | {}/{} | {:.1e} |",
            stand(row),
            row.noticed(),
            row.trials.len(),
            row.worst(|t| t.paths as f64)
        );
    }
    baselines(matrix, &mut page);
    page.push_str(EXHIBITS);
    let mut last = "";
    for e in matrix.rows.iter().filter_map(|r| r.exhibit) {
        if core::mem::replace(&mut last, e.id) == e.id {
            continue;
        }
        let _ = writeln!(
            page,
            "- **{}**: {} At: {}. Source: {}.",
            e.id, e.description, e.injection, e.source
        );
        if let Some(reason) = e.unkillable {
            let _ = writeln!(page, "  Not noticed by any finite test of means: {reason}.");
        }
    }
    page
}

fn stand(row: &Row) -> String {
    format!("{}, {}", row.stand.title(), row.stand.bandwidth)
}

fn baselines(matrix: &Matrix, page: &mut String) {
    let all = || matrix.controls.iter().chain(&matrix.rows);
    if !all().any(|r| r.accepted.is_some()) {
        return;
    }
    page.push_str(BASELINES);
    let word = |accepts: bool| if accepts { "passes" } else { "fails" };
    for row in all() {
        let Some(accepted) = row.accepted else {
            continue;
        };
        let ours = if row.noticed() > 0 { "fails" } else { "passes" };
        let _ = writeln!(
            page,
            "| {} | {} | {ours} | {} | {} | {} |",
            row.exhibit.map_or("(no fault)", |e| e.id),
            stand(row),
            word(accepted.pbrt),
            word(accepted.mitsuba),
            word(accepted.blender)
        );
    }
    let killable = || {
        let is = |r: &&Row| r.exhibit.is_some_and(|e| e.unkillable.is_none());
        matrix.rows.iter().filter(is)
    };
    let caught = |of: fn(&super::baselines::Accepted) -> bool| {
        killable()
            .filter(|r| r.accepted.as_ref().is_some_and(|a| !of(a)))
            .count()
    };
    let false_alarms = |of: fn(&super::baselines::Accepted) -> bool| {
        let alarm = |r: &&Row| r.accepted.as_ref().is_some_and(|a| !of(a));
        matrix.controls.iter().filter(alarm).count()
    };
    let _ = writeln!(
        page,
        "\nOf {} killable stands: nephroid {}, pbrt-v4's rule {}, Mitsuba 3's rule {}, Blender's rule {}. False alarms at {} stands without a \
         fault: {}, {}, {}, {}.\n",
        killable().count(),
        killable().filter(|r| r.killed()).count(),
        caught(|a| a.pbrt),
        caught(|a| a.mitsuba),
        caught(|a| a.blender),
        matrix.controls.len(),
        matrix.controls.iter().filter(|r| r.noticed() > 0).count(),
        false_alarms(|a| a.pbrt),
        false_alarms(|a| a.mitsuba),
        false_alarms(|a| a.blender),
    );
}

const HEAD: &str = "# The bug museum\n\nDeliberate faults in the reference integrators, each modelled on a public one, and what \
    notices them. A fault is a small change at the point where the code would have it; healthy integrators are compiled \
    without it. A verdict is that of `nephroid verify` at effort `standard`, ended by the first \"different\".\n\n";

const MATRIX: &str = "## Kill matrix\n\nStand: integrator, scene, bandwidth [rad or m] (of no effect where nothing is regularized). Paths and seconds: the most over the \
    seeds, pilots in the seconds, truths and the diagnosis (first seed) not.\n\n\
    | fault | stand | killed | paths | seconds | noticed as (first seed) | looks like |\n\
    | --- | --- | ---: | ---: | ---: | --- | --- |\n";

const CONTROLS: &str =
    "\n## Without a fault\n\n| stand | called different | paths |\n| --- | ---: | ---: |\n";

const BASELINES: &str = "\n## Other acceptance rules on the same faults\n\nThe rules of pbrt-v4's analytic tests (mean within 0.025), Mitsuba 3's render \
    test (z test in each pixel, variance floored at 1e-4, 0.25 % of the pixels tolerated) and Blender's image difference \
    (more than 0.016 of 8-bit pictures in more than 1 % of the pixels), at the number of paths of our verdict with the first seed, up to 256 replicates. Blender's reference is an image without the fault and with the same seed, so that noise \
    repeats: it can tell that something has changed since it was made, not that it was wrong then. A rule is right \
    when it fails a fault and passes a stand without one. See `src/museum/baselines.rs` for sources. These rules have other aims \
    than ours (a reference from the same code, a picture for people); the table says what they see, not what they are worth.\n\n\
    | fault | stand | nephroid | pbrt-v4 | Mitsuba 3 | Blender |\n\
    | --- | --- | --- | --- | --- | --- |\n";

const EXHIBITS: &str = "\n## Exhibits\n\n";
