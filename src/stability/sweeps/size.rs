//! Huge and tiny scenes, and scenes far from the origin.

use super::scenes::{
    ball, cup, dish, dome, floor, glass, hyperboloid, interface, mirror, oval, slab, waves, wedge,
};
use super::{Sweep, caustic, far, scale};

/// A danger, and what its parameter is.
pub(super) const SCALE: (&str, &str) = ("scale", "factor of all lengths");
/// The other.
pub(super) const FAR: (&str, &str) = ("translation", "offset along x and y [m]");

/// Keys that are no lengths.
pub(super) const PURE: [&str; 15] = [
    "I",
    "R",
    "E0",
    "n",
    "m",
    "e",
    "albedo",
    "max_bounces",
    "cap_cos_min",
    "mirror_normal",
    "sin_elevation",
    "cos_elevation",
    "cap_axis",
    "axis",
    "interactions",
];

/// The sweeps.
pub(super) fn sweeps() -> Vec<Sweep> {
    vec![
        caustic("diffuse", SCALE, scale(), |t| floor().scaled(t, &PURE)),
        caustic("planar-mirror", SCALE, scale(), |t| {
            mirror().scaled(t, &PURE)
        }),
        caustic("planar-chains", SCALE, scale(), wedge),
        caustic("flat-interface", SCALE, scale(), |t| {
            interface().scaled(t, &PURE)
        }),
        caustic("glass-slab", SCALE, scale(), |t| slab().scaled(t, &PURE)),
        caustic("concave-sphere", SCALE, scale(), |t| {
            dome(0.3125, 0.0625).scaled(t, &PURE)
        }),
        caustic("convex-sphere", SCALE, scale(), |t| {
            ball(1.0).scaled(t, &PURE)
        }),
        caustic("cylinder-cup", SCALE, scale(), |t| {
            cup([0.5, 0.25]).scaled(t, &PURE)
        }),
        caustic("paraboloid", SCALE, scale(), |t| {
            dish(1.25).scaled(t, &PURE)
        }),
        caustic("conic-mirrors", SCALE, scale(), |t| {
            hyperboloid().scaled(t, &PURE)
        }),
        caustic("stigmatic-refractors", SCALE, scale(), |t| {
            oval(0.25).scaled(t, &PURE)
        }),
        caustic("glass-sphere", SCALE, scale(), |t| {
            glass(0.0625).scaled(t, &PURE)
        }),
        caustic("water-waves", SCALE, scale(), |t| {
            waves(0.0625).scaled(t, &PURE)
        }),
        caustic("diffuse", FAR, far(), |t| floor().translated(t, &["light"])),
        caustic("planar-mirror", FAR, far(), |t| {
            mirror().translated(t, &["light", "mirror_point"])
        }),
        caustic("flat-interface", FAR, far(), |t| {
            interface().translated(t, &["light"])
        }),
        caustic("glass-slab", FAR, far(), |t| {
            slab().translated(t, &["light"])
        }),
        caustic("concave-sphere", FAR, far(), |t| {
            dome(0.3125, 0.0625).translated(t, &["light", "sphere_centre"])
        }),
        caustic("convex-sphere", FAR, far(), |t| {
            ball(1.0).translated(t, &["light", "sphere_centre"])
        }),
    ]
}
