//! A height field of cosine waves z = s + Σ a cos(k·(x, y) + φ) under vertical light.

use glam::{DVec2, DVec3};

use super::{Frame, Manifold, tangents};
use crate::geometry::scene::unit;

/// A wave: amplitude [m], wave vector [1/m] and phase.
pub(super) type Wave = (f64, DVec2, f64);

/// The surface.
#[derive(Clone, Debug)]
pub(super) struct Waves {
    /// Mean height [m].
    pub surface_z: f64,
    /// The waves.
    pub waves: Vec<Wave>,
    /// No ray from farther in plan than this reaches a floor point [m].
    pub reach: f64,
}

impl Waves {
    /// Height, slopes, and second derivatives xx, xy, yy.
    fn at(&self, x: f64, y: f64) -> (f64, DVec2, [f64; 3]) {
        let (mut z, mut slope, mut second) = (self.surface_z, DVec2::ZERO, [0.0; 3]);
        for (amplitude, k, phase) in &self.waves {
            let (sine, cosine) = libm::sincos(k.x * x + k.y * y + phase);
            z += amplitude * cosine;
            slope -= *k * (amplitude * sine);
            let s = -amplitude * cosine;
            second[0] += s * k.x * k.x;
            second[1] += s * k.x * k.y;
            second[2] += s * k.y * k.y;
        }
        (z, slope, second)
    }

    fn over(&self, plan: DVec2) -> DVec3 {
        plan.extend(self.at(plan.x, plan.y).0)
    }
}

impl Manifold for Waves {
    fn start(&self, x: DVec3, u: f64, v: f64) -> DVec3 {
        let aside = DVec2::new(2.0 * u - 1.0, 2.0 * v - 1.0);
        self.over(x.truncate() + aside * self.reach)
    }

    /// With f = z - h(x, y): n·p″ = p′ᵀ (∇²h) p′/|∇f| in plan.
    fn frame(&self, point: DVec3) -> Frame {
        let (_, slope, [xx, xy, yy]) = self.at(point.x, point.y);
        let gradient = DVec3::new(-slope.x, -slope.y, 1.0);
        let length = f64::sqrt(gradient.dot(gradient));
        let normal = unit(gradient);
        let [s, t] = tangents(normal);
        let bend = |a: DVec3, b: DVec3| {
            (xx * a.x * b.x + xy * (a.x * b.y + a.y * b.x) + yy * a.y * b.y) / length
        };
        Frame {
            tangents: [s, t],
            normal,
            bends: [bend(s, s), bend(s, t), bend(t, t)],
        }
    }

    fn step(&self, point: DVec3, tangent: DVec3) -> Option<DVec3> {
        let plan = (point + tangent).truncate();
        plan.is_finite().then(|| self.over(plan))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_bend_as_the_frame_says() {
        let waves = Waves {
            surface_z: 1.0,
            waves: vec![
                (0.1, DVec2::new(2.0, 1.0), 0.3),
                (0.05, DVec2::new(-1.0, 3.0), 1.1),
            ],
            reach: 0.5,
        };
        let point = waves.over(DVec2::new(0.4, -0.7));
        let frame = waves.frame(point);
        let [s, t] = frame.tangents;
        let [k11, k12, k22] = frame.bends;
        for (a, b) in [(1e-3, 0.0), (0.0, 1e-3), (1e-3, -2e-3)] {
            let next = waves.step(point, s * a + t * b).unwrap();
            let moved = next - point;
            let rise = moved.dot(frame.normal);
            // A vertical step is tangential as well where the surface is steep.
            let (a, b) = (moved.dot(s), moved.dot(t));
            let bend = 0.5 * (k11 * a * a + 2.0 * k12 * a * b + k22 * b * b);
            assert!(f64::abs(rise - bend) < 2e-8, "{rise} {bend}");
        }
    }
}
