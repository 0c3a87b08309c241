//! Mollifiers as integrators use them: on the angle between two directions, or on a distance on the floor.
//!
//! On the angle g (of the sphere, bandwidth α): cone 1/(2π(1 - cos α)); Epanechnikov N (1 - g²/α²),
//! 1/N = 2π(1 - 2 sin α/α + 2(1 - cos α)/α²); von Mises–Fisher N exp(κ(cos g - 1)), κ = 4/α², N = κ/(2π(1 - e^{-2κ})).
//! On the distance d (of the plane, bandwidth r): disc 1/(πr²); Epanechnikov 2/(πr²) (1 - d²/r²); biweight
//! 3/(πr²) (1 - d²/r²)²; cone 3/(πr²) (1 - d/r). Normalised by ∫₀¹ (1 - s) ds = 1/2, ∫₀¹ (1 - s)² ds = 1/3 with s = d²/r² and
//! ∫₀¹ (1 - t) 2t dt = 1/3 with t = d/r; and there is no smallest radius.

use core::f64::consts::{PI, TAU};
use core::fmt;
use core::str::FromStr;

use libm::{asin, cos, exp, sin, sqrt, tan};

use super::fault::Fault;

/// The shape of a mollifier.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// On an angle constant within α; on a distance the one that falls linearly to zero at r, a cone over the floor.
    Cone,
    /// Parabola within the angle α or the radius r.
    Epanechnikov,
    /// Gaussian of the sphere, with the cone's second moment.
    VonMisesFisher,
    /// Constant within the radius r.
    Disc,
    /// Square of the parabola within the radius r.
    Biweight,
}

impl Kernel {
    const NAMES: [(&'static str, Kernel); 5] = [
        ("cone", Kernel::Cone),
        ("epanechnikov", Kernel::Epanechnikov),
        ("vmf", Kernel::VonMisesFisher),
        ("disc", Kernel::Disc),
        ("biweight", Kernel::Biweight),
    ];

    /// Whether it is a kernel on the angle.
    pub const fn is_angular(self) -> bool {
        !matches!(self, Kernel::Disc | Kernel::Biweight)
    }

    /// Whether it is a kernel on the distance on the floor.
    pub const fn is_planar(self) -> bool {
        !matches!(self, Kernel::VonMisesFisher)
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Kernel::Cone => "cone",
            Kernel::Epanechnikov => "epanechnikov",
            Kernel::VonMisesFisher => "vmf",
            Kernel::Disc => "disc",
            Kernel::Biweight => "biweight",
        })
    }
}

impl FromStr for Kernel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Kernel::NAMES
            .iter()
            .find(|(name, _)| *name == text)
            .map(|&(_, kernel)| kernel)
            .ok_or_else(|| "expected cone, epanechnikov, vmf, disc or biweight".to_owned())
    }
}

/// A kernel on the angle at one bandwidth, as a function of the chord |u - v| = 2 sin(g/2) between unit directions.
#[derive(Clone, Copy, Debug)]
pub struct AngleKernel {
    kernel: Kernel,
    norm: f64,
    /// Beyond this squared chord the kernel is zero.
    pub support: f64,
    alpha: f64,
}

impl AngleKernel {
    /// A kernel of bandwidth `alpha` in (0, π]; zero everywhere for anything else. `Disc` and `Biweight` are taken for `Cone`.
    pub fn new(kernel: Kernel, alpha: f64, fault: Option<Fault>) -> Self {
        let half = sin(0.5 * alpha);
        let square = alpha * alpha;
        let mut norm = match kernel {
            Kernel::Cone | Kernel::Disc | Kernel::Biweight => 1.0 / (4.0 * PI * half * half),
            Kernel::Epanechnikov => 1.0 / (TAU * epanechnikov_mass(alpha)),
            Kernel::VonMisesFisher => {
                let kappa = 4.0 / square;
                kappa / (TAU * (1.0 - exp(-2.0 * kappa)))
            }
        };
        match fault {
            Some(Fault::KernelNormalizedByPiAlphaSquared) => {
                norm = match kernel {
                    Kernel::Cone | Kernel::Disc | Kernel::Biweight => 1.0 / (PI * square),
                    Kernel::Epanechnikov | Kernel::VonMisesFisher => 2.0 / (PI * square),
                };
            }
            Some(Fault::KernelNormalizedByTangent) => {
                norm *= 4.0 * half * half / (tan(alpha) * tan(alpha));
            }
            Some(Fault::RadiusForRadiusSquared) => norm *= alpha,
            _ => {}
        }
        let half = match fault {
            Some(Fault::FullAngleForHalf) => sin(0.25 * alpha),
            _ => half,
        };
        let support = match kernel {
            Kernel::VonMisesFisher => f64::INFINITY,
            _ => 4.0 * half * half,
        };
        let valid = alpha > 0.0 && alpha <= PI;
        AngleKernel {
            kernel,
            norm: if valid { norm } else { 0.0 },
            support: if valid { support } else { 0.0 },
            alpha,
        }
    }

    /// The density [1/sr] at a squared chord below `support`.
    pub fn density(&self, squared_chord: f64) -> f64 {
        match self.kernel {
            Kernel::Cone | Kernel::Disc | Kernel::Biweight => self.norm,
            Kernel::Epanechnikov => {
                let half = 0.5 * sqrt(squared_chord);
                let g = 2.0 * asin(if half < 1.0 { half } else { 1.0 });
                self.norm * (1.0 - (g / self.alpha) * (g / self.alpha))
            }
            // cos g - 1 = -chord²/2.
            Kernel::VonMisesFisher => {
                self.norm * exp(-2.0 * squared_chord / (self.alpha * self.alpha))
            }
        }
    }
}

/// 1 - 2 sin a/a + 2(1 - cos a)/a², by its series where the terms cancel (next term below 1e-15 of the sum).
fn epanechnikov_mass(a: f64) -> f64 {
    let z = a * a;
    if a < 0.05 {
        z * (0.25 + z * (-1.0 / 72.0 + z * (1.0 / 2880.0 - z * (1.0 / 201_600.0))))
    } else {
        1.0 - 2.0 * sin(a) / a + 2.0 * (1.0 - cos(a)) / z
    }
}

/// What a kernel on the distance is within its radius, in units of its value at the centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Profile {
    /// 1 + slope d²: disc and Epanechnikov.
    Parabola,
    /// (1 + slope d²)²: biweight.
    Square,
    /// 1 - d/r: cone.
    Linear,
}

/// A kernel on the distance at one bandwidth: norm × profile for d² < r².
#[derive(Clone, Copy, Debug)]
pub struct RadiusKernel {
    /// Value at the centre [1/m²].
    pub norm: f64,
    /// 0 for the disc, -1/r² for Epanechnikov and biweight [1/m²].
    pub slope: f64,
    /// Radius [m].
    pub radius: f64,
    /// What it is away from the centre.
    pub profile: Profile,
}

impl RadiusKernel {
    /// A kernel of bandwidth `radius` > 0 m; zero everywhere for anything else. `VonMisesFisher` is taken for `Disc`.
    pub fn new(kernel: Kernel, radius: f64, fault: Option<Fault>) -> Self {
        let square = radius * radius;
        let of = match fault {
            Some(Fault::NormOfAnotherKernel) => another(kernel),
            _ => kernel,
        };
        let mut norm = match of {
            Kernel::Epanechnikov => 2.0 / (PI * square),
            Kernel::Biweight | Kernel::Cone => 3.0 / (PI * square),
            Kernel::Disc | Kernel::VonMisesFisher => 1.0 / (PI * square),
        };
        let (slope, profile) = match kernel {
            Kernel::Epanechnikov => (-1.0 / square, Profile::Parabola),
            Kernel::Biweight => (-1.0 / square, Profile::Square),
            Kernel::Cone => (0.0, Profile::Linear),
            Kernel::Disc | Kernel::VonMisesFisher => (0.0, Profile::Parabola),
        };
        if fault == Some(Fault::RadiusForRadiusSquared) {
            norm *= radius;
        }
        let valid = radius > 0.0 && norm.is_finite();
        RadiusKernel {
            norm: if valid { norm } else { 0.0 },
            slope: if valid { slope } else { 0.0 },
            radius: if valid { radius } else { 0.0 },
            profile,
        }
    }

    /// The density [1/m²] at a squared distance below r².
    #[inline(always)]
    pub fn density(&self, d2: f64) -> f64 {
        let parabola = 1.0 + self.slope * d2;
        self.norm
            * match self.profile {
                Profile::Parabola => parabola,
                Profile::Square => parabola * parabola,
                Profile::Linear => 1.0 - f64::sqrt(d2) / self.radius,
            }
    }
}

/// See [`Fault::NormOfAnotherKernel`].
fn another(kernel: Kernel) -> Kernel {
    match kernel {
        Kernel::Disc => Kernel::Epanechnikov,
        _ => Kernel::Disc,
    }
}

impl Kernel {
    /// Of a kernel on a distance: the β of the bias β r² ΔE of merging at a small radius, half of its second moment along an axis
    /// over r² [theory: Δ is the Laplacian on the floor]. Used by methods that choose a radius.
    pub fn bias_coefficient(self) -> f64 {
        match self {
            Kernel::Epanechnikov => 1.0 / 12.0,
            Kernel::Biweight => 1.0 / 16.0,
            Kernel::Cone => 3.0 / 40.0,
            Kernel::Disc | Kernel::VonMisesFisher => 1.0 / 8.0,
        }
    }

    /// Of a kernel on a distance: r² ∫ k² dA, by which the second moment of a photon's contribution grows as r falls.
    pub fn roughness(self) -> f64 {
        match self {
            Kernel::Epanechnikov => 4.0 / (3.0 * PI),
            Kernel::Biweight => 9.0 / (5.0 * PI),
            Kernel::Cone => 3.0 / (2.0 * PI),
            Kernel::Disc | Kernel::VonMisesFisher => 1.0 / PI,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoint rule over the sphere (in 1 - cos g) and over the plane (in d²): the mass is 1.
    #[test]
    fn kernels_integrate_to_one() {
        let n = 200_000;
        for kernel in [Kernel::Cone, Kernel::Epanechnikov, Kernel::VonMisesFisher] {
            for alpha in [0.01, 0.049, 0.051, 0.3, 1.0] {
                let k = AngleKernel::new(kernel, alpha, None);
                let end = if k.support < 4.0 {
                    k.support
                } else {
                    f64::min(4.0, 20.0 * alpha * alpha)
                };
                // dω = 2π d(1 - cos g) = π d(chord²).
                let mass: f64 = (0..n)
                    .map(|i| k.density((f64::from(i) + 0.5) / f64::from(n) * end))
                    .sum::<f64>()
                    * (PI * end / f64::from(n));
                assert!((mass - 1.0).abs() < 1e-8, "{kernel} {alpha}: {mass}");
            }
        }
        for kernel in [
            Kernel::Disc,
            Kernel::Epanechnikov,
            Kernel::Biweight,
            Kernel::Cone,
        ] {
            let r = 0.3;
            let k = RadiusKernel::new(kernel, r, None);
            let value = |d2: f64| k.density(d2);
            // dA = π d(d²): mass, second moment along an axis, and r² times the integral of the square.
            let integral = |f: &dyn Fn(f64) -> f64| -> f64 {
                // Enough points for the root in the cone.
                let at = |i: i32| (f64::from(i) + 0.5) / 2e5 * r * r;
                (0..200_000).map(|i| f(at(i))).sum::<f64>() * (PI * r * r / 2e5)
            };
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{kernel}: {a} {b}");
            close(integral(&value), 1.0);
            close(
                integral(&|d2| 0.25 * d2 * value(d2)) / (r * r),
                kernel.bias_coefficient(),
            );
            close(
                integral(&|d2| value(d2) * value(d2)) * r * r,
                kernel.roughness(),
            );
        }
    }

    #[test]
    fn a_bandwidth_out_of_range_is_a_kernel_that_is_zero() {
        for bad in [0.0, -1.0, f64::NAN, 4.0] {
            assert_eq!(AngleKernel::new(Kernel::Cone, bad, None).support, 0.0);
        }
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(RadiusKernel::new(Kernel::Disc, bad, None).norm, 0.0);
        }
    }
}
