//! Where photons start: a pair of uniforms to a ray, with the flux that each photon carries when all are equally likely.

use core::f64::consts::TAU;

use glam::DVec3;

use super::light::{Directional, Point};
use super::turn::sin_cos_of_turns;

/// Draws photons of equal flux.
pub trait Emitter: Copy + Send + Sync + 'static {
    /// The ray of a photon.
    fn ray(&self, u: f64, v: f64) -> (DVec3, DVec3);

    /// Flux of all the light that is drawn from [W]: each of N photons stands for 1/N of it.
    fn flux(&self) -> f64;
}

/// Uniform over the directions from a point whose z component is in [low, high]: a cap about the downward axis, or the
/// whole sphere.
#[derive(Clone, Copy, Debug)]
pub struct Cap {
    position: DVec3,
    low: f64,
    extent: f64,
    flux: f64,
}

impl Cap {
    /// The directions that are drawn from [sr].
    pub fn solid_angle(&self) -> f64 {
        TAU * self.extent
    }
}

impl Emitter for Cap {
    #[inline(always)]
    fn ray(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let z = self.low + self.extent * v;
        let square = 1.0 - z * z;
        let r = f64::sqrt(if square > 0.0 { square } else { 0.0 });
        let (s, c) = sin_cos_of_turns(u);
        (self.position, DVec3::new(r * c, r * s, z))
    }

    fn flux(&self) -> f64 {
        self.flux
    }
}

/// Uniform over the directions from a point that are within an angle of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    position: DVec3,
    /// The axis last; orthonormal.
    frame: [DVec3; 3],
    /// 1 - cos of the angle.
    extent: f64,
    flux: f64,
}

impl Cone {
    /// The directions that are drawn from [sr].
    pub fn solid_angle(&self) -> f64 {
        TAU * self.extent
    }
}

impl Emitter for Cone {
    #[inline(always)]
    fn ray(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        // 1 - cos θ, from which sin² θ has no cancellation next to the axis.
        let down = self.extent * v;
        let r = f64::sqrt(down * (2.0 - down));
        let (s, c) = sin_cos_of_turns(u);
        let [e1, e2, axis] = self.frame;
        let direction = e1 * (r * c) + e2 * (r * s) + axis * (1.0 - down);
        (self.position, direction)
    }

    fn flux(&self) -> f64 {
        self.flux
    }
}

impl Point {
    /// Uniform over a cone that contains the convex hull of `targets`, about the mean of their directions; over the sphere
    /// if that is wider than a hemisphere. (A narrower cone is convex: it contains the hull of what it contains.)
    pub fn cone(&self, targets: &[DVec3]) -> Cone {
        let towards = |&target: &DVec3| {
            let d = target - self.position;
            d / f64::sqrt(d.dot(d))
        };
        let sum: DVec3 = targets.iter().map(towards).sum();
        let length = f64::sqrt(sum.dot(sum));
        let axis = sum / length;
        // A target at the light itself gives NaN, and the sphere. The margin keeps the border inside.
        let lowest = targets.iter().map(|t| towards(t).dot(axis) - 1e-12);
        let lowest = lowest.fold(1.0, |a, b| if b >= a { a } else { b });
        let (axis, extent) = if lowest > 0.0 {
            (axis, 1.0 - lowest)
        } else {
            (DVec3::NEG_Z, 2.0)
        };
        let aside = if axis.z.abs() > 0.5 {
            DVec3::X
        } else {
            DVec3::Z
        };
        let e1 = axis.cross(aside);
        let e1 = e1 / f64::sqrt(e1.dot(e1));
        Cone {
            position: self.position,
            frame: [e1, axis.cross(e1), axis],
            extent,
            flux: self.intensity * TAU * extent,
        }
    }

    /// Uniform over the sphere: density 1/(4π) per steradian.
    pub fn everywhere(&self) -> Cap {
        self.cap(1.0)
    }

    /// Uniform over all directions downwards.
    pub fn lower_hemisphere(&self) -> Cap {
        self.cap(0.0)
    }

    /// Uniform over the smallest downward cap that contains the convex hull of `targets`, or over the sphere if part of
    /// the hull is above the light. (A cap of at most a hemisphere is geodesically convex: it contains the hull of what
    /// it contains.)
    pub fn towards_hull(&self, targets: &[DVec3]) -> Cap {
        let highest = targets.iter().fold(-1.0, |highest, &target| {
            let d = target - self.position;
            let z = d.z / f64::sqrt(d.dot(d));
            // The margin keeps the border inside; a target at the light itself gives NaN, and the sphere.
            if z + 1e-12 <= highest {
                highest
            } else if z + 1e-12 <= 0.0 {
                z + 1e-12
            } else {
                1.0
            }
        });
        self.cap(highest)
    }

    fn cap(&self, highest: f64) -> Cap {
        let extent = highest + 1.0;
        Cap {
            position: self.position,
            low: -1.0,
            extent,
            flux: self.intensity * TAU * extent,
        }
    }
}

/// Uniform over a cross-section of a directional beam: the one whose undisturbed light covers a rectangle of the plane
/// z = 0.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    travel: DVec3,
    /// Start of the photon for u = v = 0, above everything.
    corner: DVec3,
    extent: [f64; 2],
    flux: f64,
}

impl Beam {
    /// The area of the cross-section perpendicular to the light that is drawn from [m²].
    pub fn cross_section(&self) -> f64 {
        -self.travel.z * self.extent[0] * self.extent[1]
    }
}

impl Emitter for Beam {
    #[inline(always)]
    fn ray(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let offset = DVec3::new(self.extent[0] * u, self.extent[1] * v, 0.0);
        (self.corner + offset, self.travel)
    }

    fn flux(&self) -> f64 {
        self.flux
    }
}

impl Directional {
    /// Uniform over the beam that covers the convex hull of `targets`.
    pub fn towards_hull(&self, targets: &[DVec3]) -> Beam {
        self.beam(targets, f64::NEG_INFINITY)
    }

    /// The same, from a start that is higher than `highest` as well.
    pub fn beam(&self, targets: &[DVec3], highest: f64) -> Beam {
        let mut low = DVec3::splat(f64::INFINITY);
        let mut high = DVec3::splat(f64::NEG_INFINITY);
        for &target in targets {
            let shadow = target - self.travel * (target.z / self.travel.z);
            let shadow = DVec3::new(shadow.x, shadow.y, target.z);
            low = low.min(shadow);
            high = high.max(shadow);
        }
        let extent = [high.x - low.x, high.y - low.y];
        // Starts higher than every target: whatever a photon can meet is then before it.
        let start = high.z.max(highest) + 1.0;
        let corner = DVec3::new(low.x, low.y, 0.0) + self.travel * (start / self.travel.z);
        Beam {
            travel: self.travel,
            corner,
            extent,
            flux: self.irradiance * -self.travel.z * extent[0] * extent[1],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_contains_what_it_is_aimed_at_and_no_more_than_a_hemisphere() {
        let light = Point {
            position: DVec3::new(0.25, 0.0, 2.0),
            intensity: 3.0,
        };
        let targets = [DVec3::new(-3.0, 3.0, 0.0), DVec3::new(0.7, 1.0, 1.1)];
        let cap = light.towards_hull(&targets);
        assert!((cap.flux() / (3.0 * TAU * cap.extent) - 1.0).abs() < 1e-15);
        for k in 0..=100 {
            let p = targets[0] + (targets[1] - targets[0]) * (f64::from(k) / 100.0);
            let d = p - light.position;
            assert!(d.z / d.length() <= cap.low + cap.extent);
        }
        assert!(cap.extent < 1.0);
        assert_eq!(light.towards_hull(&[DVec3::new(0.0, 1.0, 2.5)]).extent, 2.0);
        assert_eq!(light.everywhere().extent, 2.0);
    }

    #[test]
    fn a_cone_contains_what_it_is_aimed_at_and_nothing_far_from_it() {
        let light = Point {
            position: DVec3::new(0.25, 0.0, 2.0),
            intensity: 3.0,
        };
        let targets = [
            DVec3::new(1.0, 2.0, 3.0),
            DVec3::new(1.5, 2.5, 2.5),
            DVec3::new(0.5, 2.5, 3.5),
        ];
        let cone = light.cone(&targets);
        assert!((cone.flux() / (3.0 * TAU * cone.extent) - 1.0).abs() < 1e-15);
        let axis = cone.frame[2];
        for target in targets {
            let d = target - light.position;
            assert!(1.0 - d.dot(axis) / d.length() <= cone.extent);
        }
        assert!(cone.extent < 0.1);
        // Uniform over the cap: the mean of the directions is on the axis, half way down.
        let (mut mean, n) = (DVec3::ZERO, 64);
        for k in 0..n * n {
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
            let (origin, d) = cone.ray(at(k % n), at(k / n));
            assert!(origin == light.position && (d.length() - 1.0).abs() < 1e-14);
            assert!(1.0 - d.dot(axis) <= cone.extent * (1.0 + 1e-14));
            mean += d / f64::from(n * n);
        }
        assert!((mean - axis * (1.0 - 0.5 * cone.extent)).length() < 1e-12);
        // All around, and at the light itself: the sphere.
        let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let around = [at(0.25, 5.0), at(0.25, -1.0), at(9.0, 2.0)];
        for wide in [&around[..], &[light.position]] {
            assert_eq!(light.cone(wide).extent, 2.0);
        }
    }

    #[test]
    fn a_beam_covers_its_targets_and_carries_their_shadow() {
        let light = Directional {
            travel: DVec3::new(libm::cos(0.5), 0.0, -libm::sin(0.5)),
            irradiance: 3.4,
        };
        let targets = [DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.5, 1.0, 0.7)];
        let beam = light.towards_hull(&targets);
        let length = 2.5 + 0.7 * libm::cos(0.5) / libm::sin(0.5);
        let flux = 3.4 * libm::sin(0.5) * length * 3.0;
        assert!((beam.flux() / flux - 1.0).abs() < 1e-14);
        for (u, v, target) in [(0.0, 0.0, targets[0]), (1.0, 1.0, targets[1])] {
            let (o, d) = beam.ray(u, v);
            let t = (target.z - o.z) / d.z;
            assert!(t > 0.0 && (o + d * t - target).length() < 1e-14);
        }
    }
}
