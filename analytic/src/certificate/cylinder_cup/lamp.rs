//! A point light in the cup: one bounce inside the circle; [`super::chains`] has everything else. Theory block G.
//!
//! With A the light and B the receiver as complex numbers, a ray is reflected at s = a e^{iφ} where (A - s)(B - s)/s² is
//! positive. For A and B inside the circle both factors over s have arguments within a quarter turn of π, so that it is
//! enough that the product be real:
//!
//! ```text
//! Im[A B e^{-2iφ}] = a Im[(A + B) e^{-iφ}].
//! ```
//!
//! With A on the circle s = A is a zero of this that is no reflection. Dividing it out: with s = A e^{-2iv}, -π < v < 0,
//! (A - s)/s is a positive multiple of -i e^{iv}, and the condition is Re[B A* e^{3iv}] = a² cos v.
//!
//! E = I R h l/((l² + h²)^{3/2} |J|), J = r1 + τ - 2 r1 τ/(a cos i), l = r1 + τ.

use super::CylinderCup;
use crate::certificate::Lit;
use crate::certificate::radiometry::{Bundle, Facing, Point, plan_squared, point_light_enclosed};
use crate::certificate::roots::{Jet, full_turn, isolate};
use crate::enclosure::Enclosure;
use crate::scalar::Scalar;
use crate::vector::vec3;

/// A point light inside the circle, or exactly on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    pub(super) at: Point,
    pub(super) intensity: Enclosure,
    pub(super) on_wall: bool,
}

impl Lamp {
    /// `None` if the light may be outside.
    pub(super) fn new(
        radius: Enclosure,
        at: Point,
        intensity: Enclosure,
        on_wall: bool,
    ) -> Option<Self> {
        let inside = radius.squared() - plan_squared(at.x, at.y);
        let on_wall = on_wall || inside == Enclosure::ZERO;
        (on_wall || inside.is_positive()).then_some(Lamp {
            at,
            intensity,
            on_wall,
        })
    }

    pub(super) fn direct(&self, x: Point) -> (Enclosure, Lit) {
        point_light_enclosed(self.at, self.intensity, x, Facing::Up)
    }
}

impl CylinderCup {
    /// The rays of the lamp to a floor point.
    pub(super) fn lamp_rays(&self, lamp: &Lamp, x: Point, bounces: u32) -> Bundle {
        let mut bundle = Bundle::default();
        if bounces != 1 || self.holds(x) != Lit::Yes {
            return self.lamp_chains(lamp, x, bounces);
        }
        let a = self.radius;
        let jet = Jet::constant;
        let (p, q) = (lamp.at, x);
        let zeros = if lamp.on_wall {
            // B A* = (along + i across).
            let along = q.x * p.x + q.y * p.y;
            let across = q.y * p.x - q.x * p.y;
            Some(isolate(-Enclosure::PI.high(), 0.0, |v| {
                let triple = jet(Enclosure::point(3.0)) * v;
                jet(along) * triple.cos() - jet(across) * triple.sin() - jet(a.squared()) * v.cos()
            }))
        } else {
            let product = (p.x * q.x - p.y * q.y, p.x * q.y + p.y * q.x);
            let sum = (p.x + q.x, p.y + q.y);
            full_turn(|phi| {
                let twice = phi + phi;
                jet(product.1) * twice.cos()
                    - jet(product.0) * twice.sin()
                    - jet(a) * (jet(sum.1) * phi.cos() - jet(sum.0) * phi.sin())
            })
        };
        let Some(zeros) = zeros else {
            bundle.total.add_unresolved();
            return bundle;
        };
        for zero in zeros.simple {
            let (nx, ny) = if lamp.on_wall {
                let (cosine, sine) = ((zero + zero).cos(), (zero + zero).sin());
                (
                    (p.x * cosine + p.y * sine) / a,
                    (p.y * cosine - p.x * sine) / a,
                )
            } else {
                (zero.cos(), zero.sin())
            };
            let (e, wall_z) = self.lamp_ray(lamp, x, nx, ny);
            bundle.add(e, self.reaches(wall_z).and(self.covers(nx)));
        }
        for _ in zeros.undecided {
            bundle.total.add_unresolved();
        }
        bundle
    }

    /// Irradiance by the ray that is reflected at a (nx, ny), and how high it is reflected.
    fn lamp_ray(
        &self,
        lamp: &Lamp,
        x: Point,
        nx: Enclosure,
        ny: Enclosure,
    ) -> (Enclosure, Enclosure) {
        let a = self.radius;
        let leg = |p: Point| {
            let d = vec3(p.x - a * nx, p.y - a * ny, Enclosure::ZERO);
            plan_squared(d.x, d.y).sqrt()
        };
        let (r1, tau, h) = (leg(lamp.at), leg(x), lamp.at.z);
        let cosine = (a - lamp.at.x * nx - lamp.at.y * ny) / r1;
        let length = r1 + tau;
        let spread = length - Enclosure::TWO * r1 * tau / (a * cosine);
        let squared = length.squared() + h.squared();
        let e = lamp.intensity * self.reflectance * h * length
            / (squared * squared.sqrt() * spread.abs());
        (e, h * tau / length)
    }
}
