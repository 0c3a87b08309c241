//! Faults of specular manifold sampling.

use super::{Exhibit, on};
use crate::integrators::Fault;

pub(super) const EXHIBITS: &[Exhibit] = &[
    Exhibit::new(
        "manifold-jacobian-clamped",
        Fault::ManifoldJacobianClamped,
        "The Jacobian of the specular point by the light's position is clamped at 1, that of parallel light at 10.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: geometric_term)",
        "manifold sampling: geometry term",
        &[on("sms", "conic-wall"), on("sms", "dome")],
    ),
    Exhibit::new(
        "generalized-geometry-clamped",
        Fault::GeneralizedGeometryClamped,
        "The generalised geometry term is clamped at 2, whatever the unit of length.",
        "https://github.com/blender/cycles (src/kernel/integrator/mnee.h: mnee_path_contribution)",
        "manifold sampling: geometry term",
        &[on("sms", "cup"), on("sms", "conic-wall")],
    ),
    Exhibit::new(
        "solutions-merged",
        Fault::SolutionsMerged,
        "Solutions in directions whose cosine is within 1e-4 of 1 are taken for one.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: uniqueness_threshold)",
        "manifold sampling: recognition of a solution",
        &[on("sms", "dome")],
    ),
    Exhibit::new(
        "residual-loose",
        Fault::ResidualLoose,
        "A walk ends, and its end counts, where the constraint is met to 1e-3.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: solver_threshold)",
        "manifold sampling: end of a walk",
        &[on("sms", "cup")],
    ),
    Exhibit::new(
        "fixed-number-of-walks",
        Fault::FixedNumberOfWalks,
        "The different solutions that four walks find, each with the weight 1: what is not found is lost.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: biased variant)",
        "manifold sampling: reciprocal probability",
        &[on("sms", "dome")],
    ),
    Exhibit::new(
        "trials-bounded",
        Fault::TrialsBounded,
        "A solution that four further walks do not find again is dropped.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: max_trials)",
        "manifold sampling: reciprocal probability",
        &[on("sms", "dome")],
    ),
    Exhibit::new(
        "reciprocal-off-by-one",
        Fault::ReciprocalOffByOne,
        "The reciprocal probability is estimated by the failures before a solution is found again, without the success.",
        "https://github.com/tizian/specular-manifold-sampling (src/librender/manifold_ss.cpp: inv_prob_estimate starts at 1)",
        "manifold sampling: reciprocal probability",
        &[on("sms", "mirror-wall")],
    ),
    Exhibit::new(
        "reciprocal-forgotten",
        Fault::ReciprocalForgotten,
        "The first solution that is found has the weight 1: right where there is one and every walk finds it.",
        "https://github.com/blender/cycles (src/kernel/integrator/mnee.h: one walk, one solution)",
        "manifold sampling: reciprocal probability",
        &[on("sms", "cup")],
    ),
];
