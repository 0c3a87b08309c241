//! Faults of random numbers, of arithmetic and of what is stored.

use super::{Exhibit, at, on, repeats};
use crate::integrators::Fault;

pub(super) const EXHIBITS: &[Exhibit] = &[
    Exhibit::new(
        "not-a-number",
        Fault::NotANumberPixel,
        "One pixel is not a number.",
        "https://github.com/AcademySoftwareFoundation/OpenImageIO/pull/1108",
        "film: one pixel",
        &[on("pt", "floor")],
    ),
    Exhibit::new(
        "infinite",
        Fault::InfinitePixel,
        "One pixel is infinite.",
        "https://github.com/mmp/pbrt-v4/pull/477",
        "film: one pixel",
        &[on("lt", "floor")],
    ),
    Exhibit::new(
        "negative",
        Fault::NegativePixel,
        "One pixel is negative.",
        "https://github.com/KitwareMedical/ITKTubeTK/issues/3 (values that cannot be compared pass)",
        "film: one pixel",
        &[on("pm", "museum-wall")],
    ),
    Exhibit::new(
        "same-number-twice",
        Fault::SameNumberTwice,
        "One random number is used for two dimensions.",
        "https://github.com/scanlime/zenphoton/pull/8 (correlated random numbers at two places)",
        "random numbers of emission and of the scattered direction",
        &[on("lt", "floor"), at("pt-reg", "museum-wall", 0.6)],
    ),
    Exhibit::new(
        "seed-truncated",
        Fault::SeedTruncated,
        "Six bits of the seed are used: independent runs are not.",
        "https://github.com/JiayinCao/SORT/issues/35 (every thread with the same seed)",
        "random numbers: seed",
        &[repeats("lt", "floor")],
    ),
    Exhibit::new(
        "iterations-share-numbers",
        Fault::IterationsShareNumbers,
        "All iterations of a run draw the same photons.",
        "https://github.com/mmp/pbrt-v4/issues/525",
        "random numbers: iteration",
        &[on("ppm", "museum-wall")],
    )
    .unkillable(
        "each run's mean is right and runs are independent: only the variance of a run is larger, which a test of means \
         measures and takes into account",
    ),
    Exhibit::new(
        "single-precision",
        Fault::SinglePrecision,
        "Landing points are stored in single precision, 1000 km away from the origin.",
        "https://github.com/mitsuba-renderer/mitsuba2/issues/171",
        "light tracing: landing point",
        &[on("lt", "cup")],
    ),
];
