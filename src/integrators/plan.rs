//! What the methods have in common in their plans.

use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::Entry;

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
