//! Towards the sharp limit: bandwidths down to 1e-9 under a ceiling mirror.

use nephroid_analytic::bandwidth::{Kernel, Technique};

use super::{Sweep, decades};
use crate::stability::inputs::Inputs;
use crate::stability::quantity::{Against, Moment, Quantity};

/// The sweeps: every technique against double-double, mean and second moment, and the means with every kernel against the
/// law of small bandwidths.
pub(super) fn sweeps() -> Vec<Sweep> {
    let mut all = Vec::new();
    for (technique, [mean, second, law]) in Technique::ALL.into_iter().zip(DANGERS) {
        let mut add = |danger, second, kernel, against| {
            let small = against == Against::SmallBandwidthLaw;
            all.push(Sweep {
                kind: "planar-mirror",
                danger,
                parameter: if technique.bandwidth_is_angle() {
                    "bandwidth [rad]"
                } else {
                    "radius [m]"
                },
                quantity: Quantity::Bandwidth(Moment {
                    technique,
                    kernel,
                    second,
                    against,
                }),
                values: decades(if small { -4 } else { -1 }, -9),
                at: if small && technique == Technique::Linked {
                    on_axis
                } else {
                    ceiling
                },
            });
        };
        let kernel = technique.default_kernel();
        add(mean, false, kernel, Against::DoubleDouble);
        add(second, true, kernel, Against::DoubleDouble);
        add(law, false, kernel, Against::SmallBandwidthLaw);
        let others: &[(&'static str, Kernel)] = match technique {
            Technique::Camera => &[
                ("law, camera epanechnikov", Kernel::Epanechnikov),
                ("law, camera vmf", Kernel::VonMisesFisher),
            ],
            Technique::Merge => &[("law, merge epanechnikov", Kernel::Epanechnikov)],
            _ => &[],
        };
        for &(danger, kernel) in others {
            add(danger, false, kernel, Against::SmallBandwidthLaw);
        }
    }
    all
}

/// Names of the sweeps per technique: mean, second moment, law.
const DANGERS: [[&str; 3]; 5] = [
    ["mean, camera", "second moment, camera", "law, camera"],
    ["mean, light", "second moment, light", "law, light"],
    [
        "mean, symmetric",
        "second moment, symmetric",
        "law, symmetric",
    ],
    ["mean, merge", "second moment, merge", "law, merge"],
    ["mean, linked", "second moment, linked", "law, linked"],
];

/// A mirror that never meets the floor: nothing cuts the kernels.
fn ceiling(bandwidth: f64) -> Inputs {
    let numbers = [("I", 5.0), ("R", 0.875), ("bandwidth", bandwidth)];
    Inputs::new(&numbers, [0.75, -0.5])
        .with("light", &[0.25, -0.125, 1.25])
        .with("mirror_point", &[0.0, 0.0, 2.0])
        .with("mirror_normal", &[0.0, 0.0, -1.0])
}

/// The light right above the point.
fn on_axis(bandwidth: f64) -> Inputs {
    ceiling(bandwidth).at_point([0.25, -0.125])
}
