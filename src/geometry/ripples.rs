//! A height field z = H + Σ A cos(k·(x, y) + p) of water, air above it, floor and camera below it.
//!
//! The validated surface is so flat that no ray from straight above meets it twice, refracted or reflected.

use glam::DVec3;
use nephroid_analytic::class::PathClass;
use nephroid_analytic::scene::{Family, MAX_WAVES, Ripple, WaterWavesScene};

use super::chains::{Chains, Leg};
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
        let sum = |of: fn(&Wave) -> f64| waves.iter().map(of).sum();
        Ripples {
            surface_z: scene.water.surface_z,
            index: scene.water.index,
            waves,
            count: scene.waves.len().min(MAX_WAVES),
            height: sum(|w| f64::abs(w[0])),
            slope: sum(|w| f64::abs(w[0]) * libm::hypot(w[1], w[2])),
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
}

impl Chains for Ripples {
    fn classes(&self) -> &'static [PathClass] {
        self.classes
    }

    fn follow(&self, _: usize, origin: DVec3, direction: DVec3) -> Leg {
        if !(direction.z < 0.0) {
            return Leg::DARK;
        }
        // Newton's method on the height of the ray above the surface, from the mean surface: one step for a vertical ray.
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
        let normal = unit(DVec3::new(-slopes[0], -slopes[1], 1.0));
        let (inside, f) = refract(unit(direction), normal, self.index);
        Leg {
            origin: origin + direction * t,
            direction: inside,
            weight: 1.0 - f,
        }
    }

    /// Whatever crosses the plane of the deepest trough is taken to meet the surface.
    fn blocks(&self, origin: DVec3, direction: DVec3, t_end: f64) -> bool {
        let t = (self.surface_z - self.height - origin.z) / direction.z;
        (t > 0.0) & (t < t_end)
    }

    /// The floor, wider by how far the steepest slope can send light sideways.
    fn targets(&self, _: usize, floor: &[DVec3]) -> Vec<DVec3> {
        let steepest = libm::atan(self.slope);
        let lean = steepest - libm::asin(libm::sin(steepest) / self.index);
        let reach = (self.surface_z + self.height) * libm::tan(lean);
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
