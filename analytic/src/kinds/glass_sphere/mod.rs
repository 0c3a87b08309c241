//! A glass sphere in a parallel beam, before a receiver plane across the beam.
//!
//! Centre 0, radius a, index n; the beam runs along +z and is limited to incidence angles up to `max_incidence`. The
//! receiver z = c, |c| ≥ a, faces the sphere and does not block. After m interactions (m = 1: reflected outside, LRDE;
//! m ≥ 2: refracted, m - 2 internal reflections, refracted) a ray that came in at the angle i, sin i = n sin r, leaves in the
//! direction δ from +z,
//!
//! ```text
//! δ = mπ + η,   η = 2i - 2(m - 1) r,
//! ```
//!
//! turned over to the other side of the axis, and every chord, hence every leg, passes the centre at the same distance
//! a sin i. So the ray that reaches the receiver at the signed distance ρ from the axis (on the side it came from where
//! i > 0, on the other where i < 0) is a root of
//!
//! ```text
//! G(i) = a sin i - ρ cos δ - c sin δ = 0,    cos δ · c > 0,    -π/2 ≤ i ≤ π/2,
//! E = E0 W a² |sin i| cos i |cos δ|/(ρ |G'(i)|),    W = F for m = 1, T² F^(m-2) for m ≥ 2,
//! ```
//!
//! equivalent to theory block K for m = 2 and 3, but without its poles at δ = ±π/2 and its cancellation far away. All
//! roots are isolated by [`for_each_root`] from a bound of G''. Where G' = 0 the roots are born in pairs: the fold ring,
//! the rainbow. A ring of rays that reaches ρ = 0 makes the axis a line focus. On the axis the root i = 0 alone gives
//! E = E0 W a²/G'(0)². Derived here from flux conservation, E 2πρ dρ = E0 W 2πa² sin i cos i di.
//!
//! **Accuracy**: a few units of rounding times the conditioning, which grows like 1/distance to the fold.

pub mod bundle;
pub mod fold;

use crate::gradient::Gradient;
use crate::kinds::{Estimate, rounding_error};
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::roots::{Isolated, Local, for_each_root};
use crate::scalar::Scalar;

/// The most interactions with the sphere that are counted in one path.
pub const MAX_INTERACTIONS: u32 = 14;

/// A glass sphere with beam and receiver.
#[derive(Clone, Copy, Debug)]
pub struct GlassSphere<S> {
    /// Index n > 1 of the glass.
    pub index: S,
    /// Radius a [m].
    pub radius: S,
    /// Irradiance E0 on a plane perpendicular to the beam [W/m²].
    pub irradiance: S,
    /// Position c of the receiver plane along the beam, |c| ≥ a [m].
    pub receiver_z: S,
    /// The largest incidence angle in the beam, at most π/2 [rad].
    pub max_incidence: S,
}

/// A ray of the beam that reaches a receiver point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Incidence angle [rad]: positive where the ray comes in on the side of the receiver point, negative on the other.
    pub incidence: S,
    /// Product W of the Fresnel factors.
    pub weight: S,
    /// Irradiance of the receiver [W/m²]; infinite on a fold or on the axial line.
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// How far the incidence is from the limit of the beam, negative beyond it [rad].
    pub inside: S,
    /// What rounding can do to the incidence [rad].
    pub error: S,
    /// Rounding cannot tell this root from none.
    pub touching: bool,
}

/// A ray with its refraction.
#[derive(Clone, Copy)]
pub(in crate::kinds) struct Ray<S> {
    pub sin_i: S,
    pub cos_i: S,
    /// n cos r.
    pub q: S,
    /// cos δ and sin δ.
    pub cos_d: S,
    pub sin_d: S,
    /// dδ/di.
    pub turn: S,
}

/// Bounds of |sin i|, dδ/di and its derivatives over a range of incidence angles.
#[derive(Clone, Copy)]
pub(in crate::kinds) struct Bounds<S> {
    pub sine: S,
    pub turn: S,
    pub turn_1: S,
    pub turn_2: S,
}

impl<S: Scalar> GlassSphere<S> {
    /// The ray with incidence `i` after `interactions`.
    #[inline(always)]
    pub(in crate::kinds) fn ray(&self, i: S, interactions: u32) -> Ray<S> {
        let (sin_i, cos_i) = (i.sin(), i.cos());
        let q = (self.gap() + cos_i.squared()).sqrt();
        let chords = S::TWO * S::from_f64(f64::from(interactions) - 1.0);
        let r = sin_i.atan2(q);
        let eta = S::TWO * i - chords * r;
        let sign = if interactions.is_multiple_of(2) {
            S::ONE
        } else {
            -S::ONE
        };
        Ray {
            sin_i,
            cos_i,
            q,
            cos_d: sign * eta.cos(),
            sin_d: sign * eta.sin(),
            turn: S::TWO - chords * (cos_i / q),
        }
    }

    /// n² - 1.
    #[inline(always)]
    fn gap(&self) -> S {
        (self.index - S::ONE) * (self.index + S::ONE)
    }

    /// G and G' at a ray for the receiver distance ρ.
    #[inline(always)]
    fn impact(&self, ray: &Ray<S>, rho: S) -> (S, S) {
        let (a, c) = (self.radius, self.receiver_z);
        (
            a * ray.sin_i - rho * ray.cos_d - c * ray.sin_d,
            a * ray.cos_i - ray.turn * (c * ray.cos_d - rho * ray.sin_d),
        )
    }

    /// W.
    #[inline(always)]
    fn weight(&self, ray: &Ray<S>, interactions: u32) -> S {
        let (one, n) = (S::ONE, self.index);
        let f = fresnel_reflectance(one, ray.cos_i, n, ray.q);
        if interactions == 1 {
            return f;
        }
        let t = fresnel_transmittance(one, ray.cos_i, n, ray.q);
        (2..interactions).fold(t.squared(), |w, _| w * f)
    }

    /// Bounds over the incidence angles within `half` of `i`.
    ///
    /// With p = n² - sin² i, dr/di = cos i/√p falls from 1/n on the axis to 0 at grazing incidence, and
    /// d²r/di² = -(n² - 1) sin i/p^(3/2), d³r/di³ = -(n² - 1) cos i (1/p^(3/2) + 3 sin² i/p^(5/2)).
    #[inline(always)]
    pub(in crate::kinds) fn bounds(&self, i: S, half: S, interactions: u32) -> Bounds<S> {
        let quarter = S::HALF * S::PI;
        let far = (i.abs() + half).min(quarter);
        let near = (i.abs() - half).max(S::ZERO);
        let chords = S::TWO * S::from_f64(f64::from(interactions) - 1.0);
        let turn = |angle: S| {
            let cosine = angle.cos();
            (S::TWO - chords * cosine / (self.gap() + cosine.squared()).sqrt()).abs()
        };
        let (sine, cosine) = (far.sin(), far.cos());
        let p = self.gap() + cosine.squared();
        let cubed = p * p.sqrt();
        let scale = chords * self.gap() / cubed;
        Bounds {
            sine,
            turn: turn(near).max(turn(far)),
            turn_1: scale * sine,
            turn_2: scale * (S::ONE + S::from_f64(3.0) * sine.squared() / p),
        }
    }

    /// What [`for_each_root`] must know of G.
    #[inline(always)]
    fn local(&self, rho: S, interactions: u32, i: S, half: S) -> Local<S> {
        let ray = self.ray(i, interactions);
        let (value, slope) = self.impact(&ray, rho);
        let (a, reach) = (self.radius, rho.hypot(self.receiver_z));
        let b = self.bounds(i, half, interactions);
        let rays = S::from_f64(f64::from(interactions) + 1.0);
        Local {
            value,
            slope,
            curvature: a * b.sine + reach * (b.turn.squared() + b.turn_1),
            // Rounding of i counts with 1, that of δ with m; both shrink with i.
            noise: S::from_f64(4.0) * S::EPSILON * (i.abs() * (a + reach * rays) + rho.abs()),
        }
    }

    /// Visits every ray that reaches the receiver at the distance ρ ≥ 0 from the axis after `interactions` ≥ 1, of a beam
    /// that is a little wider than this one: what lies beyond the limit has a negative [`Root::inside`]. No allocation.
    pub fn for_each_root(&self, rho: S, interactions: u32, mut visit: impl FnMut(Root<S>)) {
        // What rounding could put on the wrong side of the limit is looked at as well.
        let wider = self.max_incidence * (S::ONE + S::EPSILON.sqrt());
        let limit = wider.min(S::HALF * S::PI);
        for_each_root(
            -limit,
            limit,
            |i, half| self.local(rho, interactions, i, half),
            |root| {
                let (i, touching) = match root {
                    Isolated::Simple(i) => (i, false),
                    Isolated::Touching(i) => (i, true),
                };
                // On the axis the central ray is a root exactly, which a bracket reaches to within rounding.
                let central = rho == S::ZERO && i.abs() <= S::EPSILON;
                let i = if central { S::ZERO } else { i };
                let ray = self.ray(i, interactions);
                if ray.cos_d * self.receiver_z > S::ZERO {
                    visit(self.root(rho, interactions, i, touching));
                }
            },
        );
    }

    /// Irradiance by the ray at the root `i`.
    #[inline(always)]
    fn root_irradiance(&self, rho: S, interactions: u32, i: S) -> S {
        let ray = self.ray(i, interactions);
        let (_, slope) = self.impact(&ray, rho);
        let flux = self.irradiance * self.weight(&ray, interactions) * self.radius.squared();
        if rho == S::ZERO && i == S::ZERO {
            return flux / slope.squared();
        }
        flux * ray.sin_i.abs() * ray.cos_i * ray.cos_d.abs() / (rho * slope.abs())
    }

    fn root(&self, rho: S, interactions: u32, i: S, touching: bool) -> Root<S> {
        let ray = self.ray(i, interactions);
        let (_, slope) = self.impact(&ray, rho);
        let weight = self.weight(&ray, interactions);
        // A ring that meets the axis: infinitely many rays at one point.
        let on_line = rho == S::ZERO && i != S::ZERO;
        let conditioning = if on_line || touching {
            S::ONE / S::ZERO
        } else {
            self.conditioning(rho, interactions, i, slope)
        };
        let size = self.radius + rho.hypot(self.receiver_z);
        Root {
            incidence: i,
            weight,
            irradiance: if on_line && weight > S::ZERO {
                S::ONE / S::ZERO
            } else {
                self.root_irradiance(rho, interactions, i)
            },
            conditioning,
            inside: self.max_incidence - i.abs(),
            error: S::EPSILON * S::from_f64(16.0) * (size / slope.abs() + i.abs()),
            touching,
        }
    }

    /// Differentiates the irradiance along the root, di = -(∂G/∂p dp)/G'.
    fn conditioning(&self, rho: S, interactions: u32, i: S, slope: S) -> S {
        type G<S> = Gradient<S, 4>;
        let input = |value: S, index: usize| G::input(value, index, value.abs());
        let sphere = GlassSphere {
            index: input(self.index, 0),
            radius: input(self.radius, 1),
            receiver_z: input(self.receiver_z, 2),
            irradiance: Scalar::ONE,
            max_incidence: Scalar::ONE,
        };
        let rho = input(rho, 3);
        let fixed = G::constant(i);
        let (value, _) = sphere.impact(&sphere.ray(fixed, interactions), rho);
        let mut moving = G::constant(i);
        for (m, v) in moving.slopes.iter_mut().zip(value.slopes) {
            *m = -v / slope;
        }
        sphere
            .root_irradiance(rho, interactions, moving)
            .relative_change()
    }

    /// Irradiance at the distance ρ from the axis by rays with exactly `interactions` [W/m²].
    pub fn caustic(&self, rho: S, interactions: u32) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        self.for_each_root(rho, interactions, |root| {
            let lit = root.inside >= S::ZERO;
            if lit {
                sum.add(root.irradiance, root.conditioning);
            }
            if lit && root.touching {
                sum.error = S::ONE / S::ZERO;
            } else if root.inside.abs() <= root.error + rounding_error(self.max_incidence, S::ZERO)
            {
                sum.error += root.irradiance;
            }
        });
        sum
    }
}
