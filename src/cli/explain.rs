//! `nephroid explain`: what each integrator does about each path class of a scene, and why.

use serde_json::{Value, json};

use crate::entry;
use crate::error::Error;
use crate::exit;
use crate::geometry::tracer::Extent;
use crate::integrators::details::{CompiledScene, Details, Drawn, Reach, Visibility};
use crate::integrators::{ClassPlan, Integrator, Technique, Treatment, all, by_name};

/// Show the path classes of a scene, how each integrator samples them, and which are irregular for it.
///
/// A technique (s, t) traces s vertices from the light and t from the eye, and connects them. A path is irregular for a method
/// if every edge that the method could connect touches a singularity (it ends in a specular vertex, or a light or pinhole
/// without extent would have to be hit): it can only be regularized, or not be sampled at all.
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
    let compiled = CompiledScene::new(&entry);
    let plans: Vec<_> = integrators
        .iter()
        .map(|i| {
            let plan = i.plan(&entry).into_iter();
            let detailed = plan.map(|c| (compiled.details(i.family(), &c), c));
            (i, detailed.collect::<Vec<_>>())
        })
        .collect();
    if args.json {
        let classes: Vec<_> = plans
            .iter()
            .flat_map(|(integrator, plan)| {
                plan.iter().map(|(details, c)| {
                    json!({
                        "integrator": integrator.name(),
                        "class": c.class.to_string(),
                        "irregular": is_irregular(c.treatment),
                        "treatment": treatment(c.treatment),
                        "technique": technique(c.treatment),
                        "reason": c.reason,
                        "techniques": details.techniques.iter().map(drawn_json).collect::<Vec<_>>(),
                        "edges": details.edges.iter().map(|e| {
                            json!({ "ends": e.ends, "singular": e.singular })
                        }).collect::<Vec<_>>(),
                        "mollified_vertex": details.mollified,
                        "emission": details.emission.map(extent_json),
                    })
                })
            })
            .collect();
        let answer = json!({
            "schema": "nephroid-explain/1",
            "scene": entry.name,
            "kind": entry.kind.name(),
            "closure": { "longest": closure.longest, "reason": closure.reason },
            "reach": compiled.reach().iter().map(reach_json).collect::<Vec<_>>(),
            "visibility": compiled.visibility().iter().map(visibility_json).collect::<Vec<_>>(),
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
    print_scene(&compiled);
    for (integrator, plan) in &plans {
        super::print(&format!("\n{}: {}", integrator.name(), integrator.title()));
        for (details, c) in plan {
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
            print_details(details, c);
        }
    }
    Ok(exit::PASS)
}

/// What holds for all methods: what a ray can meet, and where visibility is no question.
fn print_scene(compiled: &CompiledScene) {
    for Reach { from, to } in compiled.reach() {
        let to = if to.is_empty() {
            "nothing".to_owned()
        } else {
            to.join(", ")
        };
        super::print(&format!("from the {from} a ray can meet: {to}"));
    }
    for v in compiled.visibility() {
        let test = if v.tested { "tested" } else { "not tested" };
        let subject = format!("visibility of {}: {test},", v.between);
        super::print(&with_wrapped(&subject, v.reason));
    }
}

/// The edges of an irregular class, and what each technique draws.
fn print_details(details: &Details, class: &ClassPlan) {
    if is_irregular(class.treatment) {
        let edges: Vec<_> = details.edges.iter().map(|e| e.ends.as_str()).collect();
        let subject = format!("{:9}edges {}:", "", edges.join(", "));
        super::print(&with_wrapped(&subject, "a specular vertex at each"));
    }
    for Drawn {
        subpaths,
        densities,
    } in &details.techniques
    {
        let subject = format!("{:9}({}, {})", "", subpaths.light, subpaths.eye);
        super::print(&with_wrapped(&subject, &densities.join("; ")));
    }
}

fn drawn_json(drawn: &Drawn) -> Value {
    json!({ "s": drawn.subpaths.light, "t": drawn.subpaths.eye, "densities": drawn.densities })
}

fn extent_json(extent: Extent) -> Value {
    match extent {
        Extent::SolidAngle(sr) => json!({ "solid_angle": sr }),
        Extent::CrossSection(area) => json!({ "cross_section": area }),
    }
}

fn reach_json(reach: &Reach) -> Value {
    json!({ "from": reach.from, "to": reach.to })
}

fn visibility_json(v: &Visibility) -> Value {
    json!({ "between": v.between, "tested": v.tested, "reason": v.reason })
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
        Technique::Bidirectional => "bidirectional",
        Technique::Camera => "camera",
        Technique::CameraEveryVertex => "camera_every_vertex",
        Technique::Symmetric => "symmetric",
        Technique::Merge => "merge",
        Technique::ManifoldSampling => "manifold_sampling",
        Technique::AdaptiveMerge => "adaptive_merge",
        Technique::Connection => "connection",
        Technique::ConnectionAndMerging => "connection_and_merging",
    })
}
