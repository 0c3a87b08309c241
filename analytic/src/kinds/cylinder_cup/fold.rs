//! Where the cup's caustic curve is: the distance from a floor point to the nearest fold.
//!
//! The caustic touches each ray at J = 0. For one bounce of the beam it is the nephroid (4(x² + y²) - a²)³ = 27 a⁴ y²
//! with its cusp at (a/2, 0); for a light on the wall the cardioid. Only the part of the curve that the wall lights
//! counts. The tangent of the caustic is the ray itself, so the nearest point is where (p - c)·d changes sign, at a cusp,
//! or where the lit part ends.

use super::{CylinderCup, Light, Root};
use crate::kinds::plan_caustic::{self, Touch};
use crate::kinds::singularity::Singularity;
use crate::roots::bracketed;

/// Rays per bounce with which the curve is searched.
const RAYS: u32 = 512;

/// A point of the caustic curve.
#[derive(Clone, Copy, Debug)]
struct Fold {
    x: f64,
    y: f64,
    cos_theta: f64,
    sin_theta: f64,
    /// Velocity of the point along the ray, per parameter.
    speed: f64,
    lit: bool,
}

impl Fold {
    /// (p - c)·d.
    fn ahead(&self, x: f64, y: f64) -> f64 {
        (x - self.x) * self.cos_theta + (y - self.y) * self.sin_theta
    }

    fn distance(&self, x: f64, y: f64) -> f64 {
        libm::hypot(x - self.x, y - self.y)
    }
}

impl CylinderCup<f64> {
    /// Distance [m] from the floor point (x, y) to the nearest lit point of the caustic of any number of bounces up to
    /// `max_bounces`; `None` if no part of any caustic is lit. Accurate to about 1e-9 of the radius.
    pub fn distance_to_fold(&self, x: f64, y: f64, max_bounces: u32) -> Option<f64> {
        (1..=max_bounces)
            .filter_map(|k| self.distance_to_fold_of(x, y, k))
            .min_by(f64::total_cmp)
    }

    /// The nearest lit point of the caustic of exactly `bounces` reflections, and whether it is a cusp.
    pub fn singularity(&self, x: f64, y: f64, bounces: u32) -> Option<Singularity<f64>> {
        plan_caustic::nearest((x, y), self.fold_range(), |u| {
            self.fold(u, bounces).map(|fold| Touch {
                point: (fold.x, fold.y),
                direction: (fold.cos_theta, fold.sin_theta),
                speed: fold.speed,
                lit: fold.lit,
            })
        })
    }

    fn distance_to_fold_of(&self, x: f64, y: f64, bounces: u32) -> Option<f64> {
        let rays = RAYS * bounces.min(8);
        let (low, high) = self.fold_range();
        let at = |n: u32| low + (high - low) * (f64::from(n) + 0.5) / f64::from(rays);
        let mut nearest: Option<f64> = None;
        let mut try_fold = |fold: Fold| {
            if fold.lit {
                let d = fold.distance(x, y);
                nearest = Some(nearest.map_or(d, |n| n.min(d)));
            }
        };
        let mut last: Option<(f64, Fold)> = None;
        for n in 0..rays {
            let u = at(n);
            let Some(fold) = self.fold(u, bounces) else {
                last = None;
                continue;
            };
            try_fold(fold);
            if let Some((v, before)) = last {
                let f = |w: f64| {
                    let ahead = self.fold(w, bounces).map_or(0.0, |f| f.ahead(x, y));
                    // No derivative: the bracket is halved.
                    (ahead, 0.0)
                };
                if (before.ahead(x, y) < 0.0) != (fold.ahead(x, y) < 0.0)
                    && let Some(foot) = self.fold(bracketed(f, v, u), bounces)
                {
                    try_fold(foot);
                }
                if before.lit != fold.lit
                    && let Some(end) = self.end_of_light(v, u, before.lit, bounces)
                {
                    try_fold(end);
                }
            }
            last = Some((u, fold));
        }
        // The cusp of the beam and of a light on the wall is at i = 0.
        if let Some(cusp) = self.fold(0.5 * (low + high), bounces) {
            try_fold(cusp);
        }
        nearest
    }

    /// The last lit point of the curve between parameters of which one is lit.
    fn end_of_light(&self, from: f64, to: f64, lit_at_from: bool, bounces: u32) -> Option<Fold> {
        let (mut lit, mut dark) = if lit_at_from { (from, to) } else { (to, from) };
        for _ in 0..60 {
            let middle = 0.5 * (lit + dark);
            if self.fold(middle, bounces)?.lit {
                lit = middle;
            } else {
                dark = middle;
            }
        }
        self.fold(lit, bounces)
    }

    /// Range of the curve's parameter: incidence angle, or direction for a light off the wall.
    fn fold_range(&self) -> (f64, f64) {
        use core::f64::consts::{FRAC_PI_2, PI};
        match &self.light {
            Light::Point(lamp) if !lamp.is_on(&self.wall) => (-PI, PI),
            _ => (-FRAC_PI_2, FRAC_PI_2),
        }
    }

    /// The point where the caustic touches the ray with this parameter; `None` if it is not on the last leg.
    fn fold(&self, parameter: f64, bounces: u32) -> Option<Fold> {
        let ray = match &self.light {
            Light::Beam(beam) => self.beam_fold_ray(beam, parameter, bounces),
            Light::Point(lamp) => self.lamp_fold_ray(lamp, parameter, bounces),
        }?;
        let root: Root<f64> = ray.root;
        Some(Fold {
            x: ray.along * root.cos_theta + ray.across * root.sin_theta,
            y: ray.along * root.sin_theta - ray.across * root.cos_theta,
            cos_theta: root.cos_theta,
            sin_theta: root.sin_theta,
            speed: ray.speed,
            lit: self.is_lit(&root, bounces),
        })
    }
}

/// A ray with its root data at the point where the caustic touches it.
pub(super) struct FoldRay {
    pub root: Root<f64>,
    /// p · d of the touching point.
    pub along: f64,
    /// p × d of the ray.
    pub across: f64,
    /// (p · d)' + (p × d) θ': the touching point's velocity, which is along the ray; zero at a cusp.
    pub speed: f64,
}

#[cfg(test)]
mod tests {
    use super::super::{Beam, Wall, point_light::Lamp};
    use super::*;

    fn cup(light: Light<f64>) -> CylinderCup<f64> {
        CylinderCup {
            wall: Wall {
                radius: 1.3,
                height: None,
                // Open towards the sun; a light on the wall stands on its edge of the arc.
                cos_half_arc: Some(-0.6),
            },
            reflectance: 1.0,
            light,
        }
    }

    fn sun() -> Light<f64> {
        Light::Beam(Beam {
            irradiance: 1.0,
            sin_elevation: 0.6,
            cos_elevation: 0.8,
        })
    }

    fn lamp(x: f64, y: f64) -> Light<f64> {
        Light::Point(Lamp {
            x,
            y,
            height: 1.0,
            intensity: 1.0,
        })
    }

    #[test]
    fn one_bounce_of_the_beam_is_the_nephroid() {
        let a: f64 = 1.3;
        for n in -50..=50 {
            let fold = cup(sun())
                .fold(0.03 * f64::from(n), 1)
                .expect("on the last leg");
            let r2 = fold.x * fold.x + fold.y * fold.y;
            let left = 4.0 * r2 - a * a;
            let right = 27.0 * a * a * a * a * fold.y * fold.y;
            assert!(
                (left * left * left - right).abs() <= 1e-13 * (1.0 + right),
                "{fold:?}"
            );
        }
    }

    #[test]
    fn a_light_on_the_wall_makes_the_cardioid() {
        // Cusp at a/3; the cardioid is the track of a point of a circle of radius a/3 that rolls on one like it.
        let a = 1.3;
        for n in -50..=50 {
            let i = 0.03 * f64::from(n);
            let fold = cup(lamp(-a, 0.0)).fold(i, 1).expect("on the last leg");
            // z = (a/3)(2 e^{it} - e^{2it}) with its cusp at a/3; t runs at twice the incidence angle.
            let t = 2.0 * i;
            let x = a / 3.0 * (2.0 * libm::cos(t) - libm::cos(2.0 * t));
            let y = -a / 3.0 * (2.0 * libm::sin(t) - libm::sin(2.0 * t));
            assert!(
                libm::hypot(fold.x - x, fold.y - y) <= 1e-14,
                "{i} {fold:?} {x} {y}"
            );
        }
    }

    #[test]
    fn distances_are_measured_across_the_curve() {
        for (light, bounces) in [
            (sun(), 1),
            (sun(), 2),
            (sun(), 3),
            (lamp(-1.3, 0.0), 1),
            (lamp(-0.6, 0.3), 1),
            (lamp(-0.6, 0.3), 2),
        ] {
            let cup = cup(light);
            let mut measured = 0;
            for n in 1..80 {
                let Some(fold) = cup.fold(-1.47 + 0.037 * f64::from(n), bounces) else {
                    continue;
                };
                if !fold.lit {
                    continue;
                }
                let step = 1e-3;
                let across = |d: f64| {
                    let (x, y) = (fold.x - d * fold.sin_theta, fold.y + d * fold.cos_theta);
                    cup.distance_to_fold(x, y, bounces).expect("a fold")
                };
                assert!(across(0.0) <= 1e-9, "{fold:?}");
                let (left, right) = (across(-step), across(step));
                // Another branch, or the cusp, may be nearer than the branch that was left.
                assert!(left <= step * (1.0 + 1e-9) && right <= step * (1.0 + 1e-9));
                measured +=
                    usize::from((left - step).abs() <= 1e-9 && (right - step).abs() <= 1e-9);
            }
            assert!(measured >= 5, "{bounces} bounces: {measured}");
        }
    }
}
