//! A point light in the cup: any number of bounces, receivers inside and outside of the circle.
//!
//! A ray that leaves the light A and hits the circle at a e^{iφ} under the angle of incidence i (its moment about the centre
//! is a sin i, with its sign) goes along e^{i(φ + i)}; a reflection keeps the moment and all chords are 2a cos i. Hit k is at
//! φ_k = φ + (k - 1)(π - 2i), and the ray leaves it along d, θ = φ_k + π - i. It passes the floor point P where
//!
//! ```text
//! g = P_x sin θ - P_y cos θ - a sin i = 0,     τ = P·d + a cos i > 0,
//! E = I R^k h l/((l² + h²)^{3/2} |J|),     J = dg/dψ,     l = r1 + (k - 1) 2a cos i + τ,
//! ```
//!
//! ψ = φ + i the direction in which the ray leaves the light: g is the distance at which it passes P. For a light inside φ
//! is searched on a full turn, tan i = (A_x sin φ - A_y cos φ)/(a - A·e^{iφ}); for a light on the wall, A = a e^{iα}, φ = α - 2v
//! and i = v + π/2 with -π < v < 0. The heights at the hits fall from h (l - r1)/l on.

use super::CylinderCup;
use super::lamp::Lamp;
use crate::certificate::Lit;
use crate::certificate::radiometry::{Bundle, Point, plan_squared, power_enclosed, whole};
use crate::certificate::roots::{Jet, full_turn, isolate};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;

impl CylinderCup {
    /// Polar angle of the first hit and angle of incidence there, for a value of the parameter.
    fn first_hit(&self, lamp: &Lamp, at: Jet) -> (Jet, Jet) {
        let jet = Jet::constant;
        let p = lamp.at;
        if lamp.on_wall {
            // Away from the cut of the arc tangent.
            let start = if p.x.is_negative() {
                Enclosure::PI + (-p.y).atan2(-p.x)
            } else {
                p.y.atan2(p.x)
            };
            let start = jet(start);
            return (start - at - at, at + Jet::PI * Jet::HALF);
        }
        let (c, s) = (at.cos(), at.sin());
        let ahead = jet(self.radius) - (jet(p.x) * c + jet(p.y) * s);
        let across = jet(p.x) * s - jet(p.y) * c;
        (at, (across / ahead).atan())
    }

    /// θ and i of the ray after `bounces`.
    fn last_leg(&self, lamp: &Lamp, at: Jet, bounces: u32) -> (Jet, Jet) {
        let (phi, i) = self.first_hit(lamp, at);
        let turns = Jet::constant(whole(bounces - 1));
        (phi + (Jet::PI - i - i) * turns + Jet::PI - i, i)
    }

    /// The rays with `bounces` ≥ 1 reflections to a floor point.
    pub(super) fn lamp_chains(&self, lamp: &Lamp, x: Point, bounces: u32) -> Bundle {
        let mut bundle = Bundle::default();
        if bounces == 0 || self.cos_half_arc.is_none() && self.holds(x) == Lit::No {
            // Light that is reflected has the wall around it: behind a closed one it is dark.
            return bundle;
        }
        let (a, jet) = (self.radius, Jet::constant);
        let miss = |at: Jet| {
            let (theta, i) = self.last_leg(lamp, at, bounces);
            jet(x.x) * theta.sin() - jet(x.y) * theta.cos() - jet(a) * i.sin()
        };
        let zeros = if lamp.on_wall {
            Some(isolate(-Enclosure::PI.high(), 0.0, miss))
        } else {
            full_turn(miss)
        };
        let Some(zeros) = zeros else {
            bundle.total.add_unresolved();
            return bundle;
        };
        for at in zeros.simple {
            let (e, lit) = self.chain(lamp, x, at, bounces, &miss);
            bundle.add(e, lit);
        }
        for at in zeros.undecided {
            if self.chain(lamp, x, at, bounces, &miss).1 != Lit::No {
                bundle.total.add_unresolved();
            }
        }
        bundle
    }

    fn chain(
        &self,
        lamp: &Lamp,
        x: Point,
        at: Enclosure,
        bounces: u32,
        miss: &impl Fn(Jet) -> Jet,
    ) -> (Enclosure, Lit) {
        let (a, two, h) = (self.radius, Enclosure::TWO, lamp.at.z);
        let input = Jet::input(at, 0, Enclosure::ONE);
        let (phi, i) = self.first_hit(lamp, input);
        let (theta, _) = self.last_leg(lamp, input, bounces);
        let (phi, incidence, theta) = (phi.value, i.value, theta.value);
        let chord = two * a * incidence.cos();
        let (nx, ny) = (phi.cos(), phi.sin());
        // The wall's light sees a chord of its own.
        let first = if lamp.on_wall {
            chord
        } else {
            plan_squared(a * nx - lamp.at.x, a * ny - lamp.at.y).sqrt()
        };
        let tau = x.x * theta.cos() + x.y * theta.sin() + Enclosure::HALF * chord;
        let length = first + whole(bounces - 1) * chord + tau;
        // dψ/dt: 1 + di/dφ = a cos i/r1 inside, -1 on the wall.
        let turning = if lamp.on_wall {
            -Enclosure::ONE
        } else {
            Enclosure::HALF * chord / first
        };
        let spread = miss(input).slopes[0] / turning;
        let squared = length.squared() + h.squared();
        let e = lamp.intensity * power_enclosed(self.reflectance, bounces) * h * length
            / (squared * squared.sqrt() * spread.abs());
        let hit = |j: u32| (phi + whole(j - 1) * (Enclosure::PI - two * incidence)).cos();
        let mut lit = Lit::where_positive(tau).and(self.reaches(h * (length - first) / length));
        for j in 1..=bounces {
            lit = lit.and(self.covers(hit(j)));
        }
        let outside =
            Lit::where_not_negative(chord - tau).or(self.covers(hit(bounces + 1)).inverted());
        let lit = match self.holds(x) {
            Lit::Yes => lit,
            Lit::No => lit.and(outside),
            Lit::Undecided => lit.and(Lit::Undecided),
        };
        (e, lit)
    }

    /// Whether the wall stands between the light and a floor point outside the circle.
    pub(super) fn hides_lamp(&self, lamp: &Lamp, x: Point) -> Lit {
        let (a, zero) = (self.radius, Enclosure::ZERO);
        let (dx, dy) = (x.x - lamp.at.x, x.y - lamp.at.y);
        // The segment leaves the circle at the larger zero of |A + σ D|² = a².
        let squared = plan_squared(dx, dy);
        let along = lamp.at.x * dx + lamp.at.y * dy;
        let inside = if lamp.on_wall {
            zero
        } else {
            a.squared() - plan_squared(lamp.at.x, lamp.at.y)
        };
        let sigma = if lamp.on_wall && along.low() >= 0.0 {
            zero
        } else {
            ((along.squared() + squared * inside).sqrt() - along) / squared
        };
        let place = (lamp.at.x + sigma * dx) / a;
        self.covers(place)
            .and(self.reaches(lamp.at.z * (Enclosure::ONE - sigma)))
    }
}
