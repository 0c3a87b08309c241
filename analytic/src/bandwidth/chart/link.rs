//! Linked bandwidths: α = atan(r/d) of a radius r, by a distance d from the mollified vertex s.
//!
//! d is the way along the exact continuation of the path at s to what that ray meets first (the convention that makes r a radius
//! there), or the straight way to the receiver point, or to the light. A path from the light goes on to the floor. One from the
//! camera goes on past the light: it may come down on the floor, meet the surface again, or leave the scene, and then d is the
//! scene's diagonal (in a scene with an unbounded surface such a ray contributes nothing). d jumps between these cases, so that each
//! is integrated by itself, with the conditions of its case as margins.
//!
//! From the light only the floor is looked for: a ray that meets the surface again before it is so far from any connection to the
//! floor that no kernel of less than a right angle joins them.

use libm::{asin, atan2, exp, hypot, sqrt};

use super::{MARGINS, Node};
use crate::bandwidth::kernel::{cone_height, epanechnikov_height, von_mises_fisher};
use crate::bandwidth::{Convention, Kernel};
use crate::vector::Vec3;

/// What ends the exact ray: the clipped floor z = 0.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Receiver {
    pub center: [f64; 2],
    pub half_width: [f64; 2],
    /// Height [m].
    pub z: f64,
    /// About the size of what is over it [m].
    pub size: f64,
    /// The linked distance of a ray that leaves the scene [m]; `None`: such rays contribute nothing.
    pub escape: Option<f64>,
}

/// How a linked bandwidth follows from a radius, in one case.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Link {
    pub convention: Convention,
    pub radius: f64,
    pub kernel: Kernel,
    pub case: Case,
}

/// What the exact ray does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::bandwidth) struct Case {
    /// The first of the conditions of meeting the surface again that does not hold; `None` where the surface is not looked for.
    pub passes: Option<usize>,
    pub end: End,
}

/// Where the exact ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::bandwidth) enum End {
    /// On the floor.
    Floor,
    /// Nowhere: the first of the conditions of landing on the floor that does not hold.
    Nowhere(usize),
    /// On the surface from which it comes.
    Surface,
}

/// Where a ray meets the surface from which it comes: its length [m], and the conditions under which it does.
#[derive(Clone, Copy, Debug)]
pub(in crate::bandwidth) struct Again {
    pub length: f64,
    pub conditions: [f64; AGAIN],
}

/// Conditions under which an exact ray lands on the floor.
const LANDING: usize = 3;
/// Conditions under which it meets its surface again, at most.
pub(in crate::bandwidth) const AGAIN: usize = 3;
/// Where both stand among the margins.
const FIRST: usize = MARGINS - LANDING;
const FIRST_AGAIN: usize = FIRST - AGAIN;

impl Case {
    /// A ray that ends on the floor, whatever else is in its way.
    pub const LANDS: Self = Case {
        passes: None,
        end: End::Floor,
    };

    /// All cases of a convention. `conditions` is the number of those under which the ray meets its surface again, 0 where that is
    /// not looked for; `leaves` tells whether a ray that leaves the scene contributes.
    pub fn all(convention: Convention, conditions: usize, leaves: bool) -> Vec<Self> {
        if convention != Convention::Exact {
            return vec![Case::LANDS];
        }
        let mut ends = vec![End::Floor];
        if leaves {
            ends.extend((0..LANDING).map(End::Nowhere));
        }
        let beside = |passes| ends.iter().map(move |&end| Case { passes, end });
        if conditions == 0 {
            return beside(None).collect();
        }
        let mut cases: Vec<_> = (0..conditions).flat_map(|k| beside(Some(k))).collect();
        cases.push(Case {
            passes: None,
            end: End::Surface,
        });
        cases
    }
}

impl Receiver {
    /// Size of the scene [m].
    pub fn scale(&self) -> f64 {
        self.size
    }

    /// Where an exact ray meets the plane, how far from its start, and the conditions under which it lands on the floor.
    pub(super) fn landing(
        &self,
        s: &Vec3<f64>,
        out: &Vec3<f64>,
    ) -> ([f64; 2], f64, [f64; LANDING]) {
        let t = (s.z - self.z) / -out.z;
        let p = [s.x + out.x * t, s.y + out.y * t];
        let side = |k: usize| {
            let v = (p[k] - self.center[k]) / self.half_width[k];
            // Negative on both sides, and smooth through infinity.
            if v.abs() > 1e8 {
                -1.0
            } else {
                (1.0 - v) * (1.0 + v) / (1.0 + v * v)
            }
        };
        let down = if s.z > self.z { -out.z } else { out.z };
        (p, t, [down, side(0), side(1)])
    }
}

/// Sets the conditions of landing on the floor.
pub(super) fn set_landing(margins: &mut [f64; MARGINS], conditions: &[f64; LANDING]) {
    margins[FIRST..].copy_from_slice(conditions);
}

impl Link {
    /// The end of the kernel as D²/B²: beyond k(1 − cos g) = 40, that is D² = 80/k = 20 α², nothing is left.
    pub(super) fn reach(&self) -> f64 {
        match self.kernel {
            Kernel::VonMisesFisher => 20.0,
            _ => 1.0,
        }
    }

    /// The level and the deflection of a difference D of unit directions at the linked distance.
    ///
    /// The support is D² < k B² with the squared band B² = 4 sin²(α/2) (von Mises–Fisher: α²), tan α = r κ, κ = 1/d: even
    /// in κ, so that D² − k B² is smooth where the ray turns away from the floor.
    pub(super) fn scaled(&self, difference: Vec3<f64>, distance: f64) -> (f64, Vec3<f64>) {
        let tangent = self.radius / distance;
        let band = match self.kernel {
            Kernel::VonMisesFisher => {
                let alpha = libm::atan(tangent);
                alpha * alpha
            }
            _ => {
                let secant = hypot(1.0, tangent);
                2.0 * tangent * tangent / (secant * (secant + 1.0))
            }
        };
        let level = difference.length_squared() + self.reach() * (self.radius * self.radius - band);
        (level, difference * (1.0 / sqrt(band)))
    }

    /// φ and φ² at a node.
    pub(super) fn kernel_at(&self, node: &Node) -> [f64; 2] {
        let alpha = atan2(self.radius, node.distance);
        // D²/B².
        let ratio = node.square();
        let phi = match self.kernel {
            Kernel::VonMisesFisher => {
                let (k, n) = von_mises_fisher(alpha);
                n * exp(-0.5 * k * ratio * alpha * alpha)
            }
            Kernel::Epanechnikov => {
                let chord = 2.0 * libm::sin(0.5 * alpha) * sqrt(ratio);
                let t = 2.0 * asin((0.5 * chord).min(1.0)) / alpha;
                epanechnikov_height(alpha) * (1.0 - t * t)
            }
            _ => cone_height(alpha),
        };
        [phi, phi * phi]
    }

    /// The distance d, with the conditions of the case as margins. `again` is where the exact ray meets the surface again.
    pub(super) fn distance(
        &self,
        receiver: &Receiver,
        s: &Vec3<f64>,
        out: &Vec3<f64>,
        [r1, r2]: [f64; 2],
        again: impl FnOnce() -> Option<Again>,
        margins: &mut [f64; MARGINS],
    ) -> f64 {
        match self.convention {
            Convention::Vertex => return r1,
            Convention::Light => return r2,
            Convention::Exact => {}
        }
        let mut fails_first = |first: usize, conditions: &[f64], k: usize| {
            margins[first..first + k].copy_from_slice(&conditions[..k]);
            margins[first + k] = -conditions[k];
        };
        match (self.case.end, self.case.passes) {
            (End::Surface, _) => {
                let Some(met) = again() else { return f64::NAN };
                margins[FIRST_AGAIN..FIRST].copy_from_slice(&met.conditions);
                return met.length;
            }
            (_, Some(k)) => {
                if let Some(met) = again() {
                    fails_first(FIRST_AGAIN, &met.conditions, k);
                }
            }
            (_, None) => {}
        }
        let (_, t, conditions) = receiver.landing(s, out);
        match self.case.end {
            End::Nowhere(k) => {
                fails_first(FIRST, &conditions, k);
                receiver.escape.unwrap_or(f64::INFINITY)
            }
            _ => {
                set_landing(margins, &conditions);
                t
            }
        }
    }
}
