//! A mirror ball above the floor, not in the frame.
//!
//! A ray meets the ball at the smaller root of |o - c + t d|² = a² and is reflected there; nothing brings it back.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{ConvexSphereScene, Family};

use super::chains::{Chains, Leg, Vertex};
use super::specular::reflected;

/// The ball, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    center: DVec3,
    radius: f64,
    reflectance: f64,
    classes: &'static [PathClass],
}

impl Ball {
    /// Prepares a validated scene's ball; `reflectance` replaces the scene's own.
    pub fn new(scene: &ConvexSphereScene, reflectance: f64) -> Self {
        Ball {
            center: DVec3::from_array(scene.ball.center),
            radius: scene.ball.radius,
            reflectance,
            classes: scene.classes(),
        }
    }

    /// Ray parameter at which a ray from outside meets the ball, negative where that is behind its origin; `None` where it
    /// passes.
    fn meet(&self, o: DVec3, d: DVec3) -> Option<f64> {
        let (p, dd) = (o - self.center, d.dot(d));
        let b = p.dot(d) / dd;
        let nearest = p - d * b;
        let square = (self.radius * self.radius - nearest.dot(nearest)) / dd;
        (square >= 0.0).then(|| -b - f64::sqrt(square))
    }
}

impl Chains for Ball {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, chain: usize, origin: DVec3, direction: DVec3) -> Leg {
        let met = self.meet(origin, direction).filter(|&t| t > 0.0);
        match (chain, met) {
            (0, None) => Leg {
                origin,
                direction,
                weight: 1.0,
            },
            (1, Some(t)) => {
                let point = origin + direction * t;
                Leg {
                    origin: point,
                    direction: reflected(direction, (point - self.center) / self.radius),
                    weight: self.reflectance,
                }
            }
            _ => Leg::DARK,
        }
    }

    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        self.meet(origin, direction)
            .is_some_and(|t| t > 0.0 && t < t_end)
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let t = self.meet(origin, direction).filter(|&t| t > 0.0)?;
        let point = origin + direction * t;
        let normal = (point - self.center) / self.radius;
        Some(Vertex {
            point,
            direction: reflected(direction, normal),
            normal,
            weight: self.reflectance,
        })
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let half = DVec3::splat(self.radius);
        Some([self.center - half, self.center + half])
    }

    /// The floor, or a box around the ball.
    fn targets(&self, chain: usize, floor: &[DVec3]) -> Vec<DVec3> {
        if chain == 0 {
            return floor.to_vec();
        }
        let mut points = Vec::with_capacity(8);
        for k in 0..8 {
            let sign = |axis: usize| if k >> axis & 1 == 0 { -1.0 } else { 1.0 };
            points.push(self.center + DVec3::new(sign(0), sign(1), sign(2)) * self.radius);
        }
        points
    }
}
