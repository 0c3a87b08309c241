//! Expectations at a finite bandwidth under a plane mirror: the program's quadrature, the same integrals in
//! double-double, and the law of small bandwidths.
//!
//! **Double-double.** With x the receiver point, y the light, s on the mirror, r₁ = |s - x|, r₂ = |s - y| and c_x, c₁, c₂
//! the cosines at x and at s towards x and y, the mean is ∫ R I φ c_x c/(r₁² r₂²) dA with c = c₁ (camera), c₂ (light, linked)
//! or √(c₁ c₂) (symmetric), and for merging ∫ k E dX (`theory/bandwidth.md` §2; second moments: §4). They are summed over
//! s = s* + ρ (e₁ cos ω + e₂ sin ω + w tan θ cos ω), s* the specular root, w the direction from x to the light's image,
//! in equal steps of ω and at Gauss points of ρ from 0 to the kernel's end ρ(ω), every factor from the vectors as defined.
//! (The program integrates over the deflection g in place of ρ, with densities that are derived for it.) Nothing may cut
//! the kernel: mirror and receiver are unbounded and far from each other's line. The truncation error of [`AZIMUTHS`] and
//! [`RADII`] is below 1e-15 at the largest bandwidth swept (tested against twice as many).
//!
//! **Law.** E_α/E_0 = 1 + κ⟨g²⟩ + O(α⁴), with E_0 from the certificate and κ of `theory/bandwidth.md` §3. What is left
//! out is below [`LEFT_OUT`] α⁴, measured on the double-double values (tested), 1e-15 at the largest bandwidth where the law
//! is used.

use nephroid_analytic::bandwidth::{Expectation, Kernel, PlanarSetting, Technique};
use nephroid_analytic::double_double::DoubleDouble;
use nephroid_analytic::quadrature::gauss_legendre;
use nephroid_analytic::scalar::Scalar;
use nephroid_analytic::vector::{Vec3, vec3};

use super::forms;
use super::inputs::Inputs;
use super::quantity::{Against, Moment, Reference};

type D = DoubleDouble;
type Point = Vec3<D>;

/// Steps of the azimuth.
pub const AZIMUTHS: u32 = 16;
/// Gauss points of the radius.
pub const RADII: usize = 8;
/// Bound of what the law leaves out, in α⁴ (r⁴ in metres).
pub const LEFT_OUT: f64 = 10.0;
/// Relative tolerance that is asked of the program's quadrature.
const TOLERANCE: f64 = 1e-13;
/// The Gauss weights are `f64`.
const WEIGHTS: f64 = 1e-15;

/// The program's value and its bound.
pub(super) fn estimate(moment: &Moment, i: &Inputs) -> Option<[f64; 2]> {
    let vector = |key: &str| i.vector::<f64>(key).to_f64();
    let setting = PlanarSetting::unbounded(
        vector("light"),
        i.scalar("I"),
        vector("mirror_point"),
        vector("mirror_normal"),
        i.scalar("R"),
        [0.0, 0.0, 1.0],
    )
    .ok()?;
    let bandwidth = [i.scalar("bandwidth")];
    let expectation =
        Expectation::new(setting, moment.technique, moment.kernel, &bandwidth).ok()?;
    let moments = expectation.at([i.x[0], i.x[1], 0.0], TOLERANCE);
    let of = if moment.second {
        moments.second_moment
    } else {
        moments.mean
    };
    Some([of.value, of.error])
}

/// The reference.
pub(super) fn reference(moment: &Moment, i: &Inputs) -> Option<Reference> {
    match moment.against {
        Against::DoubleDouble => {
            let [mean, second] = moments(moment.technique, i, AZIMUTHS, RADII)?;
            let value = if moment.second { second } else { mean };
            Some(Reference::around(value.to_f64(), WEIGHTS))
        }
        Against::SmallBandwidthLaw => {
            let limit = forms::enclosed("planar-mirror", i)?;
            let b = i.scalar::<f64>("bandwidth");
            let factor = 1.0 + relative_bias(moment.technique, moment.kernel, i);
            let room = LEFT_OUT * b * b * b * b + f64::EPSILON;
            Some(Reference {
                low: limit.value.low() * (factor - room),
                high: limit.value.high() * (factor + room),
                undecided: limit.undecided,
            })
        }
    }
}

/// Light, mirror and receiver in double-double.
struct Picture {
    x: Point,
    y: Point,
    image: Point,
    /// Unit normal of the mirror.
    normal: Point,
    /// R I.
    strength: D,
    bandwidth: D,
}

impl Picture {
    fn new(i: &Inputs) -> Self {
        let normal = i.vector::<D>("mirror_normal").normalized();
        let y = i.vector::<D>("light");
        let height = (y - i.vector("mirror_point")).dot(normal);
        Picture {
            x: vec3(D::from_f64(i.x[0]), D::from_f64(i.x[1]), D::ZERO),
            y,
            image: y - normal * (D::TWO * height),
            normal,
            strength: i.scalar::<D>("I") * i.scalar::<D>("R"),
            bandwidth: i.scalar("bandwidth"),
        }
    }

    /// Mean and second moment per area of the mirror at s, for the kernel's value φ.
    fn integrand(&self, technique: Technique, s: Point, phi: D) -> [D; 2] {
        let (to_x, to_y) = (self.x - s, self.y - s);
        let (r1, r2) = (to_x.length(), to_y.length());
        let cx = -to_x.z / r1;
        let (c1, c2) = (to_x.dot(self.normal) / r1, to_y.dot(self.normal) / r2);
        let base = self.strength * phi * cx / (r1.squared() * r2.squared());
        let camera = D::PI * self.strength * phi / r2.squared();
        match technique {
            Technique::Camera => [base * c1, base * c1 * camera],
            Technique::Symmetric => {
                let both = (c1 * c2).sqrt();
                [base * both, base * c2 * camera]
            }
            _ => {
                let sample = D::from_f64(4.0) * D::PI * self.strength * phi * cx / r1.squared();
                [base * c2, base * c2 * sample]
            }
        }
    }
}

/// Mean and second moment with the technique's default kernel; `None` if the point is not in front of the mirror.
pub fn moments(technique: Technique, i: &Inputs, azimuths: u32, radii: usize) -> Option<[D; 2]> {
    let picture = Picture::new(i);
    let rule: Vec<(D, D)> = gauss_legendre(radii)
        .into_iter()
        .map(|(x, w)| {
            // On [0, 1].
            let half = D::HALF * D::from_f64(x);
            (D::HALF + half, D::HALF * D::from_f64(w))
        })
        .collect();
    let step = D::TWO * D::PI / D::from_f64(f64::from(azimuths));
    let mut sum = [D::ZERO; 2];
    for k in 0..azimuths {
        // Half a step off the frame: no symmetry of the scene is one of the steps.
        let omega = step * (D::from_f64(f64::from(k)) + D::from_f64(0.3));
        let line = picture.line(technique, omega)?;
        for &(t, weight) in &rule {
            let values = line.at(&picture, technique, line.end * t);
            for (total, value) in sum.iter_mut().zip(values) {
                *total += value * (weight * line.end * step);
            }
        }
    }
    Some(sum)
}

/// A radial line of the integral.
struct Line {
    start: Point,
    /// Change of the point per ρ.
    along: Point,
    /// dA = ρ dρ dω times this.
    area: D,
    /// Where the kernel ends.
    end: D,
}

impl Picture {
    fn line(&self, technique: Technique, omega: D) -> Option<Line> {
        let (c, s) = (omega.cos(), omega.sin());
        if technique == Technique::Merge {
            return Some(Line {
                start: self.x,
                along: vec3(c, s, D::ZERO),
                area: D::ONE,
                end: self.bandwidth,
            });
        }
        let axis = self.image - self.x;
        let length = axis.length();
        let w = axis * (D::ONE / length);
        let point = self.image + (self.y - self.image) * D::HALF;
        let p = (self.x - point).dot(self.normal);
        let q = (self.y - point).dot(self.normal);
        if !(p > D::ZERO && q > D::ZERO) {
            return None;
        }
        let (a, b) = (p * length / (p + q), q * length / (p + q));
        let cos_theta = (p + q) / length;
        let across = self.normal - w * self.normal.dot(w);
        let sin_theta = across.length();
        let e1 = across * (D::ONE / sin_theta);
        let e2 = w.cross(e1);
        let kappa = sin_theta / cos_theta * c;
        let line = Line {
            start: self.x + w * a,
            along: e1 * c + e2 * s + w * kappa,
            area: D::ONE / cos_theta,
            end: D::ZERO,
        };
        // tan g = N/D at ρ, N = ρ(a + b), D = ab + κρ(b - a) - ρ²(1 + κ²): where it is tan α.
        let end = if technique == Technique::Linked {
            self.linked_end(&line, kappa, a, b)
        } else {
            let (sin, cos) = (self.bandwidth.sin(), self.bandwidth.cos());
            let half = (a + b) * cos - kappa * (b - a) * sin;
            let square = D::ONE + kappa.squared();
            let root = (half.squared() + D::from_f64(4.0) * a * b * square * sin.squared()).sqrt();
            D::TWO * a * b * sin / (half + root)
        };
        Some(Line { end, ..line })
    }

    /// Length of the exact reflected ray from s to the floor z = 0: the straight line from the image through s.
    fn ray(&self, s: Point) -> D {
        (s - self.image).length() * s.z / (self.image.z - s.z)
    }

    /// Where d tan g = r, by Newton's method with a slope that is good for small radii.
    fn linked_end(&self, line: &Line, kappa: D, a: D, b: D) -> D {
        let mut rho = D::ZERO;
        for _ in 0..80 {
            let numerator = a + b;
            let denominator =
                a * b + kappa * rho * (b - a) - rho.squared() * (D::ONE + kappa.squared());
            let d = self.ray(line.start + line.along * rho);
            let slope = d * numerator / denominator;
            let step = self.bandwidth / slope - rho;
            rho += step;
            if step.abs().to_f64() <= 1e-31 * rho.to_f64() {
                break;
            }
        }
        rho
    }
}

impl Line {
    fn at(&self, picture: &Picture, technique: Technique, rho: D) -> [D; 2] {
        let s = self.start + self.along * rho;
        let r = picture.bandwidth;
        let [mean, second] = match technique {
            Technique::Merge => {
                let k = D::ONE / (D::PI * r.squared());
                let to = picture.image - s;
                let d = to.length();
                let e = picture.strength * to.z / (d.squared() * d);
                let photon = D::from_f64(4.0) * D::PI * picture.strength;
                [k * e, k.squared() * e * photon]
            }
            Technique::Linked => {
                // 1 - cos α for tan α = r/d.
                let d = picture.ray(s);
                let q = (d.squared() + r.squared()).sqrt();
                let phi = q * (q + d) / (D::TWO * D::PI * r.squared());
                picture.integrand(technique, s, phi)
            }
            _ => {
                let half = (D::HALF * r).sin();
                let phi = D::ONE / (D::from_f64(4.0) * D::PI * half.squared());
                picture.integrand(technique, s, phi)
            }
        };
        [mean * (rho * self.area), second * (rho * self.area)]
    }
}

/// κ⟨g²⟩, the relative bias to the leading order (`theory/bandwidth.md` §3). For `Linked` on the axis only, where the
/// receiver point is right below the light and the mirror parallel to the floor.
pub fn relative_bias(technique: Technique, kernel: Kernel, i: &Inputs) -> f64 {
    let [x, y, image, normal] = {
        let picture = Picture::new(i);
        [picture.x, picture.y, picture.image, picture.normal]
            .map(|v| vec3(v.x.to_f64(), v.y.to_f64(), v.z.to_f64()))
    };
    let b = i.scalar::<f64>("bandwidth");
    let axis = image - x;
    let distance = axis.length();
    let (p, q) = {
        let middle = image + (y - image) * 0.5;
        ((x - middle).dot(normal), (y - middle).dot(normal))
    };
    if technique == Technique::Merge {
        let beside = libm::hypot(axis.x, axis.y) / distance;
        let laplacian = (15.0 * beside * beside - 6.0) / (distance * distance);
        let share = if kernel == Kernel::Epanechnikov {
            12.0
        } else {
            8.0
        };
        return laplacian * b * b / share;
    }
    if technique == Technique::Linked {
        return -b * b / (2.0 * p * (p + q));
    }
    let spread = if kernel == Kernel::Epanechnikov {
        b * b / 3.0
    } else {
        b * b / 2.0
    };
    let w = axis * (1.0 / distance);
    // ν·w > 0, e along ν - (ν·w) w.
    let nu = if normal.dot(w) > 0.0 { normal } else { -normal };
    let cosine = nu.dot(w);
    let across = nu - w * cosine;
    let (tangent, eta) = if across.length() > 1e-12 {
        let e = across * (1.0 / across.length());
        (across.length() / cosine, e.z / w.z)
    } else {
        (0.0, 0.0)
    };
    let (m, k) = match technique {
        Technique::Camera => (4.0, 2.0),
        // √(c₁ c₂) is half way between c₁ and c₂ in the exponents of r₁ and r₂.
        Technique::Symmetric => (3.5, 2.5),
        _ => (3.0, 3.0),
    };
    let (u, v) = ((p + q) / (p * distance), (p + q) / (q * distance));
    let (c, t2) = (u + v, tangent * tangent);
    let square = u * u - u * v + v * v;
    let lean = tangent * eta - t2;
    let kappa = 1.0 / 6.0
        + (5.0 * t2 * (u - v) * (u - v) - 4.0 * (0.5 * t2 - 1.0 / 3.0) * square
            + u * u * (-0.5 * m + 0.25 * (m * m + m) * t2)
            + v * v * (-0.5 * k + 0.25 * (k * k + k) * t2)
            - 0.5 * m * k * u * v * t2
            + 0.5 * u * lean * (m * u - k * v)
            - 2.0 * (u - v) * (u * lean + (m * u - k * v) * t2))
            / (c * c);
    kappa * spread
}
