//! A vertical beam through a wavy water surface, onto a floor.
//!
//! The surface is z = H + ζ(x), ζ = Σ A cos(kx + p), extruded along y; the beam comes down along -z, the floor is z = 0.
//! With the slope s = ζ' and Q = √(n² + (n² - 1)s²), the refracted ray at u leans by the tangent
//!
//! ```text
//! τ(s) = s (Q - 1)/(Q + s²),   τ'(s) = n² (1 + s²)(Q - 1)/(Q (Q + s²)²) > 0,   Q - 1 = (n² - 1)(1 + s²)/(Q + 1),
//! x(u) = u + (H + ζ) τ(s),     dx/du = 1 + s τ + (H + ζ) τ' ζ'',               E = Σ E0 T/|dx/du|
//! T = 2Q/(1 + Q)² + 2n²Q/(n² + Q)²,
//! ```
//!
//! theory block L with the trigonometry worked out (derived here: t = d/n + (cos i/n - cos t) N, N = (-s, 1)/√(1 + s²)).
//! All roots of x(u) = x lie within (H + Σ|A|) τ(Σ|A k|) of x and are isolated by [`for_each_root`] from a bound of d²x/du².
//! The surface must be so flat that Σ|A k| · τ(Σ|A k|) < 1: then no refracted ray meets it again.
//!
//! Folds are the zeros of dx/du, born in pairs at cusps; see [`fold`]. Views from above: [`eye`]. **Accuracy**: a few
//! units of rounding times the conditioning, which grows like 1/distance to the fold.

mod bounds;
pub mod eye;
pub mod fold;
pub mod ripples;

use crate::gradient::Gradient;
use crate::kinds::Estimate;
use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;

use bounds::{SlopeBounds, Sums};

/// One wave A cos(kx + p).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave<S> {
    /// Amplitude A [m].
    pub amplitude: S,
    /// Wave number k [1/m].
    pub wave_number: S,
    /// Phase p [rad].
    pub phase: S,
}

/// A wavy surface over a floor, under a vertical beam.
#[derive(Clone, Debug)]
pub struct WaterWaves<S> {
    /// Index n > 1 of the water.
    index: S,
    /// Mean depth H [m].
    depth: S,
    /// Irradiance E0 on a horizontal plane [W/m²].
    irradiance: S,
    waves: Vec<Wave<S>>,
    sums: Sums<S>,
}

/// What keeps waves from having a closed form here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The index is not above 1.
    Index,
    /// The troughs reach the floor.
    Depth,
    /// The slopes are so steep that refracted light might meet the surface again.
    Steep,
    /// So many wavelengths can light one point that isolating all roots would take too long.
    TooManyWavelengths,
}

/// The surface at one place: ζ and its derivatives.
#[derive(Clone, Copy, Debug)]
pub(in crate::kinds) struct Surface<S> {
    pub zeta: S,
    pub slope: S,
    pub second: S,
    pub third: S,
}

/// A ray that reaches a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Where the ray enters the water [m].
    pub u: S,
    /// dx/du: negative between folds.
    pub stretch: S,
    /// Fresnel transmittance T.
    pub transmittance: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// Rounding cannot tell this root from none.
    pub touching: bool,
}

/// Refraction of the vertical beam at a slope.
#[derive(Clone, Copy)]
struct Refraction<S> {
    q: S,
    /// τ and dτ/ds.
    tau: S,
    tau_1: S,
}

/// τ(s) and its derivative for the index n.
#[inline(always)]
fn refraction<S: Scalar>(n: S, s: S) -> Refraction<S> {
    let gap = (n - S::ONE) * (n + S::ONE);
    let steep = S::ONE + s.squared();
    let q = (n.squared() + gap * s.squared()).sqrt();
    let bent = gap * steep / (q + S::ONE);
    let sum = q + s.squared();
    Refraction {
        q,
        tau: s * bent / sum,
        tau_1: n.squared() * steep * bent / (q * sum.squared()),
    }
}

/// T of the vertical beam.
#[inline(always)]
fn transmittance<S: Scalar>(n: S, q: S) -> S {
    let m = n.squared();
    S::TWO * q * (S::ONE / (S::ONE + q).squared() + m / (m + q).squared())
}

/// x - u and dx/du.
#[inline(always)]
fn landing<S: Scalar>(r: &Refraction<S>, depth: S, zeta: S, slope: S, second: S) -> (S, S) {
    let h = depth + zeta;
    (h * r.tau, S::ONE + slope * r.tau + h * r.tau_1 * second)
}

/// The most radians of phase from which light may reach one floor point.
const MAX_PHASE: f64 = 2e4;

impl<S: Scalar> WaterWaves<S> {
    /// Waves over a floor.
    ///
    /// # Errors
    /// [`Refused`] where the closed form does not hold.
    pub fn new(index: S, depth: S, irradiance: S, waves: Vec<Wave<S>>) -> Result<Self, Refused> {
        let sums = Sums::of(&waves);
        if !(index > S::ONE) {
            return Err(Refused::Index);
        }
        if !(depth > sums.height) {
            return Err(Refused::Depth);
        }
        let steepest = refraction(index, sums.slope);
        if !(sums.slope * steepest.tau < S::ONE) {
            return Err(Refused::Steep);
        }
        let water = WaterWaves {
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

    /// Height of the highest crest that the amplitudes allow [m].
    pub fn highest(&self) -> S {
        self.depth + self.sums.height
    }

    /// The largest |k| of a wave with an amplitude [1/m].
    pub fn largest_wave_number(&self) -> S {
        self.sums.largest_wave_number
    }

    /// ζ and its derivatives at u.
    #[inline]
    pub(in crate::kinds) fn surface(&self, u: S) -> Surface<S> {
        let mut at = Surface {
            zeta: S::ZERO,
            slope: S::ZERO,
            second: S::ZERO,
            third: S::ZERO,
        };
        for wave in &self.waves {
            let k = wave.wave_number;
            let angle = k * u + wave.phase;
            let (cosine, sine) = (wave.amplitude * angle.cos(), wave.amplitude * angle.sin());
            let k2 = k.squared();
            at.zeta += cosine;
            at.slope -= k * sine;
            at.second -= k2 * cosine;
            at.third += k2 * k * sine;
        }
        at
    }

    /// Bounds of τ and its derivatives for all slopes within `half` of u.
    fn slope_bounds(&self, at: &Surface<S>, half: S) -> SlopeBounds<S> {
        SlopeBounds::of(self.index, self.sums.slope_within(at, half))
    }

    /// What [`for_each_root`] must know of x(u) - x.
    fn local(&self, x: S, u: S, half: S) -> Local<S> {
        let at = self.surface(u);
        let r = refraction(self.index, at.slope);
        let (shift, slope) = landing(&r, self.depth, at.zeta, at.slope, at.second);
        let b = self.slope_bounds(&at, half);
        let (second, third) = (
            self.sums.second_within(&at, half),
            self.sums.third_within(&at, half),
        );
        let h = self.highest();
        let size = u.abs() + x.abs() + h * (r.tau.abs() + b.tau_1 * self.slope_noise(u));
        Local {
            value: u - x + shift,
            slope,
            curvature: second * (b.tau + S::TWO * b.slope * b.tau_1)
                + h * (b.tau_2 * second.squared() + b.tau_1 * third),
            noise: S::from_f64(4.0) * S::EPSILON * size,
        }
    }

    /// What a relative change of 1 of every wave's parameters and of u can change the slope by.
    fn slope_noise(&self, u: S) -> S {
        self.sums.changes(u.abs())[1]
    }

    /// Visits every ray that reaches the floor at x, in ascending u. No allocation.
    pub fn for_each_root(&self, x: S, mut visit: impl FnMut(Root<S>)) {
        // Rounding of the bound itself must not cut off a root.
        let reach = self.reach() * (S::ONE + S::from_f64(16.0) * S::EPSILON)
            + S::from_f64(16.0) * S::EPSILON * x.abs();
        for_each_root(
            x - reach,
            x + reach,
            |u, half| self.local(x, u, half),
            |root| {
                let (u, touching) = match root {
                    Isolated::Simple(u) => (u, false),
                    Isolated::Touching(u) => (u, true),
                };
                visit(self.root(x, u, touching));
            },
        );
    }

    fn root(&self, x: S, u: S, touching: bool) -> Root<S> {
        let at = self.surface(u);
        let r = refraction(self.index, at.slope);
        let (_, stretch) = landing(&r, self.depth, at.zeta, at.slope, at.second);
        let t = transmittance(self.index, r.q);
        Root {
            u,
            stretch,
            transmittance: t,
            irradiance: self.irradiance * t / stretch.abs(),
            conditioning: if touching {
                S::ONE / S::ZERO
            } else {
                self.conditioning(x, u, &at, stretch)
            },
            touching,
        }
    }

    /// Differentiates T/|dx/du| along the root, du = -(∂x/∂p dp)/(dx/du), by x, H, n and the surface's height, slope and
    /// second derivative, each of which changes as much as all waves together allow.
    fn conditioning(&self, x: S, u: S, at: &Surface<S>, stretch: S) -> S {
        type G<S> = Gradient<S, 6>;
        let changes = self.sums.changes(u.abs());
        let n = G::input(self.index, 0, self.index);
        let depth = G::input(self.depth, 1, self.depth);
        let zeta = G::input(at.zeta, 2, changes[0]);
        let slope = G::input(at.slope, 3, changes[1]);
        let second = G::input(at.second, 4, changes[2]);
        let (shift, _) = landing(&refraction(n, slope), depth, zeta, slope, second);
        // A place counts as known to a part of the reach at least, so that views can displace it.
        let offset = shift - G::input(x, 5, (x.abs() + u.abs()).max(self.reach()));
        // The entry point moves, and the surface under it.
        let mut moving = G::constant(u);
        for (m, v) in moving.slopes.iter_mut().zip(offset.slopes) {
            *m = -v / stretch;
        }
        let along = |value: G<S>, derivative: S| {
            let mut sum = value;
            for (s, m) in sum.slopes.iter_mut().zip(moving.slopes) {
                *s += derivative * m;
            }
            sum
        };
        let (zeta, slope, second) = (
            along(zeta, at.slope),
            along(slope, at.second),
            along(second, at.third),
        );
        let r = refraction(n, slope);
        let (_, stretch) = landing(&r, depth, zeta, slope, second);
        (transmittance(n, r.q) / stretch).relative_change()
    }

    /// Caustic irradiance (LSDE) of the floor at x [W/m²].
    pub fn caustic(&self, x: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        self.for_each_root(x, |root| {
            sum.add(root.irradiance, root.conditioning);
            if root.touching {
                sum.error = S::ONE / S::ZERO;
            }
        });
        sum
    }
}
