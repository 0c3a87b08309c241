//! Part of an ellipsoid as the front of a body of glass, in an opaque screen.
//!
//! The ellipsoid is |M (p - c)|² = 1 with M = diag(1/b, 1/b, 1/a), b² = a² (1 - 1/n²), normal M² (p - c); glass is below
//! it and below the screen, the plane of the rim.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, StigmaticRefractorsScene};

use super::chains::{Chains, Leg, Vertex};
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

    /// Ray parameters at which a line enters and leaves the ellipsoid; NaN where it misses.
    fn crossings(&self, origin: DVec3, direction: DVec3) -> [f64; 2] {
        let o = (origin - self.center) / self.axes;
        let d = direction / self.axes;
        let (a, b) = (d.dot(d), o.dot(d));
        let root = f64::sqrt(b * b - a * (o.dot(o) - 1.0));
        [-(b + root) / a, (root - b) / a]
    }

    /// The unit normal on the side of the air.
    fn normal(&self, point: DVec3) -> DVec3 {
        unit((point - self.center) / (self.axes * self.axes))
    }

    /// Refraction of a ray that comes from the side of `normal`.
    fn vertex(&self, point: DVec3, normal: DVec3, direction: DVec3, n: f64) -> Option<Vertex> {
        let (direction, f) = refract(direction, normal, n);
        (f < 1.0).then(|| Vertex {
            point,
            direction,
            normal: -normal,
            weight: 1.0 - f,
        })
    }
}

impl Chains for Lens {
    const REFRACTS: bool = true;
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, _: usize, origin: DVec3, direction: DVec3) -> Leg {
        let [t, _] = self.crossings(origin, direction);
        let point = origin + direction * t;
        // NaN, and thus no entry, where the ray misses.
        if !(t > 0.0 && point.z >= self.screen_z) {
            return Leg::DARK;
        }
        let normal = self.normal(point);
        let (inside, f) = refract(unit(direction), normal, self.index);
        Leg {
            origin: point,
            direction: inside,
            weight: 1.0 - f,
        }
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let [enters, _] = self.crossings(origin, direction);
        let point = origin + direction * enters;
        // NaN, and thus no entry, where the ray misses.
        if !(enters > 0.0 && point.z >= self.screen_z) {
            return None;
        }
        self.vertex(point, self.normal(point), direction, self.index)
    }

    /// From below a ray reaches the surface only through the opening of the screen: where it crosses the screen's plane it is
    /// inside the ellipsoid.
    fn trace_back(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        let [enters, leaves] = self.crossings(origin, direction);
        let at_screen = (self.screen_z - origin.z) / direction.z;
        if !(direction.z > 0.0 && enters < at_screen && at_screen <= leaves) {
            return None;
        }
        let point = origin + direction * leaves;
        self.vertex(point, -self.normal(point), direction, 1.0 / self.index)
    }

    /// Outside nothing comes back to the convex front. Inside, a ray that leaves the ellipsoid above the screen meets its
    /// front again; any other one goes through the opening.
    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        let outside = vertex.normal.dot(self.normal(vertex.point)) > 0.0;
        let [_, leaves] = self.crossings(vertex.point, direction);
        let above = vertex.point.z + direction.z * leaves >= self.screen_z;
        if !outside && above {
            leaves
        } else {
            f64::INFINITY
        }
    }

    /// The screen is unbounded.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn radiance_gain(&self) -> f64 {
        self.index * self.index
    }

    fn exposed(&self, _: DVec3, _: f64) -> Option<Vec<DVec3>> {
        Some(self.targets(0, &[]))
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
