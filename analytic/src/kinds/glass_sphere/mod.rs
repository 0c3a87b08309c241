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
//! roots are isolated by [`for_each_root_of`] from a bound of G''. Where G' = 0 the roots are born in pairs: the fold ring,
//! the rainbow. A ring of rays that reaches ρ = 0 makes the axis a line focus. On the axis the root i = 0 alone gives
//! E = E0 W a²/G'(0)². Derived here from flux conservation, E 2πρ dρ = E0 W 2πa² sin i cos i di.
//!
//! **Accuracy**: a few units of rounding times the conditioning, which grows like 1/distance to the fold.

pub mod bundle;
pub mod fold;

use crate::gradient::Gradient;
use crate::kinds::{Estimate, rounding_error};
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::roots::{Isolated, Local, Sample, for_each_root_of};
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
        self.ray_of(i.sin_cos(), interactions)
    }

    /// As [`Self::ray`], from the sine and the cosine of the incidence.
    ///
    /// The direction is e^{iδ} = (-1)^m e^{2ii} (e^{-2ir})^{m-1} with n e^{ir} = q + i sin i, without any angle.
    #[inline(always)]
    pub(in crate::kinds) fn ray_of(&self, (sin_i, cos_i): (S, S), interactions: u32) -> Ray<S> {
        let q = (self.gap() + cos_i.squared()).sqrt();
        let chords = interactions.max(1) - 1;
        let scale = S::ONE / self.index.squared();
        let chord = (
            (q - sin_i) * (q + sin_i) * scale,
            -(S::TWO * q * sin_i * scale),
        );
        let start = ((cos_i - sin_i) * (cos_i + sin_i), S::TWO * sin_i * cos_i);
        let (c, s) = (0..chords).fold(start, |(c, s), _| {
            (c * chord.0 - s * chord.1, s * chord.0 + c * chord.1)
        });
        let turned = chords.is_multiple_of(2);
        Ray {
            sin_i,
            cos_i,
            q,
            cos_d: if turned { -c } else { c },
            sin_d: if turned { -s } else { s },
            turn: S::TWO - S::TWO * S::from_f64(f64::from(chords)) * (cos_i / q),
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

    /// Bounds over the incidence angles within `half` of that of a ray.
    ///
    /// With p = n² - sin² i, dr/di = cos i/√p falls from 1/n on the axis to 0 at grazing incidence, and
    /// d²r/di² = -(n² - 1) sin i/p^(3/2), d³r/di³ = -(n² - 1) cos i (1/p^(3/2) + 3 sin² i/p^(5/2)). Sine and cosine within
    /// the range are bounded by |sin i| ± h cos i and cos i ± h |sin i|, the lower one less h²/2.
    #[inline(always)]
    pub(in crate::kinds) fn bounds(&self, ray: &Ray<S>, half: S, interactions: u32) -> Bounds<S> {
        let (one, zero) = (S::ONE, S::ZERO);
        let (sine, cosine) = (ray.sin_i.abs(), ray.cos_i.max(zero));
        let most = one.min(cosine + half * sine);
        let least = zero.max(cosine - half * sine - S::HALF * half.squared());
        let chords = S::TWO * S::from_f64(f64::from(interactions) - 1.0);
        let gap = self.gap();
        // p where the cosine is least.
        let p = gap + least.squared();
        let root = p.sqrt();
        let turn = |cosine: S, root: S| (S::TWO - chords * cosine / root).abs();
        let sine = one.min(sine + half * cosine);
        let scale = chords * gap / (p * root);
        Bounds {
            sine,
            turn: turn(least, root).max(turn(most, (gap + most.squared()).sqrt())),
            turn_1: scale * sine,
            turn_2: scale * (one + S::from_f64(3.0) * sine.squared() / p),
        }
    }

    /// G''' at most, for a receiver point at the distance `reach` from the centre.
    #[inline(always)]
    pub(in crate::kinds) fn third(&self, b: &Bounds<S>, reach: S) -> S {
        let three = S::from_f64(3.0);
        self.radius + reach * (b.turn * (b.turn.squared() + three * b.turn_1) + b.turn_2)
    }

    /// dδ'/di.
    #[inline(always)]
    pub(in crate::kinds) fn turn_1(&self, ray: &Ray<S>, interactions: u32) -> S {
        let chords = S::TWO * S::from_f64(f64::from(interactions) - 1.0);
        chords * self.gap() * ray.sin_i / (ray.q.squared() * ray.q)
    }

    /// G at a ray, for [`for_each_root_of`].
    #[inline(always)]
    fn at(&self, rho: S, reach: S, interactions: u32, i: S) -> (Ray<S>, Sample<S>) {
        let ray = self.ray(i, interactions);
        let (value, slope) = self.impact(&ray, rho);
        let rays = S::from_f64(f64::from(interactions) + 1.0);
        // Rounding of i counts with 1, that of δ with m; both shrink with i.
        let size = i.abs() * (self.radius + reach * rays) + rho.abs();
        let noise = S::from_f64(4.0) * S::EPSILON * size;
        let sample = Sample {
            value,
            slope,
            noise,
        };
        (ray, sample)
    }

    /// What [`for_each_root_of`] must know of G.
    #[inline(always)]
    fn local(&self, rho: S, reach: S, interactions: u32, i: S, half: S) -> Local<S> {
        let (ray, at) = self.at(rho, reach, interactions, i);
        let (a, c) = (self.radius, self.receiver_z);
        let b = self.bounds(&ray, half, interactions);
        let whole = a * b.sine + reach * (b.turn.squared() + b.turn_1);
        let bend = ray.turn.squared() * (c * ray.sin_d + rho * ray.cos_d)
            - self.turn_1(&ray, interactions) * (c * ray.cos_d - rho * ray.sin_d)
            - a * ray.sin_i;
        Local {
            value: at.value,
            slope: at.slope,
            curvature: whole.min(bend.abs() + half * self.third(&b, reach)),
            noise: at.noise,
        }
    }

    /// Visits every ray that reaches the receiver at the distance ρ ≥ 0 from the axis after `interactions` ≥ 1, of a beam
    /// that is a little wider than this one: what lies beyond the limit has a negative [`Root::inside`]. No allocation.
    pub fn for_each_root(&self, rho: S, interactions: u32, mut visit: impl FnMut(Root<S>)) {
        // What rounding could put on the wrong side of the limit is looked at as well.
        let wider = self.max_incidence * (S::ONE + S::EPSILON.sqrt());
        let limit = wider.min(S::HALF * S::PI);
        let reach = rho.hypot(self.receiver_z);
        for_each_root_of(
            -limit,
            limit,
            |i| self.at(rho, reach, interactions, i).1,
            |i, half| self.local(rho, reach, interactions, i, half),
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
                    visit(self.root(&ray, rho, interactions, i, touching));
                }
            },
        );
    }

    /// Irradiance by a ray; `central` says that it is the one on the axis, at ρ = 0.
    #[inline(always)]
    fn irradiance_of(&self, ray: &Ray<S>, rho: S, interactions: u32, central: bool) -> S {
        let (_, slope) = self.impact(ray, rho);
        let flux = self.irradiance * self.weight(ray, interactions) * self.radius.squared();
        if central {
            return flux / slope.squared();
        }
        flux * ray.sin_i.abs() * ray.cos_i * ray.cos_d.abs() / (rho * slope.abs())
    }

    fn root(&self, ray: &Ray<S>, rho: S, interactions: u32, i: S, touching: bool) -> Root<S> {
        let (_, slope) = self.impact(ray, rho);
        let weight = self.weight(ray, interactions);
        // A ring that meets the axis: infinitely many rays at one point.
        let on_line = rho == S::ZERO && i != S::ZERO;
        let conditioning = if on_line || touching {
            S::ONE / S::ZERO
        } else {
            self.conditioning(ray, rho, interactions, slope)
        };
        let size = self.radius + rho.hypot(self.receiver_z);
        Root {
            incidence: i,
            weight,
            irradiance: if on_line && weight > S::ZERO {
                S::ONE / S::ZERO
            } else {
                self.irradiance_of(ray, rho, interactions, rho == S::ZERO)
            },
            conditioning,
            inside: self.max_incidence - i.abs(),
            error: S::EPSILON * S::from_f64(16.0) * (size / slope.abs() + i.abs()),
            touching,
        }
    }

    /// Differentiates the irradiance along the root, di = -(∂G/∂p dp)/G'.
    fn conditioning(&self, ray: &Ray<S>, rho: S, interactions: u32, slope: S) -> S {
        type G<S> = Gradient<S, 4>;
        let input = |value: S, index: usize| G::input(value, index, value.abs());
        let sphere = GlassSphere {
            index: input(self.index, 0),
            radius: input(self.radius, 1),
            receiver_z: input(self.receiver_z, 2),
            irradiance: Scalar::ONE,
            max_incidence: Scalar::ONE,
        };
        let (sin_i, cos_i) = (ray.sin_i, ray.cos_i);
        let fixed = (G::constant(sin_i), G::constant(cos_i));
        let distance = input(rho, 3);
        let (value, _) = sphere.impact(&sphere.ray_of(fixed, interactions), distance);
        let (mut sine, mut cosine) = fixed;
        for (k, v) in value.slopes.into_iter().enumerate() {
            let moved = -v / slope;
            sine.slopes[k] = cos_i * moved;
            cosine.slopes[k] = -(sin_i * moved);
        }
        let moving = sphere.ray_of((sine, cosine), interactions);
        let central = rho == S::ZERO;
        sphere
            .irradiance_of(&moving, distance, interactions, central)
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
