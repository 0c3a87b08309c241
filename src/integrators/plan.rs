//! What the methods have in common in their plans.

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

use super::kernel::Kernel;
use super::sampleable::{Family, Subpaths, mollified_vertex, possible};
use super::settings::Settings;
use super::{ClassPlan, Plan, Technique, Treatment};

/// A plan from what is done about each of the scene's classes.
pub(super) fn plan_of(entry: &Entry, of: impl Fn(PathClass) -> ClassPlan) -> Plan {
    entry
        .kind
        .classes()
        .iter()
        .map(|&class| of(class))
        .collect()
}

/// The plan for a class that next event estimation samples.
pub(super) fn next_event_plan(class: PathClass) -> Option<ClassPlan> {
    let reason = match class {
        PathClass::LDE => "next event estimation at the floor point seen in the pixel",
        PathClass::LDSE => {
            "next event estimation at the floor point seen through the specular surface, traced exactly"
        }
        _ => return None,
    };
    Some(ClassPlan {
        class,
        treatment: Treatment::Exact(Technique::NextEvent),
        reason: reason.to_owned(),
    })
}

/// The plan for a class of bidirectional path tracing; what no technique can build is mollified with a kernel, if there is
/// one.
pub(super) fn bidirectional_plan(
    class: PathClass,
    kernel: Option<Kernel>,
    settings: &Settings,
) -> ClassPlan {
    let family = Family::Bidirectional;
    let techniques = possible(class, family, None);
    let words = |techniques: &[Subpaths]| {
        let word = |t: &Subpaths| format!("({}, {})", t.light, t.eye);
        let words: Vec<_> = techniques.iter().map(word).collect();
        words.join(", ")
    };
    let heuristic = settings.heuristic;
    let exact = |technique, reason| ClassPlan {
        class,
        treatment: Treatment::Exact(technique),
        reason,
    };
    match (
        techniques.as_slice(),
        mollified_vertex(class, family),
        kernel,
    ) {
        ([], Some(vertex), Some(kernel)) => {
            let techniques = possible(class, family, Some(vertex));
            let combined = match settings.side {
                None => format!("combined by the {heuristic} heuristic"),
                Some(side) => format!("the {side} side's alone"),
            };
            ClassPlan {
                class,
                treatment: Treatment::Regularized(Technique::Symmetric),
                reason: format!(
                    "irregular: every connection ends in a specular vertex; {kernel} kernel on the angle at the one next to                      the light, the same symmetric value for (s, t) = {}, {combined}",
                    words(&techniques)
                ),
            }
        }
        ([], ..) => not_sampled(
            class,
            "irregular: every connection of a light subpath with a camera subpath ends in a specular vertex",
        ),
        ([only], ..) if only.light == 1 => exact(
            Technique::NextEvent,
            format!(
                "only (s, t) = {} has no specular vertex at its connection: next event estimation, weight 1",
                words(&techniques)
            ),
        ),
        ([only], ..) if only.eye == 1 => exact(
            Technique::LightTracing,
            format!(
                "only (s, t) = {} has no specular vertex at its connection: light tracing, weight 1",
                words(&techniques)
            ),
        ),
        _ => exact(
            Technique::Bidirectional,
            format!(
                "(s, t) = {}, combined by the {heuristic} heuristic",
                words(&techniques)
            ),
        ),
    }
}

/// The plan for a class that the method cannot build.
pub(super) fn not_sampled(class: PathClass, reason: &str) -> ClassPlan {
    ClassPlan {
        class,
        treatment: Treatment::NotSampled,
        reason: reason.to_owned(),
    }
}

/// The plan for light that bounces between diffuse walls.
pub(super) fn walk_plan(class: PathClass, technique: Technique) -> ClassPlan {
    let end = match technique {
        Technique::LightTracing => "connected to the pinhole from its last one",
        _ => "with next event estimation at its last one",
    };
    ClassPlan {
        class,
        treatment: Treatment::Exact(technique),
        reason: format!(
            "a walk of {} diffuse vertices by the cosine law, {end}",
            class.diffuse
        ),
    }
}
