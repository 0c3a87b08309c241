//! Towards grazing incidence.

use libm::{asin, cos, sin, sqrt, tan};

use super::scenes::{ball, cup, floor, glass, interface, slab};
use super::{Sweep, caustic, graze};
use crate::stability::inputs::Inputs;

/// The danger, and what the parameter is.
pub(super) const GRAZING: (&str, &str) = ("grazing incidence", "angle to the surface [rad]");

/// The sweeps.
pub(super) fn sweeps() -> Vec<Sweep> {
    vec![
        caustic("diffuse", GRAZING, graze(), |t| {
            floor().at_point([0.25 + 1.5 / t, -0.125])
        }),
        caustic("planar-mirror", GRAZING, graze(), |t| {
            Inputs::new(&[("I", 5.0), ("R", 0.875)], [1.5 - 0.5 * t, -2.5])
                .with("light", &[1.5 - 0.5 * t, -0.125, 1.25])
                .with("mirror_point", &[1.5, 0.0, 0.0])
                .with("mirror_normal", &[-1.0, 0.0, 0.0])
        }),
        caustic("flat-interface", GRAZING, graze(), |t| {
            interface().at_point([0.25 + 0.75 / t, -0.125])
        }),
        caustic("glass-slab", GRAZING, graze(), |t| {
            slab().at_point([0.25 + 1.125 / t, -0.125])
        }),
        caustic("convex-sphere", GRAZING, graze(), |t| {
            // In the plane of centre and light: the ray that meets the ball at the angle t to its surface.
            let (lx, lz) = (1.25, 1.25);
            let distance = sqrt(lx * lx + lz * lz);
            let i = core::f64::consts::FRAC_PI_2 - t;
            let polar = i - asin(0.5 * sin(i) / distance);
            let up = libm::atan2(lz, lx) - polar;
            let (nx, nz) = (cos(up), sin(up));
            let (px, pz) = (0.5 * nx, 0.75 + 0.5 * nz);
            let (dx, dz) = (px - lx, pz - 0.75 - lz);
            let along = dx * nx + dz * nz;
            let (rx, rz) = (dx - 2.0 * along * nx, dz - 2.0 * along * nz);
            let x = px - rx * (pz / rz);
            ball(0.0).at_point([x, 0.0]).with("light", &[lx, 0.0, 2.0])
        }),
        caustic("cylinder-cup", GRAZING, graze(), |t| {
            // The ray that meets the wall at the angle t, half way along its chord.
            let phi = core::f64::consts::FRAC_PI_2 - t;
            let tau = cos(phi);
            cup([
                cos(phi) - tau * cos(2.0 * phi),
                sin(phi) - tau * sin(2.0 * phi),
            ])
        }),
        caustic("glass-sphere", GRAZING, graze(), |t| {
            let i = core::f64::consts::FRAC_PI_2 - t;
            glass(glass_landing(i).abs())
        }),
    ]
}

/// Signed distance from the axis at which the ray of incidence i meets the plane.
pub(super) fn glass_landing(i: f64) -> f64 {
    let r = asin(sin(i) / 1.5);
    let e = 2.0 * r - i;
    sin(e) - (1.25 - cos(e)) * tan(2.0 * (i - r))
}
