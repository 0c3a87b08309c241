//! Parallel light in the circular wall: the nephroid and its higher orders.
//!
//! A beam along +x meets the wall at a e^{iφ}; after k bounces it leaves a e^{iφ_k}, φ_k = (2k-1)φ + (k-1)π, in direction
//! θ_k = 2kφ + kπ, all chords being 2a cos φ. With τ the plan length along the last leg,
//!
//! ```text
//! x = a e^{iφ_k} + τ e^{iθ_k},     E = Σ E0 R^k sin ε · a cos φ / |(2k-1) a cos φ - 2k τ|,
//! ```
//!
//! and the wall is first met at height (τ + (k-1) 2a cos φ) tan ε. The caustic is τ = (2k-1)/(2k) a cos φ; for k = 1 it is
//! the nephroid (4(x² + y²) - a²)³ = 27 a⁴ y². Derived in theory block G from |det ∂x/∂(φ, τ)|.
//!
//! For one bounce the root equation is a quartic in t = tan(φ/2) on [-1, 1],
//!
//! ```text
//! q(t) = y t⁴ + (2a + 4x) t³ - 6y t² + (2a - 4x) t + y,
//! ```
//!
//! and q'' = 12y t² + 6(2a + 4x) t - 12y has two real zeros with product -1, hence exactly one in [-1, 1]. So q' has at
//! most two zeros there and q at most three, each found in a bracket without trigonometry. More bounces are isolated by
//! [`crate::roots::for_each_root`].
//!
//! **Accuracy**: `Root::conditioning` times a few units of rounding; the conditioning grows like the inverse distance to
//! the fold.

use super::circle::LinearFamily;
use super::fold::FoldRay;
use super::{CylinderCup, Light, Root};
use crate::roots::{Isolated, Sample, resolved};
use crate::scalar::Scalar;
use crate::scene::DirectionalLight;

/// Parallel light that travels along +x in plan.
#[derive(Clone, Copy, Debug)]
pub struct Beam<S> {
    /// Irradiance on a plane perpendicular to the beam, E0 [W/m²].
    pub irradiance: S,
    /// sin ε of the elevation ε.
    pub sin_elevation: S,
    /// cos ε.
    pub cos_elevation: S,
}

impl<S: Scalar> Beam<S> {
    /// tan ε: height gained per plan length.
    #[inline(always)]
    pub fn slope(&self) -> S {
        self.sin_elevation / self.cos_elevation
    }
}

impl Beam<f64> {
    /// The light of a catalogue entry.
    pub fn of(light: &DirectionalLight) -> Self {
        let elevation = light.elevation_degrees.to_radians();
        Beam {
            irradiance: light.irradiance,
            sin_elevation: libm::sin(elevation),
            cos_elevation: libm::cos(elevation),
        }
    }
}

/// The quartic of one bounce and its first derivative.
#[derive(Clone, Copy)]
struct Quartic<S> {
    y: S,
    cubic: S,
    linear: S,
}

impl<S: Scalar> Quartic<S> {
    #[inline(always)]
    fn value(&self, t: S) -> (S, S) {
        let (y, b, c) = (self.y, self.cubic, self.linear);
        let six = S::from_f64(6.0);
        let three = S::from_f64(3.0);
        let four = S::from_f64(4.0);
        let value = (((y * t + b) * t - six * y) * t + c) * t + y;
        let slope = ((four * y * t + three * b) * t - S::TWO * six * y) * t + c;
        (value, slope)
    }

    #[inline(always)]
    fn derivative(&self, t: S) -> Sample<S> {
        let (y, b) = (self.y, self.cubic);
        let six = S::from_f64(6.0);
        let size = S::from_f64(16.0) * y.abs()
            + S::from_f64(3.0) * b.abs() * t.squared()
            + self.linear.abs();
        Sample {
            value: self.value(t).1,
            slope: (S::TWO * six * y * t + six * b) * t - S::TWO * six * y,
            noise: S::from_f64(4.0) * S::EPSILON * size,
        }
    }

    /// The zero of q'' in [-1, 1], in the form that does not cancel.
    #[inline(always)]
    fn inflection(&self) -> S {
        let four_y = S::from_f64(4.0) * self.y;
        let root = (self.cubic.squared() + four_y.squared()).sqrt();
        let signed = if self.cubic < S::ZERO { -root } else { root };
        let sum = self.cubic + signed;
        if sum == S::ZERO {
            S::ZERO
        } else {
            four_y / sum
        }
    }

    /// Rounding in `value` at t.
    #[inline(always)]
    fn noise(&self, t: S) -> S {
        let t2 = t.squared();
        let size =
            self.y.abs() * S::from_f64(8.0) + t.abs() * (self.linear.abs() + self.cubic.abs() * t2);
        S::from_f64(4.0) * S::EPSILON * size
    }

    /// Visits the zeros in [-1, 1] in ascending order; the flag marks a zero that rounding cannot tell from none.
    #[inline]
    fn for_each_root(&self, mut visit: impl FnMut(S, bool)) {
        let inflection = self.inflection();
        // Cut [-1, 1] at the extrema, which lie on either side of the inflection.
        let mut ends = [-S::ONE; 4];
        let mut values = [self.value(-S::ONE).0; 4];
        let mut pieces = 0;
        let mut cut = |t: S| {
            pieces += 1;
            ends[pieces] = t;
            values[pieces] = self.value(t).0;
        };
        let (left, middle, right) = (
            self.value(-S::ONE).1,
            self.value(inflection).1,
            self.value(S::ONE).1,
        );
        for (low, high, at_low, at_high) in [
            (-S::ONE, inflection, left, middle),
            (inflection, S::ONE, middle, right),
        ] {
            if (at_low <= S::ZERO) != (at_high <= S::ZERO) {
                let rising = at_low <= S::ZERO;
                let middle = S::HALF * (low + high);
                cut(resolved(|t| self.derivative(t), low, high, middle, rising));
            }
        }
        cut(S::ONE);
        for k in 0..pieces {
            let (low, high) = (ends[k], ends[k + 1]);
            let rising = values[k] <= S::ZERO;
            if rising != (values[k + 1] <= S::ZERO) {
                // The secant is a better start than the middle.
                let secant = low - values[k] * (high - low) / (values[k + 1] - values[k]);
                let at = |t: S| {
                    let (value, slope) = self.value(t);
                    Sample {
                        value,
                        slope,
                        noise: self.noise(t),
                    }
                };
                visit(resolved(at, low, high, secant, rising), false);
            } else if k + 1 < pieces && values[k + 1].abs() <= self.noise(high) {
                // An extremum that touches zero: the point is on the fold.
                visit(high, true);
            }
        }
    }
}

impl<S: Scalar> CylinderCup<S> {
    /// Visits every ray of the beam that reaches the floor point (x, y) after `bounces` reflections at the whole circle,
    /// of any height: τ > 0 is the only condition. No allocation.
    #[inline]
    pub(super) fn for_each_beam_root(
        &self,
        beam: &Beam<S>,
        x: S,
        y: S,
        bounces: u32,
        mut visit: impl FnMut(Root<S>),
    ) {
        let a = self.wall.radius;
        if bounces == 1 {
            let four_x = S::from_f64(4.0) * x;
            let quartic = Quartic {
                y,
                cubic: S::TWO * a + four_x,
                linear: S::TWO * a - four_x,
            };
            quartic.for_each_root(|t, touching| {
                let w = S::ONE / (S::ONE + t.squared());
                let (s, c) = (S::TWO * t * w, (S::ONE - t) * (S::ONE + t) * w);
                // The last leg's direction, θ = 2φ + π.
                let (cos_theta, sin_theta) = (s.squared() - c.squared(), -S::TWO * s * c);
                let along = x * cos_theta + y * sin_theta;
                self.visit_beam_root(
                    beam,
                    1,
                    (c, s),
                    (cos_theta, sin_theta),
                    along,
                    touching,
                    &mut visit,
                );
            });
            return;
        }
        let family = self.beam_family(bounces);
        family.for_each_root(x, y, |root| {
            let (i, touching) = match root {
                Isolated::Simple(i) => (i, false),
                Isolated::Touching(i) => (i, true),
            };
            let ray = family.through(x, y, i);
            // φ = -i.
            self.visit_beam_root(
                beam,
                bounces,
                (ray.cos_i, -ray.sin_i),
                (ray.cos_theta, ray.sin_theta),
                ray.along,
                touching,
                &mut visit,
            );
        });
    }

    /// The beam's rays after k bounces: φ = -i, θ = kπ - 2k i.
    fn beam_family(&self, bounces: u32) -> LinearFamily<S> {
        LinearFamily {
            radius: self.wall.radius,
            theta0: if bounces.is_multiple_of(2) {
                S::ZERO
            } else {
                S::PI
            },
            turns: S::TWO * S::from_f64(f64::from(bounces)),
        }
    }

    #[inline(always)]
    fn visit_beam_root(
        &self,
        beam: &Beam<S>,
        bounces: u32,
        (cos_phi, sin_phi): (S, S),
        (cos_theta, sin_theta): (S, S),
        along: S,
        touching: bool,
        visit: &mut impl FnMut(Root<S>),
    ) {
        let reach = self.wall.radius * cos_phi;
        let tau = along + reach;
        if !(tau > S::ZERO && reach > S::ZERO) {
            return;
        }
        let k = S::from_f64(f64::from(bounces));
        let spread = S::TWO * k * along + reach;
        let length = tau + (k - S::ONE) * S::TWO * reach;
        let flux = beam.irradiance * beam.sin_elevation * power(self.reflectance, bounces);
        visit(Root {
            cos_phi,
            sin_phi,
            cos_theta,
            sin_theta,
            cos_incidence: cos_phi,
            tau,
            length,
            wall_z: length * beam.slope(),
            spread,
            irradiance: flux * reach / spread.abs(),
            touching,
        });
    }

    /// Upper bound of the relative change of a beam root's irradiance per relative change of x, y and a.
    ///
    /// With g = p × d(θ) - a sin i = 0 and J = ∂g/∂i: di = dg/J, ∂J/∂i = (m² - 1) a sin i at a root, m = 2k, and
    /// |∂g/∂(x, y, a)| ≤ 1 each, |∂J/∂(x, y)| ≤ m, |∂J/∂a| ≤ 1.
    pub(super) fn beam_conditioning(&self, x: S, y: S, bounces: u32, root: &Root<S>) -> S {
        let a = self.wall.radius;
        let m = S::TWO * S::from_f64(f64::from(bounces));
        let three = S::from_f64(3.0);
        let j = root.spread.abs();
        let turning = (m.squared() - S::ONE) * a * root.sin_phi.abs() / j;
        let grazing = root.sin_phi.abs() / root.cos_phi;
        let scale = a.max(x.hypot(y));
        scale * ((three * (turning + grazing) + S::TWO * m + S::ONE) / j + S::ONE / a)
    }

    /// The beam, if the light is one.
    #[inline(always)]
    pub(super) fn beam(&self) -> Option<&Beam<S>> {
        match &self.light {
            Light::Beam(beam) => Some(beam),
            Light::Point(_) => None,
        }
    }
}

impl CylinderCup<f64> {
    /// The ray with incidence angle i, at the point where the caustic touches it: p · d = -a cos i/m.
    pub(super) fn beam_fold_ray(&self, beam: &Beam<f64>, i: f64, bounces: u32) -> Option<FoldRay> {
        let family = self.beam_family(bounces);
        let ray = family.through(0.0, 0.0, i);
        let along = -self.wall.radius * ray.cos_i / family.turns;
        let mut found = None;
        self.visit_beam_root(
            beam,
            bounces,
            (ray.cos_i, -ray.sin_i),
            (ray.cos_theta, ray.sin_theta),
            along,
            true,
            &mut |root| found = Some(root),
        );
        let (across, m) = (self.wall.radius * ray.sin_i, family.turns);
        found.map(|root| FoldRay {
            root,
            along,
            across,
            speed: across * (1.0 / m - m),
        })
    }
}

/// `base^exponent` by repeated multiplication.
#[inline(always)]
pub(super) fn power<S: Scalar>(base: S, exponent: u32) -> S {
    (1..exponent).fold(base, |p, _| p * base)
}
