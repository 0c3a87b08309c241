//! Richardson's extrapolation in the bandwidth: (2ᵖ X_{α/2} − X_α)/(2ᵖ − 1), both with the same random numbers.
//!
//! Where the bias is c αᵖ + O(α^q) the first term drops out. The expectation is the same combination of expectations. Its second
//! moment needs E[X_α X_{α/2}] = ∫ φ_α φ_{α/2} w f: a kernel that is constant within its support has φ_α = H_α wherever φ_{α/2} is
//! not 0, so that it is (H_α/H_{α/2}) m₂(α/2), exactly. Of other kernels it is between 0 and √(m₂(α) m₂(α/2))
//! [Cauchy–Schwarz; samples are not negative]. Derived here.

use crate::bandwidth::kernel::cone_height;
use crate::bandwidth::{Bounded, Kernel, Moments, Technique};

/// Moments of the extrapolated sample from those at `bandwidth` and at half of it; the second moment's error is that of the bounds where it is
/// not exact. `order` is p > 0.
pub fn extrapolated(
    technique: Technique,
    kernel: Kernel,
    bandwidth: f64,
    order: f64,
    [full, half]: [Moments; 2],
) -> Moments {
    let s = libm::pow(2.0, order);
    let (a, b) = (s / (s - 1.0), 1.0 / (s - 1.0));
    let (m, h) = (full.second_moment, half.second_moment);
    let shared = match (technique, kernel) {
        (Technique::Linked, _) => None,
        (Technique::Merge, Kernel::Disc) => Some(0.25),
        (Technique::Merge, _) => None,
        (_, Kernel::Cone) => Some(cone_height(bandwidth) / cone_height(0.5 * bandwidth)),
        _ => None,
    };
    let cross = match shared {
        Some(ratio) => Bounded {
            value: ratio * h.value,
            error: ratio * h.error,
        },
        None => {
            let most = libm::sqrt((m.value + m.error) * (h.value + h.error));
            Bounded {
                value: 0.5 * most,
                error: 0.5 * most,
            }
        }
    };
    Moments {
        mean: Bounded {
            value: a * half.mean.value - b * full.mean.value,
            error: a * half.mean.error + b * full.mean.error,
        },
        second_moment: Bounded {
            value: a * a * h.value + b * b * m.value - 2.0 * a * b * cross.value,
            error: a * a * h.error + b * b * m.error + 2.0 * a * b * cross.error,
        },
    }
}
