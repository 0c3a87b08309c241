//! A vertical glass cylinder on a floor, in the sun.
//!
//! The pillar of radius a, height H and index n stands on z = 0; the floor under it and its top absorb. The beam runs
//! along +x and comes down at the elevation ε, with irradiance E0 across it.
//!
//! **Plan.** With k = (t, q, v) the wave vector's tangential, normal and vertical components in units of the vacuum's,
//! Snell's law at a vertical side keeps t and v = sin ε, outside and inside alike; |k| is 1 outside and n inside. In plan
//! |k| is therefore cos ε outside and sqrt(n² - sin² ε) inside: the plan view is refraction at the index
//!
//! ```text
//! n' = sqrt(n² - sin² ε)/cos ε,     n'² - 1 = (n² - 1)/cos² ε     (Bravais),
//! ```
//!
//! and the descent per plan length is tan ε outside, (tan ε)/n' inside. q = cos ε cos i outside and
//! q' = sqrt(n² - 1 + q²) inside give the Fresnel factors of the true angles.
//!
//! **Roots.** The plan view is that of a glass sphere's meridian with index n' ([`crate::kinds::glass_sphere`]): after m
//! interactions (m = 1 reflection outside, LRDE; m ≥ 2 with m - 2 internal reflections, LTTDE, LTRTDE, ...) the ray that
//! came in at the angle i (y = a sin i) has turned by δ = mπ + 2i - 2(m - 1) r, to the direction d = (cos δ, -sin δ), and
//! passes the axis at the distance a sin i. It comes by the floor point p, seen from the axis, where
//!
//! ```text
//! G(i) = a sin i - p_y cos δ - p_x sin δ = 0,    τ = p·d - a cos i > 0,
//! E = Σ E0 sin ε W a cos i/|J|,     J = G' = a cos i - δ' (p·d),     W = F for m = 1, T² F^(m-2) for m ≥ 2,
//! ```
//!
//! τ the plan length outside. A strip a cos i di of the side takes E0 cos ε a cos i di dz, and lands on |J| di dτ with
//! dτ = dz/tan ε; every ray of the plan comes down from each height of entry. All roots are isolated by
//! [`for_each_root_of`] from a bound of G''. J = 0 is the caustic.
//!
//! **Heights.** The ray left the side at τ tan ε > 0 and entered it at
//!
//! ```text
//! z = tan ε (τ + (m - 1) 2a cos r/n'),     0 < z ≤ H.
//! ```
//!
//! Light above comes in over the top, light that reaches the floor inside is absorbed. As cos² r ≥ 1 - 1/n'², no ray
//! lives longer than [`GlassPillar::max_interactions`]: the series over m is finite. Derived here.
//!
//! **Accuracy**: a few units of rounding times the conditioning, which grows like 1/distance to the caustic.

pub mod bundle;
pub mod fold;

use crate::gradient::Gradient;
use crate::kinds::glass_sphere::{GlassSphere, Ray};
use crate::kinds::{Estimate, power, rounding_error};
use crate::optics::{fresnel_reflectance, fresnel_transmittance};
use crate::roots::{Isolated, Local, Sample, for_each_root_of};
use crate::scalar::Scalar;
use crate::scene::{DirectionalLight, GlassCylinder};

/// A glass pillar in the sun.
#[derive(Clone, Copy, Debug)]
pub struct GlassPillar<S> {
    /// x of the axis [m].
    pub x: S,
    /// y of the axis [m].
    pub y: S,
    /// Radius a [m].
    pub radius: S,
    /// Height H of the top above the floor [m].
    pub height: S,
    /// Index n > 1 of the glass.
    pub index: S,
    /// Irradiance E0 on a plane perpendicular to the beam [W/m²].
    pub irradiance: S,
    /// sin ε of the beam's elevation, 0 < ε < π/2.
    pub sin_elevation: S,
    /// cos ε.
    pub cos_elevation: S,
}

/// A ray of the beam that reaches a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S> {
    /// Plan incidence angle i: the ray comes in at y = a sin i from the axis.
    pub incidence: S,
    /// Cosine and sine of the plan direction of the last leg.
    pub direction: (S, S),
    /// Product W of the Fresnel factors.
    pub weight: S,
    /// Plan length τ outside [m].
    pub tau: S,
    /// Height z at which the ray entered (m ≥ 2) or was reflected (m = 1) [m].
    pub entry_z: S,
    /// J [m]: zero on the caustic, of opposite sign on its two sides.
    pub spread: S,
    /// Irradiance of the floor [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the inputs.
    pub conditioning: S,
    /// How far below the top the entry is, negative above [m].
    pub below_top: S,
    /// Rounding cannot tell this root from none.
    pub touching: bool,
}

/// E, W, τ, z and J of a ray at a floor point.
struct Arrival<S> {
    irradiance: S,
    weight: S,
    tau: S,
    entry_z: S,
    spread: S,
}

impl GlassPillar<f64> {
    /// The pillar of an entry.
    pub fn from_entry(light: &DirectionalLight, pillar: &GlassCylinder) -> Self {
        let elevation = light.elevation_degrees.to_radians();
        GlassPillar {
            x: pillar.center[0],
            y: pillar.center[1],
            radius: pillar.radius,
            height: pillar.height,
            index: pillar.index,
            irradiance: light.irradiance,
            sin_elevation: libm::sin(elevation),
            cos_elevation: libm::cos(elevation),
        }
    }
}

impl<S: Scalar> GlassPillar<S> {
    /// n', the index in plan.
    pub fn effective_index(&self) -> S {
        let (n, s) = (self.index, self.sin_elevation);
        ((n - s) * (n + s)).sqrt() / self.cos_elevation
    }

    /// tan ε.
    pub fn slope(&self) -> S {
        self.sin_elevation / self.cos_elevation
    }

    /// The glass sphere whose meridian is the plan view.
    fn meridian(&self) -> GlassSphere<S> {
        GlassSphere {
            index: self.effective_index(),
            radius: self.radius,
            irradiance: S::ONE,
            receiver_z: S::ZERO,
            max_incidence: S::HALF * S::PI,
        }
    }

    fn local(&self, x: S, y: S) -> (S, S) {
        (x - self.x, y - self.y)
    }

    /// Size of the coordinates that a position from the axis comes from [m].
    fn extent(&self, x: S, y: S) -> S {
        x.abs() + y.abs() + self.x.abs() + self.y.abs()
    }

    /// How far outside the pillar's foot a floor point is, negative under it [m].
    pub fn outside(&self, x: S, y: S) -> S {
        let (px, py) = self.local(x, y);
        px.hypot(py) - self.radius
    }

    /// The most interactions after which a ray can still be above the floor when it leaves:
    /// (m - 1) 2a cos r (tan ε)/n' < H, cos r ≥ sqrt(n'² - 1)/n'. Beyond it every class is dark.
    pub fn max_interactions(&self) -> u32 {
        let n = self.effective_index();
        let shortest = ((n - S::ONE) * (n + S::ONE)).sqrt() / n.squared();
        let drop = S::TWO * self.radius * shortest * self.slope();
        let chords = (self.height / drop).to_f64();
        // Rounded up, so that rounding only adds a dark class.
        ((chords * (1.0 + 1e-5)) as u32).saturating_add(1)
    }

    /// W.
    fn weight(&self, ray: &Ray<S>, interactions: u32) -> S {
        let (one, n) = (S::ONE, self.index);
        let (outer, inner) = (self.cos_elevation * ray.cos_i, self.cos_elevation * ray.q);
        let f = fresnel_reflectance(one, outer, n, inner);
        if interactions <= 1 {
            return f;
        }
        fresnel_transmittance(one, outer, n, inner).squared() * power(f, interactions - 2)
    }

    /// G and p·d at a ray.
    fn impact(&self, ray: &Ray<S>, (px, py): (S, S)) -> (S, S) {
        (
            self.radius * ray.sin_i - py * ray.cos_d - px * ray.sin_d,
            px * ray.cos_d - py * ray.sin_d,
        )
    }

    fn arrival(&self, ray: &Ray<S>, along: S, interactions: u32) -> Arrival<S> {
        let reach = self.radius * ray.cos_i;
        let tau = along - reach;
        let spread = reach - ray.turn * along;
        let chords = S::from_f64(f64::from(interactions) - 1.0);
        let n = self.effective_index();
        // cos r = q/n'.
        let inside = chords * S::TWO * self.radius * ray.q / n.squared();
        let weight = self.weight(ray, interactions);
        Arrival {
            irradiance: self.irradiance * self.sin_elevation * weight * reach / spread.abs(),
            weight,
            tau,
            entry_z: self.slope() * (tau + inside),
            spread,
        }
    }

    /// Visits every ray that reaches the floor point (x, y) [m] after `interactions` ≥ 1 with a side of any height. No
    /// allocation.
    pub fn for_each_root(&self, x: S, y: S, interactions: u32, mut visit: impl FnMut(Root<S>)) {
        let quarter = S::HALF * S::PI;
        let p = self.local(x, y);
        let meridian = self.meridian();
        let (a, reach) = (self.radius, p.0.hypot(p.1));
        let rays = S::from_f64(f64::from(interactions) + 1.0);
        let noise = S::from_f64(4.0) * S::EPSILON * (a + reach) * rays;
        let at = |i: S| {
            let ray = meridian.ray(i, interactions);
            let (value, along) = self.impact(&ray, p);
            Sample {
                value,
                slope: a * ray.cos_i - ray.turn * along,
                noise,
            }
        };
        let local = |i: S, half: S| {
            let ray = meridian.ray(i, interactions);
            let (value, along) = self.impact(&ray, p);
            let b = meridian.bounds(&ray, half, interactions);
            let whole = a * b.sine + reach * (b.turn.squared() + b.turn_1);
            // p × d = a sin i - G.
            let across = a * ray.sin_i - value;
            let bend = ray.turn.squared() * across
                - meridian.turn_1(&ray, interactions) * along
                - a * ray.sin_i;
            Local {
                value,
                slope: a * ray.cos_i - ray.turn * along,
                curvature: whole.min(bend.abs() + half * meridian.third(&b, reach)),
                noise,
            }
        };
        for_each_root_of(-quarter, quarter, at, local, |root| {
            let (i, touching) = match root {
                Isolated::Simple(i) => (i, false),
                Isolated::Touching(i) => (i, true),
            };
            let ray = meridian.ray(i, interactions);
            let (_, along) = self.impact(&ray, p);
            let arrival = self.arrival(&ray, along, interactions);
            if !(arrival.tau > S::ZERO && ray.cos_i > S::ZERO) {
                return;
            }
            visit(Root {
                incidence: i,
                direction: (ray.cos_d, -ray.sin_d),
                weight: arrival.weight,
                tau: arrival.tau,
                entry_z: arrival.entry_z,
                spread: arrival.spread,
                irradiance: arrival.irradiance,
                conditioning: self.conditioning(x, y, interactions, &ray, arrival.spread),
                below_top: self.height - arrival.entry_z,
                touching,
            });
        });
    }

    /// Differentiates the irradiance along the root, di = -(∂G/∂p dp)/G'.
    fn conditioning(&self, x: S, y: S, interactions: u32, ray: &Ray<S>, slope: S) -> S {
        type G<S> = Gradient<S, 6>;
        let (px, py) = self.local(x, y);
        let size = self.extent(x, y);
        let pillar = GlassPillar {
            x: G::constant(self.x),
            y: G::constant(self.y),
            radius: G::input(self.radius, 0, self.radius),
            height: G::constant(self.height),
            index: G::input(self.index, 1, self.index),
            irradiance: G::constant(self.irradiance),
            sin_elevation: G::input(self.sin_elevation, 2, self.sin_elevation),
            cos_elevation: G::input(self.cos_elevation, 3, self.cos_elevation),
        };
        let p = (G::input(px, 4, size), G::input(py, 5, size));
        let meridian = pillar.meridian();
        let (sin_i, cos_i) = (ray.sin_i, ray.cos_i);
        let fixed = (G::constant(sin_i), G::constant(cos_i));
        let (value, _) = pillar.impact(&meridian.ray_of(fixed, interactions), p);
        let (mut sine, mut cosine) = fixed;
        for (k, v) in value.slopes.into_iter().enumerate() {
            let moved = -v / slope;
            sine.slopes[k] = cos_i * moved;
            cosine.slopes[k] = -(sin_i * moved);
        }
        let ray = meridian.ray_of((sine, cosine), interactions);
        let (_, along) = pillar.impact(&ray, p);
        let arrival = pillar.arrival(&ray, along, interactions);
        arrival.irradiance.relative_change()
    }

    /// Irradiance of the floor point (x, y) by rays with exactly `interactions` [W/m²].
    pub fn caustic(&self, x: S, y: S, interactions: u32) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        if !(self.outside(x, y) > S::ZERO) {
            return sum;
        }
        self.for_each_root(x, y, interactions, |root| {
            let lit = root.below_top >= S::ZERO;
            if lit {
                sum.add(root.irradiance, root.conditioning);
            }
            let size = self.height + root.entry_z + self.slope() * self.extent(x, y);
            if root.touching && lit {
                sum.error = S::ONE / S::ZERO;
            } else if root.below_top.abs() <= rounding_error(size, root.conditioning) {
                // The upper edge of the side within rounding: the root may be there or not.
                sum.error += root.irradiance;
            }
        });
        self.add_foot_error(x, y, &mut sum);
        sum
    }

    /// Irradiance by reflection at the outside (LRDE) [W/m²]: δ' = 2 makes J < 0, one root without a singularity.
    pub fn reflected(&self, x: S, y: S) -> Estimate<S> {
        self.caustic(x, y, 1)
    }

    /// Irradiance by light that passes through the glass (LTTDE) [W/m²].
    pub fn transmitted(&self, x: S, y: S) -> Estimate<S> {
        self.caustic(x, y, 2)
    }

    /// Irradiance by light with `reflections` ≥ 1 inside the glass (LTRTDE, LTRRTDE, ...) [W/m²].
    pub fn internal(&self, x: S, y: S, reflections: u32) -> Estimate<S> {
        self.caustic(x, y, reflections + 2)
    }

    /// Upper bound of the flux that reaches the floor after more than `interactions` ≥ 1 [W].
    ///
    /// That is T² F^(m-2) summed over m > `interactions`, T F^k with k = `interactions` - 1, over the side: at most
    /// max_F (1 - F) F^k = k^k/(k+1)^(k+1) < 1/(k+1) of the flux 2a H E0 cos ε on it; and none beyond
    /// [`Self::max_interactions`]. At a point no bound exists, as each class has its own caustic.
    pub fn flux_beyond(&self, interactions: u32) -> S {
        if interactions >= self.max_interactions() {
            return S::ZERO;
        }
        let k = interactions.max(1) - 1;
        let (n, next) = (S::from_f64(f64::from(k)), S::from_f64(f64::from(k + 1)));
        let share = power(n / next, k) / next;
        let on_side = S::TWO * self.radius * self.height * self.irradiance * self.cos_elevation;
        share * on_side
    }

    /// At the foot of the side rounding decides whether the point is in front of it.
    fn add_foot_error(&self, x: S, y: S, sum: &mut Estimate<S>) {
        let size = self.extent(x, y) + self.radius;
        if self.outside(x, y).abs() <= rounding_error(size, S::ZERO) {
            sum.error = S::ONE / S::ZERO;
        }
    }

    /// How far the floor point is from the edge of the pillar's shadow [m], negative in it: beside the strip
    /// |y| < a, before the pillar, or so far behind that the sun is over the top. Under the pillar it is dark.
    pub fn clearance(&self, x: S, y: S) -> S {
        let outside = self.outside(x, y);
        if !(outside > S::ZERO) {
            return outside;
        }
        let (px, py) = self.local(x, y);
        let a = self.radius;
        let half = ((a - py) * (a + py)).max(S::ZERO).sqrt();
        let beyond = px - half - self.height / self.slope();
        (py.abs() - a).max(-px).max(beyond)
    }

    /// Direct irradiance of the floor point (x, y) (LDE) [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        let e = self.irradiance * self.sin_elevation;
        let clearance = self.clearance(x, y);
        if clearance > S::ZERO {
            sum.add(e, S::ZERO);
        }
        let size = self.extent(x, y) + self.radius + self.height / self.slope();
        if clearance.abs() <= rounding_error(size, S::ZERO) {
            sum.error += e;
        }
        self.add_foot_error(x, y, &mut sum);
        sum
    }
}
