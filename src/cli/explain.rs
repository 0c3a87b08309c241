//! `nephroid explain`: what each integrator does about each path class of a scene, and why.

use serde_json::json;

use crate::entry;
use crate::error::Error;
use crate::exit;
use crate::integrators::{Integrator, Technique, Treatment, all, by_name};

/// Show the path classes of a scene, how each integrator samples them, and which are irregular for it.
///
/// A path is irregular for a method if every edge that the method could sample or connect touches a singularity (a point
/// or directional light, a specular surface, the pinhole): it can only be regularized, or not be sampled at all.
#[derive(clap::Args)]
pub struct Args {
    /// A name from `nephroid list`, or a TOML file.
    scene: String,
    /// Only this integrator.
    #[arg(long, value_name = "NAME")]
    integrator: Option<String>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<u8, Error> {
    let entry = entry::load(&args.scene)?;
    let integrators: Vec<Box<dyn Integrator>> = match &args.integrator {
        Some(name) => vec![by_name(name, &Default::default())?],
        None => all(),
    };
    let closure = entry.kind.closure();
    let plans: Vec<_> = integrators.iter().map(|i| (i, i.plan(&entry))).collect();
    if args.json {
        let classes: Vec<_> = plans
            .iter()
            .flat_map(|(integrator, plan)| {
                plan.iter().map(|c| {
                    json!({
                        "integrator": integrator.name(),
                        "class": c.class.to_string(),
                        "irregular": is_irregular(c.treatment),
                        "treatment": treatment(c.treatment),
                        "technique": technique(c.treatment),
                        "reason": c.reason,
                    })
                })
            })
            .collect();
        let answer = json!({
            "schema": "nephroid-explain/1",
            "scene": entry.name,
            "kind": entry.kind.name(),
            "closure": { "longest": closure.longest, "reason": closure.reason },
            "classes": classes,
        });
        super::print(&format!("{answer:#}"));
        return Ok(exit::PASS);
    }
    super::print(&format!(
        "{} ({}): {}",
        entry.name,
        entry.kind.name(),
        entry.title
    ));
    let complete = match closure.longest {
        Some(edges) => format!("complete up to paths of {edges} edges:"),
        None => "complete, paths of any length:".to_owned(),
    };
    super::print(&with_wrapped(&complete, closure.reason));
    for (integrator, plan) in &plans {
        super::print(&format!("\n{}: {}", integrator.name(), integrator.title()));
        for c in plan {
            let facts = format!(
                "  {:<6} {:<9} {:<12} {:<14}",
                c.class,
                if is_irregular(c.treatment) {
                    "irregular"
                } else {
                    "regular"
                },
                treatment(c.treatment),
                technique(c.treatment).unwrap_or("-"),
            );
            super::print(&with_wrapped(&facts, &c.reason));
        }
    }
    Ok(exit::PASS)
}

/// A sentence in a column of its own, to the right of others, broken between words so that no line is longer than 110.
fn with_wrapped(left: &str, sentence: &str) -> String {
    const WIDTH: usize = 110;
    let indent = left.chars().count() + 1;
    let (mut text, mut column) = (left.to_owned(), indent - 1);
    for word in sentence.split_whitespace() {
        let length = word.chars().count();
        if column + 1 + length > WIDTH && column > indent {
            text.push('\n');
            text.push_str(&" ".repeat(indent));
            column = indent;
        } else {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += length;
    }
    text
}

/// Whether the method has no edge to sample or connect without touching a singularity.
fn is_irregular(treatment: Treatment) -> bool {
    // What is connected and merged has connections that touch none.
    let connected = Treatment::Regularized(Technique::ConnectionAndMerging);
    !matches!(treatment, Treatment::Exact(_)) && treatment != connected
}

fn treatment(treatment: Treatment) -> &'static str {
    match treatment {
        Treatment::Exact(_) => "exact",
        Treatment::Regularized(_) => "regularized",
        Treatment::NotSampled => "not_sampled",
    }
}

fn technique(treatment: Treatment) -> Option<&'static str> {
    let (Treatment::Exact(technique) | Treatment::Regularized(technique)) = treatment else {
        return None;
    };
    Some(match technique {
        Technique::NextEvent => "next_event",
        Technique::LightTracing => "light_tracing",
        Technique::Camera => "camera",
        Technique::Merge => "merge",
        Technique::AdaptiveMerge => "adaptive_merge",
        Technique::Connection => "connection",
        Technique::ConnectionAndMerging => "connection_and_merging",
    })
}
