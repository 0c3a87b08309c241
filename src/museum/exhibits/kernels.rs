//! Faults of kernels, bandwidths, schedules and photon maps.

use super::{Exhibit, at, on};
use crate::integrators::Fault;

/// A bandwidth at which what is wrong by a power of it is wrong enough.
const WIDE: f64 = 0.6;
/// A first radius at which the bias is large, so that another schedule shows.
const WIDEST: f64 = 0.8;

pub(super) const EXHIBITS: &[Exhibit] = &[
    Exhibit::new(
        "kernel-on-tangent-plane",
        Fault::KernelNormalizedByPiAlphaSquared,
        "The cone's kernel is divided by πα², the area of a disc, not by its solid angle.",
        "https://github.com/drsnuggles8/OloEngineBase/issues/1347 (convention mix-ups of α)",
        "kernel: normalisation",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "kernel-by-tangent",
        Fault::KernelNormalizedByTangent,
        "The cone's kernel is divided by π tan² α, the disc at distance 1.",
        "https://github.com/hhergeth/CudaTracerLib (angle and radius converted into each other)",
        "kernel: normalisation",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "full-angle-for-half-angle",
        Fault::FullAngleForHalf,
        "The kernel's angle is compared as a full angle and normalised as a half angle.",
        "https://github.com/drsnuggles8/OloEngineBase/issues/1347 (convention mix-ups of α)",
        "kernel: support",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "delta-cosine-kept",
        Fault::DeltaCosineKept,
        "The 1/cos of the delta BSDF is kept though a kernel in solid angle needs none.",
        "https://github.com/shocker-0x15/VLR (regularised specular lobes divided by a cosine)",
        "regularized connection",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "cosine-at-specular-vertex",
        Fault::CosineAtSpecularVertex,
        "The rendering equation's cosine is applied at the mollified vertex.",
        "https://github.com/shocker-0x15/VLR (the cosine of one direction where that of the other is needed)",
        "regularized connection",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "uniform-for-cosine",
        Fault::UniformForCosine,
        "Directions are drawn uniformly and weighted as if by cos θ/π.",
        "https://github.com/gkjohnson/three-gpu-pathtracer/issues/847 (densities of sample and evaluation differ)",
        "regularized connection: direction",
        &[at("pt-reg", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "samples-clamped",
        Fault::SamplesClamped,
        "Samples above a radiance are clamped before they are accumulated.",
        "https://github.com/LuxCoreRender/LuxCore/issues/229",
        "regularized connection: value",
        &[on("pt-reg", "museum-wall")],
    ),
    Exhibit::new(
        "bandwidth-floor",
        Fault::BandwidthFloor,
        "The bandwidth is not allowed below a floor: the bias stays.",
        "https://github.com/mmp/pbrt-v4 (src/pbrt/util/scattering.h: TrowbridgeReitzDistribution::Regularize)",
        "bandwidth of an iteration",
        &[on("pt-reg", "museum-wall"), on("pm", "museum-wall")],
    ),
    Exhibit::new(
        "tiny-bandwidth-floor",
        Fault::TinyBandwidthFloor,
        "The bandwidth is not allowed below 1e-7.",
        "https://github.com/SmallVCM/SmallVCM (src/vertexcm.hxx: radius at least 1e-7)",
        "bandwidth of an iteration",
        &[on("pt-reg", "museum-wall")],
    )
    .unkillable("at the rate of n^(-1/6) a bandwidth of 0.2 gets there after 1e37 iterations: no bit differs before"),
    Exhibit::new(
        "direct-photons-merged",
        Fault::DirectPhotonsMerged,
        "Photons of direct light are gathered too, beside next event estimation.",
        "https://github.com/hhergeth/CudaTracerLib/issues/4",
        "photon map: what is stored",
        &[on("pm", "museum-wall")],
    ),
    Exhibit::new(
        "divided-by-stored-photons",
        Fault::DividedByStoredPhotons,
        "Photons are divided by those that were stored, not by those that were emitted.",
        "https://github.com/JuliaGraphics/Hikari.jl/pull/16",
        "photon map: normalisation",
        &[on("pm", "museum-wall")],
    ),
    Exhibit::new(
        "four-cells-of-nine",
        Fault::FourCellsOfNine,
        "A query looks at the cells to one side only.",
        "https://github.com/SmallVCM/SmallVCM (src/hashgrid.hxx: eight of 27 cells, with an offset that must be right)",
        "photon map: query",
        &[on("pm", "museum-wall")],
    ),
    Exhibit::new(
        "cells-too-small",
        Fault::CellsTooSmall,
        "The cells of the grid are smaller than the radius.",
        "https://github.com/SmallVCM/SmallVCM (src/hashgrid.hxx: cell size of twice the radius)",
        "photon map: cells",
        &[at("pm", "museum-wall", WIDE)],
    ),
    Exhibit::new(
        "radius-not-shrinking",
        Fault::RadiusNotShrinking,
        "The radius of an iteration is computed, and the first one is used.",
        "https://github.com/yuphin/Lumen/issues/19",
        "bandwidth of an iteration",
        &[at("ppm", "museum-wall", WIDEST)],
    ),
    Exhibit::new(
        "schedule-exponent-halved",
        Fault::ScheduleExponentHalved,
        "The reduction of r² is applied with half of its exponent.",
        "https://github.com/hhergeth/CudaTracerLib (sqrt(r0²/n^((1-a)/2)))",
        "bandwidth of an iteration",
        &[at("ppm", "museum-wall", WIDEST)],
    ),
    Exhibit::new(
        "recursion-off-by-one",
        Fault::RecursionOffByOne,
        "The recursion of radii counts from 0 where it should count from 1.",
        "https://github.com/SmallVCM/SmallVCM (src/vertexcm.hxx: iteration + 1)",
        "bandwidth of an iteration",
        &[at("ppm", "museum-wall", WIDEST)],
    ),
    Exhibit::new(
        "newest-normalization",
        Fault::NewestNormalization,
        "Photons of old iterations are divided by the newest radius.",
        "https://github.com/mitsuba-renderer/mitsuba (src/integrators/photonmapper/sppm.cpp: flux rescaled by the shrunk radius)",
        "film: sums of old iterations",
        &[on("ppm", "museum-wall")],
    ),
];
