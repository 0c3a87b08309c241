//! Towards foci, axes, centres and rims.

use super::scenes::{dish, dome, ellipsoid, glass, lamp, oval};
use super::{Sweep, caustic, near};

/// The sweeps.
pub(super) fn sweeps() -> Vec<Sweep> {
    vec![
        caustic(
            "concave-sphere",
            ("light at the centre", "distance to the centre [m]"),
            near(),
            |t| dome(t, 0.25),
        ),
        caustic(
            "concave-sphere",
            ("receiver on the axis", "distance to the axis [m]"),
            near(),
            |t| dome(0.3125, 0.0).at_point([0.6 * t, 0.8 * t]),
        ),
        caustic(
            "cylinder-cup",
            ("lamp at the rim", "distance to the wall [m]"),
            near(),
            |t| lamp([t - 1.0, 0.0, 0.75], [0.3125, 0.125]),
        ),
        caustic(
            "cylinder-cup",
            ("lamp at the centre", "distance to the axis [m]"),
            near(),
            |t| lamp([t, 0.0, 0.75], [0.3125, 0.125]),
        ),
        caustic(
            "paraboloid",
            ("receiver at the focus", "height over the focus [m]"),
            near(),
            |t| dish(1.0 + t),
        ),
        caustic(
            "conic-mirrors",
            ("receiver at the focus", "height over the focus [m]"),
            near(),
            ellipsoid,
        ),
        caustic(
            "stigmatic-refractors",
            ("receiver at the focus", "depth behind the focus [m]"),
            near(),
            oval,
        ),
        caustic(
            "glass-sphere",
            ("receiver on the axis", "distance to the axis [m]"),
            near(),
            glass,
        ),
    ]
}
