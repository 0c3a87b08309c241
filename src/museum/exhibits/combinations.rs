//! Faults of how techniques are combined: weights, measures, and what is regularized.

use super::{Exhibit, at, on};
use crate::integrators::Fault;

pub(super) const EXHIBITS: &[Exhibit] = &[
    Exhibit::new(
        "heuristics-mixed",
        Fault::HeuristicsMixed,
        "Light paths are weighted by the power heuristic, camera paths by the balance heuristic.",
        "https://github.com/mmp/pbrt-v3/issues/73 (MIS weights that do not sum to one)",
        "weights of the light's side",
        &[on("bdpt", "mirror-wall"), at("bdpt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "mis-pixels-forgotten",
        Fault::MisPixelsForgotten,
        "Weights of light tracing take the camera's density without dividing by the number of pixels.",
        "https://github.com/mmp/pbrt-v4/issues/347 (weights of light tracing ignore the crop window)",
        "weights of the light's side: density of camera subpaths",
        &[on("bdpt", "floor")],
    ),
    Exhibit::new(
        "mis-measures-mixed",
        Fault::MisMeasuresMixed,
        "Weights of the light's side take the camera's density in solid angle for the one per area.",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/847 (densities of sample and evaluation differ)",
        "weights of the mollified vertex, light's side",
        &[at("bdpt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "mis-measures-wrong",
        Fault::MisMeasuresWrong,
        "The weights of both sides take the camera's density in solid angle for the one per area.",
        "https://github.com/SmallVCM/SmallVCM (src/vertexcm.hxx: conversions of densities to area in the weights)",
        "weights of the mollified vertex, both sides",
        &[at("bdpt-reg", "museum-wall", 0.6)],
    )
    .unkillable(
        "the weights of each path still sum to one: the mean is exactly right, only the variance is larger, which a test of \
         means must not call a bias",
    ),
    Exhibit::new(
        "mollified-twice",
        Fault::MollifiedTwice,
        "A path with a mollified vertex is counted from both sides, each time with its full weight.",
        "https://github.com/RenderKit/embree/issues/491 (the same path by two strategies)",
        "weights of the mollified vertex",
        &[at("bdpt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "sides-differ",
        Fault::SidesDiffer,
        "Each side evaluates the mollified BSDF in its own form, divided by its own cosine, and the two are combined as if \
         they were one integrand.",
        "https://github.com/mmp/pbrt-v4/issues/385 (a BSDF that is not the same from both sides in bidirectional methods)",
        "mollified vertex: the cosines of the kernel",
        &[at("bdpt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "regular-regularized",
        Fault::RegularRegularized,
        "Caustics that light tracing samples exactly are mollified as well.",
        "https://github.com/mmp/pbrt-v4 (src/pbrt/cpu/integrators.cpp: regularize applies to every non-diffuse vertex)",
        "plan: which classes are irregular",
        &[at("bdpt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "delta-vertex-weighted",
        Fault::DeltaVertexWeighted,
        "A path through a specular vertex shares with a technique that cannot build it: the density of a delta is not zeroed.",
        "https://github.com/nvpro-samples/vk_raytrace/issues/13 (weights where one density is a delta)",
        "weights of next event estimation",
        &[on("bdpt", "mirror-wall"), on("bdpt", "cup")],
    ),
    Exhibit::new(
        "sphere-flux-on-aimed-photons",
        Fault::SphereFluxOnAimedPhotons,
        "Photons are aimed, and carry the flux of the whole sphere.",
        "https://github.com/SirKero/RTProgressivePhotonMapper/issues/1 (photon emission pdf wrong)",
        "light subpaths: flux per photon",
        &[on("bdpt", "floor")],
    ),
];
