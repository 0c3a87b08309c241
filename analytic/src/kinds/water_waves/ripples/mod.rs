//! A vertical beam through a water surface with waves in several directions, onto a floor.
//!
//! The surface is z = H + ζ(u), ζ = Σ A cos(k·u + p), u = (u, v); the beam comes down along -z, the floor is z = 0. With the
//! gradient g, w = |g|² and Q = √(n² + (n² - 1) w), the ray refracted at u lands at
//!
//! ```text
//! x(u) = u + h κ g,   h = H + ζ,   κ = (Q - 1)/(Q + w),   dκ/dw = -κ²/(2Q),
//! J = dx/du = 1 + κ g gᵀ + h κ Z + 2 h κ' g (Z g)ᵀ,   Z the second derivatives of ζ,   E = Σ E0 T/|det J|,
//! ```
//!
//! derived here from the form of waves along x (the parent module): refraction keeps the ray in the vertical plane of the
//! gradient, where it leans by the same tangent τ = κ |g|; d/dw of (Q - 1)/(Q + w) with 2 Q Q' = n² - 1. T is that of the
//! parent module.
//!
//! All roots of x(u) = x are isolated in two dimensions; see [`roots`]. Folds are the curves det J = 0; see [`fold`].
//! **Accuracy**: a few units of rounding times the conditioning, which grows like 1/distance to the fold.

pub mod fold;
pub mod roots;

use super::bounds::{SlopeBounds, Sums};
use super::{Refused, Surface, Wave, refraction, transmittance};
use crate::gradient::Gradient;
use crate::kinds::Estimate;
use crate::scalar::Scalar;

/// One wave A cos(k·u + p).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneWave<S> {
    /// Amplitude A [m].
    pub amplitude: S,
    /// Wave vector k [1/m].
    pub wave_vector: [S; 2],
    /// Phase p [rad].
    pub phase: S,
}

/// A rippled surface over a floor, under a vertical beam.
#[derive(Clone, Debug)]
pub struct Ripples<S> {
    /// Index n > 1 of the water.
    index: S,
    /// Mean depth H [m].
    depth: S,
    /// Irradiance E0 on a horizontal plane [W/m²].
    irradiance: S,
    waves: Vec<PlaneWave<S>>,
    sums: Sums<S>,
}

/// The surface at one place: ζ and its derivatives.
#[derive(Clone, Copy, Debug)]
struct Local<T> {
    zeta: T,
    gradient: [T; 2],
    /// By uu, uv, vv.
    second: [T; 3],
    /// By uuu, uuv, uvv, vvv.
    third: [T; 4],
}

/// The ray that enters at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray<T> {
    /// Where it lands on the floor [m].
    pub floor: [T; 2],
    /// dx/du by rows.
    pub jacobian: [[T; 2]; 2],
    /// Fresnel transmittance T.
    pub transmittance: T,
}

impl<T: Scalar> Ray<T> {
    /// det dx/du: negative between folds.
    pub fn determinant(&self) -> T {
        let [[a, b], [c, d]] = self.jacobian;
        a * d - b * c
    }
}

/// Refraction at a place of which everything is known.
fn refracted<T: Scalar>(n: T, depth: T, u: [T; 2], at: &Local<T>) -> Ray<T> {
    let [gx, gy] = at.gradient;
    let w = gx.squared() + gy.squared();
    let q = (n.squared() + (n - T::ONE) * (n + T::ONE) * w).sqrt();
    let bent = (n - T::ONE) * (n + T::ONE) * (T::ONE + w) / (q + T::ONE);
    let kappa = bent / (q + w);
    let kappa_1 = -(kappa.squared() / (T::TWO * q));
    let h = depth + at.zeta;
    let [zxx, zxy, zyy] = at.second;
    let (zx, zy) = (zxx * gx + zxy * gy, zxy * gx + zyy * gy);
    let shear = T::TWO * h * kappa_1;
    Ray {
        floor: [u[0] + h * kappa * gx, u[1] + h * kappa * gy],
        jacobian: [
            [
                T::ONE + kappa * gx.squared() + h * kappa * zxx + shear * gx * zx,
                kappa * gx * gy + h * kappa * zxy + shear * gx * zy,
            ],
            [
                kappa * gx * gy + h * kappa * zxy + shear * gy * zx,
                T::ONE + kappa * gy.squared() + h * kappa * zyy + shear * gy * zy,
            ],
        ],
        transmittance: transmittance(n, q),
    }
}

/// The most radians of phase from which light may reach one floor point.
const MAX_PHASE: f64 = 100.0;

impl<S: Scalar> Ripples<S> {
    /// Waves over a floor.
    ///
    /// # Errors
    /// [`Refused`] where the closed form does not hold.
    pub fn new(
        index: S,
        depth: S,
        irradiance: S,
        waves: Vec<PlaneWave<S>>,
    ) -> Result<Self, Refused> {
        let along: Vec<_> = waves
            .iter()
            .map(|wave| Wave {
                amplitude: wave.amplitude,
                wave_number: wave.wave_vector[0].hypot(wave.wave_vector[1]),
                phase: wave.phase,
            })
            .collect();
        let sums = Sums::of(&along);
        if !(index > S::ONE) {
            return Err(Refused::Index);
        }
        if !(depth > sums.height) {
            return Err(Refused::Depth);
        }
        // No refracted ray meets the surface again: it is steeper than the surface, in every direction.
        if !(sums.slope * refraction(index, sums.slope).tau < S::ONE) {
            return Err(Refused::Steep);
        }
        let water = Ripples {
            index,
            depth,
            irradiance,
            waves,
            sums,
        };
        if !(water.reach() * water.sums.largest_wave_number < S::from_f64(MAX_PHASE)) {
            return Err(Refused::TooManyWavelengths);
        }
        Ok(water)
    }

    /// The farthest that a ray can move sideways before it reaches the floor [m].
    pub fn reach(&self) -> S {
        (self.depth + self.sums.height) * refraction(self.index, self.sums.slope).tau
    }

    /// Height of the lowest trough that the amplitudes allow [m].
    pub fn lowest(&self) -> S {
        self.depth - self.sums.height
    }

    /// The ray that enters at u.
    pub fn ray(&self, u: [S; 2]) -> Ray<S> {
        self.ray_in(u, |s| s)
    }

    /// Flux that enters per area of the surface's plan [W/m²].
    pub fn flux(&self, ray: &Ray<S>) -> S {
        self.irradiance * ray.transmittance
    }

    /// The ray at u for a scalar that carries derivatives.
    fn ray_in<T: Scalar>(&self, u: [T; 2], lift: impl Fn(S) -> T + Copy) -> Ray<T> {
        let at = self.surface(u, lift);
        refracted(lift(self.index), lift(self.depth), u, &at)
    }

    /// ζ and its derivatives at u.
    fn surface<T: Scalar>(&self, u: [T; 2], lift: impl Fn(S) -> T) -> Local<T> {
        let zero = T::ZERO;
        let mut at = Local {
            zeta: zero,
            gradient: [zero; 2],
            second: [zero; 3],
            third: [zero; 4],
        };
        for wave in &self.waves {
            let [kx, ky] = wave.wave_vector.map(&lift);
            let angle = kx * u[0] + ky * u[1] + lift(wave.phase);
            let a = lift(wave.amplitude);
            let (sine, cosine) = angle.sin_cos();
            let (cosine, sine) = (a * cosine, a * sine);
            let (xx, xy, yy) = (kx.squared(), kx * ky, ky.squared());
            at.zeta += cosine;
            at.gradient[0] -= kx * sine;
            at.gradient[1] -= ky * sine;
            at.second[0] -= xx * cosine;
            at.second[1] -= xy * cosine;
            at.second[2] -= yy * cosine;
            at.third[0] += xx * kx * sine;
            at.third[1] += xx * ky * sine;
            at.third[2] += xy * ky * sine;
            at.third[3] += yy * ky * sine;
        }
        at
    }

    /// Bound of the second derivatives of x(u), as a bilinear map, within `half` of a place.
    ///
    /// With t(g) = κ g, |t| = τ and |Dt| = τ' at most; D²t has the radial part τ'' and the other parts (τ' - τ/s)/s, of which
    /// the modulus is at most half the bound of τ'': together (√5/2) τ'', below 9/8. Then, as in one dimension,
    /// |D²x| ≤ |Z| (τ + 2 s τ') + h (9/8 τ'' |Z|² + τ' |D³ζ|).
    fn curvature(&self, at: &Local<S>, half: S) -> S {
        let along = self.norms(at);
        let b = SlopeBounds::of(self.index, self.sums.slope_within(&along, half));
        let (second, third) = (
            self.sums.second_within(&along, half),
            self.sums.third_within(&along, half),
        );
        let bent = S::from_f64(1.125) * b.tau_2 * second.squared();
        second * (b.tau + S::TWO * b.slope * b.tau_1)
            + (self.depth + self.sums.height) * (bent + b.tau_1 * third)
    }

    /// Norms of the derivatives, in the shape of one dimension.
    fn norms(&self, at: &Local<S>) -> Surface<S> {
        let [xx, xy, yy] = at.second.map(S::squared);
        let [xxx, xxy, xyy, yyy] = at.third.map(S::squared);
        let three = S::from_f64(3.0);
        Surface {
            zeta: at.zeta,
            slope: at.gradient[0].hypot(at.gradient[1]),
            second: (xx + S::TWO * xy + yy).sqrt(),
            third: (xxx + three * (xxy + xyy) + yyy).sqrt(),
        }
    }

    /// What rounding can move a landing point by [m].
    fn noise(&self, x: [S; 2], u: [S; 2]) -> S {
        let plan = u[0].abs() + u[1].abs();
        let b = SlopeBounds::of(self.index, self.sums.slope);
        let lean = b.tau_1 * self.sums.changes(plan)[1];
        let size =
            plan + x[0].abs() + x[1].abs() + (self.depth + self.sums.height) * (b.tau + lean);
        S::from_f64(4.0) * S::EPSILON * size
    }

    /// Caustic irradiance (LSDE) of the floor at (x, y) [W/m²].
    pub fn caustic(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        for root in self.roots([x, y]) {
            sum.add(root.irradiance, root.conditioning);
            if root.touching {
                sum.error = S::ONE / S::ZERO;
            }
        }
        sum
    }

    /// Differentiates T/|det J| along the root, du = -J⁻¹ ∂x/∂p dp, by x, H, n and the surface's height and derivatives,
    /// each of which changes as much as all waves together allow.
    fn conditioning(&self, x: [S; 2], u: [S; 2]) -> S {
        type G<S> = Gradient<S, 10>;
        let at = self.surface(u, |s| s);
        let plan = u[0].abs() + u[1].abs();
        let [by_zeta, by_slope, by_second] = self.sums.changes(plan);
        let n = G::input(self.index, 0, self.index);
        let depth = G::input(self.depth, 1, self.depth);
        let moving = Local {
            zeta: G::input(at.zeta, 2, by_zeta),
            gradient: [
                G::input(at.gradient[0], 3, by_slope),
                G::input(at.gradient[1], 4, by_slope),
            ],
            second: [
                G::input(at.second[0], 5, by_second),
                G::input(at.second[1], 6, by_second),
                G::input(at.second[2], 7, by_second),
            ],
            third: at.third.map(G::constant),
        };
        let ray = refracted(n, depth, u.map(G::constant), &moving);
        let known = (x[0].abs() + x[1].abs() + plan).max(self.reach());
        let miss = [
            ray.floor[0] - G::input(x[0], 8, known),
            ray.floor[1] - G::input(x[1], 9, known),
        ];
        let [[a, b], [c, d]] = ray.jacobian.map(|row| row.map(|e| e.value));
        let determinant = a * d - b * c;
        // Where the ray enters moves with every input.
        let mut du = [G::constant(S::ZERO); 2];
        for i in 0..10 {
            let (p, q) = (miss[0].slopes[i], miss[1].slopes[i]);
            du[0].slopes[i] = -(d * p - b * q) / determinant;
            du[1].slopes[i] = -(a * q - c * p) / determinant;
        }
        let along = |value: G<S>, by: [S; 2]| {
            value + G::constant(by[0]) * du[0] + G::constant(by[1]) * du[1]
        };
        let [xx, xy, yy] = at.second;
        let [xxx, xxy, xyy, yyy] = at.third;
        let moved = Local {
            zeta: along(moving.zeta, at.gradient),
            gradient: [
                along(moving.gradient[0], [xx, xy]),
                along(moving.gradient[1], [xy, yy]),
            ],
            second: [
                along(moving.second[0], [xxx, xxy]),
                along(moving.second[1], [xxy, xyy]),
                along(moving.second[2], [xyy, yyy]),
            ],
            third: moving.third,
        };
        let ray = refracted(n, depth, u.map(G::constant), &moved);
        (ray.transmittance / ray.determinant()).relative_change()
    }
}
