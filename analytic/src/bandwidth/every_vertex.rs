//! Two reflections in vertical plane mirrors, *both* mollified: the exact moments of an estimator with a kernel in each of
//! two directions, d = 4.
//!
//! Picture: a wedge of two mirrors with its edge on the z axis, a floor point x and a light y in it. From x a direction ω₀
//! (density cos θ/π) meets mirror a in s; there the reflection is mollified: the path goes on in *any* direction ω₁ of the
//! hemisphere about the mirror's normal (density 1/2π) with the weight R φ(g₁), g₁ the angle to the exact reflection. It
//! meets mirror b in t, where it is connected with the light, with the weight R φ(g₂), g₂ the angle between the exact
//! reflection and y - t. One sample of the irradiance is X = π · 2π · R² φ(g₁) φ(g₂) I/|y - t|². A kernel that ω₁ were
//! drawn from would cancel φ(g₁) and leave a variance like α⁻²; the uniform direction is what a method has that does not
//! know at s which of the two ends it will be connected to, and it shows both deltas: E X² ~ α⁻⁴.
//!
//! **Coordinates** (derived here). Reflecting the space behind each mirror makes the path a polyline x, s, t′, y″ with y″ the
//! image of y, g₁ its angle at s and g₂ its angle at t′:
//!
//! E X = R² I ∫ cos θ₀ dω₀ ∫ φ(g₁) φ(g₂)/|y″ - t′|² dω₁,   E X² = 2π² R⁴ I² ∫ cos θ₀ dω₀ ∫ φ(g₁)² φ(g₂)²/|y″ - t′|⁴ dω₁.
//!
//! ω₀ is in polar coordinates (γ, χ) about y″ - x, ω₁ in polar coordinates (β, ψ) about y″ - s. Along an arc of growing β, g₂
//! grows monotonically (it is β plus the angle at y″, and both grow), the cap g₁ < α is an interval, and so is what the
//! mirrors' borders leave: great circles. The same holds for γ, with the angle at s between ω₀ and y″ - s, which is less than
//! 2α where the kernels overlap. Gauss rules on these intervals, with a square-root substitution in ψ where the cap
//! ends; the error is the difference of two orders.
//!
//! Kernels without an end (von Mises–Fisher) are not taken. **Accuracy**: as the error bound says, about 1e-3 of the value: where
//! the two supports part, the inner integral has kinks that the outer rules feel.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use libm::{acos, asin, atan2, cos, sin, sincos, sqrt};

use super::kernel::{cone_height, epanechnikov_height};
use super::{Bounded, Kernel, Moments};
use crate::pixel::rule::Rule;
use crate::scene::{InvalidParameter, PlanarChainsScene};
use crate::vector::{Vec3, vec3};

type V = Vec3<f64>;

/// The kernel at one bandwidth.
struct Bump {
    kernel: Kernel,
    alpha: f64,
    height: f64,
}

impl Bump {
    fn new(kernel: Kernel, alpha: f64) -> Result<Self, InvalidParameter> {
        let refused = |key: &str, found: String, allowed: &str| InvalidParameter {
            key: key.to_owned(),
            found,
            allowed: allowed.to_owned(),
        };
        if !(alpha > 0.0 && alpha <= LARGEST) {
            let allowed = "an angle greater than 0, at most 0.7 [rad]";
            return Err(refused("bandwidth", alpha.to_string(), allowed));
        }
        let height = match kernel {
            Kernel::Cone => cone_height(alpha),
            Kernel::Epanechnikov => epanechnikov_height(alpha),
            _ => return Err(refused("kernel", kernel.to_string(), "cone, epanechnikov")),
        };
        Ok(Bump {
            kernel,
            alpha,
            height,
        })
    }

    fn at(&self, g: f64) -> f64 {
        let u = g / self.alpha;
        match self.kernel {
            _ if u > 1.0 => 0.0,
            Kernel::Epanechnikov => self.height * (1.0 - u * u),
            _ => self.height,
        }
    }
}

/// The largest bandwidth [rad]: two kernels together reach less than a quarter turn.
const LARGEST: f64 = 0.7;

/// Nodes in each of γ, χ, β, ψ, for the value and for its check.
const ORDERS: [[usize; 4]; 2] = [[20, 24, 12, 20], [14, 16, 8, 14]];

/// Unfolded geometry of one sequence of two mirrors.
struct Unfolded {
    x: V,
    /// y″.
    image: V,
    /// Inner normals of mirror a, and of the image of b in a; both planes contain the origin.
    normals: [V; 2],
}

fn mirrored(v: V, normal: V) -> V {
    v - normal * (2.0 * v.dot(normal))
}

fn angle(u: V, v: V) -> f64 {
    atan2(u.cross(v).length(), u.dot(v))
}

/// Unit vectors across a unit vector.
fn across(axis: V) -> [V; 2] {
    let aside = if axis.z.abs() < 0.7 {
        vec3(0.0, 0.0, 1.0)
    } else {
        vec3(1.0, 0.0, 0.0)
    };
    let first = aside.cross(axis).normalized();
    [first, axis.cross(first)]
}

/// Where A cos β + B sin β becomes negative, of A > 0.
fn crossing(half_space: V, axis: V, aside: V) -> f64 {
    atan2(half_space.dot(axis), -half_space.dot(aside))
}

/// The root of an increasing function in [0, end], where it is negative at 0; the end if it stays negative.
fn root(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    if f(high) <= 0.0 {
        return high;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Both integrals of one inner direction, or of all.
type Pair = [f64; 2];

impl Unfolded {
    /// Half-spaces of directions from x that meet mirror a before anything else.
    fn to_first(&self) -> [V; 3] {
        let up = vec3(0.0, 0.0, 1.0);
        let a = self.normals[0];
        // Beyond the vertical plane through x and the edge, on the side of a.
        let side = up.cross(vec3(self.x.x, self.x.y, 0.0));
        let side = if side.dot(self.image - self.x) >= 0.0 {
            side
        } else {
            side * -1.0
        };
        [up, a * -1.0, side]
    }

    /// Half-spaces of directions from s that meet the image of mirror b above the floor.
    fn to_second(&self, s: V) -> [V; 3] {
        let [a, b] = self.normals;
        let above = vec3(0.0, 0.0, 1.0) * b.dot(s) - b * s.z;
        [a * -1.0, b * -1.0, above]
    }

    /// Where a ray from a point before a plane through the origin meets it.
    fn met(normal: V, from: V, direction: V) -> V {
        from - direction * (normal.dot(from) / normal.dot(direction))
    }

    /// The integrals over ω₁ at s.
    fn inner(&self, bump: &Bump, s: V, first: V, rules: [&Rule; 2]) -> Pair {
        let alpha = bump.alpha;
        let axis = (self.image - s).normalized();
        let cuts = self.to_second(s);
        // The cap g₁ < α is at this angle from the axis, towards `lean`.
        let tilt = angle(first, axis);
        if tilt >= 2.0 * alpha {
            return [0.0; 2];
        }
        let lean = first - axis * first.dot(axis);
        let lean = if lean.length() > 1e-12 {
            lean.normalized()
        } else {
            across(axis)[0]
        };
        let turned = axis.cross(lean);
        let surrounded = tilt < alpha;
        let widest = if surrounded {
            PI
        } else {
            asin((sin(alpha) / sin(tilt)).min(1.0))
        };
        let mut sum = [0.0; 2];
        for (u, weight) in rules[1].iter() {
            // ψ and -ψ see different borders: both, from one rule on [0, widest].
            let (psi, jacobian) = if surrounded {
                (widest * u, widest)
            } else {
                (
                    widest * sin(FRAC_PI_2 * u),
                    widest * FRAC_PI_2 * cos(FRAC_PI_2 * u),
                )
            };
            let (sp, cp) = sincos(psi);
            for sign in [-1.0, 1.0] {
                let aside = lean * cp + turned * (sign * sp);
                let (a, b) = (first.dot(axis), first.dot(aside));
                let amplitude = sqrt(a * a + b * b);
                if amplitude <= cos(alpha) {
                    continue;
                }
                let (middle, half) = (atan2(b, a), acos(cos(alpha) / amplitude));
                let direction = |beta: f64| {
                    let (sb, cb) = sincos(beta);
                    axis * cb + aside * sb
                };
                let second = |beta: f64| {
                    let ray = direction(beta);
                    let t = Self::met(self.normals[1], s, ray);
                    (
                        angle(ray, self.image - t),
                        (self.image - t).length_squared(),
                    )
                };
                let cut = cuts.iter().map(|&c| crossing(c, axis, aside));
                let cut = cut.fold(middle + half, f64::min);
                // Before the border itself, where a ray is parallel to the mirror.
                let end = cut.min(alpha) * (1.0 - 1e-12);
                let low = (middle - half).max(0.0);
                if !(low < end) {
                    continue;
                }
                let high = root(end, |beta| second(beta).0 - alpha);
                if !(low < high) {
                    continue;
                }
                for (v, w) in rules[0].iter() {
                    let beta = low + (high - low) * v;
                    let (g2, squared) = second(beta);
                    let g1 = angle(first, direction(beta));
                    let value = bump.at(g1.min(alpha)) * bump.at(g2.min(alpha)) / squared;
                    let measure = weight * jacobian * w * (high - low) * sin(beta);
                    sum[0] += measure * value;
                    sum[1] += measure * value * value;
                }
            }
        }
        sum
    }

    /// The integrals over ω₀ and ω₁.
    fn integrals(&self, bump: &Bump, orders: [usize; 4]) -> Pair {
        let [gammas, chis, betas, psis] = orders.map(Rule::gauss);
        let axis = (self.image - self.x).normalized();
        let [e, f] = across(axis);
        let cuts = self.to_first();
        let chis = chis.nodes.len();
        let mut sum = [0.0; 2];
        for k in 0..chis {
            let (s, c) = sincos(TAU * (k as f64 + 0.5) / chis as f64);
            let aside = e * c + f * s;
            let direction = |gamma: f64| {
                let (sg, cg) = sincos(gamma);
                axis * cg + aside * sg
            };
            let point = |gamma: f64| Self::met(self.normals[0], self.x, direction(gamma));
            let cut = cuts.iter().map(|&c| crossing(c, axis, aside));
            let end = cut.fold(2.0 * bump.alpha, f64::min) * (1.0 - 1e-12);
            let end = root(end, |gamma| {
                angle(direction(gamma), self.image - point(gamma)) - 2.0 * bump.alpha
            });
            for (u, w) in gammas.iter() {
                let gamma = end * u;
                let ray = direction(gamma);
                let inner = self.inner(bump, point(gamma), ray, [&betas, &psis]);
                let measure = TAU / chis as f64 * end * w * sin(gamma) * ray.z;
                sum[0] += measure * inner[0];
                sum[1] += measure * inner[1];
            }
        }
        sum
    }
}

/// Moments of the irradiance of class LSSDE at the floor point (x, y) of a wedge, both reflections mollified by a kernel of
/// half-width `alpha` [rad]: of one sample, in W/m² and its square. Zero outside the wedge.
///
/// # Errors
/// A kernel without an end, or one on a radius; a bandwidth that is not in (0, 0.7]; a wedge of less than three sectors to the
/// half turn, in which a chain of two turns too far for one straight line.
pub fn two_reflections(
    scene: &PlanarChainsScene,
    x: [f64; 2],
    kernel: Kernel,
    alpha: f64,
) -> Result<Moments, InvalidParameter> {
    let bump = Bump::new(kernel, alpha)?;
    let divisor = scene.wedge.divisor;
    if divisor < 3 {
        return Err(InvalidParameter {
            key: "wedge.divisor".to_owned(),
            found: divisor.to_string(),
            allowed: "3 or more".to_owned(),
        });
    }
    let (s, c) = sincos(PI / f64::from(divisor));
    let mirrors = [vec3(0.0, 1.0, 0.0), vec3(s, -c, 0.0)];
    let x = vec3(x[0], x[1], 0.0);
    let mut sums = [[0.0; 2]; 2];
    if mirrors.iter().all(|n| n.dot(x) > 0.0) {
        for (a, b) in [(mirrors[0], mirrors[1]), (mirrors[1], mirrors[0])] {
            let unfolded = Unfolded {
                x,
                image: mirrored(mirrored(Vec3::from_f64(scene.light.position), b), a),
                normals: [a, mirrored(b, a)],
            };
            for (sum, orders) in sums.iter_mut().zip(ORDERS) {
                let [mean, square] = unfolded.integrals(&bump, orders);
                sum[0] += mean;
                sum[1] += square;
            }
        }
    }
    let weight = scene.wedge.reflectance * scene.wedge.reflectance * scene.light.intensity;
    let bounded = |k: usize, scale: f64| Bounded {
        value: scale * sums[0][k],
        error: scale * (sums[0][k] - sums[1][k]).abs(),
    };
    Ok(Moments {
        mean: bounded(0, weight),
        second_moment: bounded(1, 2.0 * PI * PI * weight * weight),
    })
}
