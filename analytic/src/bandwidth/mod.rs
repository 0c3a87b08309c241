//! Exact expectations of biased estimators: what a regularized renderer converges to while its bandwidth stays finite.
//!
//! A renderer that cannot connect a point light through a mirror replaces the mirror's delta by a kernel of finite
//! width, or merges photons within a radius. Its mean is then not the closed form but an integral over the mirror (or
//! over the receiver), and that integral is computed here by deterministic quadrature, together with the second moment
//! of one sample. Picture: a point light and a floor point x on the front side of a plane mirror; s runs over the
//! mirror, r₁ = |s−x|, r₂ = |s−y|, c_x, c₁, c₂ the cosines at x, at s towards x and at s towards the light y; g is the
//! angle at s between the direction to x and the exact reflection of y → s.
//!
//! Source: `theory/bandwidth.md` sections 1, 2 and 4, after Kaplanyan & Dachsbacher 2013. The coordinates are derived in
//! `unfold`.
//!
//! **Visibility**: no leg of such a path can be hidden by the mirror. Both x and y are in the open front half-space of
//! the mirror's plane (otherwise the expectation is zero), and a segment from there to a point of the plane meets the
//! plane only at its end. The floor hides nothing either: y and s are above it.

mod chart;
mod clip;
mod cubature;
pub mod entry;
pub mod every_vertex;
mod eye;
mod eye_points;
pub mod film;
pub mod flatland;
pub mod frame;
mod hits;
mod kernel;
pub mod law;
mod light;
mod linked;
mod merge;
pub mod optimum;
mod polar;
pub mod probe;
mod quadrature;
pub mod scatter;
mod setting;
pub mod tile;
mod unfold;

use core::fmt;
use core::str::FromStr;

pub use crate::camera::Bounded;
pub use probe::Expectation;
pub use setting::{HalfSpace, PlanarSetting};

use crate::scene::InvalidParameter;

/// How the estimator builds a path of class `L S D …`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Technique {
    /// From the receiver with density cos/π, mollified at the mirror, connected to the light.
    Camera,
    /// From the light, uniform on the sphere, mollified at the mirror, connected to the receiver.
    Light,
    /// The mollified reflection R φ/√(c₁c₂), one value per path whichever side made it; the second moment is that of
    /// the camera-side sampling.
    Symmetric,
    /// Photon density estimation within a radius on the receiver.
    Merge,
    /// `Light` with the bandwidth atan(r/d), d the distance along the exact reflected ray.
    Linked,
}

impl Technique {
    /// All techniques, in the order in which they are listed.
    pub const ALL: [Technique; 5] = [
        Technique::Camera,
        Technique::Light,
        Technique::Symmetric,
        Technique::Merge,
        Technique::Linked,
    ];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Technique::Camera => "camera",
            Technique::Light => "light",
            Technique::Symmetric => "symmetric",
            Technique::Merge => "merge",
            Technique::Linked => "linked",
        }
    }

    /// Whether the bandwidth is an angle α [rad]; otherwise it is a radius r [m].
    pub const fn bandwidth_is_angle(self) -> bool {
        !matches!(self, Technique::Merge | Technique::Linked)
    }

    /// The kernel that is meant where none is named.
    pub const fn default_kernel(self) -> Kernel {
        match self {
            Technique::Merge => Kernel::Disc,
            _ => Kernel::Cone,
        }
    }

    /// The kernels that the technique can use.
    pub const fn kernels(self) -> &'static [Kernel] {
        match self {
            Technique::Merge => &[
                Kernel::Disc,
                Kernel::Epanechnikov,
                Kernel::Biweight,
                Kernel::Cone,
            ],
            _ => &[Kernel::Cone, Kernel::Epanechnikov, Kernel::VonMisesFisher],
        }
    }
}

/// From which distance d a linked bandwidth atan(r/d) is found, at a mirror point s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Convention {
    /// Along the exact continuation of the light's ray to the receiver: the right one, for a kernel of radius r there. Where
    /// that ray leaves the scene, d is the scene's diagonal.
    #[default]
    Exact,
    /// To the receiver point that is connected.
    Vertex,
    /// To the light.
    Light,
}

impl Convention {
    /// All conventions, in the order in which they are listed.
    pub const ALL: [Convention; 3] = [Convention::Exact, Convention::Vertex, Convention::Light];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Convention::Exact => "exact",
            Convention::Vertex => "vertex",
            Convention::Light => "light",
        }
    }
}

/// The shape of the bump that replaces a delta. An angular kernel is a density over directions, normalised exactly in
/// solid angle and not renormalised where the horizon cuts it; a radial kernel is a density over the receiver's plane,
/// not renormalised at the receiver's edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kernel {
    /// Angle: constant within α. Radius: 3(1−t)/(πr²), t the distance over r.
    Cone,
    /// 1 − t², normalised.
    Epanechnikov,
    /// exp(k(cos g − 1)) with k = 4/α², which has the second moment of the cone.
    VonMisesFisher,
    /// Radius only: constant within r.
    Disc,
    /// Radius only: 3(1−t²)²/(πr²).
    Biweight,
}

impl Kernel {
    /// All kernels, in the order in which they are listed.
    pub const ALL: [Kernel; 5] = [
        Kernel::Cone,
        Kernel::Epanechnikov,
        Kernel::VonMisesFisher,
        Kernel::Disc,
        Kernel::Biweight,
    ];

    /// The name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Kernel::Cone => "cone",
            Kernel::Epanechnikov => "epanechnikov",
            Kernel::VonMisesFisher => "vmf",
            Kernel::Disc => "disc",
            Kernel::Biweight => "biweight",
        }
    }
}

/// A name that is not a technique or a kernel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    /// What was given.
    pub found: String,
    /// What is allowed, separated by commas.
    pub allowed: String,
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is unknown, allowed: {}", self.found, self.allowed)
    }
}

impl core::error::Error for UnknownName {}

macro_rules! named {
    ($name:ident) => {
        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.pad(self.name())
            }
        }

        impl FromStr for $name {
            type Err = UnknownName;

            fn from_str(text: &str) -> Result<Self, UnknownName> {
                Self::ALL
                    .into_iter()
                    .find(|t| t.name() == text)
                    .ok_or_else(|| UnknownName {
                        found: text.to_owned(),
                        allowed: Self::ALL.map(Self::name).join(", "),
                    })
            }
        }
    };
}

named!(Technique);
named!(Convention);
named!(Kernel);

/// The first two moments of an estimator, each with an error bound.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// The expectation.
    pub mean: Bounded,
    /// The second moment of one sample; the variance is this minus the squared mean.
    pub second_moment: Bounded,
}

/// Smaller bandwidths are 6 digits from the rounding of the scene's coordinates: where a border cuts the kernel, the bound says
/// what is left.
pub const SMALLEST_BANDWIDTH: f64 = 1e-9;
/// The largest radius [m].
pub const LARGEST_RADIUS: f64 = 1e6;
/// The longest schedule.
pub const LONGEST_SCHEDULE: usize = 1_000_000;

/// Checks that a kernel fits a technique and that every bandwidth is in range.
///
/// # Errors
/// The first of `kernel` and `bandwidth` that does not fit, with what is allowed.
pub fn check(
    technique: Technique,
    kernel: Kernel,
    bandwidths: &[f64],
) -> Result<(), InvalidParameter> {
    let kernels = technique.kernels();
    if !kernels.contains(&kernel) {
        let names: Vec<_> = kernels.iter().map(|k| k.name()).collect();
        return Err(InvalidParameter {
            key: "kernel".to_owned(),
            found: kernel.name().to_owned(),
            allowed: format!("{} (for the technique {technique})", names.join(", ")),
        });
    }
    let (largest, unit) = if technique.bandwidth_is_angle() {
        (core::f64::consts::PI, "an angle in radians")
    } else {
        (LARGEST_RADIUS, "a radius in metres")
    };
    let allowed = format!("{unit} from {SMALLEST_BANDWIDTH} to {largest}");
    let invalid = |found: String, allowed: String| {
        Err(InvalidParameter {
            key: "bandwidth".to_owned(),
            found,
            allowed,
        })
    };
    if bandwidths.is_empty() || bandwidths.len() > LONGEST_SCHEDULE {
        return invalid(
            format!("a list of {}", bandwidths.len()),
            format!("1 to {LONGEST_SCHEDULE} bandwidths"),
        );
    }
    match bandwidths
        .iter()
        .find(|b| !(**b >= SMALLEST_BANDWIDTH && **b <= largest))
    {
        Some(b) => invalid(b.to_string(), allowed),
        None => Ok(()),
    }
}
