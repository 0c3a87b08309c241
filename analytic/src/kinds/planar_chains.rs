//! Chains of vertical plane mirrors on a floor: a wedge of angle π/m, and a corridor of two parallel mirrors.
//!
//! A mirror chain shows the light as images, all at its height h; an image of k bounces lights the floor z = 0 by
//!
//! ```text
//! E = R^k I h/(d² + h²)^{3/2},      d its plan distance from the floor point.
//! ```
//!
//! **Wedge**: mirrors are the half-planes at polar angles 0 and π/m, edge on the z axis. A light at (ρ, β, h) has one
//! image in every other sector of width π/m: for s = 1..m at πs/m + β (s even) or π(s+1)/m - β (s odd), and for
//! -s at -πs/m + β or -π(s-1)/m - β, of s bounces each; s = ±m is the same image. A kaleidoscope shows each of them to
//! the whole wedge, exactly once. Seen from a point at (r, θ), d² = (ρ-r)² + 4ρr sin²((φ-θ)/2): no cancellation.
//!
//! **Corridor**: mirrors x = 0 and x = W. Images stand at 2jW + x_l (|2j| bounces) and 2jW - x_l (|2j-1| bounces): two of
//! each number. An image of k bounces is at least (k-1)W away, so that the orders after K ≥ 1 add up to at most
//! 2 I h/W³ · R^{K+1} min(1/((1-R) K³), 1/K³ + 1/(2K²)): that bound enters the error.
//!
//! Mirrors absorb on their backs: outside the wedge or corridor it is dark. Theory block M; positions and tail bound
//! derived here. No singularity. **Accuracy**: a few units of rounding times the size of the coordinates over the
//! distance.

use crate::kinds::{Estimate, power, rounding_error};
use crate::scalar::Scalar;
use crate::vector::Vec3;

/// The largest m of a wedge, and the most bounces of a corridor that are listed one by one.
pub const MAX_BOUNCES: u32 = 64;

/// The most orders of the unbounded series that are added up; the rest is in the error bound.
const MAX_ORDERS: u32 = 1 << 20;

/// An image of the light that lights a floor point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image<S> {
    /// Number of bounces k.
    pub bounces: u32,
    /// Where the image stands: polar angle in (-π, 2π) in a wedge, x [m] in a corridor.
    pub place: S,
    /// Irradiance of the floor point [W/m²].
    pub irradiance: S,
    /// Relative change of the irradiance per relative change of the coordinates.
    pub conditioning: S,
}

/// What the floor point sees of a light at plan distance √`plan_squared` and height `height`.
#[inline(always)]
fn irradiance<S: Scalar>(intensity: S, height: S, plan_squared: S) -> (S, S) {
    let squared = plan_squared + height.squared();
    let distance = squared.sqrt();
    (intensity * height / (squared * distance), distance)
}

/// Adds up the images of one number of bounces. A point within `margin` [m] of a mirror may be lit or dark.
fn total<S: Scalar>(images: [Option<Image<S>>; 2], lit: bool, on_mirror: bool) -> Estimate<S> {
    let mut sum = Estimate::NONE;
    for image in images.into_iter().flatten() {
        if lit {
            sum.add(image.irradiance, image.conditioning);
        }
        if on_mirror {
            sum.error += image.irradiance;
        }
    }
    sum
}

/// A wedge of angle π/m with its light.
#[derive(Clone, Copy, Debug)]
pub struct Wedge<S> {
    /// m ≥ 1: the wedge has the angle π/m.
    pub m: u32,
    /// Plan distance ρ of the light from the edge [m].
    pub radius: S,
    /// Polar angle β of the light, in (0, π/m) [rad].
    pub angle: S,
    /// Height h of the light [m].
    pub height: S,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Specular reflectance R of both mirrors.
    pub reflectance: S,
}

impl<S: Scalar> Wedge<S> {
    /// Angle of the wedge [rad].
    pub fn opening(&self) -> S {
        S::PI / S::from_f64(f64::from(self.m))
    }

    /// Whether (x, y) is in front of both mirrors, and whether rounding decides.
    fn holds(&self, x: S, y: S) -> (bool, bool) {
        let opening = self.opening();
        let inside = y.min(x * opening.sin() - y * opening.cos());
        let near = rounding_error(x.hypot(y) + self.radius, S::ZERO);
        (inside >= -near, inside.abs() <= near)
    }

    /// Polar angles of the images of `bounces`, from the sectors s and -s.
    fn places(&self, bounces: u32) -> [Option<S>; 2] {
        if bounces == 0 || bounces > self.m {
            return [None, None];
        }
        let sectors = |s: u32| self.opening() * S::from_f64(f64::from(s));
        let (ahead, behind) = if bounces.is_multiple_of(2) {
            (sectors(bounces) + self.angle, self.angle - sectors(bounces))
        } else {
            (
                sectors(bounces + 1) - self.angle,
                -sectors(bounces - 1) - self.angle,
            )
        };
        [(bounces < self.m).then_some(ahead), Some(behind)]
    }

    /// The images of `bounces` reflections as (x, y) sees them, whether (x, y) is in the wedge or not.
    pub fn images(&self, x: S, y: S, bounces: u32) -> [Option<Image<S>>; 2] {
        let (r, theta) = (x.hypot(y), y.atan2(x));
        let weight = power(self.reflectance, bounces);
        self.places(bounces).map(|place| {
            place.map(|angle| {
                let half = (S::HALF * (angle - theta)).sin();
                let four = S::from_f64(4.0);
                let plan_squared =
                    (self.radius - r).squared() + four * self.radius * r * half.squared();
                let (e, distance) = irradiance(self.intensity, self.height, plan_squared);
                let size = self.radius + r;
                // Angles of up to 2π carry as many roundings as lengths do.
                let lengths = S::from_f64(9.0) * size / distance;
                Image {
                    bounces,
                    place: angle,
                    irradiance: weight * e,
                    conditioning: lengths + four + S::from_f64(f64::from(bounces)),
                }
            })
        })
    }

    /// Irradiance of the floor point (x, y) by light with exactly `bounces` reflections [W/m²].
    pub fn caustic(&self, x: S, y: S, bounces: u32) -> Estimate<S> {
        let (lit, marginal) = self.holds(x, y);
        total(self.images(x, y, bounces), lit, marginal)
    }

    /// Direct irradiance of the floor point (x, y) [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let (lit, marginal) = self.holds(x, y);
        let (r, theta) = (x.hypot(y), y.atan2(x));
        let half = (S::HALF * (self.angle - theta)).sin();
        let four = S::from_f64(4.0);
        let plan_squared = (self.radius - r).squared() + four * self.radius * r * half.squared();
        let (e, distance) = irradiance(self.intensity, self.height, plan_squared);
        let image = Image {
            bounces: 0,
            place: self.angle,
            irradiance: e,
            conditioning: four * (S::ONE + (self.radius + r) / distance),
        };
        total([Some(image), None], lit, marginal)
    }
}

/// A corridor between the mirrors x = 0 and x = W with its light.
#[derive(Clone, Copy, Debug)]
pub struct Corridor<S> {
    /// Width W [m].
    pub width: S,
    /// Position of the light [m], 0 < x < W, z > 0.
    pub light: Vec3<S>,
    /// Radiant intensity I [W/sr].
    pub intensity: S,
    /// Specular reflectance R of both mirrors.
    pub reflectance: S,
}

impl<S: Scalar> Corridor<S> {
    /// Whether x is between the mirrors, and whether rounding decides.
    fn holds(&self, x: S) -> (bool, bool) {
        let inside = x.min(self.width - x);
        let near = rounding_error(self.width, S::ZERO);
        (inside >= -near, inside.abs() <= near)
    }

    /// x of the images of `bounces` reflections.
    fn places(&self, bounces: u32) -> [S; 2] {
        let k = S::from_f64(f64::from(bounces));
        if bounces.is_multiple_of(2) {
            [k * self.width + self.light.x, self.light.x - k * self.width]
        } else {
            [
                (k + S::ONE) * self.width - self.light.x,
                -(k - S::ONE) * self.width - self.light.x,
            ]
        }
    }

    /// The images of `bounces` ≥ 1 reflections as (x, y) sees them, whether (x, y) is in the corridor or not.
    pub fn images(&self, x: S, y: S, bounces: u32) -> [Option<Image<S>>; 2] {
        if bounces == 0 {
            return [None, None];
        }
        let weight = power(self.reflectance, bounces);
        let dy = y - self.light.y;
        self.places(bounces).map(|place| {
            let plan_squared = (place - x).squared() + dy.squared();
            let (e, distance) = irradiance(self.intensity, self.light.z, plan_squared);
            let size = place.abs() + x.abs() + y.abs() + self.light.y.abs();
            let k = S::from_f64(f64::from(bounces));
            Some(Image {
                bounces,
                place,
                irradiance: weight * e,
                conditioning: S::from_f64(3.0) * size / distance + S::from_f64(4.0) + k,
            })
        })
    }

    /// Irradiance of the floor point (x, y) by light with exactly `bounces` reflections [W/m²].
    pub fn caustic(&self, x: S, y: S, bounces: u32) -> Estimate<S> {
        let (lit, marginal) = self.holds(x);
        total(self.images(x, y, bounces), lit, marginal)
    }

    /// Irradiance of the floor point (x, y) by light with any number of reflections from 1 on [W/m²]: orders are added
    /// up to where the bound of the rest is below rounding, or to 2²⁰; that bound is in the error.
    pub fn all_orders(&self, x: S, y: S) -> Estimate<S> {
        let mut sum = Estimate::NONE;
        for k in 1..=2 {
            let order = self.caustic(x, y, k);
            sum.value += order.value;
            sum.error += order.error;
        }
        let (lit, _) = self.holds(x);
        if !lit {
            return sum;
        }
        let goal = sum.value * S::EPSILON * S::from_f64(0.25);
        let mut last = 2;
        while last < MAX_ORDERS && self.rest(last) > goal {
            last *= 2;
        }
        // Horner's scheme from the smallest term on: R³ (g3 + R (g4 + R (...))).
        let dy_squared = (y - self.light.y).squared();
        let mut rest = S::ZERO;
        for k in (3..=last).rev() {
            let [a, b] = self.places(k).map(|place| {
                let plan_squared = (place - x).squared() + dy_squared;
                irradiance(self.intensity, self.light.z, plan_squared).0
            });
            rest = self.reflectance * rest + (a + b);
        }
        let rest = power(self.reflectance, 3) * rest;
        let size = (x.abs() + y.abs() + self.light.length()) / self.width;
        // Weights 1/k³ times k roundings each, and the coordinates.
        sum.error += rounding_error(rest, S::from_f64(24.0) + S::from_f64(6.0) * size);
        sum.error += self.rest(last) + rounding_error(sum.value + rest, S::ZERO);
        sum.value += rest;
        sum
    }

    /// Upper bound of the irradiance by more than `last` ≥ 1 reflections.
    fn rest(&self, last: u32) -> S {
        let k = S::from_f64(f64::from(last));
        let cube = k.squared() * k;
        let geometric = S::ONE / ((S::ONE - self.reflectance) * cube);
        let harmonic = S::ONE / cube + S::HALF / k.squared();
        let weight = power(self.reflectance, last + 1);
        let scale = S::TWO * self.intensity * self.light.z / (self.width.squared() * self.width);
        scale * weight * geometric.min(harmonic)
    }

    /// Direct irradiance of the floor point (x, y) [W/m²].
    pub fn direct(&self, x: S, y: S) -> Estimate<S> {
        let (lit, marginal) = self.holds(x);
        let plan_squared = (self.light.x - x).squared() + (self.light.y - y).squared();
        let (e, distance) = irradiance(self.intensity, self.light.z, plan_squared);
        let size = self.light.x.abs() + self.light.y.abs() + x.abs() + y.abs();
        let image = Image {
            bounces: 0,
            place: self.light.x,
            irradiance: e,
            conditioning: S::from_f64(4.0) * (S::ONE + size / distance),
        };
        total([Some(image), None], lit, marginal)
    }
}
