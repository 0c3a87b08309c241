//! A height field z = H + Σ A cos(k·(x, y) + p) of water, air above it, floor and camera below it.
//!
//! The validated surface is so flat that no ray from straight above meets it twice, refracted or reflected. Other rays can:
//! the first of their meetings is isolated by a bound on the surface's curvature.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, MAX_WAVES, Ripple, WaterWavesScene};

use super::chains::{Chains, Leg, Vertex};
use super::dielectric::refract;
use super::scene::unit;

/// Amplitude, wave vector and phase.
type Wave = [f64; 4];

/// The surface, ready for rays.
#[derive(Clone, Copy, Debug)]
pub struct Ripples {
    surface_z: f64,
    index: f64,
    waves: [Wave; MAX_WAVES],
    count: usize,
    /// Sum of all amplitudes [m].
    height: f64,
    /// Steepest slope that the waves allow.
    slope: f64,
    /// Largest curvature that they allow [1/m].
    curvature: f64,
    /// Rays from below that rise less than this are totally reflected wherever they meet the surface.
    least_rise: f64,
    classes: &'static [PathClass],
}

impl Ripples {
    /// Prepares a validated scene's surface.
    pub fn new(scene: &WaterWavesScene) -> Self {
        let mut waves = [[0.0; 4]; MAX_WAVES];
        for (to, from) in waves.iter_mut().zip(&scene.waves) {
            let Ripple {
                amplitude,
                wave_vector: [kx, ky],
                phase,
            } = *from;
            *to = [amplitude, kx, ky, phase];
        }
        let sum = |of: fn(&Wave) -> f64| -> f64 { waves.iter().map(of).sum() };
        let slope = sum(|w| f64::abs(w[0]) * libm::hypot(w[1], w[2]));
        let widest = libm::asin(1.0 / scene.water.index) + libm::atan(slope);
        Ripples {
            surface_z: scene.water.surface_z,
            index: scene.water.index,
            waves,
            count: scene.waves.len().min(MAX_WAVES),
            height: sum(|w| f64::abs(w[0])),
            slope,
            curvature: sum(|w| f64::abs(w[0]) * (w[1] * w[1] + w[2] * w[2])),
            least_rise: libm::cos(widest.min(core::f64::consts::FRAC_PI_2)).max(LEAST_RISE),
            classes: scene.classes(),
        }
    }

    /// Height above the mean, and its slopes along x and y.
    fn height(&self, x: f64, y: f64) -> [f64; 3] {
        let mut at = [0.0; 3];
        for [a, kx, ky, phase] in &self.waves[..self.count] {
            let (sine, cosine) = libm::sincos(kx * x + ky * y + phase);
            at[0] += a * cosine;
            at[1] -= a * kx * sine;
            at[2] -= a * ky * sine;
        }
        at
    }

    /// The unit normal on the side of the air.
    fn normal(&self, point: DVec3) -> DVec3 {
        let [_, by_x, by_y] = self.height(point.x, point.y);
        unit(DVec3::new(-by_x, -by_y, 1.0))
    }

    /// By how much the steepest slope turns light from straight above.
    fn lean(&self) -> f64 {
        let steepest = libm::atan(self.slope);
        steepest - libm::asin(libm::sin(steepest) / self.index)
    }

    /// Ray parameter where a ray from above that is steeper than the surface meets it, and the slopes there: Newton's method
    /// on the height of the ray above the surface, from the mean surface (one step for a vertical ray).
    fn meet_from_above(&self, origin: DVec3, direction: DVec3) -> (f64, [f64; 2]) {
        let mut t = (self.surface_z - origin.z) / direction.z;
        let mut slopes = [0.0; 2];
        for _ in 0..16 {
            let p = origin + direction * t;
            let [height, by_x, by_y] = self.height(p.x, p.y);
            slopes = [by_x, by_y];
            let above = p.z - self.surface_z - height;
            if f64::abs(above) <= 1e-14 * self.surface_z {
                break;
            }
            t -= above / (direction.z - by_x * direction.x - by_y * direction.y);
        }
        (t, slopes)
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

/// A ray in one of the media, and how far it is beyond the surface: negative inside the medium.
struct Ray<'a> {
    surface: &'a Ripples,
    origin: DVec3,
    direction: DVec3,
    /// 1 in the water, -1 in the air.
    side: f64,
    /// Bound on the second derivative of `beyond` along the ray.
    bend: f64,
}

/// Rays that rise or fall less than this part of their length are not followed.
const LEAST_RISE: f64 = 1e-3;
/// Kernels that send light farther from the vertical than this [rad] reach the floor from an unbounded part of the surface.
const WIDEST: f64 = 1.5;
/// Halvings of a part of a ray in the search for its first meeting.
const HALVINGS: u32 = 48;

impl<'a> Ray<'a> {
    fn new(surface: &'a Ripples, origin: DVec3, direction: DVec3, side: f64) -> Self {
        let plan = direction.x * direction.x + direction.y * direction.y;
        Ray {
            surface,
            origin,
            direction,
            side,
            bend: surface.curvature * plan,
        }
    }

    /// The value, and its derivative.
    fn beyond(&self, t: f64) -> [f64; 2] {
        let (p, d) = (self.origin + self.direction * t, self.direction);
        let [height, by_x, by_y] = self.surface.height(p.x, p.y);
        let value = p.z - self.surface.surface_z - height;
        [
            self.side * value,
            self.side * (d.z - by_x * d.x - by_y * d.y),
        ]
    }

    /// The first t in [a, b] at which `beyond` is not negative any more; `None` if it stays negative. `at` are its values
    /// at a, where it is negative, and at b.
    fn first_meeting(&self, [a, b]: [f64; 2], at: [f64; 2], halvings: u32) -> Option<f64> {
        let (h, [from, to]) = (b - a, at);
        // The chord is off by no more than h²/8 times the bend, its slope by no more than h/2 times that.
        if to < 0.0 && from.max(to) + 0.125 * self.bend * h * h < 0.0 {
            return None;
        }
        if to >= 0.0 && to - from > 0.5 * self.bend * h * h {
            return Some(self.root(a, b));
        }
        if halvings == 0 {
            return (to >= 0.0).then_some(b);
        }
        let middle = 0.5 * (a + b);
        let [value, _] = self.beyond(middle);
        let left = self.first_meeting([a, middle], [from, value], halvings - 1);
        if left.is_some() || value >= 0.0 {
            return left.or(Some(middle));
        }
        self.first_meeting([middle, b], [value, to], halvings - 1)
    }

    /// The root between a and b, between which `beyond` increases: Newton's method, halving where that leaves the interval.
    fn root(&self, mut a: f64, mut b: f64) -> f64 {
        let mut t = 0.5 * (a + b);
        for _ in 0..60 {
            let [value, slope] = self.beyond(t);
            if f64::abs(value) <= 1e-15 * self.surface.surface_z {
                break;
            }
            if value < 0.0 {
                a = t;
            } else {
                b = t;
            }
            let newton = t - value / slope;
            t = if newton > a && newton < b {
                newton
            } else {
                0.5 * (a + b)
            };
        }
        t
    }
}

impl Chains for Ripples {
    const REFRACTS: bool = true;
    const MEETS_ITSELF: bool = true;

    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, _: usize, origin: DVec3, direction: DVec3) -> Leg {
        if !(direction.z < 0.0) {
            return Leg::DARK;
        }
        let (t, slopes) = self.meet_from_above(origin, direction);
        let normal = unit(DVec3::new(-slopes[0], -slopes[1], 1.0));
        let (inside, f) = refract(unit(direction), normal, self.index);
        Leg {
            origin: origin + direction * t,
            direction: inside,
            weight: 1.0 - f,
        }
    }

    fn strike(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        if !(direction.z < 0.0) {
            return None;
        }
        let (t, [by_x, by_y]) = self.meet_from_above(origin, direction);
        let normal = unit(DVec3::new(-by_x, -by_y, 1.0));
        self.vertex(origin + direction * t, normal, direction, self.index)
    }

    fn trace_back(&self, _: usize, origin: DVec3, direction: DVec3) -> Option<Vertex> {
        if !(direction.z >= self.least_rise) {
            return None;
        }
        let at = |z: f64| (self.surface_z + z - origin.z) / direction.z;
        let (low, high) = (at(-self.height), at(self.height));
        let ray = Ray::new(self, origin, direction, 1.0);
        let ends = [low, high].map(|t| ray.beyond(t)[0]);
        let t = ray.first_meeting([low, high], ends, HALVINGS)?;
        let point = origin + direction * t;
        self.vertex(point, -self.normal(point), direction, 1.0 / self.index)
    }

    /// A ray that hardly rises or falls is taken to meet the surface at once.
    fn again(&self, vertex: &Vertex, direction: DVec3) -> f64 {
        let steep = f64::abs(direction.z) / f64::sqrt(direction.dot(direction));
        let side = if vertex.normal.z < 0.0 { 1.0 } else { -1.0 };
        let ray = Ray::new(self, vertex.point, direction, side);
        let [_, departs] = ray.beyond(0.0);
        if !(steep > LEAST_RISE && departs < 0.0) {
            return 0.0;
        }
        // Up to where the ray is below all troughs, or above all crests.
        let end = f64::copysign(self.height, direction.z);
        let end = (self.surface_z + end - vertex.point.z) / direction.z;
        // The bend brings it back to zero at twice this, at the soonest.
        let start = -departs / ray.bend;
        if !(start < end) {
            return f64::INFINITY;
        }
        let ends = [start, end].map(|t| ray.beyond(t)[0]);
        ray.first_meeting([start, end], ends, HALVINGS)
            .unwrap_or(f64::INFINITY)
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        None
    }

    fn radiance_gain(&self) -> f64 {
        self.index * self.index
    }

    fn exposed(&self, x: DVec3, alpha: f64) -> Option<Vec<DVec3>> {
        let widest = self.lean() + alpha;
        if !(widest < WIDEST) {
            return None;
        }
        let top = self.surface_z + self.height;
        let reach = top * libm::tan(widest);
        let wide = DVec3::new(reach, reach, 0.0);
        Some([x - wide, x + wide].map(|p| p.with_z(top)).to_vec())
    }

    /// Whatever crosses the plane of the deepest trough is taken to meet the surface.
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let t = (self.surface_z - self.height - origin.z) / direction.z;
        (t > 0.0) & (t < t_end)
    }

    /// The floor, wider by how far the steepest slope can send light sideways.
    fn targets(&self, _: usize, floor: &[DVec3]) -> Vec<DVec3> {
        let reach = (self.surface_z + self.height) * libm::tan(self.lean());
        let mut targets = Vec::with_capacity(16);
        for &corner in floor {
            for (x, y) in [
                (-reach, -reach),
                (reach, -reach),
                (-reach, reach),
                (reach, reach),
            ] {
                targets.push(corner + DVec3::new(x, y, self.surface_z + self.height));
            }
        }
        targets
    }
}
