//! Quadrics about a centre: f(p) = qᵀ A q + 2 b·q - c = 0, q = p - o, with A diagonal in an orthonormal frame. Planes,
//! cylinders, spheres, paraboloids, ellipsoids and hyperboloids, upright or of revolution.
//!
//! With ∇f = 2 (A q + b) and n = ∇f/|∇f|, a curve in the surface has n·p″ = -p′ᵀ (2A) p′/|∇f|.

use glam::DVec3;

use super::patch::Patch;
use super::{Frame, Manifold, tangents};
use crate::geometry::quadratic::zeros;
use crate::geometry::scene::unit;

/// The quadric, and the part of it that is the surface.
#[derive(Clone, Debug)]
pub(super) struct Quadric {
    /// o [m].
    pub center: DVec3,
    /// Axes of the frame.
    pub axes: [DVec3; 3],
    /// Diagonal of A.
    pub square: DVec3,
    /// b, in the scene's frame.
    pub linear: DVec3,
    /// The surface.
    pub patch: Patch,
}

impl Quadric {
    /// A plane.
    pub fn plane(center: DVec3, normal: DVec3, patch: Patch) -> Self {
        Quadric {
            center,
            axes: DVec3::AXES,
            square: DVec3::ZERO,
            linear: normal,
            patch,
        }
    }

    /// A q.
    fn times(&self, q: DVec3) -> DVec3 {
        let [x, y, z] = self.axes;
        x * (self.square.x * q.dot(x))
            + y * (self.square.y * q.dot(y))
            + z * (self.square.z * q.dot(z))
    }

    /// Half of the gradient.
    fn half_gradient(&self, point: DVec3) -> DVec3 {
        self.times(point - self.center) + self.linear
    }
}

impl Manifold for Quadric {
    fn start(&self, x: DVec3, u: f64, v: f64) -> DVec3 {
        self.patch.point(x, u, v)
    }

    fn frame(&self, point: DVec3) -> Frame {
        let gradient = self.half_gradient(point);
        let length = f64::sqrt(gradient.dot(gradient));
        let normal = gradient / length;
        let [s, t] = tangents(normal);
        let (along_s, along_t) = (self.times(s), self.times(t));
        let bend = |a: DVec3, b: DVec3| -a.dot(b) / length;
        Frame {
            tangents: [s, t],
            normal,
            bends: [bend(along_s, s), bend(along_s, t), bend(along_t, t)],
        }
    }

    /// Along the normal at `point`, to the nearer of the two crossings. `point` is on the quadric, of which f is thus not
    /// evaluated: f(point + d) = 2 g·d + dᵀ A d.
    fn step(&self, point: DVec3, tangent: DVec3) -> Option<DVec3> {
        let gradient = self.half_gradient(point);
        let normal = unit(gradient);
        let away = self.times(tangent);
        let a = normal.dot(self.times(normal));
        let b = gradient.dot(normal) + away.dot(normal);
        let c = 2.0 * gradient.dot(tangent) + away.dot(tangent);
        let [s, t] = zeros(a, b, c);
        // A plane has one crossing, the other is infinite or NaN.
        let t = if f64::abs(s) < f64::abs(t) || t.is_nan() {
            s
        } else {
            t
        };
        t.is_finite().then(|| point + tangent + normal * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A general ellipsoid in a turned frame: the frame's normal and bends are those of steps along the surface.
    #[test]
    fn steps_stay_on_the_quadric_and_bend_as_the_frame_says() {
        let axes = [
            DVec3::new(0.6, 0.8, 0.0),
            DVec3::new(-0.8, 0.6, 0.0),
            DVec3::Z,
        ];
        for (square, linear) in [
            (DVec3::new(0.7, 1.9, 1.2), DVec3::ZERO),
            (DVec3::new(0.7, 0.7, -1.2), DVec3::ZERO),
            (DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 0.0, 0.4)),
        ] {
            let quadric = Quadric {
                center: DVec3::new(0.3, -0.2, 1.0),
                axes,
                square,
                linear,
                patch: Patch::Everything(DVec3::ZERO),
            };
            let f = |p: DVec3| {
                let q = p - quadric.center;
                quadric.times(q).dot(q) + 2.0 * linear.dot(q)
            };
            let point = DVec3::new(0.9, 0.5, 1.3);
            let level = f(point);
            let frame = quadric.frame(point);
            let [s, t] = frame.tangents;
            assert!(f64::abs(s.dot(t)) + f64::abs(s.dot(frame.normal)) < 1e-15);
            let [k11, k12, k22] = frame.bends;
            for (a, b) in [(1e-3, 0.0), (0.0, 1e-3), (1e-3, -2e-3)] {
                let next = quadric.step(point, s * a + t * b).unwrap();
                assert!(f64::abs(f(next) - level) < 1e-14);
                let rise = (next - point).dot(frame.normal);
                let bend = 0.5 * (k11 * a * a + 2.0 * k12 * a * b + k22 * b * b);
                assert!(f64::abs(rise - bend) < 1e-8, "{rise} {bend}");
            }
        }
    }

    #[test]
    fn a_plane_has_no_bend_and_every_step() {
        let plane = Quadric::plane(DVec3::Z, DVec3::Y, Patch::Everything(DVec3::Z));
        assert_eq!(
            plane.frame(DVec3::Z).bends,
            [0.0, 0.0, 0.0].map(|_: f64| -0.0)
        );
        let d = DVec3::new(3.0, 0.0, -4.0);
        assert_eq!(plane.step(DVec3::Z, d), Some(DVec3::Z + d));
    }
}
