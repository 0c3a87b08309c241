//! A glass sphere in a parallel beam: all rays to a point of a plane across the beam, counted. Theory block K.
//!
//! By symmetry about the axis, refraction and reflection at a sphere keep the moment of a ray about the centre: a ray that
//! comes in at the angle i leaves at the distance a sin i from the centre as well, turned by 2(i - r) on entering and leaving
//! and by π - 2r at each internal reflection, all in the same sense. With δ the whole turn, it passes through the point at
//! the signed distance ρ from the axis in the plane z = c where
//!
//! ```text
//! G(i) = a sin i - ρ cos δ - c sin δ = 0,     c cos δ > 0,     E = E0 W a² |sin i cos i cos δ|/(ρ |G'(i)|).
//! ```
//!
//! (The flux of a ring, E 2πρ dρ = E0 W 2π a² sin i cos i di, with dρ = G' di/cos δ.) G is searched on all of the beam. Next
//! to the axis sin i/ρ comes from the mean value theorem, i = ± ρ/G'(ξ) for the zero that goes to 0 with ρ.

use crate::certificate::radiometry::{
    Bundle, Point, plan_squared, power_enclosed, reflectance_enclosed, transmittance_enclosed,
    whole,
};
use crate::certificate::roots::{Jet, isolate};
use crate::certificate::{Lit, source::Source};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

/// The sphere, at the origin, with its beam along +z and a receiver plane.
#[derive(Clone, Copy, Debug)]
pub struct GlassSphere {
    index: Enclosure,
    radius: Enclosure,
    irradiance: Enclosure,
    receiver_z: Enclosure,
    max_incidence: Enclosure,
}

impl GlassSphere {
    /// `n`, `a`, `E0`, `receiver_z` and, if the beam is limited, `i_max`.
    pub fn read(p: &dyn Source) -> Option<Self> {
        let quarter = Enclosure::PI * Enclosure::HALF;
        Some(GlassSphere {
            index: p.number("n")?,
            radius: p.number("a")?,
            irradiance: p.number("E0")?,
            receiver_z: p.number("receiver_z")?,
            max_incidence: p.number("i_max").unwrap_or(quarter),
        })
    }

    /// The number of interactions of the brightest class: two through the sphere, three back.
    pub fn usual_interactions(&self) -> u32 {
        if self.receiver_z.is_positive() { 2 } else { 3 }
    }

    /// Turn of a ray after `interactions` ≥ 1: reflected outside, or refracted, reflected inside, refracted.
    fn turn(&self, i: Jet, interactions: u32) -> Jet {
        let (n, jet) = (self.index, Jet::constant);
        let q = (jet(n.squared() - Enclosure::ONE) + i.cos().squared()).sqrt();
        let r = (i.sin() / q).atan();
        if interactions == 1 {
            // The other way round.
            return i + i - Jet::PI;
        }
        let inside = interactions - 2;
        (i - r) * Jet::TWO + (Jet::PI - r - r) * jet(whole(inside))
    }

    fn moment(&self, rho: Enclosure, i: Jet, interactions: u32) -> Jet {
        let jet = Jet::constant;
        let delta = self.turn(i, interactions);
        jet(self.radius) * i.sin() - jet(rho) * delta.cos() - jet(self.receiver_z) * delta.sin()
    }

    /// Light after `interactions` with the sphere.
    pub fn caustic_enclosed(&self, x: Point, interactions: u32) -> Bundle {
        let mut bundle = Bundle::default();
        let rho = plan_squared(x.x, x.y).sqrt();
        let limit = self.max_incidence.high();
        let zeros = isolate(-limit, limit, |i| self.moment(rho, i, interactions));
        for i in zeros.simple {
            let (e, lit) = self.ray(rho, i, interactions);
            bundle.add(e, lit);
        }
        for _ in zeros.undecided {
            bundle.total.add_unresolved();
        }
        bundle
    }

    fn ray(&self, rho: Enclosure, i: Enclosure, interactions: u32) -> (Enclosure, Lit) {
        let (one, n) = (Enclosure::ONE, self.index);
        let (sine, cosine) = (i.sin(), i.cos());
        let q = (n.squared() - one + cosine.squared()).sqrt();
        let f = reflectance_enclosed(one, cosine, n, q);
        let weight = if interactions == 1 {
            f
        } else {
            let t = transmittance_enclosed(one, cosine, n, q);
            t.squared() * power_enclosed(f, interactions - 2)
        };
        let slope = |i: Enclosure| {
            let i = Jet::input(i, 0, one);
            self.moment(rho, i, interactions).slopes[0]
        };
        let cos_delta = self.turn(Jet::constant(i), interactions).value.cos();
        // sin i/ρ, directly or from G(0) = ∓ρ; 1 - i²/6 ≤ sin i/i ≤ 1.
        let ratio = (sine / rho).abs();
        let flat = (one - i.squared() / Enclosure::point(6.0)).hull(one);
        let by_mean = flat / slope(i.hull(Enclosure::ZERO)).abs();
        let ratio = ratio.intersection(by_mean).unwrap_or(ratio);
        let e = self.irradiance * weight * self.radius.squared() * ratio * cosine * cos_delta.abs()
            / slope(i).abs();
        let lit = Lit::where_positive(cos_delta * self.receiver_z)
            .and(Lit::where_not_negative(self.max_incidence - i.abs()));
        let positive = Enclosure::new(0.0, f64::INFINITY);
        (e.intersection(positive).unwrap_or(positive), lit)
    }
}
