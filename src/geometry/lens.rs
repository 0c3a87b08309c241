//! Part of an ellipsoid as the front of a body of glass, in an opaque screen.
//!
//! The ellipsoid is |M (p - c)|² = 1 with M = diag(1/b, 1/b, 1/a), b² = a² (1 - 1/n²), normal M² (p - c); glass is below
//! it and below the screen, the plane of the rim.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, StigmaticRefractorsScene};

use super::chains::{Chains, Leg};
use super::dielectric::refract;
use super::scene::unit;

/// The lens, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    center: DVec3,
    /// Semi-axes [m].
    axes: DVec3,
    index: f64,
    /// Height of the screen [m].
    screen_z: f64,
    classes: &'static [PathClass],
}

impl Lens {
    /// Prepares a validated scene's lens.
    pub fn new(scene: &StigmaticRefractorsScene) -> Self {
        let lens = &scene.lens;
        let (a, n) = (lens.semi_axis, lens.index);
        let b = a * f64::sqrt(1.0 - 1.0 / (n * n));
        // The ray from the focus at the half angle, in the coordinates in which the ellipsoid is the unit sphere.
        let (sine, cosine) = libm::sincos(lens.half_angle_degrees.to_radians());
        let (focus, across, along) = (-1.0 / n, sine / b, cosine / a);
        let (square, half) = (across * across + along * along, focus * along);
        let length = (f64::sqrt(half * half + square * (1.0 - focus * focus)) - half) / square;
        Lens {
            center: DVec3::new(lens.center[0], lens.center[1], lens.defocus + a / n),
            axes: DVec3::new(b, b, a),
            index: n,
            screen_z: lens.defocus + length * cosine,
            classes: scene.classes(),
        }
    }
}

impl Chains for Lens {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, _: usize, origin: DVec3, direction: DVec3) -> Leg {
        let o = (origin - self.center) / self.axes;
        let d = direction / self.axes;
        let (a, b) = (d.dot(d), o.dot(d));
        let root = f64::sqrt(b * b - a * (o.dot(o) - 1.0));
        let t = -(b + root) / a;
        let point = origin + direction * t;
        // NaN, and thus no entry, where the ray misses.
        if !(t > 0.0 && point.z >= self.screen_z) {
            return Leg::DARK;
        }
        let normal = unit((point - self.center) / (self.axes * self.axes));
        let (inside, f) = refract(unit(direction), normal, self.index);
        Leg {
            origin: point,
            direction: inside,
            weight: 1.0 - f,
        }
    }

    /// Whatever crosses the plane of the screen meets the screen, or the lens above it.
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let t = (self.screen_z - origin.z) / direction.z;
        (t > 0.0) & (t < t_end)
    }

    /// The square around the rim, instead of the floor: no other light gets through, and it comes straight down.
    fn targets(&self, _: usize, _: &[DVec3]) -> Vec<DVec3> {
        let height = (self.screen_z - self.center.z) / self.axes.z;
        let radius = self.axes.x * f64::sqrt(1.0 - height * height);
        let top = self.center.z + self.axes.z;
        [
            (-radius, -radius),
            (radius, -radius),
            (-radius, radius),
            (radius, radius),
        ]
        .map(|(x, y)| DVec3::new(self.center.x + x, self.center.y + y, top))
        .to_vec()
    }
}
